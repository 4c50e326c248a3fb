"""Errors of a run: norms of fields against an exact solution or a finer run,
relative to the size of the latter."""
import numpy as np

from problems import RunFailure
from other_meshes import barycentric, located  # problems.py says where it is

# Dunavant's rule of degree 5: weights (sum 1) and barycentric points
A, B = 0.059715871789770, 0.470142064105115
C, D = 0.797426985353087, 0.101286507323456
POINTS = np.array([[1 / 3] * 3, [A, B, B], [B, A, B], [B, B, A], [C, D, D], [D, C, D], [D, D, C]])
WEIGHTS = np.array([0.225] + 3 * [0.132394152788506] + 3 * [0.125939180544827])
GAUSS = np.polynomial.legendre.leggauss(4)
SAME = 1e-12  # of the extent: positions of one mesh written by two codes


class Exact:
    """Components of an exact field at time t."""

    def __init__(self, exact, let, time):
        self.exact, self.let, self.time = exact, let, time

    def __call__(self, body, points):
        x, y = points[..., 0], points[..., 1]
        names = {}
        for name, expression in self.let:
            names[name] = expression(x, y, self.time, **names)
        components = self.exact.get(body, self.exact.get(""))
        values = np.stack([each(x, y, self.time, **names) for each in components.values()], -1)
        if not np.isfinite(values).all():
            raise RunFailure(f"the exact solution is not finite in body {body or 'all'} at t = {self.time:g}")
        return values


class Sampled:
    """Fields of a finer run at any points."""

    def __init__(self, run):
        self.bodies = run.bodies

    def triangles(self, name, points):
        return located(self.bodies[name], points.reshape(-1, 2), name)[0].reshape(points.shape[:-1])

    def stress(self, name, points):
        body, found = self.bodies[name], self.triangles(name, points)
        if body.stress_at_points is None:
            return body.stress[found]
        return np.einsum("...i,...ij->...j", between_points(self.barycentric(name, points, found)),
                         body.stress_at_points[found])

    def displacement(self, name, points):
        found = self.triangles(name, points)
        return np.einsum("...i,...ij->...j", shapes(self.bodies[name], self.barycentric(name, points, found)),
                         self.bodies[name].displacement[nodes_of(self.bodies[name])[found]])

    def barycentric(self, name, points, found):
        """Of points in the triangles in which they are; in curved ones by Newton's method."""
        body = self.bodies[name]
        corners = body.points[body.triangles[found]].reshape(-1, 3, 2)
        at = barycentric(corners, points.reshape(-1, 2)).reshape(*points.shape[:-1], 3)
        if body.elements is None:
            return at
        nodes = body.points[body.elements[found]]
        for _ in range(4):
            miss = points - np.einsum("...i,...ij->...j", shapes(body, at), nodes)
            tangents = np.einsum("...di,...ij->...jd", slopes(body, at), nodes)
            step = np.linalg.solve(tangents, miss[..., None])[..., 0]
            at = at + np.concatenate([step, -step.sum(-1, keepdims=True)], -1)
        return at


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def nodes_of(body):
    return body.triangles if body.elements is None else body.elements


def shapes(body, at):
    """Shape functions of the displacement at barycentric coordinates, ... x nodes of a triangle."""
    if body.elements is None:
        return at
    return np.concatenate([at * (2 * at - 1), 4 * at * np.roll(at, -1, -1)], -1)


def slopes(body, at):
    """Their derivatives by the first two barycentric coordinates, of which the third is what is left,
    ... x 2 x nodes."""
    corners = np.broadcast_to(np.array([[1.0, 0, -1], [0, 1, -1]]), (*at.shape[:-1], 2, 3))
    if body.elements is None:
        return corners
    at = at[..., None, :]
    middles = 4 * (corners * np.roll(at, -1, -1) + at * np.roll(corners, -1, -1))
    return np.concatenate([corners * (4 * at - 1), middles], -1)


def between_points(at):
    """Weights of a stress that is linear, by its values at the points 2/3, 1/6, 1/6."""
    return 2 * at - 1 / 3


def quadrature(body):
    """Points, triangles x 7 x 2, and weights, triangles x 7; curved sides are mapped as displacements are."""
    corners = body.points[nodes_of(body)]
    points = np.einsum("qi,tij->tqj", shapes(body, POINTS), corners)
    tangents = np.einsum("qdi,tij->tqdj", slopes(body, POINTS), corners)
    return points, cross(tangents[..., 0, :], tangents[..., 1, :]) / 2 * WEIGHTS


def energy_density(stress, young, poisson):
    """s : E^-1 s; in plane stress s33 is not there."""
    s11, s22, s12, *beyond = np.moveaxis(stress, -1, 0)
    s33 = beyond[0] if beyond else 0.0
    return (s11**2 + s22**2 + s33**2 - 2 * poisson * (s11 * s22 + s33 * (s11 + s22)) +
            2 * (1 + poisson) * s12**2) / young


def completed(stress, components, poisson, ring=False):
    """An exact stress of the plane with the s33 that plane strain of an elastic body has,
    where it is asked for; that around an axis is to be given."""
    if stress.shape[-1] == components:
        return stress
    if ring or stress.shape[-1] > components:
        raise RunFailure("the exact solution has no s33, expected the stress around the axis" if ring else
                         "the exact solution has s33, expected none in plane stress")
    return np.concatenate([stress, poisson * (stress[..., :1] + stress[..., 1:2])], -1)


