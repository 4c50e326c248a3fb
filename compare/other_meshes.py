"""Two results on meshes of their own: fields of one where the triangles of the other have their middles."""
import contextlib
import io

import numpy as np

import results
from compare import Difference, Verdict, quantity_differences

NEAR = 0.2  # of a triangle: polygons of one curve differ
OUTSIDE = 0.02  # of a body's area that may lie outside of the other mesh


def same_meshes(first, second):
    """Whether fields can be compared vertex by vertex. A run of FreeFEM has the scene's meshes, and does not
    write them."""
    if set(first.bodies) != set(second.bodies):
        return False
    pairs = [(body, second.bodies[name]) for name, body in first.bodies.items()]
    return all(b.points is None or np.array_equal(a.points, b.points)
               and np.array_equal(a.triangles, b.triangles)
               for a, b in pairs)


class Sampled:
    """The fields of a body on another mesh, at the middles of the triangles of the first."""

    def __init__(self, name, first, second):
        corners = first.points[first.triangles]
        self.middles = corners.mean(1)
        self.areas = areas_of(corners)
        found, inside = located(second, self.middles, name)
        shape = barycentric(second.points[second.triangles[found]], self.middles)
        self.displacement = np.einsum("ij,ijk->ik", shape, second.displacement[second.triangles[found]])
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
    differences = []
    sampled = {name: Sampled(name, first.bodies[name], second.bodies[name]) for name in names}
    faults += [f"body {name}: {100 * each.outside:.2g} % of its area lies outside of the other mesh"
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
    return body.displacement[body.triangles].mean(1) if what == "displacement" else body.stress


def resultant_differences(first, second, within):
    pairs = [run.summary.get("final", {}).get("contact_resultant") for run in (first, second)]
    if None in pairs:
        return []
    size = max(float(np.linalg.norm(each)) for each in pairs)
    return [Difference(f"contact resultant {axis}", abs(a - b) / size if a != b else 0.0, within, a, b)
            for axis, a, b in zip("xy", *pairs)]


def areas_of(corners):
    (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    return np.abs(ax * by - ay * bx) / 2


def located(body, points, name):
    """The triangle of each point, the nearest one where it is outside; and whether it is inside, or outside
    by no more than NEAR of that triangle."""
    from matplotlib.tri import Triangulation

    try:
        found = Triangulation(*body.points.T, body.triangles).get_trifinder()(*points.T)
    except (RuntimeError, ValueError) as error:
        raise results.ResultError(f"body {name}: a mesh in which no point can be found: {error}") from error
    inside = found >= 0
    corners = body.points[body.triangles]
    middles = corners.mean(1)
    for i in np.flatnonzero(~inside):
        found[i] = np.linalg.norm(middles - points[i], axis=1).argmin()
    inside |= barycentric(corners[found], points).min(1) > -NEAR
    return found, inside


def barycentric(corners, points):
    """Coordinates in a triangle each: n x 3."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    p = points - corners[:, 0]
    twice = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    second = (p[:, 0] * b[:, 1] - p[:, 1] * b[:, 0]) / twice
    third = (a[:, 0] * p[:, 1] - a[:, 1] * p[:, 0]) / twice
    return np.column_stack([1 - second - third, second, third])


def read_vtu_of(path):
    """A body that another code wrote: displacements by vertex and, where there are any, stresses by cell."""
    import meshio

    results.checked(path, times=4)
    try:
        # it prints
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            mesh = meshio.read(path)
    except (Exception, SystemExit) as error:  # meshio ends the process on some faults
        raise results.ResultError(f"{path}: cannot be read: {error!r}") from error
    if "displacement" not in mesh.point_data:
        names = ", ".join(mesh.point_data) or "none"
        raise results.ResultError(f"{path}: point data {names}, expected displacement")
    triangles, stresses = [], []
    for block, cells in enumerate(mesh.cells):
        split = {"triangle": [(0, 1, 2)], "triangle6": [(0, 1, 2)], "quad": [(0, 1, 2), (0, 2, 3)],
                 "quad8": [(0, 1, 2), (0, 2, 3)], "quad9": [(0, 1, 2), (0, 2, 3)]}.get(cells.type, [])
        for corners in split:
            triangles.append(cells.data[:, corners])
            if "stress" in mesh.cell_data:
                stresses.append(in_plane(path, np.asarray(mesh.cell_data["stress"][block], float)))
    if not triangles:
        raise results.ResultError(f"{path}: no triangles and no quadrangles")
    displacement = np.asarray(mesh.point_data["displacement"], float)
    if displacement.ndim != 2 or displacement.shape[1] < 2:
        raise results.ResultError(f"{path}: displacement of shape {displacement.shape}, expected "
                                  "two or three components")
    stress = np.concatenate(stresses) if stresses else None
    body = results.Body(displacement[:, :2], stress, mesh.points[:, :2], np.concatenate(triangles))
    for what in ("displacement", "points", "stress"):
        if getattr(body, what) is not None:
            results.require_finite(path, what, getattr(body, what))
    return body


def in_plane(path, stress):
    """s11, s22, s12 of three components, mortier's four, VTK's six (xx, yy, zz, xy, yz, xz) or all nine."""
    stress = stress.reshape(len(stress), -1)
    columns = {3: (0, 1, 2), 4: (0, 1, 2), 6: (0, 1, 3), 9: (0, 4, 1)}.get(stress.shape[1])
    if columns is None:
        raise results.ResultError(f"{path}: stress of {stress.shape[1]} components, expected 3, 4, 6 or 9")
    return stress[:, columns]
