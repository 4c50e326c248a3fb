#!/usr/bin/python3
"""Estimated against true errors of all quantities of random scenes whose values are known.

Values are those of closed forms, of statics, or of the same scene on meshes of --finer times the cells by
quadratic elements. For each value: the true error over "+-", "not known" with the reason. An error is
rounding below 1e-7 of the largest value of its unit; a value with a "+-" of rounding that is off by rounding
is right. Works and heat, which are sums over steps, are not asked for.

    tests/compare/known_values.py [--count 300] [--first SEED] [--jobs N] [--mortier PROGRAM]

The last lines print the shares of scenes that docs/measurements.md quotes.
"""
import math
import sys
from collections import Counter
from dataclasses import dataclass

from contact_support import command, solve
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


def values_of(program, seed):
    """Of a scene, and why there are none."""
    kind, scene = scene_of(seed)
    options = ["--accuracy", str(scene.accuracy), "--max-unknowns", "20000"] if scene.accuracy else []
    run = solve(program, scene.text(scene.degree, 1), *options)
    shown = f"{kind} degree {scene.degree}" + (f" accuracy {scene.accuracy}" if scene.accuracy else "")
    if run.code not in (0, 1) or not run.summary.get("quantities"):
        return [], f"{seed} {shown}: {run.end}"
    quantities = run.summary["quantities"]
    exact, doubt = dict(scene.known), dict.fromkeys(scene.known, 0)
    if any(name not in exact for name in quantities):
        fine = solve(program, scene.text(2, scene.finer), patience=300)
        if fine.code != 0:
            return [], f"{seed} {shown}: on the fine mesh: {fine.end}"
        for name, each in fine.summary["quantities"].items():
            exact.setdefault(name, each["value"])
            doubt.setdefault(name, each["estimated_error"] or 0)
    largest = {}
    unit = lambda each: {"N": "N/m", "N m": "N"}.get(each["unit"], each["unit"])  # moments are of forces
    for name, each in quantities.items():
        largest[unit(each)] = max(largest.get(unit(each), 0), abs(exact[name]), abs(each["value"]))
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


def examined(program, seed):
    found, message = values_of(program, seed)
    return scene_of(seed)[0], ([message] if message else []) + violations(found), found


def tell(results):
    found = [each for of_scene in results for each in of_scene]
    for reason, count in Counter(e.reason for e in found if e.error is None).most_common():
        print(f"not known {count}: {reason}")
    print(*(text + ("" if right else ": MISSED") for text, right in judged(found)), sep="\n")


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 300, told=tell))
