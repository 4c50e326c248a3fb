"""Two results on meshes of their own: fields of one where the triangles (in space: tetrahedra) of the other
have their middles."""
import numpy as np

import results
from compare import Difference, Verdict, quantity_differences
from ending import require

NEAR = 0.2  # of a triangle: polygons of one curve differ
OUTSIDE = 0.02  # of a body's area that may lie outside of the other mesh
# Triangles or tetrahedra of the cells that other codes write, by their corners.
IN_PLANE = {"triangle": [(0, 1, 2)], "triangle6": [(0, 1, 2)],
            **dict.fromkeys(("quad", "quad8", "quad9"), [(0, 1, 2), (0, 2, 3)])}
IN_SPACE = {"tetra": [(0, 1, 2, 3)], "tetra10": [(0, 1, 2, 3)]}


def same_meshes(first, second):
    """Whether fields can be compared vertex by vertex. A run of FreeFEM has the scene's meshes, and does not
    write them."""
    if set(first.bodies) != set(second.bodies):
        return False
    pairs = [(body, second.bodies[name]) for name, body in first.bodies.items()]
    return all(b.points is None or np.array_equal(a.points, b.points)
               and np.array_equal(a.simplices, b.simplices)
               for a, b in pairs)


class Sampled:
    """The fields of a body on another mesh, at the middles of the elements of the first."""

    def __init__(self, name, first, second):
        corners = first.points[first.simplices]
        self.middles = corners.mean(1)
        self.areas = areas_of(corners)
        found, inside = located(second, self.middles, name)
        shape = barycentric(second.points[second.simplices[found]], self.middles)
        self.displacement = np.einsum("ij,ijk->ik", shape, second.displacement[second.simplices[found]])
        self.stress = None if second.stress is None else second.stress[found]
        self.outside = self.areas[~inside].sum() / self.areas.sum()


def compare_elsewhere(first, second, within):
    """The verdict on a run of mortier and a result on other meshes;
    bodies that only the first has are left out.

    Fields: root mean square of the difference over a body, relative to that of the field over all bodies.
    """
    names = [name for name in first.bodies if name in second.bodies]
    faults = [f"body {name}: not in the scene" for name in second.bodies if name not in first.bodies]
    if not names:
        return Verdict([], faults or ["no body in common"])
    space = {name: first.bodies[name].tetrahedra is not None for name in names}
    faults += [f"body {name}: in space in one of them, in the plane in the other" for name in names
               if space[name] != (second.bodies[name].tetrahedra is not None)]
    if faults:
        return Verdict([], faults)
    differences = []
    sampled = {name: Sampled(name, first.bodies[name], second.bodies[name]) for name in names}
    faults += [f"body {name}: {100 * each.outside:.2g} % of its {'volume' if space[name] else 'area'} lies "
               "outside of the other mesh"
               for name, each in sampled.items() if each.outside > OUTSIDE]
    for what in ("displacement", "stress"):
        pairs = {name: (at_middles(first.bodies[name], what), getattr(each, what))
                 for name, each in sampled.items() if getattr(each, what) is not None}
        size = np.sqrt(sum((sampled[name].areas * (a**2).sum(1)).sum() for name, (a, _) in pairs.items())
                       / sum(sampled[name].areas.sum() for name in pairs)) if pairs else 0.0
        for name, (a, b) in pairs.items():
            columns = min(a.shape[1], b.shape[1])
            squares = ((a[:, :columns] - b[:, :columns])**2).sum(1)
            mean = np.sqrt((sampled[name].areas * squares).sum() / sampled[name].areas.sum())
            differences.append(Difference(f"{what} {name}", mean / size if mean > 0 else mean, within))
    differences += resultant_differences(first, second, within) + quantity_differences(first, second, within)
    return Verdict(differences, faults)


def at_middles(body, what):
    return body.displacement[body.simplices].mean(1) if what == "displacement" else body.stress


def resultant_differences(first, second, within):
    pairs = [run.summary.get("final", {}).get("contact_resultant") for run in (first, second)]
    if None in pairs:
        return []
    nonmortar = [[each.get("nonmortar") for each in run.summary.get("interfaces", [])]
                 for run in (first, second)]
    if len(nonmortar[0]) == 1 and len(nonmortar[1]) == 1 and nonmortar[0] != nonmortar[1]:
        pairs[1] = [-each for each in pairs[1]]  # of the nonmortar side, which is the other one there
    size = max(float(np.linalg.norm(each)) for each in pairs)
    return [Difference(f"contact resultant {axis}", abs(a - b) / size if a != b else 0.0, within, a, b)
            for axis, a, b in zip("xyz", *pairs)]


def volumes(corners):
    """Of tetrahedra, n x 4 x 3; negative where they are turned back."""
    (x1, y1, z1), (x2, y2, z2), (x3, y3, z3) = ((corners[:, i] - corners[:, 0]).T for i in (1, 2, 3))
    return (x1 * (y2 * z3 - z2 * y3) + y1 * (z2 * x3 - x2 * z3) + z1 * (x2 * y3 - y2 * x3)) / 6


