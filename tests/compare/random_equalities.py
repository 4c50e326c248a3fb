#!/usr/bin/env python3
"""Random scenes of random_choices.py in other words, which must change nothing: units whose factors are no
powers of two, x and y turned by a right angle (in the plane), the bodies in the reverse order, two
threads, without `solver.reduce`, with SuiteSparse. Histories are compared step by step, over the largest
stress, force, energy and displacement of the run.

    tests/compare/random_equalities.py [--space] [--count 100] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import collections
import re
import sys

from contact_support import command, meshed, solve
from random_choices import SpaceScene, WideScene
from random_scenes import PATIENCE

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


def turn(mesh):
    """Turns a Medit mesh by a right angle: (x, y) becomes (-y, x)."""
    lines = mesh.split("\n")
    first = lines.index("Vertices") + 2
    for i in range(first, first + int(lines[first - 1])):
        x, y, rest = lines[i].split(maxsplit=2)
        lines[i] = f"{-float(y)!r} {x} {rest}"
    return "\n".join(lines)


def run(program, scene, turned, options):
    """The run, and the columns of its history that are compared, by steps."""
    files = {name: turn(text) if turned else text for name, text in meshed(program, scene.meshes).items()}
    if "--threads" not in options:
        options = ["--threads", "1", *options]
    done = solve(program, "\n".join(scene.text) + "\n", "--quiet", *options, files=files, patience=PATIENCE)
    rows = done.history
    units = UNITS if scene.length == UNITS[1] else (1, 1, 1)
    columns = {}
    for name, powers in COLUMNS.items():
        header = next((key for key in (rows[0] if rows else {}) if key.split("[")[0] == name), None)
        deep = scene.plane in ("axisymmetric", "space")  # forces and energies are not those of a depth
        depth = 1 if deep and name in ("contact_force", "elastic_energy") else 0
        unit = units[0]**powers[0] * units[1]**(powers[1] + depth) * units[2]**powers[2]
        columns[name] = [float(row[header]) / unit for row in rows] if header else []
    return done, columns


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


def compare(program, seed, kind=WideScene):
    """The exit code as it stands, and (way, column, difference) of all ways."""
    scene = kind(seed)
    done, columns = run(program, scene, False, [])
    found = []
    for way, (changes, options) in WAYS.items():
        if way == "turned" and scene.plane in ("axisymmetric", "space"):
            continue
        again, others = run(program, kind(seed, **changes), way == "turned", options)
        if again.code != done.code:
            found.append((way, f"exit code {done.code}, {again.end}", float("inf")))
            continue
        found.append((way, *max(differences(scene, columns, others).items(), key=lambda item: item[1])))
    return done.code, found


def examined(program, seed, space=False):
    code, found = compare(program, seed, SpaceScene if space else WideScene)
    return f"exit {code}", [f"{way}: {name} {difference:.2e}" for way, name, difference in found
                            if not difference <= TOLERANCE], found


def tell(results):
    worst = collections.defaultdict(list)
    for way, _, difference in [each for found in results for each in found]:
        worst[way].append(difference)
    for way, all_of in worst.items():
        print(f"{way:12} {len(all_of):6} scenes, median {sorted(all_of)[len(all_of) // 2]:.1e}")


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 100, told=tell, space="scenes in space"))
