"""Meshes of arrays and of meshio, and steps as meshes of meshio."""
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mortier import _core
from mortier.errors import InputError

if TYPE_CHECKING:
    import meshio

REFERENCES = ("gmsh:physical", "medit:ref")
DIMENSIONS = {"line": 1, "triangle": 2, "tetra": 3}


class Mesh(NamedTuple):
    """A mesh of triangles: vertices and edges are numbered from 0, triangles run in either sense, labels and
    regions are integers or names. Vertices of no triangle are left out."""

    points: ArrayLike  # n x 2, or n x 3 at one z [m]
    triangles: ArrayLike  # n x 3
    edges: ArrayLike  # n x 2, of the labelled boundary
    labels: ArrayLike  # of each edge
    regions: ArrayLike | None = None  # of each triangle


Names = list[tuple[str, str, int]]  # "label" or "region", name, number


def plain(mesh: Any, of: str) -> tuple[tuple[Any, ...], Names]:
    """A mesh as mortier writes it (counterclockwise, two columns, numbers), and the names of its numbers.
    InputError: points at several z."""
    names: Names = []
    arrays: list[Any] = [None if each is None else np.asarray(each) for each in Mesh(*mesh)]
    points, triangles, edges, labels, regions = arrays
    if points.ndim == 2 and points.shape[1] == 3:
        if np.ptp(points[:, 2]) > 1e-9 * np.ptp(points, axis=0).max(initial=0):
            raise InputError(f"{of}: points with z from {points[:, 2].min():g} to {points[:, 2].max():g}, "
                             "expected one plane")
        points = points[:, :2]
    labels, more = numbered(labels, "label")
    names += more
    if regions is not None:
        regions, more = numbered(regions, "region")
        names += more
    whole = points.ndim == triangles.ndim == edges.ndim == 2 and triangles.shape[1] == 3
    if whole and np.issubdtype(triangles.dtype, np.integer) and triangles.size and \
            np.issubdtype(points.dtype, np.number) and 0 <= triangles.min() and triangles.max() < len(points):
        a, b, c = (points[triangles[:, k]] for k in range(3))
        turned = (b - a)[:, 0] * (c - a)[:, 1] < (b - a)[:, 1] * (c - a)[:, 0]
        triangles = np.where(turned[:, None], triangles[:, [0, 2, 1]], triangles)
        used = np.unique(triangles)
        if len(used) < len(points) and np.isin(edges, used).all():
            points, triangles, edges = points[used], np.searchsorted(used, triangles), \
                np.searchsorted(used, edges)
    return (points, triangles, edges, labels, regions), names


def numbered(values: Any, of: str) -> tuple[Any, Names]:
    """Names as numbers from 1."""
    if values.dtype.kind not in "UO":
        return values, []
    words, numbers = np.unique(values.astype(str), return_inverse=True)
    return numbers + 1, [(of, str(word), number + 1) for number, word in enumerate(words)]


def write_meshio(path: Path, mesh: meshio.Mesh, of: str, region: Any = None) -> None:
    """As a file of Gmsh, with references of cells and cell sets as physical groups. InputError: no triangles
    or tetrahedra, or none in the region."""
    import meshio

    kinds = [block.type.rstrip("0123456789") for block in mesh.cells]
    chosen = [i for i, kind in enumerate(kinds) if kind in DIMENSIONS]
    dimension = {i: DIMENSIONS[kinds[i]] for i in chosen}
    whole = max(dimension.values(), default=0)
    if whole < 2:
        raise InputError(f"{of}: cells {', '.join(sorted(set(kinds))) or 'none'}, expected triangles or "
                         "tetrahedra")
    name = next((each for each in REFERENCES if each in mesh.cell_data), None)
    groups = {i: np.array(mesh.cell_data[name][i] if name else np.zeros(len(mesh.cells[i].data)), int)
              for i in chosen}
    names = {each: (int(number), int(of_group)) for each, (number, of_group) in mesh.field_data.items()}
    for each, sets in mesh.cell_sets.items():
        for i in chosen if not each.startswith("gmsh:") else ():
            if sets[i] is not None and len(sets[i]):
                taken = [groups[k].max(initial=0) for k in chosen if dimension[k] == dimension[i]]
                groups[i][sets[i]] = names.setdefault(each, (int(max(taken)) + 1, dimension[i]))[0]
    numbers = {str(number) for i in chosen if dimension[i] == whole for number in groups[i]}
    known = [each for each, (_, of_group) in names.items() if of_group == whole] or sorted(numbers)
    if region is not None and str(region) not in {*known, *numbers}:
        raise InputError(f"region {region}: expected one of {', '.join(known)}")
    points = np.zeros((len(mesh.points), 3))
    points[:, :np.shape(mesh.points)[1]] = mesh.points
    marks = [groups[i] for i in chosen]
    meshio.write(path, meshio.Mesh(points, [mesh.cells[i] for i in chosen],
                                   cell_data={"gmsh:physical": marks, "gmsh:geometrical": marks},
                                   field_data={each: np.array(pair) for each, pair in names.items()}),
                 file_format="gmsh22", binary=False)


def cells_of(step: _core.Step, name: str) -> dict[str, Any]:
    """What a body has by triangle or tetrahedron, by the names of the files."""
    return {"stress": step.stress[name], "von_mises": step.von_mises[name],
            "viscoplastic_strain": step.viscoplastic_strain[name], "viscoplastic": step.viscoplastic[name],
            "region": step.regions[name], "error": step.error[name]}


def to_meshio(step: _core.Step) -> dict[str, meshio.Mesh]:
    """Body -> mesh, with displacements by point and all else by triangle or tetrahedron."""
    import meshio

    meshes = {}
    for name, points in step.points.items():
        elements = (step.tetrahedra if points.shape[1] == 3 else step.triangles)[name]
        kind = {3: "triangle", 6: "triangle6", 4: "tetra", 10: "tetra10"}[elements.shape[1]]
        meshes[name] = meshio.Mesh(points, [(kind, elements)],
                                   point_data={"displacement": step.displacement[name]},
                                   cell_data={key: [of] for key, of in cells_of(step, name).items()})
    return meshes