def same_mesh(a, b):
    return (a.triangles.shape == b.triangles.shape and a.points.shape == b.points.shape
            and np.array_equal(a.triangles, b.triangles)
            and np.abs(a.points - b.points).max() <= SAME * np.ptp(b.points))


def field_error(quantity, run, truth, materials, ring=False):
    """Energy norm of the stress error or L2 norm of the displacement error, relative.

    truth: Exact, or a run; integrals are taken on the finer of both meshes, of bodies of revolution (ring)
    over the whole ring.
    """
    difference = size = 0.0
    for name, body in run.bodies.items():
        if quantity == "energy" and name not in materials:
            raise RunFailure(f"error of the energy: body {name} has no young and poisson that are numbers")
        norm = (lambda v, name=name: energy_density(v, *materials[name])) if quantity == "energy" \
            else (lambda v: (v**2).sum(-1))
        attribute = "stress" if quantity == "energy" else "displacement"
        ours = Sampled(run)
        if isinstance(truth, Exact):
            points, weights = quadrature(body)
            exact, value = truth(name, points), on_quadrature(body, attribute)
        elif same_mesh(body, truth.bodies[name]):
            points, weights = quadrature(body)
            exact, value = on_quadrature(truth.bodies[name], attribute), on_quadrature(body, attribute)
        else:
            finer = max((body, truth.bodies[name]), key=lambda each: len(each.triangles))
            points, weights = quadrature(finer)
            exact = getattr(Sampled(truth), attribute)(name, points)
            value = getattr(ours, attribute)(name, points)
        if attribute == "stress":
            exact = completed(exact, value.shape[-1], materials[name][1], ring)
        if ring:
            weights = weights * points[..., 0]
        difference += (weights * norm(value - exact)).sum()
        size += (weights * norm(exact)).sum()
    return relative(np.sqrt(difference), np.sqrt(size))


def on_quadrature(body, attribute):
    if attribute == "displacement":
        return np.einsum("qi,tij->tqj", shapes(body, POINTS), body.displacement[nodes_of(body)])
    if body.stress_at_points is None:
        return np.repeat(body.stress[:, None], len(POINTS), 1)
    return np.einsum("qi,tij->tqj", between_points(POINTS), body.stress_at_points)


def pressure_error(run, truth, ring=False):
    """L2 norm of the pressure error on the nonmortar line, relative; ring: on the surface that it sweeps."""
    s, p, position = pressure_line(run, ring)
    nodes, weights = GAUSS
    if not isinstance(truth, Exact):
        other_s, other_p, _ = pressure_line(truth, ring)
        cuts = np.union1d(s, other_s[(other_s > s[0]) & (other_s < s[-1])])
    else:
        cuts = s
    h = np.diff(cuts)
    at = cuts[:-1, None] + h[:, None] * (nodes + 1) / 2
    w = h[:, None] * weights / 2
    if ring:
        w = w * np.interp(at, s, position[:, 0])
    if isinstance(truth, Exact):
        points = np.stack([np.interp(at, s, position[:, 0]), np.interp(at, s, position[:, 1])], -1)
        exact = truth("", points)[..., 0]
    else:
        exact = np.interp(at, other_s, other_p)
    difference = (w * (np.interp(at, s, p) - exact)**2).sum()
    return relative(np.sqrt(difference), np.sqrt((w * exact**2).sum()))


def pressure_line(run, ring=False):
    """Arc length, pressure and position of the nonmortar nodes in order;
    M^-1 p where a code gives forces only."""
    if run.contact is None:
        raise RunFailure("no contact pressure in this result")
    position = run.contact.position  # the nodes stand in the order of the line, the one body to its left
    across = position[-1] - position[0]
    # the same whichever body that is
    order = slice(None, None, -1 if across[np.abs(across).argmax()] < 0 else 1)
    position = position[order]
    steps = np.hypot(*np.diff(position, axis=0).T)
    if run.contact.interface is not None:  # several lines have nothing between them
        steps[np.diff(run.contact.interface[order]) != 0] = 0
    s = np.concatenate([[0], np.cumsum(steps)])
    if run.contact.pressure is not None:
        return s, run.contact.pressure[order], position
    h = np.diff(s)
    mass = np.zeros((len(s), len(s)))
    i = np.arange(len(h))
    # what the ends of an element stand for: 1, or the circumference
    a, b = (2 * np.pi * position[i, 0], 2 * np.pi * position[i + 1, 0]) if ring else (1, 1)
    mass[i, i] += h * (3 * a + b) / 12
    mass[i + 1, i + 1] += h * (a + 3 * b) / 12
    mass[i, i + 1] = mass[i + 1, i] = h * (a + b) / 12
    return s, np.linalg.solve(mass, run.contact.force[order]), position


def relative(difference, size):
    if not size > 0:
        raise RunFailure("the exact solution is zero: no relative error")
    return float(difference / size)


def error_of(measure, run, truth, materials, let, time, ring=False):
    """One error of a run; truth is the reference run, or None where the measure has an exact value; ring:
    whether bodies are of revolution."""
    if measure.quantity in ("energy", "displacement", "pressure"):
        against = Exact(measure.exact, let, time) if measure.exact is not None else truth
        return pressure_error(run, against, ring) if measure.quantity == "pressure" \
            else field_error(measure.quantity, run, against, materials, ring)
    exact = measure.exact if measure.exact is not None else truth.scalars[measure.quantity]
    if measure.quantity not in run.scalars:
        raise RunFailure(f"no {measure.quantity} in this result")
    return relative(abs(run.scalars[measure.quantity] - exact), abs(exact))