def areas_of(corners):
    """Volumes in space."""
    if corners.shape[2] == 3:
        return np.abs(volumes(corners))
    (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    return np.abs(ax * by - ay * bx) / 2


def located(body, points, name):
    """The triangle or tetrahedron of each point, the nearest one where it is outside; and whether it is
    inside, or outside by no more than NEAR of that element."""
    if body.tetrahedra is not None:
        found = tetrahedron_of(body.points[body.tetrahedra], points)
    else:
        require("matplotlib")
        from matplotlib.tri import Triangulation
        try:
            found = Triangulation(*body.points.T, body.triangles).get_trifinder()(*points.T)
        except (RuntimeError, ValueError) as error:
            raise results.ResultError(f"body {name}: a mesh in which no point can be found: "
                                      f"{error}") from error
    inside = found >= 0
    corners = body.points[body.simplices]
    middles = corners.mean(1)
    for i in np.flatnonzero(~inside):
        found[i] = np.linalg.norm(middles - points[i], axis=1).argmin()
    inside |= barycentric(corners[found], points).min(1) > -NEAR
    return found, inside


def tetrahedron_of(corners, points):
    """Of each point, -1 where it is in none. corners: n x 4 x 3."""
    low, high = corners.min((0, 1)), corners.max((0, 1))
    size = max(float((corners.max(1) - corners.min(1)).mean()), 1e-300)  # of the boxes that are looked into
    count = np.clip(((high - low) / size).astype(int), 1, 128)

    def boxes(places):
        return np.clip(((places - low) / np.maximum(high - low, 1e-300) * count).astype(int), 0, count - 1)

    first, last = boxes(corners.min(1)), boxes(corners.max(1))
    wide = last - first + 1
    each = np.repeat(np.arange(len(corners)), wide.prod(1))  # an element in every box that it touches
    within = np.arange(len(each)) - np.repeat(np.cumsum(wide.prod(1)) - wide.prod(1), wide.prod(1))
    at = first[each] + np.stack([within % wide[each, 0], within // wide[each, 0] % wide[each, 1],
                                 within // (wide[each, 0] * wide[each, 1])], 1)
    number = np.ravel_multi_index(at.T, count)
    order = np.argsort(number, kind="stable")
    begin = np.searchsorted(number[order], np.arange(count.prod() + 1))
    found, best = np.full(len(points), -1), np.full(len(points), -1e-9)
    wanted = np.ravel_multi_index(boxes(points).T, count)
    for k in range(int((begin[wanted + 1] - begin[wanted]).max(initial=0))):
        tried = np.flatnonzero(begin[wanted] + k < begin[wanted + 1])
        element = each[order[begin[wanted[tried]] + k]]
        least = barycentric(corners[element], points[tried]).min(1)
        better = least > best[tried]
        found[tried[better]], best[tried[better]] = element[better], least[better]
    return found


def barycentric(corners, points):
    """Coordinates in a triangle each, n x 3, or in a tetrahedron, n x 4."""
    edges = np.moveaxis(corners[:, 1:] - corners[:, :1], 1, 2)
    flat = ~(np.abs(np.linalg.det(edges)) > 0)
    beyond = np.linalg.solve(np.where(flat[:, None, None], np.eye(edges.shape[1]), edges),
                             (points - corners[:, 0])[..., None])[..., 0]
    beyond[flat] = -1.0  # nothing is in it
    return np.column_stack([1 - beyond.sum(1), beyond])


def read_vtu_of(path):
    """A body that another code wrote: displacements by vertex and, where there are any, stresses by cell."""
    mesh = results.with_meshio(path)
    if "displacement" not in mesh.point_data:
        names = ", ".join(mesh.point_data) or "none"
        raise results.ResultError(f"{path}: point data {names}, expected displacement")
    elements, stresses = [], []
    space = any(cells.type in IN_SPACE for cells in mesh.cells)
    for block, cells in enumerate(mesh.cells):
        for corners in (IN_SPACE if space else IN_PLANE).get(cells.type, []):
            elements.append(cells.data[:, corners])
            if "stress" in mesh.cell_data:
                stresses.append(components(path, np.asarray(mesh.cell_data["stress"][block], float), space))
    if not elements:
        raise results.ResultError(f"{path}: no triangles, quadrangles or tetrahedra")
    displacement = np.asarray(mesh.point_data["displacement"], float)
    axes = 3 if space else 2
    if displacement.ndim != 2 or displacement.shape[1] < axes:
        raise results.ResultError(f"{path}: displacement of shape {displacement.shape}, expected "
                                  f"{'three' if space else 'two or three'} components")
    stress = np.concatenate(stresses) if stresses else None
    body = results.Body(displacement[:, :axes], stress, mesh.points[:, :axes],
                        **{"tetrahedra" if space else "triangles": np.concatenate(elements)})
    for what in ("displacement", "points", "stress"):
        if getattr(body, what) is not None:
            results.require_finite(path, what, getattr(body, what))
    return body


def components(path, stress, space):
    """In the plane s11, s22, s12 of three components, mortier's four, VTK's six (xx, yy, zz, xy, yz, xz) or
    all nine; in space VTK's six."""
    stress = stress.reshape(len(stress), -1)
    known = {3: (0, 1, 2), 4: (0, 1, 2), 6: (0, 1, 3), 9: (0, 4, 1)}
    in_space = {6: tuple(range(6)), 9: (0, 4, 8, 1, 5, 2)}
    columns = (in_space if space else known).get(stress.shape[1])
    if columns is None:
        raise results.ResultError(f"{path}: stress of {stress.shape[1]} components, expected "
                                  f"{'6 or 9' if space else '3, 4, 6 or 9'}")
    return stress[:, columns]
