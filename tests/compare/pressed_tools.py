#!/usr/bin/python3
"""Random tools, pressed into a block and dragged along it with finite sliding: sharp, chamfered and rounded.

Rounded edges are polygons with sides of a 32nd of the arc, shorter than what is pressed in. Exit code 1 is a
fault where a stiff meshed body of the same outline is solved. Where a run ends with 0, the moved sides of
block and tool are intersected here, from the displacements that it wrote. Between nodes the block is straight
(with degree 2 a parabola) and the tool is not, and rows of contact are means over two edges of the block, so
an overlap stays at corners: its mean over two edges is up to 0.06 edges at a punch, and 0.16 at a tip
narrower than them, on 100 stiff meshed bodies. What is deeper than OVERLAP was hidden.

    tests/compare/pressed_tools.py [--count 500] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import math
import random
import sys

import numpy as np
from contact_support import HELD, command, forces, outline_geo, polygon, rectangle, solve
from scene_parts import body, contact, timed

OVERLAP = {"punch": 0.08, "tip": 0.2}  # in edges of the block
HALF = 1.5  # of the width of the block


class Scene:
    """Scene number `seed`: a tool above a block, and the same with a stiff body in its place."""

    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.degree = rng.choice([1, 1, 2])
        self.variant = rng.choice([None, "weighted", "mortar", "interpolation", None])
        self.friction = rng.choice([0, 0, rng.uniform(0.05, 0.6)])
        self.steps = rng.choice([1, 2, 4, 10])
        self.columns = rng.choice([24, 36, 48, 72])
        self.size = 2 * HALF / self.columns
        self.depth = self.size * 10 ** rng.uniform(-0.9, -0.1)
        self.drag = rng.choice([0, rng.uniform(-0.6, 0.6)])
        self.draw_tool()
        pressing = "min(2*t, 1)" if self.drag else "t"
        self.motion = (f'ux = "{self.drag!r}*max(2*t - 1, 0)"', f'uy = "-{self.depth!r}*{pressing}"')
        if self.drag:
            self.steps = max(2, self.steps)
        self.labels = [1] * (len(self.points) - 3) + [2, 3, 4]
        block = body("b", rectangle((-HALF, -1), (HALF, 0), (self.columns, max(6, self.columns // 4))),
                     1000.0, f"label = 1, {HELD}")
        self.start = f'degree = {self.degree}\nplane = "strain"\n' + block
        self.end = contact(("b", 3), ("t", 1), variant=self.variant, friction=self.friction, sliding="finite")

    def corner(self, inclined):
        """One edge of the foot: points from the flat foot at (0, 0) to a flank that rises by `inclined`."""
        rng = self.rng
        kind = rng.choice(["sharp", "chamfered", "rounded", "rounded"])
        size = 10 ** rng.uniform(-2.3, -0.7)
        if kind == "sharp":
            return kind, [(0, 0)]
        if kind == "chamfered":
            turn = inclined * rng.uniform(0.3, 0.7)
            return f"chamfered {size:.2g}", [(0, 0), (size * math.cos(turn), size * math.sin(turn))]
        angles = [inclined * i / 32 for i in range(33)]
        return f"rounded {size:.2g}", [(size * math.sin(a), size * (1 - math.cos(a))) for a in angles]

    def draw_tool(self):
        rng = self.rng
        half = rng.choice([0.02, 1]) * rng.uniform(0.15, 0.5)
        self.kind = "tip" if half < 2 * self.size else "punch"
        x = rng.uniform(-0.3, 0.3)
        inclined = [math.radians(rng.choice([rng.uniform(10, 60), rng.uniform(60, 90)])) for _ in range(2)]
        (left, lefts), (right, rights) = (self.corner(turn) for turn in inclined)
        left, right = (f"{kind} at {math.degrees(turn):.0f}" for kind, turn in zip((left, right), inclined))
        self.what = f"{self.kind}, {left}, {right}"
        points = [(x - half - px, y) for px, y in reversed(lefts)] + [(x + half + px, y) for px, y in rights]
        ends = [(points[0][0] - math.cos(inclined[0]), points[0][1] + math.sin(inclined[0])),
                (points[-1][0] + math.cos(inclined[1]), points[-1][1] + math.sin(inclined[1]))]
        top = max(end[1] for end in ends) + 0.3
        self.points = [ends[0], *points, ends[1], (ends[1][0], top), (ends[0][0], top)]

    @property
    def shown(self):
        return (f"{self.what}, pressed {self.depth:.3g}, dragged {self.drag:.2g}, edges {self.size:.3g}, "
                f"{self.variant or 'default'}, degree {self.degree}, friction {self.friction:.2g}, "
                f"{self.steps} steps")

    def tool(self):
        return (self.start + polygon("t", self.points, "\n".join(self.motion), self.labels) + self.end
                + forces("reaction", "t") + timed(self.steps))

    def stiff(self):
        upper = body("t", '{ file = "t.geo" }', 1e9, f"label = 3, {', '.join(self.motion)}")
        return self.start + upper + self.end + timed(self.steps)

    def files(self):
        return {"t.geo": outline_geo(self.points, self.labels, 0.3)}

    def overlap(self, run):
        """The largest mean of the depth of the moved block in the moved tool, over two edges of the block
        with a hat function as weight, or with `interpolation` the depth at nodes; in edges."""
        nodes, places = surface(run.bodies["b"])
        tool = np.array(self.points[:-2]) + [self.drag, -self.depth]  # its lower side, from left to right

        def depth(x, y):
            return np.maximum(y - np.interp(x, *tool.T, left=math.inf, right=math.inf), 0)

        if self.variant == "interpolation":
            return float(np.max(depth(*nodes.T))) / self.size
        x = np.linspace(-HALF, HALF, 40 * self.columns + 1)
        depths = depth(x, np.interp(x, *places.T))
        hat = 1 - np.abs(np.linspace(-1, 1, 81))
        return float(np.max(np.convolve(depths, hat / hat.sum(), "same"))) / self.size


def surface(block):
    """The moved nodes of the top of the block from left to right, and its moved side as a polyline, of
    quadratic elements in 8 pieces."""
    on = np.flatnonzero(np.abs(block.points[:, 1]) < 1e-12)
    on = on[np.argsort(block.points[on, 0])]
    places = block.points[on] + block.displacement[on]
    if block.elements is None:
        return places, places
    s = np.linspace(0, 1, 9)[:-1, None]
    pieces = [a * (1 - s) * (1 - 2 * s) + m * 4 * s * (1 - s) + b * s * (2 * s - 1)
              for a, m, b in zip(places[:-1:2], places[1::2], places[2::2])]
    return places[::2], np.vstack(pieces + [places[-1:]])


def examined(program, seed):
    scene = Scene(seed)
    run = solve(program, scene.tool(), fields=True)
    if run.code == 1:
        stiff = solve(program, scene.stiff(), files=scene.files())
        return scene.shown, [run.end + ", a stiff body is solved"] if stiff.code == 0 else []
    if run.code != 0:
        return scene.shown, [run.end]
    overlap = scene.overlap(run)
    if overlap > OVERLAP[scene.kind]:
        return scene.shown, [f"overlap of {overlap:.3g} edges, pressed {scene.depth / scene.size:.3g}, force "
                             f"{run.value('X'):.4g} {run.value('Y'):.4g}"]
    return scene.shown, []


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 500))
