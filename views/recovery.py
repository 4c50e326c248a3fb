"""Stresses recovered from those of the triangles: at vertices, of linear functions fitted to the triangles
around. The difference to what they are recovered from estimates its error (Zienkiewicz and Zhu, 1992)."""
import numpy as np

from runs import areas


def averaged(body, values):
    """By vertex and region, of values by triangle: their mean over the triangles at the vertex, weighted by
    area; as one value for each corner of the triangles, n x 3."""
    regions = np.unique(body.cells.get("region", np.zeros(len(body.triangles))), return_inverse=True)[1]
    places = body.triangles + len(body.points) * regions[:, None]
    area = np.repeat(areas(body), 3)
    count = places.max() + 1
    weight = np.bincount(places.ravel(), area, count)
    summed = np.bincount(places.ravel(), area * np.repeat(values, 3), count)
    return (summed / np.where(weight > 0, weight, 1))[places]


def von_mises(s11, s22, s12, s33=0.0):
    return np.sqrt(np.maximum(s11**2 + s22**2 - s11 * s22 + s33 * (s33 - s11 - s22) + 3 * s12**2, 0))


class AtVertices:
    """The map from values by triangle to those at some vertices; made once for a mesh."""

    def __init__(self, body, vertices):
        corners = body.triangles.ravel()
        order = np.argsort(corners, kind="stable")
        begin = np.searchsorted(corners[order], np.arange(len(body.points) + 1))
        centres = body.points[body.triangles].mean(1)
        regions = body.cells.get("region", np.zeros(len(body.triangles)))

        def around(vertex):
            return order[begin[vertex]:begin[vertex + 1]] // 3

        self.triangles, self.weights, self.first, self.known = [], [], [], []
        for vertex in vertices:
            near = around(vertex)
            self.known.append(len(near) > 0)  # else the middle of a side
            if not len(near):
                continue
            wide = np.unique(np.concatenate([around(v) for v in np.unique(body.triangles[near])]))
            wide = wide[np.isin(regions[wide], regions[near])]
            away = centres[wide] - body.points[vertex]
            size = np.abs(away).max()
            fit = np.column_stack([np.ones(len(wide)), away / size])
            weights = np.linalg.pinv(fit, rcond=1e-6)[0]
            self.first.append(self.first[-1] + len(self.triangles[-1]) if self.first else 0)
            self.triangles.append(wide)
            self.weights.append(weights)
        self.known = np.array(self.known, bool)
        if self.triangles:
            self.triangles, self.weights = map(np.concatenate, (self.triangles, self.weights))

    def __call__(self, values):
        """Values by vertex, of values by triangle x components; 0 where a vertex has no triangle."""
        found = np.zeros((len(self.known), values.shape[1]))
        if self.known.any():
            found[self.known] = np.add.reduceat(self.weights[:, None] * values[self.triangles], self.first)
        return found


class NormalStress:
    """The pressure that the stresses of the nonmortar body have along a contact line: minus the normal
    stress, recovered at the nodes of the line."""

    def __init__(self, body, line):
        self.line, self.at = line, AtVertices(body, line.vertices)

    def __call__(self, body):
        s11, s22, s12 = self.at(body.stress[:, :3]).T
        n1, n2 = self.line.normals.T
        pressure = -(n1 * n1 * s11 + n2 * n2 * s22 + 2 * n1 * n2 * s12)
        known = self.at.known
        return np.interp(self.line.lengths, self.line.lengths[known], pressure[known]) if known.any() \
            else pressure
