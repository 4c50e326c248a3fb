#!/usr/bin/python3
"""Estimated against true errors of all quantities of random scenes whose values are known.

Values are those of closed forms, of statics, or of the same scene on meshes of --finer times the cells by
quadratic elements. For each value: the true error over "+-", "not known" with the reason. An error is
rounding below 1e-7 of the largest value of its unit; a value with a "+-" of rounding that is off by rounding
is right. Works and heat, which are sums over steps, are not asked for.

    tests/compare/known_values.py [--count 300] [--first SEED] [--jobs N] [--only KIND] [--values FILE]
                                  [--mortier PROGRAM]

--values keeps the values that fine meshes gave, so that a second run computes them no more. Exit code 1 where
the shares that docs/measurements.md names are not reached.
"""
import argparse
import json
import math
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from contact_support import ROOT, solve
from known_scenes import scene_of

ROUNDING = 1e-7


@dataclass
class Found:
    seed: int
    kind: str
    name: str
    value: float
    exact: float
    scale: float
    error: float = None  # "+-"
    reason: str = ""
    stress: float = 0  # its estimated error
    shown: str = ""
    doubt: float = 0  # the "+-" of the value of a fine mesh

    @property
    def true(self):
        return abs(self.value - self.exact)

    @property
    def rounding(self):
        return self.true <= ROUNDING * self.scale

    @property
    def over(self):
        """The true error over "+-"; None where that is not known. Where meshes gave both values, small
        differences say nothing of the error that they share."""
        if self.error is None:
            return None
        if self.rounding and self.error <= ROUNDING * self.scale:
            return 1.0
        if self.error == 0:
            return math.inf
        over = self.true / self.error
        return over if over > 1 else min(1.0, max(over, self.doubt / self.error))


def examined(program, seed, values):
    kind, scene = scene_of(seed)
    options = ["--accuracy", str(scene.accuracy), "--max-unknowns", "20000"] if scene.accuracy else []
    run = solve(program, scene.text(scene.degree, 1), *options)
    shown = f"{kind} degree {scene.degree}" + (f" accuracy {scene.accuracy}" if scene.accuracy else "")
    if run.code not in (0, 1) or not run.summary.get("quantities"):
        return [], f"{seed} {shown}: {run.end}"
    quantities = run.summary["quantities"]
    exact = dict(scene.known)
    if any(name not in exact for name in quantities):
        if str(seed) not in values:
            fine = solve(program, scene.text(2, scene.finer), patience=300)
            if fine.code != 0:
                return [], f"{seed} {shown}: on the fine mesh: {fine.end}"
            values[str(seed)] = {name: (each["value"], each["estimated_error"] or 0)
                                 for name, each in fine.summary["quantities"].items()}
        exact = {name: value for name, (value, _) in values[str(seed)].items()} | exact
    largest = {}
    unit = lambda each: {"N": "N/m", "N m": "N"}.get(each["unit"], each["unit"])  # moments are of forces
    for name, each in quantities.items():
        largest[unit(each)] = max(largest.get(unit(each), 0), abs(exact[name]), abs(each["value"]))
    doubt = {name: 0 if name in scene.known else values[str(seed)][name][1] for name in quantities}
    return [Found(seed, kind, name, each["value"], exact[name], largest[unit(each)], each["estimated_error"],
                  each.get("no_estimate", ""), run.summary["accuracy"]["energy_error"], shown, doubt[name])
            for name, each in quantities.items()], ""


def share(part, whole):
    return f"{len(part)} of {len(whole)} ({100 * len(part) / max(1, len(whole)):.3g} %)"


def judged(found, least_not_wide=1):
    """What the shares are, and whether they are those asked for.

    :param least_not_wide: the share of "+-" below 100 of the true error; values that are exact by chance or
        symmetry miss it
    """
    known = [each for each in found if each.error is not None]
    checks = []
    for what, part, whole, least in (
            ('true error at most 1.0 of "+-"', [e for e in known if e.over <= 1], known, 0.95),
            ('true error at most 1.5 of "+-"', [e for e in known if e.over <= 1.5], known, 0.99),
            ('"+-" below 10 of the true error', [e for e in known if e.over > 0.1], known, 0.8),
            ('"+-" below 100 of the true error', [e for e in known if e.over > 0.01], known, least_not_wide),
            ("known", known, found, 0.85)):
        checks.append((f"{what}: {share(part, whole)}, {100 * least:g} % asked for",
                       len(part) >= least * len(whole)))
    return checks


def line(value):
    error = value.reason
    if value.error is not None:
        error = f"+- {value.error:.2g}, true error {value.over:.3g} of it"
    return (f"{value.seed} {value.shown}: {value.name} {value.value:.6g}, right is {value.exact:.6g}; "
            f"{error} (stress {100 * value.stress:.2g} %)")


def violations(found):
    return [line(value) for value in found if value.error is not None and not 0.01 < value.over <= 1]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--values", type=Path)
    parser.add_argument("--mortier", default=str(ROOT / "build" / "mortier"))
    parser.add_argument("--all", action="store_true", help="a line for each value")
    options = parser.parse_args()
    values = json.loads(options.values.read_text()) if options.values and options.values.exists() else {}
    seeds = [seed for seed in range(options.first, options.first + options.count)
             if options.only in scene_of(seed)[0]]
    program = str(Path(options.mortier).resolve())
    found, failed = [], 0
    with ThreadPoolExecutor(options.jobs) as pool:
        for each, message in pool.map(lambda seed: examined(program, seed, values), seeds):
            found += each
            if message:
                failed += 1
                print(message, flush=True)
            for text in map(line, each) if options.all else violations(each):
                print(text, flush=True)
    if options.values:
        options.values.write_text(json.dumps(values, indent=0))
    print()
    for reason, count in Counter(e.reason for e in found if e.error is None).most_common():
        print(f"not known {count}: {reason}")
    checks = judged(found)
    print(*(text + ("" if right else ": MISSED") for text, right in checks), sep="\n")
    return 0 if all(right for _, right in checks) and not failed else 1


if __name__ == "__main__":
    sys.exit(main())
