"""Mesh files that mortier does not read itself, as Medit text on standard output: `mesh_files.py FILE`.

What the program reads there (cpp/mesh/python_files.cpp): the letter r, the number of cells that lose the
nodes on their edges, a line break, the text. Cells and sides stand in it once for each of their groups, 0
where a cell has none; names are behind its End. Or the letter e and what is wrong with the file, or m where
memory does not suffice.
"""
from __future__ import annotations

import re
import sys
import traceback
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parent))

CORNERS = {"line": 2, "triangle": 3, "quad": 4, "tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}
DIMENSION = {"line": 1, "triangle": 2, "quad": 2, "tetra": 3, "pyramid": 3, "wedge": 3, "hexahedron": 3}
SECTIONS = {"line": "Edges", "triangle": "Triangles", "quad": "Quadrilaterals", "tetra": "Tetrahedra",
            "wedge": "Prisms", "pyramid": "Pyramids", "hexahedron": "Hexahedra"}
# Corners of the sides of a cell, of volumes by the numbers that Abaqus has for them.
SIDES = {"triangle": ((0, 1), (1, 2), (2, 0)), "quad": ((0, 1), (1, 2), (2, 3), (3, 0)),
         "tetra": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
         "pyramid": ((0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)),
         "wedge": ((0, 1, 2), (3, 5, 4), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
         "hexahedron": ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))}
REGIONS = ("gmsh:physical", "medit:ref", "region", "CellEntityIds", "MaterialIDs", "material", "cell_tags")


class Wrong(Exception):
    """A fault of the file, in one line."""


class Block(NamedTuple):
    kind: str
    cells: Any  # corners, by indices of points
    quadratic: bool
    groups: dict[str | int, Any]  # name or number: indices of cells


class Groups(NamedTuple):
    """A mesh with all that names parts of it."""

    points: Any  # n x 3 [m]
    blocks: list[Block]
    sides: dict[str, list[tuple[int, ...]]]  # by their corners
    nodes: dict[str, list[int]]  # sets, of which the sides are meant between them


def of_meshio(mesh: Any) -> Groups:
    """Cell sets, or integers that cells have, as groups. Wrong: cells of other kinds."""
    import numpy as np

    points = np.asarray(mesh.points, float)
    points = np.hstack([points, np.zeros((len(points), 3 - points.shape[1]))])
    whole = [name for name, values in mesh.cell_data.items()
             if all(np.ndim(v) == 1 and np.issubdtype(np.asarray(v).dtype, np.integer) for v in values)]
    name = next((each for each in REGIONS if each in whole), whole[0] if len(whole) == 1 else None)
    words = {(int(k), int(d)): word for word, (k, d) in getattr(mesh, "field_data", {}).items()}
    families = getattr(mesh, "cell_tags", {})
    blocks = []
    for b, block in enumerate(mesh.cells):
        kind = re.sub(r"\d+$", "", block.type)
        if kind == "vertex":
            continue
        if kind not in CORNERS:
            raise Wrong(f"cells of type {block.type}, expected one of {', '.join(CORNERS)}")
        cells = np.asarray(block.data)
        groups: dict[str | int, Any] = {}
        numbers = np.asarray(mesh.cell_data[name][b]) if name else np.zeros(len(cells), int)
        for number in np.unique(numbers).tolist():
            chosen = np.flatnonzero(numbers == number)
            for each in families.get(number, [words.get((number, DIMENSION[kind]), number)]):
                if each != 0:
                    groups[each] = np.concatenate([groups.get(each, chosen[:0]), chosen])
        for each, sets in mesh.cell_sets.items():
            if not each.startswith("gmsh:") and sets[b] is not None and len(sets[b]):
                groups[each] = np.asarray(sets[b])
        blocks.append(Block(kind, cells[:, :CORNERS[kind]], cells.shape[1] > CORNERS[kind], groups))
    return Groups(points, blocks, {}, {each: list(v) for each, v in mesh.point_sets.items()})


def outer_sides(blocks: list[Block]) -> Any:
    """Corners of the sides that one cell has, or cells of different groups have; -1 after three."""
    import numpy as np

    rows, owners = [], []
    for b, block in enumerate(blocks):
        group = np.zeros(len(block.cells), int)
        for k, chosen in enumerate(block.groups.values()):
            group[chosen] = group[chosen] * 31 + k + 1
        for side in SIDES[block.kind]:
            row = block.cells[:, list(side)]
            width = 2 if len(side) == 2 else 4
            rows.append(np.pad(np.sort(row, axis=1), ((0, 0), (0, width - row.shape[1])), constant_values=-1))
            owners.append(group + b * 1_000_003)
    sides, owner = np.concatenate(rows), np.concatenate(owners)
    order = np.lexsort(sides.T[::-1])
    sides, owner = sides[order], owner[order]
    begins = np.flatnonzero(np.append(True, (sides[1:] != sides[:-1]).any(axis=1)))
    ends = np.append(begins[1:], len(sides))
    kept = (ends - begins == 1) | (owner[begins] != owner[ends - 1])
    return around(sides[begins[kept]], blocks)


def around(chosen: Any, blocks: list[Block]) -> Any:
    """Sorted corners of sides in their order around the side, which matters where there are four."""
    if not len(chosen) or chosen.shape[1] == 2 or (chosen[:, 3] < 0).all():
        return chosen
    wanted = {tuple(side): side for side in chosen.tolist() if side[3] >= 0}
    for block in blocks:
        for side in (each for each in SIDES[block.kind] if len(each) == 4):
            for corners in block.cells[:, list(side)].tolist():
                if tuple(sorted(corners)) in wanted:
                    wanted[tuple(sorted(corners))] = corners
    import numpy as np
    return np.array([wanted.get(tuple(side), side) for side in chosen.tolist()])


