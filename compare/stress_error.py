"""How far the stress of one result is from that of a far better one, in the energy norm: both are read at the points of a rule
on the finer mesh, whose triangles lie in those of the coarser one where both were refined from the same first mesh.

Plane stress, or plane strain where the files have s33; straight triangles, or quadratic ones with curved sides.
"""
import json
from pathlib import Path

import meshio
import numpy as np
from matplotlib.tri import Triangulation

# Dunavant's rule of degree 4: barycentric coordinates, parts of the area.
NEAR, FAR = 0.445948490915965, 0.091576213509771
RULE = np.array([[1 - 2 * NEAR, NEAR, NEAR], [NEAR, 1 - 2 * NEAR, NEAR], [NEAR, NEAR, 1 - 2 * NEAR],
                 [1 - 2 * FAR, FAR, FAR], [FAR, 1 - 2 * FAR, FAR], [FAR, FAR, 1 - 2 * FAR]])
WEIGHTS = np.array([0.223381589678011] * 3 + [0.109951743655322] * 3)


def shapes(b):
    """Of the six nodes at barycentric coordinates (... x 3)."""
    x, y, z = np.moveaxis(b, -1, 0)
    return np.stack([x * (2 * x - 1), y * (2 * y - 1), z * (2 * z - 1), 4 * x * y, 4 * y * z, 4 * z * x], -1)


def slopes(b):
    """By the second and third barycentric coordinate: ... x 6 x 2."""
    x, y, z = np.moveaxis(b, -1, 0)
    zero = np.zeros_like(x)
    first = np.stack([1 - 4 * x, 4 * y - 1, zero, 4 * (x - y), 4 * z, -4 * z], -1)
    second = np.stack([1 - 4 * x, zero, 4 * z - 1, -4 * y, 4 * y, 4 * (x - z)], -1)
    return np.stack([first, second], -1)


class Field:
    """The stress of a body at one time."""

    def __init__(self, path):
        mesh = meshio.read(path)
        triangles = mesh.cells[0].data
        at = mesh.points[:, :2]
        corners = at[triangles[:, :3]]
        if triangles.shape[1] == 3:
            middles = (corners + np.roll(corners, -1, axis=1)) / 2
            self.stress = mesh.cell_data["stress"][0][:, None, :]
        else:
            middles = at[triangles[:, 3:]]
            self.stress = mesh.cell_data["stress_at_points"][0].reshape(len(triangles), 3, -1)
        self.nodes = np.concatenate([corners, middles], axis=1)  # triangles x 6 x 2
        self.corners, self.vertices, self.triangles = corners, at, triangles[:, :3]

    def places(self, b):
        return np.einsum("qa,tad->tqd", shapes(b), self.nodes)

    def weights(self):
        jacobian = np.einsum("qai,tad->tqid", slopes(RULE), self.nodes)
        return np.linalg.det(jacobian) / 2 * WEIGHTS

    def at(self, triangle, b):
        """Stress in triangles (n) at barycentric coordinates (n x 3)."""
        parts = 2 * b - 1 / 3 if self.stress.shape[1] == 3 else np.ones((len(b), 1))
        return np.einsum("nq,nqc->nc", parts, self.stress[triangle])

    def find(self, x):
        """Triangles and barycentric coordinates of places (n x 2)."""
        found = Triangulation(*self.vertices.T, self.triangles).get_trifinder()(*x.T).astype(int)
        outside = np.flatnonzero(found < 0)  # between a chord and its arc
        for i in outside:
            found[i] = np.argmax(self.straight(np.arange(len(self.triangles)), x[i]).min(axis=1))
        b = self.straight(found, x)
        for _ in range(4):  # Newton's method on the place in a curved triangle
            miss = x - np.einsum("na,nad->nd", shapes(b), self.nodes[found])
            jacobian = np.einsum("nai,nad->ndi", slopes(b), self.nodes[found])
            step = np.linalg.solve(jacobian, miss[..., None])[..., 0]
            b = b + np.column_stack([-step.sum(axis=1), step])
        return found, b

    def straight(self, triangle, x):
        a, one, two = np.moveaxis(self.corners[triangle], 1, 0)
        cross = lambda p, q: p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]  # noqa: E731
        area = cross(one - a, two - a)
        y, z = cross(x - a, two - a) / area, cross(one - a, x - a) / area
        return np.stack([1 - y - z, y, z], -1)


def energies(stress, young, poisson):
    """s : E^-1 s of stresses (n x 3, or n x 4 with s33)."""
    s11, s22, s12, *beyond = stress.T
    s33 = beyond[0] if beyond else 0
    mixed = s11 * s22 + s22 * s33 + s33 * s11
    return (s11**2 + s22**2 + s33**2 - 2 * poisson * mixed + 2 * (1 + poisson) * s12**2) / young


def field_names(folder, bodies, time=None):
    """Files of the bodies at a kept time, the last one without."""
    sets = []
    for line in (Path(folder) / "fields.pvd").read_text().splitlines():
        if "timestep" in line:
            words = dict(word.split("=") for word in line.replace('"', "").strip("<>/ ").split() if "=" in word)
            sets.append((float(words["timestep"]), words["file"]))
    time = max(t for t, _ in sets) if time is None else min((t for t, _ in sets), key=lambda t: abs(t - time))
    files = [name for t, name in sets if t == time]
    return [next(Path(folder) / name for name in files if name.rsplit("_", 1)[0] == body) for body in bodies]


def true_error(folder, better, bodies, time=None):
    """Of the result in a folder, relative to the stress of the better one at that time.

    bodies: name -> (young, poisson).
    """
    error = norm = 0.0
    for one, two, (young, poisson) in zip(field_names(folder, bodies, time), field_names(better, bodies, time), bodies.values()):
        coarse, fine = Field(one), Field(two)
        weights = fine.weights().ravel()
        count = len(fine.triangles)
        exact = fine.at(np.repeat(np.arange(count), len(RULE)), np.tile(RULE, (count, 1)))
        found, b = coarse.find(fine.places(RULE).reshape(-1, 2))
        error += weights @ energies(coarse.at(found, b) - exact, young, poisson)
        norm += weights @ energies(exact, young, poisson)
    return (error / norm)**0.5


def summary(folder):
    return json.loads((Path(folder) / "summary.json").read_text())
