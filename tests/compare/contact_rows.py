"""Scenes of contact_scenes.py: the rows of contact that a scene gets where it does not choose."""
import math
import re

import numpy as np
from contact_support import (HELD, PLANE, UNRESOLVED, ended, forces, off, outline_geo, quadrilateral,
                             rectangle, solve, zero)
from scene_parts import body, contact, elastic, timed


def light_contact(program):
    """A cylinder pressed by 0.002 of 50: 27.9 by a mesh that resolves the contact; or named as unresolved."""
    faults = []
    for degree, sides in ((1, True), (1, False), (2, True)):
        text = (f"degree = {degree}\n" + PLANE
                + body("c", '{ shape = "halfdisc", radius = 50, core = 10, cells = 40, cut = "both" }',
                       210000.0, 'label = 2, ux = 0, uy = "-0.002*t"')
                + body("b", rectangle((-60, -60), (60, 0), (120, 60)), 70000.0, f"label = 1, {HELD}")
                + contact(("c", 1), ("b", 3), sides) + forces("reaction", "c", 2) + timed())
        run = solve(program, text)
        what = f"degree {degree}, {'sides' if sides else 'nonmortar'}"
        faults += ended(what, run)
        if not UNRESOLVED.search(run.log):
            faults += off(what + ", not named as unresolved", -run.value("Y"), 27.9, 0.2)
    return faults


def light_contact_without_estimate(program):
    """A disc on a block with meshes of one edge on the contact, and rounds of refinement: 250 N/m in space
    is 377 in the plane, which the rounds reach."""
    text = ("degree = 2\n" + PLANE
            + body("c", '{ shape = "halfdisc", radius = 1, core = 0.3, cells = 4, cut = "both" }', 1e6,
                   'label = 2, ux = 0, uy = "-0.002*t"')
            + body("b", rectangle((-2, -2), (2, 0), (20, 10)), 1e6, f"label = 1, {HELD}")
            + contact(("c", 1), ("b", 3), True) + forces("reaction", "c", 2) + timed())
    faults = []
    for degree in (1, 2):
        run = solve(program, text.replace("degree = 2", f"degree = {degree}"), "--accuracy", "0.05")
        faults += ended(f"degree {degree}", run) or off(f"degree {degree}", -run.value("Y"), 377.5, 0.02)
    return faults


def light_ball(program):
    """A ball about its axis on first meshes of one cell: 998.9 by rounds of refinement to 0.5 %."""
    text = ('plane = "axisymmetric"\ndegree = 2\n'
            + body("c", '{ shape = "quarterdisc", lowest = [0, 0], radius = 5, core = 1.6, cells = 1 }',
                   2.1e5, "label = 2, uy = -0.02")
            + body("b", '{ shape = "rectangle", lower = [0, -10], upper = [10, 0], cells = 2 }', 2.1e5,
                   "label = 1, uy = 0")
            + contact(("c", 1), ("b", 3), True)
            + '[[quantity]]\nname = "Y"\nreaction = { body = "c", label = 2 }\ncomponent = "y"\n' + timed())
    run = solve(program, text, "--accuracy", "0.05")
    return ended("ball", run) or off("force", -run.value("Y"), 998.93, 0.005)


def prandtl(program):
    """A rigid punch on ground that flows, half of it: (2 + pi)/sqrt3, on cells of one diagonal and of both,
    with the volume that the program chooses: to 2 %, on crossed cells, of first order, to 3 %."""
    faults = []
    for shape in ("rising", "falling", "both"):
        ground = body("g", rectangle((0, -2), (4, 0), (32, 16), shape), 1000.0, "label = 4, ux = 0",
                      "label = 2, ux = 0", f"label = 1, {HELD}")
        ground = ground.replace("poisson = 0.3 }", "poisson = 0.3, viscosity = 1e-4, yield_stress = 1 }")
        punch = body("p", '{ shape = "rectangle", lower = [0, 0], upper = [1, 0.25], cells = [4, 1] }',
                     1000.0, 'label = 1, ux = 0, uy = "-0.1*t"')
        run = solve(program, PLANE + ground + punch + contact(("g", 3), ("p", 1), sliding="allow")
                    + forces("contact_force", "p", 1) + timed(8))
        faults += ended(shape, run) or off(shape, abs(run.value("Y")), (2 + math.pi) / math.sqrt(3),
                                            0.03 if shape == "both" else 0.02)
    return faults


