#!/usr/bin/python3
"""The zone that sticks under a rough rigid parabola (Spence 1975), in steps that the program chooses.

    bench/rough_punch.py [--program build/mortier] [--cells 40] [--tolerance 0.05] [--width 200]
                         [--poisson 0.375] [--friction 0.2]

Prints c/a, half the zone that sticks over half that in contact, in the mean over the second half of the run
(it is the same all along; each ends half-way to the next node), and the energy that friction dissipated,
beside those of 600 equal steps and of one. The half plane is in plane strain, so Dundurs' constant is
beta = (1 - 2 nu)/(2 (1 - nu)), 0.2 for nu = 0.375. With friction 0.2 c/a is 0.680 (the integral equations
of the half plane, discretised); where the shear stress is taken to leave the pressure alone it is given by
K(c/a)/K'(c/a) = mu/beta, which is printed: 0.7071.

What the figure needs: a half plane that is large beside the contact (--width, half of it: 12 half widths
are not, it moves sideways like a block, and c/a is 0.78), triangles as high as they are long down to the
depth of the contact (ten times too long they made it 0.70), and steps.
"""
import argparse
import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

INNER, GROWTH = 0.36, 1.15  # half the line of equal elements, a little more than the contact; beyond it


def places(cells, far):
    """From 0 on: equal cells up to INNER, then growing ones."""
    step = INNER / cells
    x = [i * step for i in range(cells + 1)]
    while x[-1] < far:
        step *= GROWTH
        x.append(x[-1] + step)
    stretch = (far - INNER) / (x[-1] - INNER)
    return [value if value <= INNER else INNER + (value - INNER) * stretch for value in x]


def write_mesh(path, cells, far):
    half = places(cells, far)
    xs = [-x for x in half[:0:-1]] + half
    ys = [-y for y in half[::-1]]
    nx, ny = len(xs), len(ys)
    triangles = []
    for j in range(ny - 1):
        for i in range(nx - 1):
            a, b, c, d = j * nx + i, j * nx + i + 1, (j + 1) * nx + i + 1, (j + 1) * nx + i
            triangles += [(a, b, c), (a, c, d)] if xs[i] < 0 else [(a, b, d), (b, c, d)]
    top = (ny - 1) * nx
    edges = [(i, i + 1, 1) for i in range(nx - 1)] + [(top + i, top + i + 1, 3) for i in range(nx - 1)]
    for j in range(ny - 1):
        edges += [(j * nx, (j + 1) * nx, 4), (j * nx + nx - 1, (j + 1) * nx + nx - 1, 2)]
    with open(path, "w") as file:
        print(f"MeshVersionFormatted 2\nDimension 2\nVertices\n{nx * ny}", file=file)
        for y in ys:
            for x in xs:
                print(f"{x:.17g} {y:.17g} 0", file=file)
        print(f"Edges\n{len(edges)}", file=file)
        for a, b, label in edges:
            print(a + 1, b + 1, label, file=file)
        print(f"Triangles\n{len(triangles)}", file=file)
        for triangle in triangles:
            print(*(vertex + 1 for vertex in triangle), 0, file=file)
        print("End", file=file)
    return len(triangles)


def scene(arguments, steps):
    return f"""plane = "strain"
[[body]]
name = "half-plane"
mesh = "half-plane.mesh"
material = {{ young = 100, poisson = {arguments.poisson} }}
boundary = [ {{ label = 1, ux = 0, uy = 0 }} ]
[[body]]
name = "punch"  # all of its lower side is held: it is rigid
mesh = {{ shape = "rectangle", lower = [-1, 0], upper = [1, 1], cells = [2, 1] }}
material = {{ young = 100, poisson = 0.3 }}
boundary = [ {{ label = 1, ux = 0, uy = "-{arguments.depth}*t" }} ]
[[contact]]
nonmortar = {{ body = "half-plane", label = 3 }}
mortar = {{ body = "punch", label = 1 }}
gap = "x^2/2"
friction = {arguments.friction}
[time]
end = 1
{steps}
[output]
every = 1
"""


def half_width(x, nodes):
    """Of the zone of these nodes, which ends half-way to the next ones."""
    return (x[nodes[-1]] + x[nodes[-1] + 1] - x[nodes[0]] - x[nodes[0] - 1]) / 4


def ratio(step):
    x = [node["x"] for node in step]
    closed = [i for i, node in enumerate(step) if node["force"] > 0]
    stuck = [i for i in closed if step[i]["slipping"] == 0]
    return abs(half_width(x, stuck) / half_width(x, closed)) if stuck else 0.0


def solve(folder, arguments, steps):
    """c/a, the energy that friction dissipated, and the number of steps."""
    (folder / "scene.toml").write_text(scene(arguments, steps))
    subprocess.run([Path(arguments.program).resolve(), "run", "scene.toml", "--quiet", "--out", "out"],
                   check=True, cwd=folder, stderr=subprocess.DEVNULL)
    nodes = {}
    with open(folder / "out" / "contact.csv") as file:
        for row in csv.DictReader(file):
            if float(row["time"]) > 0.5:
                nodes.setdefault(int(row["step"]), []).append({key: float(row[key]) for key in row})
    ratios = [ratio(step) for step in nodes.values()]
    summary = json.loads((folder / "out" / "summary.json").read_text())
    return sum(ratios) / len(ratios), summary["final"]["friction_work"], max(nodes)


def uncoupled(part):
    """c/a of K(c/a)/K'(c/a) = part, by bisection."""
    def complete(k):
        a, g = 1.0, math.sqrt(1 - k * k)
        while a - g > 1e-15 * a:
            a, g = (a + g) / 2, math.sqrt(a * g)
        return math.pi / (2 * a)
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        if complete(middle) / complete(math.sqrt(1 - middle * middle)) < part:
            low = middle
        else:
            high = middle
    return low


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", default="build/mortier")
    parser.add_argument("--cells", type=int, default=40, help="on half the contact")
    parser.add_argument("--tolerance", type=float, default=0.05)
    parser.add_argument("--width", type=float, default=200, help="half that of the half plane")
    parser.add_argument("--depth", type=float, default=0.45, help="of the punch at the end")
    parser.add_argument("--poisson", type=float, default=0.375)
    parser.add_argument("--friction", type=float, default=0.2)
    parser.add_argument("--equal", type=int, nargs="*", default=[600, 1], help="runs with equal steps")
    arguments = parser.parse_args()
    beta = (1 - 2 * arguments.poisson) / (2 * (1 - arguments.poisson))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        triangles = write_mesh(folder / "half-plane.mesh", arguments.cells, arguments.width)
        print(f"{triangles} triangles, mu {arguments.friction}, beta {beta:.4f}; with a pressure that the "
              f"shear stress leaves alone c/a {uncoupled(arguments.friction / beta):.4f}")
        equal = [f"steps = {n}" for n in arguments.equal]
        for steps in [f"tolerance = {arguments.tolerance}", *equal]:
            c, work, count = solve(folder, arguments, steps)
            print(f"{steps:<16} {count:4d} steps: c/a {c:.4f}, dissipated {work:.5g}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
