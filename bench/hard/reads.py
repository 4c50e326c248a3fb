"""What the rows of bench/hard.py read of runs (results.Run): functions of a run, or makers of such."""
import math
import re

import numpy as np

import results


def quantity(name, factor=1.0):
    return lambda run: factor * run.summary["quantities"][name]["value"]


def total(run):
    """Of the normal nodal forces."""
    return float(run.contact.force.sum())


def pressures(run):
    """Abscissa and pressure of the contact nodes; of the nodal forces where the code has no pressures."""
    x, p = run.contact.position[:, 0], run.contact.pressure
    if p is None:
        order = np.argsort(x)
        ends = np.diff(x[order])
        share = (np.concatenate([[0], ends]) + np.concatenate([ends, [0]])) / 2
        p = np.empty_like(x)
        p[order] = run.contact.force[order] / share
    return x, p


def half_width(run):
    """Twice the radius of gyration of the forces about x = 0: of Hertz's pressure the half width."""
    x, force = run.contact.position[:, 0], run.contact.force
    return 2 * math.sqrt(force @ x**2 / force.sum())


def from_axis(run):
    """Distances of the contact nodes from the axis x = 0, in space x = y = 0."""
    return np.linalg.norm(run.contact.position[:, :-1], axis=1)


def radius_of_contact(run):
    """The radius of contact by the forces about an axis: of Hertz's pressure."""
    return math.sqrt(2.5 * (run.contact.force @ from_axis(run)**2) / total(run))


def peak(run):
    """The pressure in the middle."""
    return float(pressures(run)[1][np.argmin(from_axis(run))])


def ball_peak(modulus, radius):
    """The largest pressure over Hertz's of the same force, of a ball about its axis."""
    def read(run):
        a = (0.75 * total(run) / modulus * radius) ** (1 / 3)
        return float(pressures(run)[1].max() * math.pi * a**2 / (1.5 * total(run)))
    return read


def receding(run):
    """The pressure under the load, over the load, half of which is modelled."""
    return peak(run) / (2 * total(run))


def off_hertz(modulus, radius, symmetric=False, up_to=0.55):
    """The largest deviation of a nodal pressure from Hertz's of the same force; symmetric: of one half."""
    def read(run):
        force = total(run) * (2 if symmetric else 1)
        b = math.sqrt(4 * force * radius / (math.pi * modulus))
        x, p = pressures(run)
        inside = np.abs(x) < up_to * b
        exact = 2 * force / (math.pi * b) * np.sqrt(1 - (x[inside] / b)**2)
        return float(np.abs(p[inside] / exact - 1).max())
    return read


def off_punch(run):
    """The same from F/(pi sqrt(a^2 - x^2)) on nine tenths of the width."""
    a, x, p = 0.01, *pressures(run)
    inside = x < 0.9 * a
    return float(np.abs(p[inside] * math.pi * np.sqrt(a**2 - x[inside]**2) / (2 * total(run)) - 1).max())


def off_cone(run):
    """The largest deviation of a nodal pressure from E t/(2 (1 - nu^2)) arcosh(a/r), a = 2 depth/(pi t)."""
    a, unit = 2 / math.pi, 1000 / (1 - 0.3**2) * 0.02 / 2
    r, p = pressures(run)
    inside = (r > 0.1 * a) & (r < 0.85 * a)
    return float(np.abs(p[inside] / (unit * np.arccosh(a / r[inside])) - 1).max())


def off_fit(shaft, hub):
    """The largest deviation of a nodal pressure of shrink fits from Lame's; Young's moduli."""
    def motion(young, inner, outer, at):  # of a ring by a pressure of 1 at one side, plane strain
        return 1.3 / young * at * (0.4 * at**2 + (inner * outer / at)**2) / (outer**2 - inner**2)
    exact = 0.001 / (motion(shaft, 0.5, 1, 1) + motion(hub, 1, 2, 1))
    return lambda *runs: float(max(np.abs(pressures(run)[1] / exact - 1).max() for run in runs))


def off_stress(*exact):
    """The largest deviation of a stress (s11, s22, s12), over the largest exact one."""
    def read(run):
        return float(max(np.abs(body.stress[:, :3] - exact).max() for body in run.bodies.values())
                     / np.abs(exact).max())
    return read


def radii(body):
    return np.linalg.norm(body.points[body.triangles].mean(1), axis=1)


def off_ring(run):
    """The largest deviation of the radial stress, over k."""
    body, k = run.bodies["ring"], 1 / math.sqrt(3)
    x = body.points[body.triangles].mean(1)[:, 0]
    return float(np.abs(body.stress[:, 0] + 2 * k * np.log(2 / x)).max() / k)


def off_tube(run):
    """The largest deviation of the mean stress, over k."""
    body, k, c = run.bodies["tube"], 1 / math.sqrt(3), 1.5
    r, p = radii(body), 2 * k * (math.log(c) + (1 - c * c / 4) / 2)
    exact = np.where(r < c, -p + 2 * k * np.log(r) + k, k * c * c / 4)
    mean = body.stress[:, [0, 1, 3]].sum(1) / 3
    return float(np.abs(mean - exact).max() / k)