def nearly_incompressible(program):
    """A disc of a tool on a block with Poisson's ratio from 0.3 to 0.4901, 12 cells on the half width: the
    largest pressure of Hertz to 8 %, with the volume that the program chooses."""
    faults, half = [], 0.05
    block = outline_geo([(-1, -1), (1, -1), (1, 0), (1.3 * half, 0), (-1.3 * half, 0), (-1, 0)],
                        [1, 2, 3, 3, 3, 2], [0.3, 0.3, 0.3, half / 12, half / 12, 0.3])
    for poisson in (0.3, 0.45, 0.48, 0.49, 0.4901):
        for degree in (1, 2):
            force = math.pi * 1e3 / (1 - poisson**2) * half**2 / 4
            text = (f"degree = {degree}\n" + PLANE
                    + body("b", '"block.geo"', elastic(1e3, poisson), f"label = 1, {HELD}")
                    + '[[tool]]\nname = "c"\nshape = "disc"\ncentre = [0, 1]\nradius = 1\n'
                    f'fy = "-{force!r}*t"\n'
                    + contact(("b", 3), ("c", None)) + forces("contact_force", "b", 3) + timed())
            run = solve(program, text, files={"block.geo": block})
            what = f"nu {poisson}, degree {degree}"
            largest = max((row["pressure"] for row in run.contact), default=math.nan)
            faults += ended(what, run) or off(what, largest, 2 * force / (math.pi * half), 0.08)
    return faults


def tipping(program):
    """A block of 1 x 2, weight 2, pushed at half its height by t: tips at t = 1 about its corner."""
    faults, steps = [], 150
    for degree in (1, 2):
        for variant in (None, "mortar"):
            for swap in (False, True):
                text = (f"degree = {degree}\n"
                        + body("f", rectangle((-2, -0.5), (3, 0), (20, 2)), 1e6, f"label = 1, {HELD}")
                        + body("b", rectangle((0, 0), (1, 2), (8, 12)), 1e6, 'label = 4, tx = "0.5*t"',
                               more="force = { x = 0.0, y = -1.0 }\n")
                        + contact(("b", 1), ("f", 3), friction=2, variant=variant, swap=swap)
                        + timed(steps, 1.2))
                run = solve(program, text)
                what = f"degree {degree}, {variant or 'default'}, swap {swap}"
                faults += ended(what, run, 3)
                if found := re.search(r" at t = ([\d.]+)", run.told):
                    faults += off(what, float(found[1]), 1 + 0.5 * 1.2 / steps, 0.005)
    return faults


def default_while_sliding(program):
    """A disc that is drawn along a block: its force varies by the mesh below alone, 0.33 % with weighted
    rows; twice of that is allowed. The length of the way is that of the middle of the block, where the ends
    of the block matter least, and a slow change over it is subtracted."""
    text = (PLANE + body("low", rectangle((0, -1), (4, 0), (40, 8)), 1000.0, f"label = 1, {HELD}")
            + body("up", '{ shape = "halfdisc", radius = 1, core = 0.3, cells = 12, lowest = [1.2, 0] }',
                   1000.0, 'label = 2, ux = "1.5*max(0,t-0.1)/0.9", uy = "-0.02*min(10*t,1)"')
            + contact(("up", 1), ("low", 3), True, friction=0.2, sliding="finite")
            + forces("reaction", "up", 2) + timed(90) + "[output]\nevery = 0\n")
    run = solve(program, text)
    faults = ended("disc", run)
    if not faults:
        force = -run.course("Y")[12:]
        ways = np.arange(len(force))
        force = force - np.polyval(np.polyfit(ways, force, 2), ways)
        faults += zero("spread of the force", np.ptp(force), run.value("Y"), 0.008)
    return faults


def stiff_fine_core(program):
    """A disc and a block, one 1000 times as stiff, the core of the disc 1.7 times as fine, 10 cells of the
    block on the half width: pressures follow Hertz to 5 % up to 0.85 b, or are named."""
    faults = []
    for degree in (1, 2):
        for young in ((1e6, 1e3), (1e3, 1e6)):
            block = ('{ shape = "rectangle", lower = [-10, -10], upper = [10, 0], cells = [120, 60], '
                     'cut = "both", focus = [0, 0], grading = 2.5 }')
            text = (f"degree = {degree}\n" + PLANE
                    + body("c", '{ shape = "halfdisc", radius = 10, core = 1.5, cells = 25, cut = "both" }',
                           young[0], 'label = 2, ux = 0, uy = "-0.16*t"')
                    + body("b", block, young[1], f"label = 1, {HELD}")
                    + contact(("c", 1), ("b", 3), True) + forces("reaction", "c", 2) + timed())
            run = solve(program, text)
            what = f"degree {degree}, E {young}"
            faults += ended(what, run) or hertz(what, run, 10, young, 0.05)
    return faults


