#!/usr/bin/python3
"""Friction work of random scenes in 16 steps against that of 8 times as many, and the energy of each step.

Bodies and tools that are dragged, that spin, that roll and that go back and forth (hysteresis), on meshes of
some hundred elements. Reversals are at ends of steps, so that the path is known. The friction work at the end
is within 0.1 % of it, or of a hundredth of all work. What loads and supports do in a step is what is stored
and what friction dissipates, to 1e-9 of it, 1e-7 with finite sliding, and the support at rest does nothing.

    tests/compare/friction_works.py [--count 50] [--first SEED] [--jobs N] [--all] [--mortier PROGRAM]
"""
import random
import sys

import numpy as np
from contact_support import HELD, command, rectangle, solve
from scene_parts import body, contact, quantity, timed

STEPS, FINER = 16, 8
ALLOWED, BALANCE = 1e-3, 1e-9
TOLERANCE = 1e-7  # with finite sliding rows are repeated until they fit the bodies to that
KINDS = ("dragged", "spinning", "hysteresis", "rolling", "pressed")


class Scene:
    """Scene number `seed`: data change at multiples of 1/16, the ends of steps."""

    def __init__(self, seed):
        rng = random.Random(seed)
        self.kind = KINDS[seed % len(KINDS)]
        self.friction = rng.uniform(0.1, 0.8)
        self.degree = rng.choice([1, 1, 2])
        self.finite = self.kind == "rolling" or rng.random() < 0.3
        self.way = rng.choice([-1, 1]) * 10 ** rng.uniform(-3, -1.3)
        self.depth = rng.uniform(0.005, 0.02)
        self.turns = rng.uniform(0.01, 0.1)
        # Meshes resolve the contact of discs from the first step on.
        finer = 3 if self.kind in ("rolling", "spinning") else 0
        self.cells = [rng.randint(3, 6) + finer, rng.randint(2, 4)]
        self.tool = rng.random() < 0.5
        self.variant = rng.choice(["weighted", "mortar"]) if self.degree == 1 else "weighted"

    @property
    def shown(self):
        return f"{self.kind}{' finite' if self.finite else ''}, degree {self.degree}, {self.variant}"

    def text(self, steps):
        more = {"friction": self.friction, "variant": self.variant,
                "sliding": "finite" if self.finite else None}
        ground = body("lower", rectangle((-2, -1), (2, 0), (4 * self.cells[0], self.cells[1])), 1000.0,
                      "label = 1, " + HELD)
        pressed, ramp = "min(4*t, 1)", "max(0, t - 0.25)/0.75"
        wave = {"time": "[0.25, 0.4375, 0.8125, 1]", "value": "[0, 1, -1, 0.5]"}
        way = f'"{self.way!r}*{ramp}"'
        if self.kind == "hysteresis":
            values = [value * self.way for value in (0, 1, -1, 0.5)]
            way = f"{{ time = {wave['time']}, value = {values} }}"
        elif self.kind == "pressed":
            way = f'"{self.way!r}*{pressed}"'
        if self.kind in ("spinning", "rolling"):
            move = (f"rotation = {way}".replace(repr(self.way), repr(self.turns)) if self.kind == "spinning"
                    else f"moment = 0\nux = {way}".replace(repr(self.way), repr(2 * self.turns)))
            upper = (f'[[tool]]\nname = "upper"\nshape = "disc"\ncentre = [0, 2]\nradius = 2\n{move}\n'
                     f'uy = "{-self.depth!r}*max({pressed}, 1/4)"\n')
            bodies, sides = ["lower"], [("lower", 3), ("upper", 1)]
        elif self.tool:
            upper = (f'[[tool]]\nname = "upper"\nshape = "rectangle"\nlower = [-0.5, 0]\nupper = [0.5, 1]\n'
                     f'ux = {way}\nuy = "{-self.depth!r}*{pressed}"\n')
            bodies, sides = ["lower"], [("lower", 3), ("upper", 1)]
        else:
            upper = body("upper", rectangle((-0.5, 0), (0.5, 0.6), self.cells), 1000.0,
                         f'label = 3, ux = {way}, uy = "{-self.depth!r}*{pressed}"')
            bodies, sides = ["lower", "upper"], [("upper", 1), ("lower", 3)]
        asked = "".join(quantity(f"stored_{name}", "stored_energy", name) for name in bodies)
        asked += "".join(quantity(f"done_{name}", "external_work", name) for name in ("lower", "upper"))
        return (f'plane = "strain"\ndegree = {self.degree}\n' + ground + upper + contact(*sides, **more)
                + asked + quantity("rubbed", "friction_work", *sides[0]) + timed(steps)
                + '[check]\nallow = ["large-strain", "large-rotation", "large-displacement"]\n')


def examined(program, seed):
    scene = Scene(seed)
    runs = [solve(program, scene.text(STEPS * factor)) for factor in (1, FINER)]
    for run in runs:
        if run.code != 0:
            return scene.shown, [run.end]
    coarse, fine = (run.value("rubbed") for run in runs)
    faults = []
    done = runs[0].course("done_lower") + runs[0].course("done_upper")
    # Where next to nothing slips what is stored takes its place.
    if abs(coarse - fine) > ALLOWED * max(fine, 0.01 * abs(done).max()):
        faults.append(f"friction work {coarse:.6g}, {fine:.6g} in {STEPS * FINER} steps: "
                      f"{100 * (coarse / fine - 1):.3g} %")
    course = runs[0].course
    names = [key.split("[")[0] for key in runs[0].history[0]]
    kept = sum(course(name) for name in names if name.startswith("stored_")) + course("rubbed")
    steps = np.abs(np.diff(done))
    worst = max(np.abs(np.diff(kept) - np.diff(done)) / np.maximum(steps, 1e-3 * steps.max()))
    if worst > (TOLERANCE if scene.finite else BALANCE):
        faults.append(f"energy of a step is off by {worst:.2g} of its work")
    idle = abs(course("done_lower")).max() / abs(done).max()
    if idle > BALANCE:
        faults.append(f"the support at rest does {idle:.2g} of all work")
    return f"{scene.shown}: {100 * (coarse / fine - 1) if fine else 0:.3g} %, balance {worst:.1g}", faults


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 50))
