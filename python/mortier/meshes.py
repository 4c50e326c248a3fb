"""Meshes of arrays and of meshio, and steps as meshes of meshio."""
from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mortier import _core
from mortier.errors import InputError

if TYPE_CHECKING:
    import meshio

REFERENCES = ("gmsh:physical", "medit:ref")


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
    if hasattr(mesh, "cells_dict"):
        mesh, names = of_meshio(mesh, of)
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


def of_meshio(mesh: meshio.Mesh, of: str) -> tuple[Mesh, Names]:
    """Its triangles and the lines that have a label. InputError: no triangles."""
    triangles, regions = marked(mesh, "triangle")
    edges, labels = marked(mesh, "line")
    if not len(triangles):
        kinds = ", ".join(sorted({block.type for block in mesh.cells}))
        raise InputError(f"{of}: cells {kinds or 'none'}, expected triangles")
    names = [("label" if dimension == 1 else "region", name, int(number))
             for name, (number, dimension) in mesh.field_data.items() if dimension in (1, 2)]
    for name, blocks in mesh.cell_sets_dict.items():
        for kind, cells in blocks.items():
            if name.startswith("gmsh:") or kind[:4] not in ("line", "tria") or \
                    any(name == each for _, each, _ in names):
                continue
            values = labels if kind[:4] == "line" else regions
            values[cells] = number = max(values.max(initial=0), 0) + 1
            names.append(("label" if kind[:4] == "line" else "region", name, int(number)))
    known = labels > 0
    return Mesh(mesh.points, triangles, edges[known], labels[known], regions), names


def marked(mesh: meshio.Mesh, kind: str) -> tuple[Any, Any]:
    """Corners of the cells of a kind, linear or quadratic, and their references (0 without)."""
    corners = 3 if kind == "triangle" else 2
    kinds = (kind, kind + ("6" if kind == "triangle" else "3"))
    chosen = [i for i, block in enumerate(mesh.cells) if block.type in kinds]
    name = next((each for each in REFERENCES if each in mesh.cell_data), None)
    cells = [mesh.cells[i].data[:, :corners] for i in chosen]
    values = [np.asarray(mesh.cell_data[name][i], int) if name else np.zeros(len(mesh.cells[i].data), int)
              for i in chosen]
    return (np.concatenate(cells), np.concatenate(values)) if cells else (np.zeros((0, corners), int),
                                                                          np.zeros(0, int))


def part(mesh: meshio.Mesh, region: int | str | None) -> Any:
    """The triangles of one region, by number or name, and the labelled lines along them."""
    whole, names = of_meshio(mesh, "mesh")
    if region is None:
        return mesh
    number = dict(((each, k) for of, each, k in names if of == "region")).get(str(region), region)
    chosen = np.array([each == number for each in np.asarray(whole.regions).tolist()])
    if not chosen.any():
        known = [each for of, each, _ in names if of == "region"] or sorted(set(np.asarray(whole.regions)))
        raise InputError(f"region {region}: expected one of {', '.join(map(str, known))}")
    triangles = np.asarray(whole.triangles)[chosen]
    sides = {tuple(side) for side in sides_of(triangles)}
    along = [tuple(sorted(edge)) in sides for edge in np.asarray(whole.edges).tolist()]
    words = {k: each for of, each, k in names if of == "label"}
    labels = [words.get(k, k) for k in np.asarray(whole.labels)[along].tolist()]
    return Mesh(whole.points, triangles, np.asarray(whole.edges)[along], labels)


def sides_of(triangles: Any) -> Iterator[list[int]]:
    for k in range(3):
        yield from np.sort(triangles[:, [k, (k + 1) % 3]], axis=1).tolist()


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
