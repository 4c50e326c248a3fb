#!/usr/bin/python3
"""Random light contact of curved pairs on coarse and fine meshes, and blocks that tip.

Half discs on blocks, rings, in rings and on lines of tools, discs of tools on blocks: pressed by 1e-6 to 1e-2
of the radius, with 1 to 100 edges of the finer side on the contact. The right force F follows Hertz: with
half width b = sqrt(4 F R/(pi E)) the displacement is F (K - log(F)/(pi E)), where K is of the bodies and
comes from one run with a fine mesh and a heavier load. A force that is more than 20 % off is a fault, unless
the log names the contact as unresolved. Every fourth scene is a block that is pushed until it tips: at the
load that statics knows, to 0.5 %, with the couplings that are a default. Where the scene itself makes the
floor nonmortar, whose nodes do not know the end of the block, a third of an edge of the floor is allowed
beside.

    tests/compare/light_contacts.py [--count 80] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import math
import random
import re
import sys

from contact_support import HELD, UNRESOLVED, command, forces, rectangle, solve
from scene_parts import body, contact, timed

FORCE = 0.2
TIPS = 0.005
KINDS = ("disc on block", "disc on block", "disc on block", "tool on block", "disc on line", "disc on ring",
         "disc in ring")


def graded(radius, smallest, shift, side):
    """A block 3 radii wide, its top at y = 0, with `side` cells to each side of x = shift."""
    length = 1.5 * radius
    least, most = 1 + 1e-9, 1e6
    for _ in range(200):
        middle = math.sqrt(least * most)
        first = length / (middle - 1) * (middle ** (1 / side) - 1)
        least, most = (middle, most) if first > smallest else (least, middle)
    grading = max(least, 1.001)
    return (f'{{ shape = "rectangle", lower = [{shift - length!r}, {-length!r}], '
            f'upper = [{shift + length!r}, 0], cells = [{2 * side}, {side}], cut = "both", '
            f'focus = [{shift!r}, 0], grading = {grading!r} }}')


class Pair:
    """Scene number `seed`: two curved sides, in the wanted and in a fine mesh."""

    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.kind = rng.choice(KINDS)
        self.radius = 10 ** rng.uniform(-1, 2)
        self.young = 1e3, 1e3 * 10 ** rng.uniform(-2, 2)
        self.degree = rng.choice([1, 1, 2])
        self.variant = rng.choice([None, None, None, None, "mortar", "weighted"])
        self.sides = rng.choice(["any", "upper", "lower"])
        self.sliding = rng.choice(["refuse", "refuse", "finite"])
        self.other = {"disc on ring": rng.uniform(0.7, 3), "disc in ring": -rng.uniform(1.5, 4)}.get(
            self.kind, math.inf) * self.radius
        self.curved = 1 / (1 / self.radius + 1 / self.other)
        rigid = {"tool on block": 0, "disc on line": 1}.get(self.kind)
        self.modulus = 1 / sum(0.91 / e for i, e in enumerate(self.young) if i != rigid)
        # Rings have equal cells all around.
        ring = "ring" in self.kind
        self.half = self.curved * 10 ** (rng.uniform(-1.7, -1.2) if ring else rng.uniform(-3.3, -1.3))
        self.edges = 10 ** (rng.uniform(0, 1) if ring else rng.uniform(0, 2))
        self.ratio = 10 ** rng.uniform(0, 0.8) if ring else 10 ** rng.uniform(-0.7, 0.9)
        self.shift = rng.random()

    @property
    def shown(self):
        return (f"{self.kind}, half width {self.half / self.curved:.2g} of the radius, "
                f"{self.edges:.3g} edges, other edges {self.ratio:.2g} times, "
                f"E {self.young[0] / self.young[1]:.2g}, {self.variant or 'default'}, degree {self.degree}, "
                f"sides {self.sides}, {self.sliding}")

    def force(self, half):
        return math.pi * self.modulus * half**2 / (4 * self.curved)

    def sinks(self, force, constant):
        return force * (constant - math.log(force) / (math.pi * self.modulus))

    def text(self, depth, smallest, ratio, cells, side, exact=False):
        """Edges of the upper side near the contact of size `smallest`, of the lower one of `ratio` times it.
        exact: rows that are right on a fine mesh."""
        radius, other = self.radius, smallest * ratio
        moved = f'ux = 0, uy = "-{depth!r}*t"'
        core = min(cells * smallest, 0.3 * radius)
        first, second = ("u", 1), ("l", 3)
        if self.kind == "tool on block":
            upper = (f'[[tool]]\nname = "u"\nshape = "disc"\ncentre = [0, {radius!r}]\nradius = {radius!r}\n'
                     + moved.replace(", uy", "\nuy") + "\n")
        else:
            upper = body("u", f'{{ shape = "halfdisc", radius = {radius!r}, core = {core!r}, '
                         f'cells = {cells}, cut = "both" }}', self.young[0], f"label = 2, {moved}")
        if self.kind in ("disc on block", "tool on block"):
            lower = body("l", graded(radius, other, self.shift * other, side), self.young[1],
                         f"label = 1, {HELD}")
        elif self.kind == "disc on line":
            second = ("l", 1)
            lower = (f'[[tool]]\nname = "l"\nshape = "line"\npoints = [[{0.9 * radius!r}, 0], '
                     f'[{-0.9 * radius!r}, 0]]\n')
        else:
            ring = abs(self.other)
            inner, outer = (ring, 1.6 * ring) if self.other < 0 else (0.4 * ring, ring)
            around = min(max(24, round(2 * math.pi * ring / other)), 1200)
            mesh = (f'{{ shape = "annulus", centre = [0, {-self.other!r}], inner = {inner!r}, '
                    f'outer = {outer!r}, cells = [{around}, {max(3, min(around // 12, 24))}], span = "full", '
                    'cut = "both" }')
            near, far = (1, 2) if self.other < 0 else (2, 1)
            second = ("l", near)
            lower = body("l", mesh, self.young[1], f"label = {far}, {HELD}")
        both = [first, second]
        body_only = {"tool on block": second, "disc on line": first}.get(self.kind)
        if body_only:
            both.sort(key=lambda part: part is not body_only)
        elif self.sides == "lower" and not exact:
            both.reverse()
        where = ("u", None) if self.kind == "tool on block" else ("u", 2)
        return (f"degree = {1 if exact else self.degree}\n" + 'plane = "strain"\n' + upper + lower
                + contact(*both, self.sides == "any" or exact, variant="weighted" if exact else self.variant,
                          sliding="refuse" if exact else self.sliding)
                + forces("reaction", *where) + timed())

    def constant(self, program):
        """K of the bodies by a fine mesh, on which the half width is about a twentieth of the radius."""
        half = 0.06 * self.curved if "ring" in self.kind else 0.02 * self.curved
        guess = 3 / self.modulus - math.log(1 / self.force(half)) / (math.pi * self.modulus)
        depth = self.sinks(self.force(half), guess)
        run = solve(program, self.text(depth, half / 10, 1, 20, 45, True))
        force = abs(run.value("Y"))
        if run.code != 0 or not force > 0:
            return math.nan
        return depth / force + math.log(force) / (math.pi * self.modulus)

    def faults(self, program):
        constant = self.constant(program)
        right = self.force(self.half)
        depth = self.sinks(right, constant)
        smallest = 2 * self.half / self.edges
        if self.ratio < 1:  # the other side has this many edges
            smallest /= self.ratio
        cells = max(2, min(12, round(0.3 * self.radius / smallest)))
        run = solve(program, self.text(depth, smallest, self.ratio, cells, 30))
        if run.code != 0 or math.isnan(constant):
            return [run.end]
        if UNRESOLVED.search(run.log):
            return []
        force = -run.value("Y")
        if abs(force / right - 1) <= FORCE:
            return []
        return [f"force {force:.4g}, {force / right:.3g} of the right one, pressed "
                f"{depth / self.curved:.2g} of the radius, not named as unresolved"]


class Tipping:
    """A block on a floor, pushed at half of its height."""

    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.width, self.height = rng.uniform(0.5, 3), rng.uniform(0.5, 3)
        self.degree = rng.choice([1, 2])
        self.variant = rng.choice([None, None, "mortar"])
        self.sides = rng.choice(["any", "upper", "lower"])
        self.sliding = rng.choice(["refuse", "finite"])
        self.cells = [rng.randint(2, 16), rng.randint(2, 10)]
        self.floor = [rng.randint(8, 60), 3]
        self.young = 1e7, 1e7 * 10 ** rng.uniform(-1, 2)

    @property
    def shown(self):
        return (f"tips, {self.width:.3g} x {self.height:.3g}, {self.cells[0]} cells on {self.floor[0]}, E "
                f"{self.young[0] / self.young[1]:.2g}, {self.variant or 'default'}, degree {self.degree}, "
                f"sides {self.sides}, {self.sliding}")

    def faults(self, program):
        """Pushed by a part of the load at which it tips, width/height of its weight, which grows slowly near
        one."""
        friction = 1.3 * self.width / self.height + 0.2
        push = self.width / self.height * self.width  # of a weight of 1 per area
        in_time = "(t < 0.5 ? 1.8*t : 0.9 + 0.3*(t - 0.5))"
        floor = body("l", rectangle((-2, -0.5), (self.width + 2, 0), self.floor), self.young[1],
                     f"label = 1, {HELD}")
        block = body("u", rectangle((0, 0), (self.width, self.height), self.cells), self.young[0],
                     f'label = 4, tx = "{push!r}*{in_time}"', more="force = { y = -1 }\n")
        both = [("u", 1), ("l", 3)]
        if self.sides == "lower":
            both.reverse()
        steps = 200
        run = solve(program, f"degree = {self.degree}\n" + floor + block
                    + contact(*both, self.sides == "any", variant=self.variant, friction=round(friction, 6),
                              sliding=self.sliding) + timed(steps) + "[output]\nevery = 0\n")
        found = re.search(r" at t = ([\d.e+-]+)", run.told)
        if run.code != 3 or not found:
            return [run.end]
        at = float(found[1])
        load = 1.8 * at if at < 0.5 else 0.9 + 0.3 * (at - 0.5)
        step = 0.3 / steps  # it tips within the step that ends there
        edge = (self.width + 4) / self.floor[0] / 3 if self.sides == "lower" else 0
        if 1 - TIPS - edge / (self.width / 2) <= load <= 1 + TIPS + step:
            return []
        return [f"tips at {load:.4g} of the right load: {run.end}"]


def scene(seed):
    return Tipping(seed) if seed % 4 == 0 else Pair(seed)


def examined(program, seed):
    drawn = scene(seed)
    return drawn.shown, drawn.faults(program)


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 80))
