"""Steps as meshes of meshio."""
from __future__ import annotations

import meshio

from mortier import _core


def to_meshio(step: _core.Step) -> dict[str, meshio.Mesh]:
    """Body -> mesh, with displacements by point and all else by triangle."""
    meshes = {}
    for name, points in step.points.items():
        triangles = step.triangles[name]
        cells = {"stress": step.stress[name], "von_mises": step.von_mises[name],
                 "viscoplastic_strain": step.viscoplastic_strain[name],
                 "viscoplastic": step.viscoplastic[name], "region": step.regions[name],
                 "error": step.error[name]}
        meshes[name] = meshio.Mesh(points, [("triangle" if triangles.shape[1] == 3 else "triangle6",
                                             triangles)],
                                   point_data={"displacement": step.displacement[name]},
                                   cell_data={key: [values] for key, values in cells.items()})
    return meshes
