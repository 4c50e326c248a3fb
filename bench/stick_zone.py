#!/usr/bin/python3
"""The stick zone of Cattaneo and Mindlin by the program: two half planes, pressed by a parabola, pushed along
by Q up to 0.9 mu P and pulled back.

    bench/stick_zone.py [--program build/mortier] [--cells 804]

Prints for every step Q/(mu P), on the way back the part of the reversed force, (Q_most - Q)/(2 mu P), half
the zone that sticks over half that in contact (each ends half-way to the next node), and the exact
sqrt(1 - that). Exit code 1 where one is more than 1 % off.
"""
import argparse
import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

FRICTION = 0.3
ON = (0.00225, 0.0045, 0.009, 0.0135, 0.0175, 0.0197)  # motion of the top [m]
BACK = (0.0152, 0.0062, -0.0033, -0.0153, -0.0193)


def body(name, low, boundary, cells):
    return f"""[[body]]
name = "{name}"
mesh = {{ shape = "rectangle", lower = [-12, {low}], upper = [12, {low + 12}], cells = [{cells}, 30], """ \
           f"""focus = [0, 0], grading = [25, 600] }}
material = {{ young = 100, poisson = 0.3 }}
boundary = [ {boundary} ]
"""


def scene(cells):
    motion = [0, 0, *ON, *BACK]
    steps = len(motion) - 1
    push = f"ux = {{ time = {list(range(len(motion)))}, value = {motion} }}"
    return (body("upper", 0, f'{{ label = 3, uy = "-0.047*min(t, 1)", {push} }}', cells)
            + body("lower", -12, "{ label = 1, ux = 0, uy = 0 }", cells)
            + f"""[contact]
nonmortar = {{ body = "upper", label = 1 }}
mortar = {{ body = "lower", label = 3 }}
gap = "x^2/60"
friction = {FRICTION}
[time]
end = {steps}
steps = {steps}
[output]
every = 1
""")


def half_width(x, nodes):
    """Of the zone of these nodes, which ends half-way to the next ones."""
    return (x[nodes[-1]] + x[nodes[-1] + 1] - x[nodes[0]] - x[nodes[0] - 1]) / 4


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default="build/mortier")
    parser.add_argument("--cells", type=int, default=804, help="along the line")
    arguments = parser.parse_args()
    steps = {}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.toml"
        path.write_text(scene(arguments.cells))
        subprocess.run([arguments.program, "run", path, "--quiet", "--out", Path(folder) / "out"], check=True,
                       stderr=subprocess.DEVNULL)
        with open(Path(folder) / "out" / "contact.csv") as file:
            for row in csv.DictReader(file):
                steps.setdefault(int(row["step"]), []).append({key: float(row[key]) for key in row})
    most, worst = 0.0, 0.0
    for step in sorted(steps)[2:]:
        nodes = steps[step]
        x = [node["x"] for node in nodes]
        closed = [i for i, node in enumerate(nodes) if node["force"] > 0]
        stuck = [i for i in closed if nodes[i]["slipping"] == 0]
        part = sum(node["friction"] for node in nodes) / (FRICTION * sum(node["force"] for node in nodes))
        back = step - 1 > len(ON)
        most = most if back else part
        reversed_part = (most - part) / 2 if back else part
        exact = math.sqrt(1 - abs(reversed_part))
        ratio = half_width(x, stuck) / half_width(x, closed)
        worst = max(worst, abs(ratio / exact - 1))
        print(f"{'back' if back else 'on':<5} {abs(reversed_part):.4f}  c/a {ratio:.4f}  exact {exact:.4f}  "
              f"off by {100 * (ratio / exact - 1):.2f} %")
    print(f"worst {100 * worst:.2f} %")
    return 0 if worst <= 0.01 else 1


if __name__ == "__main__":
    sys.exit(main())
