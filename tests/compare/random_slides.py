#!/usr/bin/python3
"""Random bodies that slide along each other with sliding = "finite": blocks and discs on blocks, stiffnesses
that differ by up to 1e6, friction up to 1, past ends and corners, back and forth. Every run ends certified,
or with a reason. Prints a line for each: its exit code, the linear solves that its steps took, the message.

    tests/compare/random_slides.py --count 50 [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import argparse
import csv
import json
import random
import re
import statistics
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def variant_of(rng):
    variant = rng.choice(["weighted", "weighted", "mortar", "", "interpolation"])
    return f'variant = "{variant}"' if variant else ""


def scene(seed):
    rng = random.Random(seed)
    young = 1e3 * 10 ** rng.uniform(-1, 1)
    ratio = 10 ** rng.uniform(0, 6)
    lower, upper = rng.choice([(young, young * ratio), (young * ratio, young)])
    degree = rng.choice([1, 1, 2])
    mu = rng.choice([0, rng.uniform(0, 1)])
    length = rng.uniform(3, 8)
    disc = rng.random() < 0.5
    depth = rng.uniform(1e-3, 1e-2)
    if disc:
        radius = rng.uniform(1, 4)
        mesh = (f'{{ shape = "halfdisc", radius = {radius:.6g}, core = {radius / 5:.6g}, '
                f'cells = {rng.randint(3, 6)}, lowest = [{length / 3:.6g}, 0] }}')
        near, held = 1, 2
    else:
        width = rng.uniform(0.5, 2)
        cells = f"[{rng.randint(2, 8)}, {rng.randint(2, 5)}]"
        mesh = (f'{{ shape = "rectangle", lower = [{length / 3:.6g}, 0], '
                f'upper = [{length / 3 + width:.6g}, 1], cells = {cells}, cut = "both" }}')
        near, held = 1, 3
    far = rng.uniform(0.2, 1.2) * length  # may pass the end
    way = rng.choice([f"{far:.6g}*max(t - 0.2, 0)/0.8",
                      f"{far:.6g}*sin(5*max(t - 0.2, 0))",
                      f"-{far:.6g}*max(t - 0.2, 0)/0.8"])
    press = f'uy = "-{depth:.6g}*min(5*t, 1)"'
    if not disc and rng.random() < 0.2:  # held by contact alone: falls where it passes the end
        press = f'ty = "-{depth * young / 10:.6g}*min(5*t, 1)"'
    sides = [f'{{ body = "upper", label = {near} }}', '{ body = "lower", label = 3 }']
    rng.shuffle(sides)
    return f"""\
degree = {degree}
plane = "{rng.choice(['stress', 'strain'])}"
[[body]]
name = "lower"
[body.mesh]
shape = "rectangle"
lower = [0, -1.5]
upper = [{length:.6g}, 0]
cells = [{rng.randint(8, 24)}, 4]
cut = "both"
[body.material]
young = {lower:.6g}
poisson = 0.3
[[body.boundary]]
label = 1
ux = 0
uy = 0
[[body]]
name = "upper"
mesh = {mesh}
material = {{ young = {upper:.6g}, poisson = 0.3 }}
boundary = [ {{ label = {held}, ux = "{way}", {press} }} ]
[contact]
nonmortar = {sides[0]}
mortar = {sides[1]}
{variant_of(rng)}
friction = {mu:.6g}
sliding = "finite"
[time]
end = 1
steps = {rng.choice([10, 20, 40])}
"""


def run(program, seed, folder):
    (folder / "scene.toml").write_text(scene(seed))
    done = subprocess.run([program, "run", "scene.toml", "--quiet", "--threads", "1", "--out", "out"],
                          cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=300)
    out = folder / ("out" if done.returncode == 0 else "out.failed")
    summary = json.loads((out / "summary.json").read_text()) if (out / "summary.json").exists() else None
    solves = []
    if (out / "history.csv").exists():
        with open(out / "history.csv", newline="") as file:
            solves = [int(row["iterations"]) for row in csv.DictReader(file) if int(row["step"]) > 0]
    return done, summary, solves


def examined(program, seed):
    """Exit code, linear solves of its steps, and what is wrong with it or empty."""
    with tempfile.TemporaryDirectory() as name:
        try:
            done, summary, solves = run(program, seed, Path(name))
        except subprocess.TimeoutExpired:
            return None, [], "fault: does not end", ""
    told = " ".join(line for line in done.stderr.splitlines() if " warning: " not in line)
    wrong = ""
    if done.returncode not in (0, 1, 3) or (summary is None and done.returncode != 3):
        wrong = "fault: no result"
    elif done.returncode == 0 and max(summary["verification"][key] for key in CERTIFIED
                                      if key in summary["verification"]) > 1e-8:
        wrong = f"fault: not certified, {summary['verification']}"
    return done.returncode, solves, wrong, re.sub(r"\s+", " ", told)[:400]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--mortier", default=str(ROOT / "build" / "mortier"))
    arguments = parser.parse_args()
    program = str(Path(arguments.mortier).resolve())
    ends = Counter()
    faults = []
    medians = []
    seeds = range(arguments.first, arguments.first + arguments.count)
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for seed, (code, solves, wrong, told) in zip(
                seeds, pool.map(lambda seed: examined(program, seed), seeds)):
            ends[code] += 1
            if wrong:
                faults.append(seed)
            line = f"{seed}: exit {code}, {len(solves)} steps"
            if solves:
                medians.append(statistics.median(solves))
                line += f", solves of a step: median {medians[-1]:g}, most {max(solves)}"
            print(" ".join(filter(None, (line, wrong, told))), flush=True)
    print(f"{arguments.count} scenes: " + ", ".join(f"exit {code}: {n}" for code, n in ends.most_common()))
    if medians:
        print(f"linear solves of a step: median {statistics.median(medians):g}, "
              f"largest median of a run {max(medians):g}")
    print("faults: " + (", ".join(map(str, faults)) or "none"))
    return 1 if faults else 0


CERTIFIED = ("force_balance", "gap_on_active", "friction", "complementarity")


if __name__ == "__main__":
    sys.exit(main())
