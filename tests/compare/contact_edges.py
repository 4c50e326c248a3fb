"""Scenes of contact_scenes.py: tools with short edges and with long ones, rounded, chamfered and sharp."""
import math

import numpy as np
from contact_support import HELD, PLANE, ended, forces, off, outline_geo, polygon, rectangle, solve, zero
from scene_parts import body, contact, timed


def pressed(points, labels, depth, steps=4, variant="weighted", degree=1, more=""):
    """A block, pressed from above by a tool from y = 0 on: finite sliding without friction."""
    block = body("b", rectangle((-1.5, -1), (1.5, 0), (72, 24)), 1000.0, f"label = 1, {HELD}")
    return (f"degree = {degree}\n" + PLANE + block + polygon("t", points, f'uy = "-{depth}*t"', labels)
            + contact(("b", 3), ("t", 1), variant=variant, friction=0, sliding="finite")
            + forces("reaction", "t") + timed(steps) + more)


def by_stiff_body(program, points, labels, depth):
    """The force on a meshed body a million times as stiff, of the same outline."""
    stiff = body("t", '{ file = "t.geo" }', 1e9, f'label = 3, ux = 0, uy = "-{depth}*t"')
    block = body("b", rectangle((-1.5, -1), (1.5, 0), (72, 24)), 1000.0, f"label = 1, {HELD}")
    text = (PLANE + block + stiff + contact(("b", 3), ("t", 1), variant="weighted", sliding="finite")
            + forces("reaction", "t", 3) + timed(4))
    return solve(program, text, files={"t.geo": outline_geo(points, labels, 0.3)})


def rounded(radius, half=0.5, pieces=8):
    """The right half of the foot of a punch, whose edge is an arc of 60 degrees in pieces."""
    turns = [math.pi / 3 * i / pieces for i in range(pieces + 1)]
    return [(half - radius + radius * math.sin(a), radius * (1 - math.cos(a))) for a in turns]


def punch(right, flank):
    """The foot mirrored, and flanks from its ends up to `flank` beside them at the height of 1.5."""
    left = [(-x, y) for x, y in reversed(right)]
    points = left + right + [(right[-1][0] + flank, 1.5), (left[0][0] - flank, 1.5)]
    return points, [1] * (len(left + right) - 1) + [2, 3, 4]


def as_stiff(what, run, stiff):
    """The force of the stiff body of the same outline at every step, to 2 %; none along x."""
    faults = ended(what, run)
    if not faults:
        found, right = run.course("Y"), stiff.course("Y")
        times = np.linspace(0, 1, len(found) + 1)[1:]
        for time_, value in zip(times, found):
            at = 4 * time_
            if abs(at - round(at)) < 1e-9:
                faults += off(f"{what}, Y at t = {time_:g}", value, right[round(at) - 1], 0.02)
        faults += zero(what + ", largest X", np.abs(run.course("X")).max(), right[-1], 1e-7)
    return faults


def rounded_punch(program):
    """Edges rounded by 0.02, in pieces of which the shortest are 0.0007 long: pressed by 0.01."""
    faults = []
    for pieces in (2, 4, 8, 16, 32):
        points, labels = punch(rounded(0.02, pieces=pieces), 0.1)
        stiff = by_stiff_body(program, points, labels, 0.01)
        faults += as_stiff(f"{pieces} pieces", solve(program, pressed(points, labels, 0.01)), stiff)
    return faults


def chamfered_punch(program):
    """Chamfers at 45 degrees, smaller and larger than the depth."""
    faults = []
    for size in (0.0025, 0.005, 0.01, 0.02):
        points, labels = punch([(0.5 - size, 0), (0.5, size)], 0)
        stiff = by_stiff_body(program, points, labels, 0.01)
        for steps in (1, 4, 10):
            run = solve(program, pressed(points, labels, 0.01, steps))
            faults += as_stiff(f"chamfer of {size}, {steps} steps", run, stiff)
    return faults


def wedge(slope, end, apex=0.0, pieces=1, left=None):
    """The outline of a wedge with flanks out to x = end and cut within 0.7 of the apex."""
    left, (first, second) = left or slope, end
    rise = first * slope
    cuts = [(apex + 0.7 * i / pieces, slope * 0.7 * i / pieces) for i in range(1, pieces + 1) if pieces > 1]
    fall = [(2 * apex - x, y * left / slope) for x, y in reversed(cuts)]
    top = 1 + max(rise, second * left)
    points = [(apex, 0)] + cuts + [(apex + first, rise), (apex + first, top), (apex - second, top),
                                   (apex - second, second * left)] + fall
    return points, [1] * (len(cuts) + 1) + [2, 3, 4] + [1] * (len(fall) + 1)


def wedges_cut(program):
    """Symmetric wedges: no force along x, and the force of the wedge that is not cut."""
    faults = []
    for slope in (0.2, 0.3):
        right = first = None
        for pieces, steps in ((1, 4), (4, 4), (40, 4), (100, 4), (40, 40)):
            run = solve(program, pressed(*wedge(slope, (10, 10), 0, pieces), 0.03, steps))
            what = f"slope {slope}, {pieces} pieces, {steps} steps"
            faults += ended(what, run)
            right = right or by_stiff_body(program, *wedge(slope, (1, 1)), 0.03).value("Y")
            faults += off(what + ", Y against a stiff body", run.value("Y"), right, 2e-3)
            first = first or run.value("Y")
            faults += off(what + ", Y", run.value("Y"), first, 1e-9)
            faults += zero(what + ", X", run.value("X"), right, 1e-9)
    return faults


def wedge_flanks(program):
    """Far ends of flanks from 0.8 to 100 away, of which the block meets 0.3 at most: one force to 1e-9,
    that of a stiff meshed wedge to 0.2 % of its size."""
    faults, first = [], None
    stiff = by_stiff_body(program, *wedge(0.3, (1, 1), 0.013, 1, 0.05), 0.03).values("X", "Y")
    for ends in ((0.8, 0.8), (0.8, 1), (1, 0.8), (3, 3), (10, 10), (0.8, 100), (100, 100)):
        for pieces in (1, 8):
            run = solve(program, pressed(*wedge(0.3, ends, 0.013, pieces, 0.05), 0.03))
            what = f"flanks to {ends}, {pieces} pieces"
            faults += ended(what, run)
            force = run.values("X", "Y")
            first = force if first is None else first
            for i, name in enumerate("XY"):
                faults += zero(f"{what}, {name} less the first", force[i] - first[i], first[1], 1e-9)
                faults += zero(f"{what}, {name} less a stiff body's", force[i] - stiff[i], stiff[1], 2e-3)
    return faults


SCENES = (rounded_punch, chamfered_punch, wedges_cut, wedge_flanks)
