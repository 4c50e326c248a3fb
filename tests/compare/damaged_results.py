#!/usr/bin/python3
"""Results with seeded damage through mortier plot and mortier report: a picture or one line,
never a fault of the program.

    tests/compare/damaged_results.py [--count 300] [--seed 1]

Each case spoils one file (mutators.py, or a value of summary.json) and draws.
tests/compare/plot_test.py does a few.
"""
import argparse
import collections
import json
import random
import sys
import tempfile
import warnings
from pathlib import Path

from mutators import OF_MESHES
from views_support import solve, view

VALUES = [None, [], {}, "x", "", -1, 0, 1e308, 1e-320, 3.5, True, 10**30, [[]], [1], {"a": 1}, "\0<b>",
          "../x"]
COMMANDS = [("report", "run"), ("report", "run"), ("plot", "run", "--only", "fields", "--out", "x.svg"),
            ("plot", "run", "--only", "contact", "--out", "x.svg"),
            ("plot", "run", "--only", "history", "--out", "x.svg")]


def places(value):
    """Every (container, key) in a JSON document."""
    for key, each in value.items() if isinstance(value, dict) else enumerate(value):
        yield value, key
        if isinstance(each, (dict, list)):
            yield from places(each)


def spoiled(name, data, rng):
    if name == "summary.json" and rng.random() < 0.7:
        summary = json.loads(data)
        container, key = rng.choice(list(places(summary)))
        container[key] = rng.choice(VALUES)
        return json.dumps(summary).encode()
    return rng.choice(OF_MESHES)(data, rng)


def explore(folder, seed, count):
    """Faults as text, and how often each exit code came."""
    rng, faults, codes = random.Random(seed), [], collections.Counter()
    solve(folder, "run", "output.every=2", "contact.variant=interpolation")
    sound = {path.name: path.read_bytes() for path in sorted((folder / "run").iterdir())
             if path.name != "manifest.json"}
    for case in range(count):
        name, command = rng.choice(list(sound)), rng.choice(COMMANDS)
        (folder / "run" / name).write_bytes(spoiled(name, sound[name], rng))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            code, _, errors = view(folder, *command)
        codes[code] += 1
        left = {path.name for path in folder.iterdir()} - {"run", "x.svg", "run.html"}
        if code not in (0, 2) or errors.count("\n") != (code != 0) or left:
            faults.append(f"case {case}: {name}, {command[:4]}: code {code}, {errors[:300]!r} {left or ''}")
        (folder / "run" / name).write_bytes(sound[name])
        for made in ("x.svg", "run.html"):
            (folder / made).unlink(missing_ok=True)
    return faults, codes


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        faults, codes = explore(Path(folder), given.seed, given.count)
    print(*faults, f"exit codes: {dict(codes)}", sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
