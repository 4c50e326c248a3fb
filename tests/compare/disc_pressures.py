#!/usr/bin/python3
"""Pressures of discs on blocks against Hertz: stiffnesses, mesh sizes and nonmortar sides of every kind.

E of the two bodies differ by 1 to 1000 either way, the edges of the mortar side are 0.3 to 8 times those of
the nonmortar one, and 5 to 40 of the coarser ones lie on the half width b of the contact. Two of three
scenes are of shapes, whose edges double over b, the others of meshes by Gmsh, equal up to 1.3 b; the
nonmortar side is given or left to the program; degree 1 and 2. Nodal pressures up to 0.85 b are within
5 % of those of Hertz, from 20 edges on within 2 %; or the log names the contact as unresolved. With b a
twentieth of the radius, what bodies are not half planes changes pressures by 1e-3.

    tests/compare/disc_pressures.py [--count 100] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import math
import random
import sys

from contact_support import HELD, UNRESOLVED, command, forces, outline_geo, solve
from scene_parts import body, contact, timed

HALF = 0.05  # of the contact, over the radius
FINEST = {1: 44, 2: 24}  # most edges of the finer side on the half width, by degree
UP_TO = 0.85  # of the half width
DISC = """\
Point(1) = {{0, 1, 0, 0.3}}; Point(2) = {{-1, 1, 0, 0.2}}; Point(5) = {{1, 1, 0, 0.2}};
Point(3) = {{-Sin({turn}), 1 - Cos({turn}), 0, {fine}}};
Point(4) = {{Sin({turn}), 1 - Cos({turn}), 0, {fine}}};
Circle(1) = {{2, 1, 3}}; Circle(2) = {{3, 1, 4}}; Circle(3) = {{4, 1, 5}}; Line(4) = {{5, 2}};
Curve Loop(1) = {{1:4}}; Plane Surface(1) = {{1}}; Physical Surface(1) = {{1}};
Physical Curve(1) = {{1, 2, 3}}; Physical Curve(2) = {{4}};
"""


class Scene:
    """Scene number `seed`: a half disc of radius 1, pressed on a block."""

    def __init__(self, seed):
        rng = random.Random(seed)
        self.degree = rng.choice([1, 2])
        ratio = 10 ** rng.uniform(0, 3)
        self.young = rng.choice([(1e3, 1e3 * ratio), (1e3 * ratio, 1e3)])
        self.sides = rng.choice(["any", "upper", "lower"])
        self.ratio = 0.3 * (8 / 0.3) ** rng.random()
        most = max(1, min(40, FINEST[self.degree] / max(self.ratio, 1 / self.ratio)) / 5)
        self.cells = round(5 * most ** rng.random())
        self.shift = rng.random()
        self.shapes = rng.random() < 2 / 3
        # 0.3 to 8 is the size of the mortar edges over that of the nonmortar ones; the coarser have `cells`.
        coarse = HALF / self.cells
        nonmortar, mortar = (coarse, coarse * self.ratio) if self.ratio < 1 else (coarse / self.ratio, coarse)
        self.upper, self.lower = (mortar, nonmortar) if self.sides == "lower" else (nonmortar, mortar)

    @property
    def shown(self):
        return (f"{'shapes' if self.shapes else 'Gmsh'}, {self.cells} cells, edges {self.upper / HALF:.3g} "
                f"and {self.lower / HALF:.3g} of the half width, E {self.young[0] / self.young[1]:.3g}, "
                f"degree {self.degree}, sides {self.sides}")

    def text(self):
        modulus = 1 / sum(0.91 / e for e in self.young)
        force = math.pi * modulus * HALF**2 / 4
        disc, block = self.of_shapes() if self.shapes else ('"disc.geo"', '"block.geo"')
        upper = body("u", disc, self.young[0], f'label = 2, ux = 0, ty = "-{force / 2!r}*t"')
        lower = body("l", block, self.young[1], f"label = 1, {HELD}")
        both = [("u", 1), ("l", 3)]
        if self.sides == "lower":
            both.reverse()
        return (f'degree = {self.degree}\nplane = "strain"\n' + upper + lower
                + contact(*both, self.sides == "any") + forces("contact_force", "l", 3) + timed())


    def of_shapes(self):
        """The edges of the block double over the half width: 0.69 times the mean in its middle,
        about which it is shifted by a part of it."""
        cells = round(HALF / self.upper)
        disc = (f'{{ shape = "halfdisc", radius = 1, core = {cells * self.upper!r}, cells = {cells}, '
                'cut = "both" }')
        first, shift, length = 0.69 * self.lower, self.shift * 0.69 * self.lower, 0.75
        grading = 1 + length / HALF
        side = round(math.log(grading) * HALF / first)
        return disc, (f'{{ shape = "rectangle", lower = [{shift - length!r}, {-length!r}], '
                      f'upper = [{shift + length!r}, 0], cells = [{2 * side}, {side // 2}], cut = "both", '
                      f'focus = [{shift!r}, 0], grading = {grading!r} }}')

    def files(self):
        """The disc has label 1 around and 2 at its flat side, the block 1 at its bottom and 3 at its top."""
        right = 1.3 * HALF + self.shift * self.lower
        block = [(-1, -1), (1, -1), (1, 0), (right, 0), (-1.3 * HALF, 0), (-1, 0)]
        return {"disc.geo": DISC.format(fine=self.upper, turn=1.3 * HALF),
                "block.geo": outline_geo(block, [1, 2, 3, 3, 3, 2],
                                         [0.3, 0.3, 0.3, self.lower, self.lower, 0.3])}


def examined(program, seed):
    scene = Scene(seed)
    run = solve(program, scene.text(), files={} if scene.shapes else scene.files())
    if run.code != 0:
        return scene.shown, [run.end]
    if UNRESOLVED.search(run.log):
        return scene.shown, []
    modulus = 1 / sum(0.91 / e for e in scene.young)
    force = abs(run.value("Y"))
    half = math.sqrt(4 * force / (math.pi * modulus))
    peak = 2 * force / (math.pi * half)
    errors = [row["pressure"] / (peak * math.sqrt(1 - (row["x"] / half) ** 2)) - 1
              for row in run.contact if abs(row["x"]) <= UP_TO * half]
    if not errors:
        return scene.shown, ["no node on the contact"]
    allowed = 0.02 if scene.cells >= 20 else 0.05
    worst = max(map(abs, errors))
    variant, nonmortar = (run.summary["interfaces"][0][key] for key in ("variant", "nonmortar"))
    return scene.shown + f", {variant} of {nonmortar}", [] if worst <= allowed else [
        f"pressures {100 * min(errors):.3g} to {100 * max(errors):.3g} % off, {100 * allowed:g} allowed"]


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 100))