def inner_motion(run):
    body = run.bodies["tube"]
    inside = np.abs(np.linalg.norm(body.points, axis=1) - 1) < 1e-9
    return float(np.linalg.norm(body.displacement[inside], axis=1).mean())


def order(error):
    """The fitted order of an error in the size of the cells."""
    def read(*runs):
        sizes = [sum(len(body.simplices) for body in run.bodies.values())
                 **(-1 / run.contact.position.shape[1]) for run in runs]
        return float(np.polyfit(np.log(sizes), np.log([error(run) for run in runs]), 1)[0])
    return read


def curved_pressure(run):
    """Root mean square deviation of the nodal pressures from 1 + 0.6 cos 2 phi."""
    x, y = run.contact.position.T
    return float(np.sqrt(np.mean((run.contact.pressure - 1 - 0.6 * np.cos(2 * np.arctan2(y, x)))**2)))


def curved_motion(run):
    """The same of the displacements of the nodes."""
    squares = []
    for body in run.bodies.values():
        x, y = body.points.T
        exact = np.stack([-1.48 * x + 1.2 * (x * y**2 + 0.1 * x**3),
                          0.08 * y - 1.2 * (x**2 * y + 0.1 * y**3)], 1)
        squares.append(((body.displacement - exact)**2).sum(1))
    return float(np.sqrt(np.mean(np.concatenate(squares))))


def shell_pressure(run):
    """Root mean square deviation of the nodal pressures from 1/9, over that."""
    return float(np.sqrt(np.mean((9 * run.contact.pressure - 1)**2)))


def shell_motion(run):
    """The same of the displacements of the vertices from those of Lame's hollow ball."""
    squares = []
    for body in run.bodies.values():
        radius = np.linalg.norm(body.points, axis=1, keepdims=True)
        squares.append(((body.displacement - (0.4 + 5.2 / radius**3) / 63 * body.points)**2).sum(1))
    return float(np.sqrt(np.mean(np.concatenate(squares))))


def dragged(run):
    """Largest deviation of the friction from mu times the pressing force, of the steps in which all closed
    nodes slip to one side."""
    worst, steps = 0.0, 0
    for contact in results.contact_tables(run.folder).values():
        closed = contact.force > 0
        if closed.any() and abs(contact.slipping[closed].sum()) == closed.sum():
            steps += 1
            worst = max(worst, abs(abs(contact.friction.sum()) / (0.1 * contact.force.sum()) - 1))
    return worst if steps else math.inf


def zones(contact):
    """Length of the zone that sticks and of that in contact; each ends half-way to the next node."""
    order = np.argsort(contact.position[:, 0])
    x = contact.position[order, 0]
    ends = np.concatenate([x[:1], (x[1:] + x[:-1]) / 2, x[-1:]])
    closed = contact.force[order] > 0
    where = (np.flatnonzero(each) for each in (closed & (contact.slipping[order] == 0), closed))
    return [float(ends[each[-1] + 1] - ends[each[0]]) if len(each) else 0.0 for each in where]


def stuck_part(run):
    """Of the contact, in the mean over the second half of the run."""
    history, tables = results.read_history(run.folder), results.contact_tables(run.folder)
    parts = [zones(tables[step]) for step, time in zip(history["step"], history["time[s]"]) if time > 0.5]
    return float(np.mean([stuck / closed for stuck, closed in parts]))


def off_stuck(run):
    """The largest deviation [%] of the part that sticks from sqrt(1 - Q/(mu P)), on the way back from the
    same of half of the reversed force; the first step presses, six push, mu is 0.3."""
    worst, most = 0.0, 0.0
    for step, contact in sorted(results.contact_tables(run.folder).items())[2:]:
        part = contact.friction.sum() / (0.3 * contact.force.sum())
        most = part if step <= 7 else most
        stuck, closed = zones(contact)
        exact = math.sqrt(1 - abs(part if step <= 7 else (most - part) / 2))
        worst = max(worst, abs(stuck / closed / exact - 1))
    return 100 * worst


def iterations(run):
    """Linear solves of the worst step."""
    return float(results.read_history(run.folder)["iterations"].max())


def growth(*runs):
    """The most linear solves of a run over the fewest, less 1."""
    counts = [run.summary["newton_iterations"] for run in runs]
    return max(counts) / min(counts) - 1


def unloading(run):
    """Change of the force over that of the motion of the punch, in unloading."""
    history = results.read_history(run.folder)
    (name,) = [key for key in history if key.startswith("force[")]
    loaded = int(np.argmin(np.abs(history["time[s]"] - 0.8)))
    return float((history[name][loaded] - history[name][-1]) / -0.008)


def number(pattern, of=lambda found: found[0]):
    """The first number of a command's output that a pattern finds, or another one of all."""
    return lambda output: of([float(found) for found in re.findall(pattern, output)])
