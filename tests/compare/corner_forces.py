#!/usr/bin/python3
"""Random corners that a load presses without friction onto straight slopes of 2 to 55 degrees.

Corners of tools on bodies, of bodies on tools (small and finite sliding) and of bodies on bodies with either
side nonmortar; of 20 to 160 degrees, the corner within a side, at its end (the other side of the body is not
in the contact), or of a whole outline that is one label; every coupling, both degrees. The other components
are held, so statics knows both: Y is the load, and X is Y times the tangent of the slope, to 1e-9.

    tests/compare/corner_forces.py [--count 200] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import math
import random
import sys

import numpy as np
from contact_support import HELD, command, forces, outline_geo, polygon, quadrilateral, solve
from scene_parts import body, contact, timed, tool, written

TOLERANCE = 1e-9  # the certificate of a step is 1e-10 of the largest force


def turned(angle):
    return np.array([math.cos(angle), math.sin(angle)])


def held(point, *components):
    return f"[[body.point]]\nat = {written(point)}\n" + "".join(f"{name} = 0\n" for name in components)


class Scene:
    """Scene number `seed`: its text, its files, the load and the normal of the slope."""

    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.kind = rng.choice(["tool on body", "body on tool", "body on body"])
        self.degree = rng.choice([1, 2])
        self.variant = rng.choice([None, "mortar", "weighted", "interpolation", None])
        self.finite = self.kind == "body on tool" and rng.random() < 0.6
        self.angle = rng.choice([-1, 1]) * math.radians(rng.uniform(2, 55))
        self.young = 10 ** rng.uniform(0, 6), 10 ** rng.uniform(0, 6)
        self.load = min(self.young) * 10 ** rng.uniform(-5, -3.5)
        self.where = rng.choice(["within", "end", "outline"])
        self.files = {}
        self.draw_corner()
        above = self.corner_tool() if self.kind == "tool on body" else self.corner_body()
        below = self.slope_tool() if self.kind == "body on tool" else self.slope_body()
        corner = ("above", 1)
        sides = [corner, ("below", self.below)]
        if self.kind == "tool on body" or self.kind == "body on body" and rng.random() < 0.5:
            sides.reverse()
        self.nonmortar = sides[0][0]
        keys = {"variant": self.variant, "sliding": "finite" if self.finite else "allow"}
        self.text = (f'degree = {self.degree}\nplane = "{rng.choice(["stress", "strain"])}"\n' + above + below
                     + contact(*sides, **keys) + forces("contact_force", *corner)
                     + timed(2 if self.finite else 1))

    @property
    def shown(self):
        first, second = (math.degrees(side) for side in self.sides)
        return (f"{self.kind}, nonmortar {self.nonmortar}, {self.where}, "
                f"slope {math.degrees(self.angle):.1f}, sides at {first:.0f} and {180 - second:.0f} to it, "
                f"{self.variant or 'default'}, degree {self.degree}, {'finite' if self.finite else 'small'}")

    def draw_corner(self):
        """The corner at (0, 0) and its sides, at angles from the slope of 8 to 172 degrees. Where the contact
        has one side only, this one faces the slope."""
        rng = self.rng
        while True:
            first = math.radians(rng.uniform(8, 55 if self.where == "end" else 80))
            second = rng.choice([first + math.pi / 2, math.radians(rng.uniform(100, 172))])
            if not math.radians(98) < second < math.radians(172):
                continue
            lengths = rng.uniform(0.4, 1), rng.uniform(0.4, 1)
            ends = [length * turned(self.angle + side) for length, side in zip(lengths, (first, second))]
            far = [ends[0] + ends[1]] if rng.random() < 0.7 else []
            if abs(ends[0][1] - ends[1][1]) < 0.3 and not far:
                continue  # held along x at both: turns where they are as high
            if max(abs(end[1] - other[1]) for end in ends for other in ends + far) > 0.25:
                break
        self.sides = first, second
        self.outline = [np.zeros(2), ends[0], *far, ends[1]]

    def labels(self):
        """The side to the right of the corner is the first one, that to the left the last."""
        between = len(self.outline) - 2
        last = {"within": 1, "end": 3, "outline": 1}[self.where]
        return [1] + [1 if self.where == "outline" else 2] * between + [last]

    def corner_tool(self):
        return polygon("above", self.outline, f'fy = "-{self.load!r}*t"', self.labels())

    def corner_body(self):
        rng = self.rng
        self.files["above.geo"] = outline_geo(self.outline, self.labels(), rng.uniform(0.08, 0.3))
        outline = np.array(self.outline)
        if self.where == "outline":
            x, y = outline.T
            area = 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))
            weight = f'force = {{ x = 0.0, y = "-{self.load / area!r}*t" }}\n'
            return body("above", '"above.geo"', self.young[0],
                        more=weight + held(outline[1], "ux") + held(outline[-1], "ux"))
        length = sum(np.linalg.norm(b - a) for a, b in zip(outline[1:], outline[2:]))
        return body("above", '"above.geo"', self.young[0],
                    f'label = 2, ux = 0, ty = "-{self.load / length!r}*t"')

    def ends(self):
        return [sign * self.rng.uniform(0.8, 2) * turned(self.angle) for sign in (-1, 1)]

    def slope_tool(self):
        rng = self.rng
        left, right = self.ends()
        self.below = None
        if rng.random() < 0.5:
            return tool("below", shape="line", points=[right, left])
        low = min(left[1], right[1]) - 1
        self.below = 1
        whole = rng.random() < 0.5
        return polygon("below", [right, left, (left[0], low), (right[0], low)], "", [1] * 4 if whole
                       else [1, 2, 3, 4])

    def slope_body(self):
        rng = self.rng
        left, right = self.ends()
        low = min(left[1], right[1]) - 1
        corners = [(left[0], low), (right[0], low), right, left]
        if rng.random() < 0.3:
            self.below = 1
            self.files["below.geo"] = outline_geo(corners, [1] * 4, rng.uniform(0.15, 0.4))
            return body("below", '"below.geo"', self.young[1],
                        more="".join(held(corner, "ux", "uy") for corner in corners[:2]))
        self.below = 3
        return body("below", quadrilateral(corners, (rng.randint(5, 20), rng.randint(3, 8))), self.young[1],
                    f"label = 1, {HELD}")


def examined(program, seed):
    scene = Scene(seed)
    run = solve(program, scene.text, files=scene.files)
    if run.code != 0:
        return scene.shown, [run.end]
    x, y = run.values("X", "Y") / scene.load
    faults = []
    if not abs(abs(y) - 1) < TOLERANCE:
        faults.append(f"Y {y:.12g} of the load")
    if not abs(x * math.cos(scene.angle) + y * math.sin(scene.angle)) < TOLERANCE * abs(y):
        faults.append(f"X/Y {x / y if y else math.nan:.9g}, right is {-math.tan(scene.angle):.9g}")
    return scene.shown, faults


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 200))
