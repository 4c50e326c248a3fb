"""What the rows of published_rows.py read of runs, beside what bench/hard/reads.py has."""
import math

import numpy as np

import results
from reads import half_width, quantity, total


def quantities(*names):
    reads = [quantity(name) for name in names]
    return lambda run: [read(run) for read in reads]


def course(name, times, factor=1.0):
    """A quantity at some times of the run."""
    def read(run):
        history = results.read_history(run.folder)
        (column,) = [key for key in history if key.startswith(f"{name}[")]
        return factor * np.interp(times, history["time[s]"], history[column])
    return read


def courses(times, **factors):
    """Several quantities at some times, each times a factor, one after the other."""
    reads = [course(name, times, factor) for name, factor in factors.items()]
    return lambda run: np.concatenate([read(run) for read in reads])


def nearest(body, point):
    return int(np.argmin(np.hypot(*(body.points - point).T)))


def motions(name, *places):
    """Displacements (x, y) of nodes of a body, one after the other."""
    def read(run):
        body = run.bodies[name]
        return np.concatenate([body.displacement[nearest(body, place)] for place in places])
    return read


def stress_at(name, point, component):
    """A stress at a vertex: the mean of the values of its triangles there."""
    def read(run):
        body = run.bodies[name]
        vertex = nearest(body, point)
        values = []
        for triangle, corner in np.argwhere(body.triangles == vertex):
            if body.stress_at_points is None:
                values.append(body.stress[triangle, component])
            else:  # linear, known at the points with coordinates 2/3, 1/6, 1/6
                at = body.stress_at_points[triangle, :, component]
                values.append(2 * at[corner] - at.sum() / 3)
        return float(np.mean(values))
    return read


def constant(component, name=None):
    """A stress that is the same everywhere: the value that is farthest from the mean."""
    def read(run):
        bodies = [run.bodies[name]] if name else run.bodies.values()
        values = np.concatenate([body.stress[:, component] for body in bodies])
        return float(values[np.argmax(np.abs(values - values.mean()))])
    return read


def flow(name, *components):
    """Components of the viscoplastic strain of the first triangle."""
    return lambda run: run.bodies[name].cells["viscoplastic_strain"][0, list(components)]


def along(direction):
    """The contact force along a direction, of the quantities fx and fy."""
    return lambda run: quantity("fx")(run) * direction[0] + quantity("fy")(run) * direction[1]


def scaled_width(force):
    """The half width of one half of a line contact, for another force by Hertz's square root."""
    return lambda run: half_width(run) * math.sqrt(force / (2 * total(run)))


def prandtl_reuss(strains, shear, yield_stress, hardening, steps=200):
    """Von Mises stresses after stretches of the strains (e11, e22), e33 = 0, with isotropic hardening: up to
    yield as it is, then by the method of Runge and Kutta."""
    stress, flow, found = np.zeros(3), 0.0, []
    for first, last in zip(strains, strains[1:]):
        strain = np.array([*np.subtract(last, first), 0.0])
        rise = 2 * shear * (strain - strain.mean())

        def rates(stress):
            n = stress / np.linalg.norm(stress)
            part = max(n @ rise, 0.0) / (2 * shear + 2 / 3 * hardening)
            return np.array([*(rise - 2 * shear * part * n), math.sqrt(2 / 3) * part])

        a, b = rise @ rise, stress @ rise
        c = stress @ stress - 2 / 3 * (yield_stress + hardening * flow)**2
        inside = b < 0 or c < -1e-9 * yield_stress**2
        elastic = min(1.0, (-b + math.sqrt(max(b * b - a * c, 0.0))) / a) if inside else 0.0
        stress = stress + elastic * rise
        h = (1 - elastic) / steps
        for _ in range(steps if h > 0 else 0):
            k1 = rates(stress)
            k2 = rates(stress + h / 2 * k1[:3])
            k3 = rates(stress + h / 2 * k2[:3])
            k4 = rates(stress + h * k3[:3])
            change = h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            stress, flow = stress + change[:3], flow + change[3]
        found.append(math.sqrt(1.5) * np.linalg.norm(stress))
    return found