def hertz(what, run, radius, young, tolerance):
    """Nodal pressures up to 0.85 of the half width against those of Hertz for the force that was found."""
    if UNRESOLVED.search(run.log):
        return []
    force = abs(run.value("Y"))
    modulus = 1 / sum(0.91 / e for e in young)
    width = math.sqrt(4 * force * radius / (math.pi * modulus))
    peak = 2 * force / (math.pi * width)
    nodes = [(row["x"], row["pressure"]) for row in run.contact if abs(row["x"]) < 0.85 * width]
    worst = max((abs(p / (peak * math.sqrt(1 - (x / width)**2)) - 1) for x, p in nodes), default=math.inf)
    return [] if worst <= tolerance else [f"{what}: nodal pressure {100 * worst:.3g} % off"]


def accuracy_alternates(program):
    """Rounds of refinement: pressures to 10 %, as asked for of the stress, at both degrees."""
    faults = []
    for degree in (1, 2):
        text = (f"degree = {degree}\n" + PLANE
                + body("c", '{ shape = "halfdisc", radius = 50, core = 4, cells = 24, cut = "both" }', 2.1e5,
                       'label = 2, ux = 0, uy = "-0.1*t"')
                + body("b", rectangle((-60, -60), (60, 0), (60, 30)), 7e4, f"label = 1, {HELD}")
                + contact(("c", 1), ("b", 3), True) + forces("reaction", "c", 2) + timed())
        run = solve(program, text, "--accuracy", "0.1")
        faults += ended(f"degree {degree}", run) or hertz(f"degree {degree}", run, 50, (2.1e5, 7e4), 0.1)
    return faults


def symmetric_ends(program):
    """A hub in the middle of a shaft, whose ends lie 1e-10 and less beside nodes of the shaft: the pressures
    at both ends are equal as the parts are, to the size of what makes them differ."""
    faults = []
    for degree in (1, 2):
        for beside in (0, 1e-14, 1e-12, 1e-10, -1e-10, 1e-9):
            for swap in (False, True):
                text = (f'degree = {degree}\nplane = "axisymmetric"\n'
                        + body("s", rectangle((0, -50), (20, 50 + 2.5 * beside), (8, 40)), 2.1e5)
                        + "[[body.point]]\nat = [0, 0]\nuy = 0\n"
                        + body("h", rectangle((20, -20), (40, 20), (8, 24)), 2.1e5)
                        + "[[body.point]]\nat = [40, 0]\nuy = 0\n"
                        + contact(("s", 2), ("h", 4), swap=swap, gap="-0.02*t") + timed())
                run = solve(program, text)
                what = f"degree {degree}, beside by {beside}, swap {swap}"
                faults += ended(what, run)
                rows = sorted((row for row in run.contact if row["force"] > 0), key=lambda row: row["y"])
                if len(rows) > 1:
                    for name in ("force", "pressure"):
                        faults += off(f"{what}, {name} at the lower end", rows[0][name], rows[-1][name], 1e-6)
    return faults


def sloped_rollers(program):
    """Sides in any direction with `un` at more than 16 nodes: no memory error in run and check, and the
    reaction along the normal: what carries the load."""
    faults = []
    for i in range(30):
        height = 1 + 0.01937 * (i - 10)
        mesh = quadrilateral([(0, 0), (2, 0), (2, height), (0, 1)], (16 + i, 8), "rising")
        text = (body("w", mesh, 1000.0, "label = 3, un = 0", 'label = 1, ty = "t", ux = 0')
                + forces("reaction", "w", 3) + timed())
        for which in ("run", "check"):
            run = solve(program, text, command=which)
            faults += ended(f"wedge {i}, {which}", run, 0)
            if which == "run" and run.code == 0:
                faults += off(f"wedge {i}, Y", run.value("Y"), -2, 1e-9)
                faults += zero(f"wedge {i}, X", run.value("X") - (height - 1), 2, 1e-9)
    return faults


SCENES = (light_contact, light_contact_without_estimate, light_ball, prandtl, nearly_incompressible, tipping,
          default_while_sliding, stiff_fine_core, accuracy_alternates, symmetric_ends, sloped_rollers)
