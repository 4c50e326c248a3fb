#!/usr/bin/env python3
"""Random scenes of random_choices.py in other words, which must change nothing: units whose factors are no
powers of two, x and y turned by a right angle (in the plane), the bodies in the reverse order, two
threads, without `solver.reduce`, with SuiteSparse. Histories are compared step by step, over the largest
stress, force, energy and displacement of the run.

Usage: random_equalities.py [--space] [--count 100] [--seed 0] [--patience 20] [--jobs 1]
                            [--mortier build/mortier]
"""
import argparse
import collections
import concurrent.futures
import csv
import os
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from random_choices import SpaceScene, WideScene

UNITS = (7.3, 0.21, 3.1)  # of stress, length and time
WAYS = {
    "units": ({"units": UNITS}, []),
    "turned": ({"turned": True}, []),
    "exchanged": ({"exchanged": True}, []),
    "two threads": ({}, ["--threads", "2"]),
    "all solved": ({}, ["--set", "solver.reduce=false"]),
    "SuiteSparse": ({}, ["--set", "solver.linear=suitesparse"]),
}
#: column of history.csv: powers of the units of stress, length (with one depth more about an axis) and time
COLUMNS = {"time": (0, 0, 1), "contact_force": (1, 1, 0), "max_pressure": (1, 0, 0),
           "von_mises_max": (1, 0, 0), "elastic_energy": (1, 2, 0), "displacement_max": (0, 1, 0)}
TOLERANCE = 1e-8


def turn(path):
    """Turns a Medit mesh by a right angle: (x, y) becomes (-y, x)."""
    lines = path.read_text().split("\n")
    first = lines.index("Vertices") + 2
    for i in range(first, first + int(lines[first - 1])):
        x, y, rest = lines[i].split(maxsplit=2)
        lines[i] = f"{-float(y)!r} {x} {rest}"
    path.write_text("\n".join(lines))


def run(program, folder, scene, turned, options, patience):
    """Exit code and history of a run: the columns that are compared, by steps."""
    folder.mkdir()
    (folder / "scene.toml").write_text("\n".join(scene.text) + "\n")
    for mesh, arguments in scene.meshes.items():
        subprocess.run([program, "mesh", *arguments, mesh], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        if turned:
            turn(folder / mesh)
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (patience, patience + 1))
    if "--threads" not in options:
        options = ["--threads", "1", *options]
    done = subprocess.run([program, "run", "scene.toml", "--quiet", "--out", "out", *options], cwd=folder,
                          preexec_fn=limit, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    history = next(folder.glob("out*/history.csv"), None)
    rows = list(csv.DictReader(history.open())) if history else []
    units = UNITS if scene.length == UNITS[1] else (1, 1, 1)
    columns = {}
    for name, powers in COLUMNS.items():
        header = next((key for key in (rows[0] if rows else {}) if key.split("[")[0] == name), None)
        deep = scene.plane in ("axisymmetric", "space")  # forces and energies are not those of a depth
        depth = 1 if deep and name in ("contact_force", "elastic_energy") else 0
        unit = units[0]**powers[0] * units[1]**(powers[1] + depth) * units[2]**powers[2]
        columns[name] = [float(row[header]) / unit for row in rows] if header else []
    return done.returncode, columns, done.stderr


def scales(scene, columns):
    """The largest of the run: pressures and forces that are rounding beside the stress are compared with it,
    and stresses that are rounding of displacements with what is known of them to as many digits."""
    known = 1e-16 / TOLERANCE * 10
    largest = {name: max(map(abs, values), default=0) for name, values in columns.items()}
    young = max(float(number) for number in re.findall(r"young1? = ([^,]+)", "\n".join(scene.text)))
    # Loads may end at 0, of which what remains is rounding of what was prescribed.
    driven = re.findall(r'u[yz] = "-?([0-9.e-]+)\*', "\n".join(scene.text))
    moved = max([largest["displacement_max"], *map(float, driven)])
    stress = max(largest["von_mises_max"], largest["max_pressure"], known * young * moved)
    return {**largest, "displacement_max": max(largest["displacement_max"], known * moved),
            "max_pressure": stress, "von_mises_max": stress,
            "contact_force": max(largest["contact_force"], stress),
            "elastic_energy": max(largest["elastic_energy"], stress**2 / young)}


def differences(scene, columns, other):
    """Column: the largest difference over its scale; infinite where the steps are others."""
    scale = scales(scene, columns)
    return {name: float("inf") if len(values) != len(other[name]) else
            max((abs(a - b) for a, b in zip(values, other[name])), default=0) / (scale[name] or 1)
            for name, values in columns.items()}


def compare(program, seed, patience, kind=WideScene):
    """The seed, the exit code as it stands, and (way, column, difference) of all ways."""
    with tempfile.TemporaryDirectory(prefix=f"equal-{seed}-") as name:
        folder = Path(name)
        scene = kind(seed)
        code, columns, _ = run(program, folder / "as it stands", scene, False, [], patience)
        found = []
        for way, (changes, options) in WAYS.items():
            if way == "turned" and scene.plane in ("axisymmetric", "space"):
                continue
            other = kind(seed, **changes)
            again, others, told = run(program, folder / way, other, way == "turned", options, patience)
            if again != code:
                found.append((way, f"exit code {code}, {again}: {told.strip()[-200:]}", float("inf")))
                continue
            name, worst = max(differences(scene, columns, others).items(), key=lambda item: item[1])
            found.append((way, name, worst))
        return seed, code, found


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mortier", default=os.environ.get("MORTIER", "build/mortier"))
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--patience", type=int, default=20)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--space", action="store_true")
    options = parser.parse_args()
    kind = SpaceScene if options.space else WideScene
    program, worst, unequal = str(Path(options.mortier).resolve()), collections.defaultdict(list), 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        seeds = range(options.seed, options.seed + options.count)
        for seed, code, found in pool.map(lambda s: compare(program, s, options.patience, kind), seeds):
            for way, name, difference in found:
                worst[way].append(difference)
                if not difference <= TOLERANCE:
                    unequal += 1
                    print(f"{seed:6} {code:3} {way}: {name} {difference:.2e}", flush=True)
    for way, all_of in worst.items():
        all_of.sort()
        print(f"{way:12} {len(all_of):6} scenes, median {all_of[len(all_of) // 2]:.1e}, "
              f"beyond {TOLERANCE:g}: {sum(not each <= TOLERANCE for each in all_of)}")
    return 1 if unequal else 0


if __name__ == "__main__":
    sys.exit(main())
