"""Scenes of contact_scenes.py: full circles on lines, and bodies that fall."""
import math
import re

import numpy as np
from contact_support import HELD, PLANE, ended, forces, off, polygon, rectangle, solve, zero
from scene_parts import body, contact, elastic, timed, tool


def ring(line, sliding):
    """A ring, moved by 0.01 onto a line at its lowest point."""
    mesh = '{ shape = "annulus", centre = [0, 1], inner = 0.3, outer = 1, span = "full", cells = [96, 6] }'
    return (PLANE + body("roll", mesh, 1000.0, 'label = 1, ux = 0, uy = "-0.01*t"') + line
            + contact(("roll", 2), ("low", 1), variant="weighted", sliding=sliding)
            + forces("reaction", "low") + timed(2))


def cut(start, end, pieces):
    """Points of a straight way, without its end."""
    return [np.add(start, np.subtract(end, start) * i / pieces) for i in range(pieces)]


def table(half, pieces, depth=1.0):
    """A rectangle as a polygon with its top, label 1, in pieces."""
    points = cut((half, 0), (-half, 0), pieces) + [(-half, 0), (-half, -depth), (half, -depth)]
    return polygon("low", points, "", [1] * pieces + [2, 3, 4])


def ring_on_line(program):
    """5.914 of a line in pieces, each with some nodes of the ring; from any length and any number of pieces.
    A line of a tool is straight however it is cut: equal to rounding of the repetition."""
    faults, small = [], []
    for half in (1.05, 1.1, 1.2, 1.8, 2, 5, 50):
        lines = {"line": tool("low", shape="line", points=[(half, 0), (-half, 0)]),
                 **{f"{pieces} pieces": table(half, pieces) for pieces in (1, 10, 100)}}
        for name, line in lines.items():
            what = f"half length {half}, {name}"
            run = solve(program, ring(line, "finite"))
            faults += ended(what, run) or off(what, run.value("Y"), 5.91398, 2e-6)
            run = solve(program, ring(line, "refuse"))
            faults += ended(what + ", small sliding", run)
            small.append((what, run.value("Y")))
    # Small sliding: one force from all lines, and near that of the other one.
    for what, value in small:
        faults += off(what + ", small sliding", value, 5.914028, 2e-6) or off(
            what + ", small sliding against the first line", value, small[0][1], 1e-9)
    return faults


def ring_on_floor(program):
    """A ring held at its inner circle, and a floor as wide as it and wider, pressed up by 0.2: one force,
    that of the floor of half width 20, whose ends are clear of the ring's."""
    faults = []
    mesh = '{ shape = "annulus", inner = 17.5, outer = 35, cells = [240, 8], span = "full" }'
    for half in (20, 35, 60, 400):
        for pieces in (1, 10):
            for sliding in ("refuse", "finite"):
                for variant, tolerance in (("weighted", 1e-4), (None, 0.02)):
                    points = cut((half, -35), (-half, -35), pieces)
                    points += [(-half, -35), (-half, -50), (half, -50)]
                    text = (PLANE + body("roller", mesh, 2.75e6, f"label = 1, {HELD}")
                            + polygon("low", points, 'uy = "0.2*t"', [1] * pieces + [2, 3, 4])
                            + contact(("roller", 2), ("low", 1), sliding=sliding, variant=variant)
                            + forces("reaction", "low") + timed())
                    run = solve(program, text)
                    what = f"half width {half}, {pieces} pieces, {sliding}, {variant or 'default'}"
                    faults += ended(what, run) or (off(what + ", Y", run.value("Y"), 339370, tolerance)
                                                   + zero(what + ", X", run.value("X"), 339370, 1e-9))
    return faults


DISC_GEO = """\
R = 25; Point(1) = {0, 0, 0, 2.5}; Point(2) = {R, 0, 0, 2.5}; Point(3) = {0, R, 0, 1};
Point(4) = {-R, 0, 0, 2.5}; Point(5) = {0, -R, 0, 1};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Point{1} In Surface{1};
Physical Surface("disc") = {1}; Physical Curve("rim") = {1:4};
"""


def disc_between_platens(program):
    """A whole rim as the side of two contacts: both platens carry the load; 2 P/(pi D) of tension across the
    middle, where the load is met along less than a twentieth of the radius."""
    faults = []
    for half in (8, 30, 300):
        for sliding in ("refuse", "finite"):
            text = body("disc", '{ file = "disc.geo", region = "disc" }', elastic(20000, 0.25))
            text += "[[body.point]]\nat = [0, 0]\nux = 0\n"
            text += "[[body.point]]\nat = [0, -25]\nux = 0\n"
            for name, y, push in (("lower", -25, ""), ("upper", 25, 'fy = "-1000*t"\n')):
                ends = [(half, y), (-half, y)] if y < 0 else [(-half, y), (half, y)]
                text += tool(name, shape="line", points=ends, more=push)
                text += contact(("disc", "rim"), (name,), sliding=sliding)
            text += forces("reaction", "lower") + forces("contact_force", "upper", None, "U") + timed()
            run = solve(program, text, fields=True, files={"disc.geo": DISC_GEO})
            what = f"half width {half}, {sliding}"
            faults += ended(what, run)
            if run.code == 0:
                faults += off(what + ", lower platen", abs(run.value("Y")), 1000, 1e-9)
                faults += off(what + ", upper platen", abs(run.value("UY")), 1000, 1e-9)
                disc = run.bodies["disc"]
                centres = disc.points[disc.triangles].mean(axis=1)
                near = np.linalg.norm(centres, axis=1) < 3
                faults += off(what + ", tension in the middle", disc.stress[near, 0].mean(),
                              2 * 1000 / (math.pi * 50), 0.05)
    return faults


