#!/usr/bin/env python3
"""Random scenes with friction: thin, stacked, curved and stiff bodies, and how the program ends on each.

Stiffness ratios to 1e6, mu from 0 to 3, degree 1 and 2, all couplings, either side nonmortar; loads that
press, draw, turn round and lift. Exit code 0 is asked for, or 3 where contact alone holds a body. Scenes that
end otherwise are run again with `solver.linear = "suitesparse"` and with the sides exchanged.

    tests/compare/friction_scenes.py [--count 100] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import math
import random
import sys

from contact_support import command, solve

OTHERS = {"suitesparse": ["--set", "solver.linear=suitesparse"], "exchanged": []}


def number(value):
    return f"{value:.6g}"


class Scene:
    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.kind = rng.choice(["strip", "stack", "belt", "rings", "discs"])
        self.ratio = 10 ** rng.uniform(-6, 6)
        self.friction = rng.choice([rng.uniform(0, 3), rng.uniform(0, 0.6)])
        self.degree = rng.choice([1, 1, 2])
        self.swap = rng.random() < 0.5
        self.variant = rng.choice(["mortar", "interpolation", "weighted"])
        plane = "axisymmetric" if self.kind == "discs" else rng.choice(["stress", "strain"])
        self.text = [f'plane = "{plane}"', f"degree = {self.degree}"]
        self.contacts = []
        getattr(self, self.kind)()
        for upper, lower in self.contacts:
            self.text += ["[[contact]]", f"nonmortar = {upper}", f"mortar = {lower}",
                          f"friction = {number(self.friction)}", f'variant = "{self.variant}"',
                          'sliding = "allow"',
                          f"swap = {str(self.swap).lower()}"]
        self.text += ["[time]", "end = 1", f"steps = {rng.choice([1, 3, 6])}"]

    def scene(self, exchanged=False):
        text = "\n".join(self.text) + "\n"
        sides = [f"swap = {str(side).lower()}" for side in (self.swap, not self.swap)]
        return text.replace(*sides) if exchanged else text

    def in_time(self):
        return self.rng.choice(["t", "min(2*t,1)", "(t<0.5 ? 2*t : 2-2*t)", "sin(3*pi*t)"])

    def body(self, name, mesh, young, boundary):
        poisson = self.rng.choice([0, 0.3, 0.45])
        self.text += ["[[body]]", f'name = "{name}"', f"mesh = {mesh}",
                      f"material = {{ young = {young:.6g}, poisson = {poisson} }}",
                      "boundary = [" + ", ".join(boundary) + "]"]

    def rectangle(self, left, bottom, width, height, most, rows):
        cells = f"[{self.rng.randint(4, most)}, {self.rng.randint(1, rows)}]"
        return (f'{{ shape = "rectangle", lower = [{number(left)}, {number(bottom)}], '
                f'upper = [{number(left + width)}, {number(bottom + height)}], cells = {cells}, '
                'cut = "both" }')

    def drawn(self, label, size):
        """Forces on the end of a thin body, or its motion."""
        along, lift = self.rng.uniform(-3, 3), self.rng.uniform(-0.5, 0.5)
        if self.rng.random() < 0.4:
            return f'{{ label = {label}, ux = "{number(along * size * 1e-3)}*{self.in_time()}" }}'
        return (f'{{ label = {label}, tx = "{number(along)}*{self.in_time()}", '
                f'ty = "{number(lift)}*{self.in_time()}" }}')

    def strip(self):
        """A strip on a block."""
        rng = self.rng
        height = 10 ** rng.uniform(-2.3, -0.3)
        width = rng.uniform(0.5, 1.6)
        most = 30 if self.degree == 1 else 16
        held = rng.choice(["{ label = 4, ux = 0 }", "{ label = 4, ux = 0, uy = 0 }"])
        left = rng.uniform(-0.9, 0.9 - width)
        self.body("upper", self.rectangle(left, 0, width, height, most, 2), 1e3 * self.ratio,
                  [held, self.drawn(2, width), f'{{ label = 3, ty = "-{self.in_time()}" }}'])
        self.body("lower", self.rectangle(-1, -1, 2, 1, most, 6), 1e3, ["{ label = 1, ux = 0, uy = 0 }"])
        self.contacts = [('{ body = "upper", label = 1 }', '{ body = "lower", label = 3 }')]

    def stack(self):
        """Three or four layers."""
        rng = self.rng
        count, bottom = rng.randint(3, 4), 0.0
        for i in range(count):
            height = 10 ** rng.uniform(-2, -0.3)
            boundary = ["{ label = 1, ux = 0, uy = 0 }"] if i == 0 else ["{ label = 4, ux = 0 }"]
            if i == count - 1:
                boundary += [f'{{ label = 3, ty = "-(1+0.5*sin(5*x))*{self.in_time()}", '
                             f'tx = "{number(rng.uniform(-1, 1))}*t" }}']
            self.body(f"layer{i}", self.rectangle(0, bottom, 1, height, 14 if self.degree == 1 else 8, 2),
                      1e3 * self.ratio ** (i % 2), boundary)
            if i > 0:
                self.contacts.append((f'{{ body = "layer{i}", label = 1 }}',
                                      f'{{ body = "layer{i - 1}", label = 3 }}'))
            bottom += height

    def annulus(self, inner, outer, around, across):
        return (f'{{ shape = "annulus", cells = [{around}, {across}], inner = {number(inner)}, '
                f'outer = {number(outer)}, span = "half", cut = "both" }}')

    def belt(self):
        """A belt half round a drum."""
        rng = self.rng
        thickness = 10 ** rng.uniform(-2.7, -1)
        around = rng.choice([12, 24, 36])
        if self.degree == 2:  # curved sides do not turn triangles inside out
            around = max(around // 2, math.ceil(5 / math.sqrt(thickness)))
        other = around if rng.random() < 0.5 else around + rng.randint(-4, 8)
        self.body("belt", self.annulus(1, 1 + thickness, around, 2), 1e5,
                  [f"{{ label = 3, ty = {number(-1 / thickness)} }}",
                   f'{{ label = 4, uy = "-{number(10 ** rng.uniform(-3, -0.5))}*{self.in_time()}" }}'])
        self.body("drum", self.annulus(0.8, 1, other, 3), 1e5 * self.ratio,
                  ["{ label = 1, ux = 0, uy = 0 }"])
        self.contacts = [('{ body = "belt", label = 1 }', '{ body = "drum", label = 2 }')]

    def rings(self):
        """Halves of two rings, one in the other, pressed and turned."""
        rng = self.rng
        around = rng.choice([10, 20, 30]) // self.degree
        thickness = 10 ** rng.uniform(-2, -0.3)
        middle, outer = 1.0, 1 + thickness
        if self.degree == 2:
            around = max(around, math.ceil(5 / math.sqrt(thickness)))
        turn = number(10 ** rng.uniform(-4, -2))
        time = self.in_time()
        self.body("outer", self.annulus(middle, outer, around, 2), 1e3 * self.ratio,
                  ["{ label = 3, uy = 0 }", "{ label = 4, uy = 0 }",
                   f'{{ label = 2, pressure = "(1+0.5*x)*{time}" }}'])
        self.body("inner", self.annulus(0.5, middle, around + rng.randint(0, 6), 3), 1e3,
                  [f'{{ label = 1, ux = "-{turn}*y*{time}", uy = "{turn}*x*{time}" }}'])
        self.contacts = [('{ body = "outer", label = 1 }', '{ body = "inner", label = 2 }')]

    def discs(self):
        """A ring on a ring about the axis."""
        rng = self.rng
        inside = rng.choice([0.5, 2.0])
        height = 10 ** rng.uniform(-2, -0.3)
        most = 24 if self.degree == 1 else 12
        self.body("upper", self.rectangle(inside, 0, 1, height, most, 2), 1e3 * self.ratio,
                  [f'{{ label = 3, ty = "-(1+0.3*x)*{self.in_time()}" }}',
                   f'{{ label = 2, tx = "{number(rng.uniform(-3, 3))}*{self.in_time()}" }}'])
        self.body("lower", self.rectangle(inside - 0.2, -1, 1.4, 1, most, 5), 1e3,
                  ["{ label = 1, ux = 0, uy = 0 }"])
        self.contacts = [('{ body = "upper", label = 1 }', '{ body = "lower", label = 3 }')]


def examined(program, seed):
    scene = Scene(seed)
    run = solve(program, scene.scene(), patience=60)
    if run.code in (0, 3):
        return scene.kind, []
    solved = [name for name, options in OTHERS.items()
              if solve(program, scene.scene(name == "exchanged"), *options, patience=60).code == 0]
    return scene.kind, [f"{run.end}, solved by {' and '.join(solved) or 'none'}"]


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 100))
