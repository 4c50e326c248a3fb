"""Scenes of contact_scenes.py: corners on straight sides, whose force is along the normal of the side."""
import math

import numpy as np
from contact_support import HELD, PLANE, ended, forces, off, polygon, quadrilateral, rectangle, solve
from scene_parts import body, contact, timed

TAN = math.tan(math.radians(10))
SLOPE = [(0, -1), (3, -1), (3, 3 * TAN), (0, 0)]
FOOT = (1.5, 1.5 * TAN)


def along(what, run, normal, exact=1e-9):
    """The force is along the normal: exactly on drawn or rigid lines, else to the rotation of the body."""
    faults = ended(what, run)
    if not faults:
        force = run.values("X", "Y")
        size = np.linalg.norm(force)
        if not size > 0:
            return [f"{what}: no force"]
        turned = abs(force[0] * normal[1] - force[1] * normal[0]) / np.linalg.norm(normal) / size
        if turned > exact:
            faults.append(f"{what}: X/Y {force[0] / force[1]:.6g}, right is {normal[0] / normal[1]:.6g}")
    return faults


def turned(run):
    """By what the moved sides turn at most with finite sliding, whose normals are those of the moved lines:
    edges turn by the rotation and the shear strain of their triangles."""
    peaks = run.summary.get("peaks", {})
    return sum(peaks.get(name, {"value": 0})["value"] for name in ("rotation", "strain"))


def corner_variants():
    for sliding in ("refuse", "finite"):
        for swap in (False, True):
            for degree in (1, 2):
                for variant in (None, "mortar", "weighted", "interpolation"):
                    yield sliding, swap, degree, variant


def corner_of_a_body(program, block, other, names, normal, motion):
    """A corner of one body on a straight side of the other one, both sides nonmortar, every coupling."""
    faults = []
    for sliding, swap, degree, variant in corner_variants():
        keys = {"sliding": sliding, "swap": swap, "variant": variant}
        run = solve(program, f"degree = {degree}\n" + PLANE + block + other + contact(*names, **keys)
                    + forces("contact_force", *names[0]) + motion)
        what = f"{sliding}, swap {swap}, degree {degree}, {variant or 'default'}"
        turns = turned(run)
        faults += along(what, run, normal, 1e-9 if sliding == "refuse" else turns)
    return faults


def corner_on_slope(program):
    """Along the normal of the slope: X/Y = -tan(10 degrees)."""
    block = body("b", quadrilateral(SLOPE, (24, 8)), 1000.0, f"label = 1, {HELD}")
    bar = body("k", rectangle((0.9, FOOT[1]), (1.5, FOOT[1] + 0.6), (6, 6)), 1e4,
               'label = 3, ux = 0, uy = "-0.01*t"')
    return corner_of_a_body(program, block, bar, (("k", 1), ("b", 3)), (-TAN, 1), timed(2))


def tool_corner(program):
    """A sharp tool pressed 0.01 into the slope: not missed, and along the normal of the moved slope."""
    faults = []
    block = body("b", quadrilateral(SLOPE, (24, 8)), 1000.0, f"label = 1, {HELD}")
    outline = [(0.9, FOOT[1]), FOOT, (1.5, 0.9), (0.9, 0.9)]
    for labels in ([1, 1, 1, 1], [1, 2, 3, 4]):
        for sliding, swap, degree, variant in corner_variants():
            if swap:
                continue
            run = solve(program, f"degree = {degree}\n" + PLANE + block
                        + polygon("k", outline, 'uy = "-0.01*t"', labels)
                        + contact(("b", 3), ("k", 1), sliding=sliding, variant=variant)
                        + forces("reaction", "k") + timed(2))
            what = f"labels {labels}, {sliding}, degree {degree}, {variant or 'default'}"
            turns = turned(run)
            faults += along(what, run, (-TAN, 1), 1e-9 if sliding == "refuse" else turns)
    return faults


def bar_in_a_v(program):
    """A square bar with its lower corners on two flanks: X/Y is the tangent of the flank on each, of 30
    degrees below the bottom of the bar, and of 40 degrees beside its sides, which are nonmortar."""
    faults = []
    for sliding, swap, degree, variant in corner_variants():
        tan = math.tan(math.radians(40 if swap else 30))
        bar = rectangle((-0.5, 0.5 * tan), (0.5, 0.5 * tan + 1), (8, 8))
        text = f"degree = {degree}\n" + PLANE + body("k", bar, 1e4, 'label = 3, ux = 0, ty = "-t"')
        for side, name in ((1, "right"), (-1, "left")):
            corners = [(0, 0), (0, -1), (2 * side, -1), (2 * side, 2 * tan)]
            text += body(name, quadrilateral(corners[::side], (8, 16)), 1000.0, f"label = 2, {HELD}")
            sides = [(name, 4), ("k", 1)]
            if swap:
                sides = [("k", 2 if side > 0 else 4), (name, 4)]
            text += contact(*sides, sliding=sliding, variant=variant)
            text += forces("contact_force", name, 4, name[0])
        run = solve(program, text + timed())
        what = f"{sliding}, {'bar' if swap else 'flanks'} nonmortar, degree {degree}, {variant or 'default'}"
        faults += ended(what, run)
        if run.code == 0:
            turns = 2 * turned(run)  # of the tangent
            for name in "rl":
                faults += off(f"{what}, {name}Y", abs(run.value(name + "Y")), 0.5, 1e-9)
                faults += off(f"{what}, {name}X", abs(run.value(name + "X")), 0.5 * tan,
                              1e-9 if sliding == "refuse" else turns / tan)
    return faults


def beam_on_corner(program):
    """A beam at -15 degrees on the upper right corner of a block: along the normal of the beam."""
    turn = math.radians(15)
    c, s = math.cos(turn), math.sin(turn)
    corners = [(0, 0), (4 * c, -4 * s), (4 * c + 0.3 * s, 0.3 * c - 4 * s), (0.3 * s, 0.3 * c)]
    beam = body("b", quadrilateral(corners, (40, 4)), 10000.0, f"label = 4, {HELD}",
                'label = 3, pressure = "0.5*t"')
    foot = (3 * c, -3 * s)
    block = body("s", rectangle((foot[0] - 1, foot[1] - 1), foot, (6, 6)), 1e5, f"label = 1, {HELD}")
    return corner_of_a_body(program, beam, block, (("b", 1), ("s", 3)), (s, c), timed(4))


SCENES = (corner_on_slope, tool_corner, bar_in_a_v, beam_on_corner)