def fall(what, run, motion):
    """Exit code 3, with the motion of the body, and no advice that the scene refuses."""
    faults = ended(what, run, 3)
    if not faults and not re.search(motion, run.told):
        faults.append(f"{what}: does not name {motion}: {run.end}")
    if re.search("swap|off by|depend on each other", run.told):
        faults.append(f"{what}: told as a fault of the solver: {run.end}")
    return faults


def disc_falls(program):
    """A disc that is drawn over the ends of two blocks and pressed by a force alone."""
    text = PLANE.replace("strain", "stress")
    for name, left, right in (("a", 0, 2.156), ("b", 2.2039, 4.25608)):
        text += body(name, rectangle((left, -0.979051), (right, 0), (33, 4)), elastic(1e3, 0),
                     f"label = 1, {HELD}")
    text += ('[[tool]]\nname = "tool"\nshape = "disc"\ncentre = [2.94351, 2.8167]\nradius = 2.8167\n'
             'ux = "3.89746*max(t - 0.2, 0)/0.8"\nfy = "-1.58984*min(5*t, 1)"\n'
             'rotation = "-0.920076*max(t - 0.2, 0)/0.8"\n')
    for name in "ab":
        text += contact((name, 3), ("tool", None), variant="weighted", friction=0, sliding="finite")
    return fall("disc", solve(program, text + timed(20)), r"body tool\b.*translation along")


def spline_leaves_corner(program):
    """An ellipse, drawn past the end of a block: nothing carries it there."""
    centre, a, b = (2.281205, 0.859475), 0.66, 0.859475
    turns = [-math.pi / 2 + i * math.pi / 6 for i in range(12)]
    points = [(centre[0] + a * math.cos(t), centre[1] + b * math.sin(t)) for t in turns]
    text = ("degree = 2\n" + PLANE
            + body("a", rectangle((0, -1.12112), (3.87827, 0), (80, 7)), elastic(1000.0, 0.45),
                   f"label = 1, {HELD}")
            + tool("tool", shape="spline", points=points + points[:1], ux="-3.17213*max(t - 0.2, 0)/0.8",
                   fy="-0.494765*min(5*t, 1)")
            + contact(("a", 3), ("tool", None), variant="weighted", friction=0.454662, sliding="finite")
            + timed(40))
    return fall("spline", solve(program, text), r"body tool\b.*translation along")


def stack_tips(program):
    """A block on a plate that is drawn from under it: it tips where the plate has passed its middle."""
    text = PLANE
    for name, (lower, upper), cells, held in (
            ("low", ((0, -1), (4, 0)), (32, 6), f"label = 1, {HELD}"),
            ("mid", ((0, 0), (4.5, 0.3)), (40, 3), 'label = 2, ux = "3.0*max(0, t-0.1)/0.9"'),
            ("up", ((0, 0.3), (4, 1.3)), (36, 6), 'label = 3, ux = 0, ty = "-2.0*min(10*t,1)"')):
        text += body(name, rectangle(lower, upper, cells), 1000.0, held)
    text += contact(("mid", 1), ("low", 3), variant="weighted", friction=0.2, sliding="finite")
    text += contact(("mid", 3), ("up", 1), variant="weighted", friction=0.2, sliding="finite")
    text += timed(60) + "[output]\nevery = 0\n"
    return fall("stack", solve(program, text), r"body up\b.*rotation about")


def disc_in_groove(program):
    """A disc that nothing but friction keeps from turning, pressed into a groove by its weight of 20 an
    area: places of contact move as it turns, and repetitions swing about the state."""
    faults = []
    groove = [(-1.5, 1.5), (0, 0), (1.5, 1.5), (1.5, -1), (-1.5, -1)][::-1]
    cases = ((1, [48, 4], 0.8), (2, [96, 8], 0.8), (1, [96, 8], 0.8), (1, [64, 5], 0.6))
    for degree, cells, outer in cases:
        mesh = (f'{{ shape = "annulus", centre = [0, {outer * math.sqrt(2)!r}], inner = 0.3, '
                f'outer = {outer}, span = "full", cells = {cells} }}')
        text = (f"degree = {degree}\n" + PLANE + body("disc", mesh, 1000.0, force={"y": "-20*t"})
                + polygon("v", groove, "", [3, 4, 1, 1, 2])
                + contact(("disc", 2), ("v", 1), friction=0.2, sliding="finite")
                + forces("reaction", "v") + timed(2))
        run = solve(program, text)
        what = f"disc in a groove, degree {degree}, {cells}"
        weight = 20 * math.pi * (outer ** 2 - 0.3 ** 2)
        faults += ended(what, run) or (off(what + ", Y", run.value("Y"), weight, 0.01)
                                       + zero(what + ", X", run.value("X"), weight, 1e-9))
    return faults


SCENES = (disc_in_groove, ring_on_line, ring_on_floor, disc_between_platens, disc_falls,
          spline_leaves_corner, stack_tips)
