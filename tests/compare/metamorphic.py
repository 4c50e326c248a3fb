#!/usr/bin/python3
"""Random scenes of contact in other words: what does not change the problem does not change the forces.

Tools and bodies (wedges, punches, rounded and round ones, discs and rings) on blocks, rings and half discs on
lines; small and finite sliding, both degrees, every coupling, some with friction. Each scene is run again
with points inserted into straight sides of its tool, the far ends of its flanks moved away, its whole outline
as one label, a meshed tool in place of the polygon, all free sides of a body as one label: the nonmortar mesh
is the same and the tool is rigid, so forces are equal to 1e-9. With a stiff body in place of the tool, and
with the sides exchanged, they are equal to three times the sum of the estimated errors, or to a FLOOR of the
force; depths are a tenth to half of an edge, which few nodes feel. Where the tool is round, a mesh of it is a
curve, from which the polygon deviates by its sagitta.

    tests/compare/metamorphic.py [--count 300] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import math
import random
import sys

import numpy as np
from contact_support import HELD, command, forces, outline_geo, polygon, solve
from scene_parts import body, contact, timed, tool

EQUAL = 1e-9
# Of the force: what the stiffness of a body 1e6 times as stiff, and estimates of almost nothing, leave.
FLOOR = 0.01
# With `interpolation` and exchanged sides: the nodes of one side, or of the other one, meet the other.
NODES = 0.25
STIFF = 1e9
ZERO = 1e-9  # forces over the depth that are rounding: of E = 1000, 1e-12


def inserted(points, labels, pieces):
    """Points inserted into the straight sides: side i in pieces[i]."""
    new_points, new_labels = [], []
    for i, (point, label) in enumerate(zip(points, labels)):
        step = np.subtract(points[(i + 1) % len(points)], point) / pieces[i]
        new_points += [np.add(point, step * k) for k in range(pieces[i])]
        new_labels += [label] * pieces[i]
    return new_points, new_labels


class Scene:
    """Scene number `seed`: for each variant its name, text, files and whether forces are equal to EQUAL."""

    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.kind = rng.choice(["tool on block", "tool on block", "round on line", "body on block"])
        self.degree = rng.choice([1, 1, 2])
        self.variant = rng.choice([None, "mortar", "weighted", "interpolation", None])
        self.sliding = rng.choice(["allow", "finite"])
        self.friction = rng.choice([0, 0, rng.uniform(0.05, 0.8)])
        self.plane = rng.choice(["stress", "strain"])
        self.sagitta = 0.0  # of a polygon in place of a curve
        self.steps = rng.choice([1, 2, 4]) if self.sliding == "finite" else 1
        self.variants = []
        {"tool on block": self.tool_on_block, "round on line": self.round_on_line,
         "body on block": self.body_on_block}[self.kind]()

    @property
    def shown(self):
        return (f"{self.kind}, {self.what}, {self.variant or 'default'}, degree {self.degree}, "
                f"{self.sliding}, friction {self.friction:.2g}, {self.steps} steps")

    def add(self, name, parts, sides, files=None, equal=True, quantity=""):
        text = (f'degree = {self.degree}\nplane = "{self.plane}"\n' + "".join(parts)
                + contact(*sides, variant=self.variant, sliding=self.sliding, friction=self.friction)
                + quantity + timed(self.steps))
        self.variants.append((name, text, files or {}, equal))

    # --- What is pressed together ---

    def foot(self):
        """The lower side of a tool from left to right, lowest at y = 0: at its ends begin straight flanks,
        whose directions to the far ends follow."""
        rng, x = self.rng, self.rng.uniform(-0.4, 0.4)
        self.what = kind = rng.choice(["wedge", "punch", "trapezoid", "rounded", "round"])
        self.sagitta = 0.0
        half = rng.uniform(0.15, 0.5)
        slopes = [math.radians(rng.uniform(3, 40)) for _ in range(2)]
        if kind == "wedge":
            middle = [(x, 0.0)]
        elif kind == "round":
            radius, pieces = rng.uniform(0.4, 3), rng.randint(5, 40)
            turn = min(0.8 / radius, 1)
            angles = np.linspace(-turn, turn, pieces + 1)
            middle = [(x + radius * math.sin(a), radius * (1 - math.cos(a))) for a in angles]
            self.sagitta = radius * (1 - math.cos(turn / pieces))
            low = min(y for _, y in middle)
            middle = [(px, y - low) for px, y in middle]
            slopes = [turn + turn / pieces] * 2
        elif kind == "rounded":
            radius, pieces = rng.uniform(0.005, 0.15), rng.choice([3, 8, 32])
            turn = math.radians(rng.uniform(40, 88))
            angles = [turn * i / pieces for i in range(pieces + 1)]
            self.sagitta = radius * (1 - math.cos(turn / pieces / 2))
            right = [(half + radius * math.sin(a), radius * (1 - math.cos(a))) for a in angles]
            middle = [(x - px, y) for px, y in reversed(right)] + [(x + px, y) for px, y in right]
            slopes = [min(angles[-1] + 0.03, math.pi / 2)] * 2
        else:
            middle = [(x - half, 0.0), (x + half, 0.0)]
            slopes = [math.pi / 2] * 2 if kind == "punch" else slopes
        self.far = [np.array([-math.cos(slopes[0]), math.sin(slopes[0])]),
                    np.array([math.cos(slopes[1]), math.sin(slopes[1])])]
        return [np.array(point) for point in middle]

    def outline(self, foot, lengths):
        left, right = foot[0] + lengths[0] * self.far[0], foot[-1] + lengths[1] * self.far[1]
        top = max(left[1], right[1]) + 0.3
        ends = [np.array([right[0], top]), np.array([left[0], top])]
        return [left, *foot, right, *ends], [1] * (len(foot) + 1) + [2, 3, 4]

    def way(self):
        """A displacement down, of a tenth of an element to half of it, and some of them also along."""
        rng = self.rng
        self.depth = self.size * 10 ** rng.uniform(-1, -0.3)
        along = rng.choice([0, 0, rng.uniform(-2, 2)]) * self.depth
        return f'ux = "{along!r}*t"', f'uy = "-{self.depth!r}*t"'

    def block(self, label=3, young=1000.0):
        """With a mesh by Gmsh: its free sides have one label, or its top has its own."""
        self.size = self.rng.uniform(0.05, 0.15)
        points = [(-1.5, -1), (1.5, -1), (1.5, 0), (-1.5, 0)]
        sizes = [0.3, 0.3, self.size, self.size]
        text = body("b", '"b.geo"', young, f"label = 1, {HELD}")
        return text, *({"b.geo": outline_geo(points, [1, sides, 3, sides], sizes)} for sides in (2, 3))

    def tool_on_block(self):
        rng = self.rng
        block, files, whole = self.block()
        foot = self.foot()
        # With `mortar` the gap is projected on all that face each other, here the whole top of the block.
        near = 3.0 if self.variant in (None, "mortar") else 0.7
        lengths = [rng.uniform(1, 2) * near for _ in range(2)]
        points, labels = self.outline(foot, lengths)
        motion = self.way()
        sides = [("b", 3), ("t", 1)]
        force = forces("reaction", "t")

        def tool(name, outline, files=files, **more):
            self.add(name, [block, polygon("t", outline[0], "\n".join(motion), outline[1])], sides, files,
                     quantity=force, **more)

        tool("as drawn", (points, labels))
        most = max(1, min(100, 900 // len(points)))
        pieces = rng.choice([2, 3, rng.randint(2, 100), 100])
        tool("points inserted", inserted(points, labels, [min(pieces, most)] * len(points)))
        straight = [rng.randint(1, most) for _ in points]
        tool("some points inserted", inserted(points, labels, straight))
        far = [length * 10 ** rng.uniform(0, 1.7) for length in lengths]
        tool("flanks moved away", self.outline(foot, far))
        tool("whole outline", (points, [1] * len(points)))
        tool("free sides of the block", (points, labels), whole)
        mesh = {"t.geo": outline_geo(points, labels, rng.uniform(0.1, 1))}
        meshed = ['[[tool]]\nname = "t"\nmesh = { file = "t.geo" }\n', *(f"{way}\n" for way in motion)]
        self.add("meshed tool", [block, *meshed], sides, {**files, **mesh}, self.sagitta == 0, force)
        stiff = body("t", '{ file = "t.geo" }', STIFF, f"label = 3, {', '.join(motion)}")
        self.add("stiff body", [block, stiff], sides, {**files, **mesh}, False, forces("reaction", "t", 3))

    def round_on_line(self):
        rng = self.rng
        self.what = shape = rng.choice(["full", "half", "halfdisc"])
        radius = 10 ** rng.uniform(-1, 1)
        around = rng.choice([24, 40, 64, 96])
        self.size = 2 * math.pi * radius / around
        if shape == "halfdisc":
            mesh = (f'{{ shape = "halfdisc", radius = {radius!r}, core = {radius * 0.3!r}, cells = '
                    f'{around // 6}, cut = "both" }}')
            near, held, floor, side = 1, 2, 0.0, 1
            self.size = radius * 0.3 / (around // 6)
        else:
            # The half is the upper one: its line is above it.
            side = 1 if shape == "full" else -1
            mesh = (f'{{ shape = "annulus", inner = {rng.uniform(0.2, 0.7) * radius!r}, outer = {radius!r}, '
                    f'span = "{shape}", cells = [{around if shape == "full" else around // 2}, 4] }}')
            near, held, floor = 2, 1, -side * radius
        motion = self.way()
        moved = "\n".join(motion)
        if side > 0:  # the line is below and moves up
            moved = moved.replace('uy = "-', 'uy = "')
        ring = body("r", mesh, 1000.0, f"label = {held}, {HELD}")
        sides, force = [("r", near), ("t", 1)], forces("reaction", "t")
        half = radius * rng.choice([1.05, 1.2, 2])

        def table(name, half, pieces=1, whole=False, kind="polygon"):
            low = [(side * half, floor), (-side * half, floor)]
            if kind == "line":
                drawn = tool("t", shape="line", points=low, more=moved + "\n")
                return self.add(name, [ring, drawn], sides, quantity=force)
            depth = floor - side * radius
            points = low + [(-side * half, depth), (side * half, depth)]
            labels = [1] * 4 if whole else [1, 2, 3, 4]
            points, labels = inserted(points, labels, [pieces, 1, 1, 1])
            if kind == "mesh":
                files = {"t.geo": outline_geo(points, labels, half / rng.uniform(0.5, 6))}
                drawn = f'[[tool]]\nname = "t"\nmesh = {{ file = "t.geo" }}\n{moved}\n'
                return self.add(name, [ring, drawn], sides, files, quantity=force)
            return self.add(name, [ring, polygon("t", points, moved, labels)], sides, quantity=force)

        table("as drawn", half)
        table("line", half, kind="line")
        table("longer", half * 10 ** rng.uniform(0, 2))
        table("longer line", half * 10 ** rng.uniform(0, 2), kind="line")
        table("in pieces", half, rng.choice([2, 3, 10, 100]))
        table("longer in pieces", half * 3, rng.choice([2, 10, 100]))
        table("whole outline", half, whole=True)
        table("meshed", half, kind="mesh")

    def body_on_block(self):
        rng = self.rng
        block, files, whole = self.block(young=rng.choice([1000.0, 10 ** rng.uniform(1, 5)]))
        if rng.random() < 0.5:
            foot = self.foot()
            points, labels = self.outline(foot, [rng.uniform(0.3, 0.6) for _ in range(2)])
            motion = self.way()
            labels = [1] * (len(foot) + 1) + [2, 3, 2]
            sizes = [self.size * rng.uniform(0.5, 1.5)] * (len(foot) + 2) + [0.3, 0.3]
            name, near, held = '"t.geo"', 1, 3
            files = {**files, "t.geo": outline_geo(points, labels, sizes)}
            alone = [3 if label == 3 else 1 for label in labels]
            free = {**files, "t.geo": outline_geo(points, alone, sizes)}
        else:
            self.what, motion, free = "ring", self.way(), None
            radius = rng.uniform(0.3, 1.2)
            name = (f'{{ shape = "annulus", centre = [{rng.uniform(-0.3, 0.3)!r}, {radius!r}], '
                    f'inner = {0.4 * radius!r}, outer = {radius!r}, span = "full", '
                    f'cells = [{rng.randint(24, 64)}, 4] }}')
            near, held = 2, 1
        upper = body("t", name, 1000.0, f"label = {held}, {', '.join(motion)}")
        sides = [("b", 3), ("t", near)]
        if rng.random() < 0.5:
            sides.reverse()
        force = forces("reaction", "t", held)
        self.add("as drawn", [block, upper], sides, files, quantity=force)
        self.add("free sides of the block", [block, upper], sides, {**files, **whole}, quantity=force)
        if free:
            self.add("free sides of the body", [block, upper], sides, free, quantity=force)
        self.add("sides exchanged", [block, upper], sides[::-1], files, equal=False, quantity=force)


def examined(program, seed):
    scene = Scene(seed)
    faults, first = [], None
    for name, text, files, equal in scene.variants:
        run = solve(program, text, files=files)
        if run.code != 0:
            faults.append(f"{name}: {run.end}")
            continue
        force = run.values("X", "Y")
        error = np.array([run.error("X"), run.error("Y")])
        if first is None:
            first, first_name, errors = force, name, error
            # Rows are means: a tip may lie between nodes, but not a round side.
            if scene.what != "wedge" and not np.linalg.norm(force) > 0:
                faults.append(f"{name}: no force")
            continue
        scale = max(np.linalg.norm(first), np.linalg.norm(force))
        rounding = 2 * scene.sagitta / scene.depth
        floor = NODES if name == "sides exchanged" and scene.variant == "interpolation" else FLOOR
        allowed = EQUAL * scale if equal else max((floor + rounding) * scale,
                                                  3 * float(np.max(error + errors)))
        allowed = max(allowed, ZERO * scene.depth)
        if not np.max(np.abs(force - first)) <= allowed:
            faults.append(f"{name}: {force[0]:.10g} {force[1]:.10g}, {first_name}: {first[0]:.10g} "
                          f"{first[1]:.10g}, allowed {allowed:.2g}")
    return scene.shown, faults


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 300))
