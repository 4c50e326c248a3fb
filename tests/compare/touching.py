#!/usr/bin/python3
"""Bodies that touch or are apart, and that nothing presses: contact exerts no force, whatever they look like.

Drawings of two bodies: discs, ellipses, splines, waves, corners, V grooves and steps on each other, shapes
and curves of geometries, pins in holes, given distances; either side nonmortar, degrees 1 and 2, all
variants, sections in a plane and around an axis. They touch in one point at least or are lifted, and stay
where they are or part further in the run.

    tests/compare/touching.py [--count 100] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import math
import random
import sys

import numpy as np

from contact_support import command, solve

FINE = 4001  # points at which the distance of two curves is sampled


def circle(radius, middle):
    return lambda x: radius - np.sqrt(np.maximum(radius**2 - (x - middle)**2, 0))


def ellipse(a, b, middle):
    return lambda x: b - b*np.sqrt(np.maximum(1 - ((x - middle)/a)**2, 0))


def spline(rng, low, high):
    """A natural cubic spline through random points."""
    x = np.linspace(low, high, 6)
    y = np.array([0.15*rng.uniform(-1, 1) for _ in x])
    h, n = x[1] - x[0], len(x)
    system, right = np.eye(n), np.zeros(n)
    for i in range(1, n - 1):
        system[i, i - 1:i + 2] = 1, 4, 1
        right[i] = 6*(y[i - 1] - 2*y[i] + y[i + 1])/h**2
    m = np.linalg.solve(system, right)

    def value(at):
        i = np.clip(((at - low)/h).astype(int), 0, n - 2)
        a, b = x[i + 1] - at, at - x[i]
        return (m[i]*a**3 + m[i + 1]*b**3)/(6*h) + (y[i]/h - m[i]*h/6)*a + (y[i + 1]/h - m[i + 1]*h/6)*b
    return value


def profile(rng, low, high, upwards):
    """The height of a side over x; `upwards` is the side below which the body lies. Its name, its function,
    its corners."""
    middle = rng.choice([0.0, rng.uniform(low, high)])
    kind = rng.choice(["disc", "ellipse", "spline", "corner", "wave", "flat", "groove", "step"])
    sign = -1 if upwards else 1
    slope = rng.uniform(0.1, 0.9)
    if kind == "disc":
        f = circle(rng.uniform(2.2, 20), middle)
    elif kind == "ellipse":
        f = ellipse(rng.uniform(2.2, 5), rng.uniform(0.3, 3), middle)
    elif kind == "spline":
        f = spline(rng, low, high)
    elif kind == "corner":
        def f(x): return slope*np.abs(x - middle)
    elif kind == "groove":
        def f(x): return -slope*np.abs(x - middle)
    elif kind == "wave":
        height, waves = rng.uniform(0.005, 0.05), rng.randint(1, 4)
        def f(x): return height*np.cos(waves*math.pi*(x - low))
    elif kind == "step":
        def f(x): return 0.2*np.clip((x - middle)/0.3, 0, 1)
    else:
        def f(x): return 0*x
    corners = [middle] if kind in ("corner", "groove") else []
    return kind, lambda x: sign*f(x), [x for x in corners if low < x < high]


def nodes(rng, low, high, corners):
    """Places along a side, with cells of different sizes and a node at every corner, or not."""
    count = rng.randint(3, 24)
    sizes = np.exp([rng.uniform(0, math.log(rng.choice([1.001, 3]))) for _ in range(count)])
    x = np.concatenate([[0], np.cumsum(sizes)])
    x = low + (high - low)*x/x[-1]
    for corner in corners if rng.random() < 0.7 else []:
        x[1 + np.argmin(np.abs(x[1:-1] - corner))] = corner
    return np.sort(x)


def medit(x, near, far):
    """A mesh between the heights `near` (label 1) and `far` (label 2) over x; 3 and 4 are the other sides."""
    rows, columns = 4, len(x)
    vertices = [(x[i], near[i] + (far - near[i])*j/(rows - 1)) for j in range(rows) for i in range(columns)]

    def at(i, j): return j*columns + i + 1
    cells = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1))
             for j in range(rows - 1) for i in range(columns - 1)]
    if far < near[0]:
        cells = [cell[::-1] for cell in cells]
    triangles = []
    for a, b, c, d in cells:
        middle = len(vertices) + 1
        corners = [vertices[k - 1] for k in (a, b, c, d)]
        vertices.append(tuple(sum(part)/4 for part in zip(*corners)))
        triangles += [(a, b, middle), (b, c, middle), (c, d, middle), (d, a, middle)]
    edges = [(at(i, j), at(i + 1, j), label) for j, label in ((0, 1), (rows - 1, 2))
             for i in range(columns - 1)]
    edges += [(at(i, j), at(i, j + 1), label) for i, label in ((0, 4), (columns - 1, 3))
              for j in range(rows - 1)]
    parts = [("Vertices", [(*map(repr, map(float, v)), 0) for v in vertices]), ("Edges", edges),
             ("Triangles", [(*t, 0) for t in triangles])]
    text = "MeshVersionFormatted 2\nDimension 2\n"
    for name, rows in parts:
        text += f"{name}\n{len(rows)}\n" + "".join(" ".join(map(str, row)) + "\n" for row in rows)
    return text + "End\n"


def ellipse_geo(a, b, lowest, size):
    """The lower half of an ellipse that ends below its widest place: curves 1."""
    top = lowest + 0.4*b
    x = a*math.sqrt(1 - 0.6**2)
    return (f"Point(1) = {{0, {lowest + b!r}, 0, {size}}};\nPoint(2) = {{{-x!r}, {top!r}, 0, {size}}};\n"
            f"Point(3) = {{0, {lowest!r}, 0, {size}}};\nPoint(4) = {{{x!r}, {top!r}, 0, {size}}};\n"
            f"Point(5) = {{{a!r}, {lowest + b!r}, 0, {size}}};\n"
            "Ellipse(1) = {2, 1, 5, 3};\nEllipse(2) = {3, 1, 5, 4};\nLine(3) = {4, 2};\n"
            "Curve Loop(1) = {1, 2, 3};\nPlane Surface(1) = {1};\n"
            "Physical Curve(1) = {1, 2};\nPhysical Curve(2) = {3};\nPhysical Surface(1) = {1};\n")


class Drawing:
    """Drawing number `seed`: the text of its scene, its files, and what it shows."""

    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.files = {}
        self.plane = rng.choice(["stress", "strain", "axisymmetric"])
        self.degree = rng.choice([1, 2])
        self.variant = rng.choice(["", "", "mortar", "weighted", "interpolation"])
        self.lift = rng.choice([0, 0, 0, rng.uniform(0, 0.05)])
        self.gap = ""
        kind = rng.choice(["curves"]*6 + ["shapes", "geometry", "pin", "gap"])
        meshes, far = getattr(self, "draw_" + kind)()
        self.shows = f"{kind} {self.what}, degree {self.degree}, {self.variant or 'default'}, {self.plane}"
        moved = rng.choice(["0", '"0.02*t"']) if kind != "pin" else "0"
        bodies = [("upper", meshes[0], far[0], moved), ("lower", meshes[1], far[1], "0")]
        sides = [f'{{ body = "{name}", label = {near} }}' for name, near in
                 (("upper", self.near[0]), ("lower", self.near[1]))]
        if rng.random() < 0.5:
            sides.reverse()
        self.scene = f'title = "{self.shows}"\nplane = "{self.plane}"\ndegree = {self.degree}\n'
        for name, mesh, held, uy in bodies:
            self.scene += (f'[[body]]\nname = "{name}"\nmesh = {mesh}\n'
                           f'material = {{ young = {rng.choice([1e3, 2e5])}, poisson = 0.3 }}\n'
                           f'boundary = [ {{ label = {held}, ux = 0, uy = {uy} }} ]\n')
        self.scene += f"[contact]\nnonmortar = {sides[0]}\nmortar = {sides[1]}\n" + self.gap
        if self.variant:
            self.scene += f'variant = "{self.variant}"\n'
        self.scene += '[time]\nend = 1\nsteps = 2\n'

    def draw_curves(self):
        rng = self.rng
        low, high = (0, 1) if self.plane == "axisymmetric" else (-1, 1)
        above, below = profile(rng, low, high, False), profile(rng, low, high, True)
        x = [nodes(rng, low, high, corners) for _, _, corners in (above, below)]
        everywhere = np.unique(np.concatenate([np.linspace(low, high, FINE), *x]))
        heights = []  # the curves, and the polygons of the meshes
        for places, (_, f, _) in zip(x, (above, below)):
            heights.append((f(everywhere), np.interp(everywhere, places, f(places))))
        up = max(float(np.max(lower - upper)) for upper in heights[0] for lower in heights[1]) + self.lift
        self.near = (1, 1)
        self.what = f"{above[0]} on {below[0]}"
        upper, lower = above[1](x[0]) + up, below[1](x[1])
        self.files = {"upper.mesh": medit(x[0], upper, float(max(upper)) + 0.5),
                      "lower.mesh": medit(x[1], lower, float(min(lower)) - 0.5)}
        return ('"upper.mesh"', '"lower.mesh"'), (2, 2)

    def draw_shapes(self):
        rng = self.rng
        radius, cells = rng.uniform(5, 50), rng.randint(3, 12)
        around = self.plane == "axisymmetric"
        disc = f'{{ shape = "{"quarter" if around else "half"}disc", radius = {radius}, core = ' \
               f'{radius*rng.uniform(0.1, 0.3)}, cells = {cells}, lowest = [0, {self.lift}] }}'
        width = 1.2*radius
        block = f'{{ shape = "rectangle", lower = [{0 if around else -width}, {-width}], ' \
                f'upper = [{width}, 0], cells = [{rng.randint(4, 40)}, 6], focus = [0, 0], ' \
                f'grading = {rng.choice([1, 8])} }}'
        self.near, self.what = (1, 3), "disc on block"
        return (disc, block), (2, 1)

    def draw_geometry(self):
        rng = self.rng
        self.plane = rng.choice(["stress", "strain"])
        a, b = rng.uniform(1, 3), rng.uniform(0.5, 2)
        size = a/rng.randint(5, 15)
        self.files["upper.geo"] = ellipse_geo(max(a, b), min(a, b), self.lift, size)
        block = f'{{ shape = "rectangle", lower = [-4, -2], upper = [4, 0], ' \
                f'cells = [{rng.randint(9, 40)}, 5] }}'
        self.near, self.what = (1, 3), "ellipse on block"
        return ('"upper.geo"', block), (2, 1)

    def draw_pin(self):
        rng = self.rng
        self.plane = rng.choice(["stress", "strain"])
        hole = 1 + rng.choice([0, rng.uniform(0.01, 0.2)])
        down = 1 - hole + self.lift if self.lift < hole - 1 else 0
        pin = f'{{ shape = "annulus", centre = [0, {down}], inner = 0.4, outer = 1, ' \
              f'cells = [{rng.randint(16, 60)}, 3] }}'
        plate = f'{{ shape = "annulus", inner = {hole}, outer = 3, cells = [{rng.randint(16, 60)}, 4] }}'
        self.near, self.what = (2, 1), "pin in a hole"
        return (pin, plate), (1, 2)

    def draw_gap(self):
        rng = self.rng
        at = rng.uniform(0, 1)
        self.gap = 'gap = "' + rng.choice([f"(x-{at})^2", f"abs(x-{at})", f"1-cos(9*(x-{at}))"]) + '"\n'
        blocks = [f'{{ shape = "rectangle", lower = [0, {low}], upper = [1, {low + 1}], '
                  f'cells = [{rng.randint(2, 20)}, 3] }}' for low in (0, -1)]
        self.near, self.what = (1, 3), "given distance"
        return blocks, (3, 1)


def examined(program, seed):
    drawing = Drawing(seed)
    run = solve(program, drawing.scene, "--quiet", files=drawing.files, patience=300)
    if run.code != 0:
        return drawing.shows, [run.end]
    force = run.summary["peaks"]["contact_force"]["value"]  # the largest sum of nodal forces at any step
    return drawing.shows, [f"a force of {force}"] if force else []


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 100))
