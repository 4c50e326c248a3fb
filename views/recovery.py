"""Stresses recovered from those of the triangles: at vertices, of functions fitted to the triangles around.
The difference to what they are recovered from estimates its error (Zienkiewicz and Zhu, 1992)."""
import numpy as np

from results import von_mises
from runs import areas


class Means:
    """Values of triangles as values of their vertices, one for each region there: the mean over the triangles
    at a vertex, weighted by area (in space: tetrahedra, volume). `places`: of the corners, n x 3."""

    def __init__(self, body):
        regions = body.cells.get("region", np.zeros(len(body.simplices)))
        self.regions, regions = np.unique(regions, return_inverse=True)
        self.places = body.simplices + len(body.points) * regions[:, None]
        self.count = self.places.max() + 1
        self.area = np.repeat(areas(body), self.places.shape[1])
        weight = np.bincount(self.places.ravel(), self.area, self.count)
        self.weight = np.where(weight > 0, weight, 1)

    def __call__(self, values):
        each = np.repeat(values, self.places.shape[1])
        return np.bincount(self.places.ravel(), self.area * each, self.count) / self.weight


def averaged(body, values):
    """Means as one value for each corner of the triangles, n x 3."""
    means = Means(body)
    return means(values)[means.places]


def averaged_von_mises(body):
    """Of the means of the components."""
    means = Means(body)
    return von_mises(*map(means, body.stress.T))[means.places]


AT = np.array([[4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6  # points of the stress in a quadratic triangle
ENOUGH = 9  # values for a quadratic function, which has 6 parameters


def sampled(body):
    """Stresses by point, n x components: one in a linear triangle, three in a quadratic one."""
    at_points = body.stress_at_points
    return body.stress if at_points is None else at_points.reshape(-1, at_points.shape[-1])


class AtVertices:
    """The map from sampled stresses to those at some vertices; made once for a mesh."""

    def __init__(self, body, vertices):
        corners = body.triangles.ravel()
        order = np.argsort(corners, kind="stable")
        begin = np.searchsorted(corners[order], np.arange(len(body.points) + 1))
        regions = body.cells.get("region", np.zeros(len(body.triangles)))
        places = body.points[body.triangles]
        linear = body.stress_at_points is None
        count = 1 if linear else 3
        points = places.mean(1) if linear else np.einsum("qi,tij->tqj", AT, places).reshape(-1, 2)

        def around(vertex):
            return order[begin[vertex]:begin[vertex + 1]] // 3

        self.samples, self.weights, self.first, self.known = [], [], [], []
        for vertex in vertices:
            near = around(vertex)
            self.known.append(len(near) > 0)  # else the middle of a side
            if not len(near):
                continue
            if linear or len(near) * count < ENOUGH:
                wide = np.unique(np.concatenate([around(v) for v in np.unique(body.triangles[near])]))
                near = wide[np.isin(regions[wide], regions[near])]
            samples = (near[:, None] * count + np.arange(count)).ravel()
            away = points[samples] - body.points[vertex]
            x, y = (away / np.abs(away).max()).T
            terms = [np.ones(len(x)), x, y, *([x * x, x * y, y * y] if len(x) >= ENOUGH else [])]
            self.first.append(self.first[-1] + len(self.samples[-1]) if self.first else 0)
            self.samples.append(samples)
            self.weights.append(np.linalg.pinv(np.column_stack(terms), rcond=1e-6)[0])
        self.known = np.array(self.known, bool)
        if self.samples:
            self.samples, self.weights = map(np.concatenate, (self.samples, self.weights))

    def __call__(self, values):
        """Values by vertex, of values by sample; 0 where a vertex has no triangle."""
        found = np.zeros((len(self.known), values.shape[1]))
        if self.known.any():
            found[self.known] = np.add.reduceat(self.weights[:, None] * values[self.samples], self.first)
        return found


class NormalStress:
    """The pressure that the stresses of the nonmortar body have along a contact line: minus the normal
    stress, recovered at the nodes of the line."""

    def __init__(self, body, line):
        self.line, self.at = line, AtVertices(body, line.vertices)

    def __call__(self, body):
        s11, s22, s12 = self.at(sampled(body)[:, :3]).T
        n1, n2 = self.line.normals.T
        pressure = -(n1 * n1 * s11 + n2 * n2 * s22 + 2 * n1 * n2 * s12)
        known = self.at.known
        return np.interp(self.line.lengths, self.line.lengths[known], pressure[known]) if known.any() \
            else pressure