def medit(mesh: Groups) -> tuple[int, str]:
    """The number of quadratic cells, and the text. Wrong: no cells, or nodes without a place."""
    import numpy as np

    dimension = max((DIMENSION[block.kind] for block in mesh.blocks if len(block.cells)), default=0)
    if dimension < 2:
        raise Wrong("no cells of a plane or of space, expected triangles, quadrangles, tetrahedra, "
                    "hexahedra, prisms or pyramids")
    bodies = [block for block in mesh.blocks if DIMENSION[block.kind] == dimension and len(block.cells)]
    used = np.unique(np.concatenate([block.cells.ravel() for block in bodies]))
    if used[0] < 0 or used[-1] >= len(mesh.points):
        raise Wrong(f"a cell has node {used[0] if used[0] < 0 else used[-1]}, counted from 0, expected one "
                    f"of {len(mesh.points)} nodes")
    for node in used[~np.isfinite(mesh.points[used]).all(axis=1)][:1]:
        raise Wrong(f"node {node}, counted from 0, is at {tuple(mesh.points[node].tolist())}, expected "
                    "finite coordinates")
    number = np.full(len(mesh.points) + 1, 0)
    number[used] = np.arange(1, len(used) + 1)

    rows: dict[str, list[str]] = {kind: [] for kind in SECTIONS}
    names: list[str] = []

    def numbers_of(groups: Any, of: str) -> dict[str | int, int]:
        taken = {each for each in groups if isinstance(each, int)}
        result: dict[str | int, int] = {each: each for each in taken}
        for each in groups:
            if each not in result:
                result[each] = next(k for k in range(len(taken) + 1, 10**9) if k not in taken)
                taken.add(result[each])
                names.append(f"# {of} {result[each]} = {each}\n")
        return result

    regions = numbers_of(dict.fromkeys(each for block in bodies for each in block.groups), "region")
    for block in bodies:
        lines = [" ".join(map(str, cell)) for cell in number[block.cells].tolist()]
        free = np.ones(len(lines), bool)
        for each, chosen in block.groups.items():
            free[chosen] = False
            rows[block.kind] += [f"{lines[i]} {regions[each]}\n" for i in np.asarray(chosen).tolist()]
        rows[block.kind] += [f"{lines[i]} 0\n" for i in np.flatnonzero(free).tolist()]

    sides = {each: set(chosen) for each, chosen in mesh.sides.items()}
    for block in mesh.blocks:
        if DIMENSION[block.kind] == dimension - 1:
            for each, chosen in block.groups.items():
                sides.setdefault(each, set()).update(map(tuple, block.cells[chosen].tolist()))
    outer = outer_sides(bodies) if mesh.nodes else None
    for each, nodes in mesh.nodes.items():
        inside = np.zeros(len(mesh.points) + 1, bool)
        inside[nodes] = True
        inside[-1] = True  # of the corner that is none
        found = outer[inside[outer].all(axis=1)].tolist()
        if found:
            sides.setdefault(each, set()).update(tuple(k for k in side if k >= 0) for side in found)
    labels = numbers_of(sides, "label")
    kinds = {2: "line", 3: "triangle", 4: "quad"}
    for each, corners in sides.items():
        for side in sorted(corners):
            if max(side) < len(mesh.points) and min(row := number[list(side)].tolist()) > 0:
                rows[kinds[len(side)]].append(" ".join(map(str, row)) + f" {labels[each]}\n")

    text = ["MeshVersionFormatted 2\nDimension 3\nVertices\n", f"{len(used)}\n"]
    text += [" ".join(map(repr, x)) + " 0\n" for x in mesh.points[used].tolist()]
    for kind, lines in rows.items():
        if lines:
            text += [f"{SECTIONS[kind]}\n{len(lines)}\n", *lines]
    quadratic = sum(len(block.cells) for block in bodies if block.quadratic)
    return quadratic, "".join([*text, "End\n", *names])


def read(path: Path) -> Groups:
    kind = path.suffix.lower()
    if kind == ".inp":
        import abaqus
        return abaqus.read(path)
    import meshio
    reader = {".vtk": meshio.vtk, ".vtu": meshio.vtu, ".xdmf": meshio.xdmf, ".med": meshio.med,
              ".meshb": meshio.medit}[kind]
    try:
        return of_meshio(reader.read(str(path)))
    except (ImportError, MemoryError, Wrong):
        raise
    except Exception as error:  # of whatever meshio meets in a damaged file
        why = str(error) or "in " + traceback.extract_tb(error.__traceback__)[-1].name
        raise Wrong(f"meshio cannot read it: {type(error).__name__}: {why}") from error


def answer(path: str) -> str:
    try:
        quadratic, text = medit(read(Path(path)))
        return f"r{quadratic}\n{text}"
    except MemoryError:
        return "m"
    except ImportError as error:
        package = (error.name or "").split(".")[0]
        return f"e: {sys.executable} has no {package}, which reads it (Debian package python3-{package})"
    except (Wrong, OSError) as error:
        line = " ".join(str(error).split())[:400]
        return "e" + (line if line.startswith(path) else f"{path}: {line}")


if __name__ == "__main__":
    import mesh_files  # this file as abaqus.py has it

    out, sys.stdout = sys.stdout.buffer, sys.stderr  # of what libraries print
    out.write(mesh_files.answer(sys.argv[1]).encode("utf-8", "surrogateescape"))
