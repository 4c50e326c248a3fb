#!/usr/bin/python3
"""Refinement that aims at a quantity, against refinement in the energy norm and equal meshes.

    bench/goals.py [--rounds 6]

Two scenes: the force of a tilted block that lifts off a wider one, and the mean pressure under the middle of
a stiff punch. A row per mesh: unknowns, true error of the quantity (against a mesh made for a ninth of the
last tolerance), and the guaranteed one, both relative. Then the unknowns that a true error of 1e-3 and a
guaranteed one of 1e-2 take, by fits in logarithms.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("MORTIER", str(ROOT / "build" / "mortier"))

BODY = """\
[[body]]
name = "{name}"
mesh = {{ shape = "rectangle", lower = {lower}, upper = {upper}, cells = {cells}, cut = "both" }}
material = {{ young = {young}, poisson = 0.3 }}
boundary = [ {boundary} ]
"""
REST = """\
[contact]
nonmortar = { body = "upper", label = 1 }
mortar = { body = "lower", label = 3 }
[time]
end = 1
steps = 1
[[quantity]]
name = "goal"
"""
SCENES = {
    "tilted block, contact force": (
        dict(lower=[0, 0], upper=[1, 1], young=1, boundary='{ label = 3, ux = 0, uy = "t*(-0.3 + 0.4*x)" }'),
        dict(lower=[-1, -1], upper=[2, 0], young=1, boundary="{ label = 1, ux = 0, uy = 0 }"),
        [2, 2], [6, 2], 'contact_force = { body = "upper", label = 1 }\ncomponent = "y"\n'),
    "punch, mean pressure under its middle": (
        dict(lower=[-1, 0], upper=[1, 1], young=1000, boundary='{ label = 3, ux = 0, uy = "-0.01*t" }'),
        dict(lower=[-4, -4], upper=[4, 0], young=1, boundary="{ label = 1, ux = 0, uy = 0 }"),
        [4, 2], [8, 4],
        'mean_pressure = { body = "upper", label = 1, from = [-0.5, 0], to = [0.5, 0], margin = 0.25 }\n'),
}


def scene(which, times=1):
    upper, lower, first, second, quantity = SCENES[which]
    bodies = [BODY.format(name=name, cells=[times * n for n in cells], **body)
              for name, body, cells in (("upper", upper, first), ("lower", lower, second))]
    return "".join(bodies) + REST + quantity


def run(text, folder):
    """Unknowns, value, and the guaranteed error, of the last mesh and of each round."""
    path = Path(folder) / "scene.toml"
    path.write_text(text)
    subprocess.run([PROGRAM, "run", str(path), "--out", f"{folder}/out", "--quiet"], check=False,
                   stderr=subprocess.DEVNULL)
    summary = json.loads((Path(folder) / "out" / "summary.json").read_text())
    goal = summary["quantities"]["goal"]
    return summary["free_dofs"], goal["value"], goal["bound"]["error"]


def unknowns_for(rows, column, error):
    """By a line through the logarithms."""
    rows = [row for row in rows if row[column] > 0]
    slope, start = numpy.polyfit(numpy.log([row[column] for row in rows]),
                                 numpy.log([row[0] for row in rows]), 1)
    return numpy.exp(start + slope * numpy.log(error))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    for which in SCENES:
        print(which)
        found = {"quantity": [], "energy": [], "equal": []}
        with tempfile.TemporaryDirectory() as folder:
            for i in range(options.rounds):
                tolerance = 0.1 / 3 ** i
                aim = f'[accuracy]\nquantity = "goal"\ntolerance = {tolerance}\n'
                found["quantity"].append(run(scene(which) + aim, folder))
                energy = f"[accuracy]\nbound = true\nenergy = {0.2 / 1.7 ** i}\n"
                found["energy"].append(run(scene(which) + energy, folder))
                found["equal"].append(run(scene(which, 2 ** i) + "[accuracy]\nbound = true\n", folder))
            best = f'[accuracy]\nquantity = "goal"\ntolerance = {0.1 / 3 ** (options.rounds + 1)}\n'
            exact = run(scene(which) + best, folder)
        print(f"  value {exact[1]:.8g} +- {exact[2]:.1e}, {exact[0]} unknowns")
        for way, rows in found.items():
            rows = [(n, abs(value / exact[1] - 1), error / abs(exact[1])) for n, value, error in rows]
            found[way] = rows
            for n, true, guaranteed in rows:
                print(f"  {way:<9} {n:8d}  true {true:8.1e}  guaranteed {guaranteed:8.1e}", flush=True)
        for column, name, error in ((1, "true", 1e-3), (2, "guaranteed", 1e-2)):
            text = ", ".join(f"{way} {unknowns_for(rows, column, error):.3g}" for way, rows in found.items())
            print(f"  unknowns for a {name} error of {error:g}: {text}")


if __name__ == "__main__":
    sys.exit(main())
