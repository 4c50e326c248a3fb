#!/usr/bin/python3
"""Estimated over true errors of quantities of bodies in space on one mesh; true is the difference from the
value by quadratic tetrahedra on a mesh of --finer times the cells. The table of docs/measurements.md.

    bench/space_quantities.py [--finer 3] [--only PART] [--degree 1]
"""
import argparse
import tempfile
from pathlib import Path

from quantity_errors import ALLOW, FLOWS, STEEL, STEP, body, contact, quantity, run

HERE = [0, 0, 0]


def cuboid(lower, upper, cells):
    return (f'mesh = {{ shape = "cuboid", lower = {list(lower)}, upper = {list(upper)}, '
            f'cells = {list(cells)} }}\n')


def held(label):
    return f"{{ label = {label}, ux = 0, uy = 0, uz = 0 }}"


def swept(shape, by):
    return f"mesh = {{ {shape}, {by} }}\n"


def annulus(inner, outer, cells, layers, length=1):
    return swept(f'shape = "annulus", inner = {inner}, outer = {outer}, span = "quarter", cells = {cells}',
                 f"extrude = {length}, layers = {layers}")


def force(name, kind, of, label, component="z", about=""):
    return quantity(name, kind, of, f", label = {label}", component) + (f"about = {about}\n" if about else "")


def touching(nonmortar, label, mortar, other, more=""):
    sizes = "".join(quantity(name, kind, nonmortar, f", label = {label}") for name, kind in (
        ("pressure", "largest_pressure"), ("mean", "mean_pressure"), ("area", "contact_area")))
    return (contact(nonmortar, label, mortar, other, more) + sizes
            + force("contact", "contact_force", nonmortar, label)
            + force("contact_moment", "contact_force", nonmortar, label, "moment_y"))


def stresses(*bodies):
    return "".join(quantity(f"energy_{each}", "stored_energy", each)
                   + quantity(f"mises_{each}", "largest_mises", each) for each in bodies)


ENDS = '{ label = "start", uz = 0 }', '{ label = "end", uz = 0 }'
CORNER = "{ label = 4, ux = 0 }", "{ label = 5, uy = 0 }"


def blocks(upper, lower, load, material=STEEL):
    """A unit cube on another, with planes of symmetry."""
    return (body("upper", cuboid(HERE, [1, 1, 1], upper), material, *CORNER, f"{{ label = 3, {load} }}")
            + body("lower", cuboid([0, 0, -1], [1, 1, 0], lower), material, *CORNER, "{ label = 1, uz = 0 }")
            + touching("upper", 1, "lower", 3) + force("floor", "reaction", "lower", 1)
            + force("floor_moment", "reaction", "lower", 1, "moment_x")
            + force("top", "displacement", "upper", 3) + stresses("upper", "lower") + STEP)


def patch(f):
    return blocks([3*f, 3*f, 3*f], [4*f, 4*f, 4*f], 'tz = "-0.01*t"')


def patch_coarse(f):
    return blocks([2*f, 2*f, 2*f], [5*f, 4*f, 3*f], 'uz = "-0.01*t"')


def leaning(f):
    return blocks([3*f, 3*f, 3*f], [4*f, 4*f, 4*f], 'tz = "-0.01*t*(1 + 0.8*x - 0.5*y)"')


def bumped(f):
    return blocks([5*f, 5*f, 3*f], [4*f, 4*f, 4*f], 'tz = "-0.03*t*exp(-4*(x^2 + y^2))"')


def given_gap(f):
    """A paraboloid between two cubes."""
    return blocks([6*f, 6*f, 4*f], [5*f, 5*f, 4*f], 'uz = "-0.05*t"').replace(
        "mortar = { body = \"lower\", label = 3 }\n", "mortar = { body = \"lower\", label = 3 }\n"
        'gap = "0.1*(x^2 + y^2)"\n')


def flowing(f):
    return blocks([3*f, 3*f, 3*f], [4*f, 4*f, 3*f], 'tz = "-2*t*(1 + 0.5*x)"', FLOWS).replace(
        "steps = 1", "steps = 5")


def cantilever(f):
    return (body("beam", cuboid(HERE, [4, 1, 1], [8*f, 2*f, 2*f]), STEEL, held(4),
                 '{ label = 2, tz = "0.01*t", ty = "0.003*t" }')
            + force("held", "reaction", "beam", 4) + force("held_moment", "reaction", "beam", 4, "moment_y")
            + force("tip", "displacement", "beam", 2)
            + quantity("point", "displacement", "beam", ", point = [2, 0.5, 0.5]", "z") + stresses("beam")
            + STEP)


def moved_beam(f):
    return (body("beam", cuboid(HERE, [4, 1, 1], [8*f, 2*f, 2*f]), STEEL, held(4),
                 '{ label = 2, uz = "0.1*t" }')
            + force("held", "reaction", "beam", 4) + force("held_moment", "reaction", "beam", 4, "moment_y")
            + force("side", "displacement", "beam", 2, "x")
            + quantity("point", "displacement", "beam", ", point = [2, 0.5, 0.5]", "z") + stresses("beam")
            + STEP)


def creeping_beam(f):
    return moved_beam(f).replace(STEEL, 'material = { young = 1e3, poisson = 0.3, law = "norton", '
                                 "reference_stress = 1, reference_rate = 1e-2, exponent = 4 }\n").replace(
        'uz = "0.1*t"', 'tz = "0.05"').replace("steps = 1", "steps = 5")


def twisted(f):
    return (body("bar", cuboid([-0.5, -0.5, 0], [0.5, 0.5, 2], [3*f, 3*f, 4*f]), STEEL,
                 held(1), '{ label = 3, ux = "-0.05*y*t", uy = "0.05*x*t" }')
            + force("torque", "reaction", "bar", 3, "moment_z")
            + force("held", "reaction", "bar", 1, "moment_z")
            + quantity("point", "displacement", "bar", ", point = [0.5, 0, 1]", "y") + stresses("bar") + STEP)


def tube(f):
    return (body("tube", annulus(1, 2, [6*f, 3*f], 2*f), STEEL, "{ label = 3, uy = 0 }",
                 "{ label = 4, ux = 0 }", *ENDS, '{ label = 1, pressure = "0.01*t" }')
            + force("held", "reaction", "tube", 3, "y") + force("axial", "reaction", "tube", '"end"')
            + quantity("bore", "displacement", "tube", ", label = 1", "x")
            + quantity("outside", "displacement", "tube", ", label = 2", "x") + stresses("tube") + STEP)


def shrunk(f):
    ends = "{ label = 3, uy = 0 }", "{ label = 4, ux = 0 }", *ENDS
    return (body("hub", annulus(1, 1.5, [6*f, 3*f], 2*f), STEEL, *ends)
            + body("ring", annulus(1.5, 2, [8*f, 3*f], 2*f), STEEL, *ends)
            + touching("hub", 2, "ring", 1, 'gap = -0.01\n')
            + force("cut", "reaction", "ring", 3, "y") + force("bore", "displacement", "hub", 1, "x")
            + stresses("hub", "ring") + STEP)


def disc(f):
    """A roller along z on a block: contact grows from a line."""
    along = f"extrude = 1, layers = {2*f}"
    roller = swept(f'shape = "halfdisc", radius = 1, core = 0.3, lowest = [0, 0], cells = {5*f}', along)
    block = swept(f'shape = "rectangle", lower = [-1, -1], upper = [1, 0], cells = [{10*f}, {5*f}], '
                  "focus = [0, 0], grading = [4, 4]", along)
    return (body("roller", roller, STEEL, '{ label = 2, ux = 0, uy = "-0.06*t" }', *ENDS)
            + body("block", block, STEEL, "{ label = 1, ux = 0, uy = 0 }", *ENDS)
            + touching("roller", 1, "block", 3).replace('component = "z"', 'component = "y"').replace(
                "moment_y", "moment_x")
            + force("press", "reaction", "roller", 2, "y") + stresses("roller", "block") + STEP)


def ball(f):
    return (body("ball", f'mesh = {{ shape = "ball", centre = [0, 0, 1], radius = 1, cells = {5*f}, '
                         'keep = ["x", "y", "-z"] }\n', STEEL, *CORNER, '{ label = 3, uz = "-0.1*t" }')
            + body("block", cuboid([0, 0, -1], [1, 1, 0], [6*f, 6*f, 5*f]), STEEL, *CORNER,
                   "{ label = 1, uz = 0 }")
            + touching("ball", 7, "block", 3) + force("press", "reaction", "ball", 3)
            + stresses("ball", "block") + STEP)


def pushed_ball(f):
    return ball(f).replace('uz = "-0.1*t"', 'tz = "-0.02*t"').replace(
        force("press", "reaction", "ball", 3), force("sinks", "displacement", "ball", 3))


def soft_ball(f):
    return ball(f).replace(STEEL, "material = { young = 20, poisson = 0.3 }\n", 1)


def two_balls(f):
    half = ('mesh = {{ shape = "ball", centre = [0, 0, {}], radius = 1, cells = {}, '
            'keep = ["x", "y", "{}"] }}\n')
    return (body("ball", half.format(1, 5*f, "-z"), STEEL, *CORNER, '{ label = 3, uz = "-0.1*t" }')
            + body("other", half.format(-1, 4*f, "z"), STEEL, *CORNER, "{ label = 1, uz = 0 }")
            + touching("ball", 7, "other", 7) + force("press", "reaction", "ball", 3)
            + stresses("ball", "other") + STEP)


def punch(f):
    return (body("punch", cuboid(HERE, [0.5, 0.5, 0.5], [3*f, 3*f, 3*f]), STEEL, *CORNER,
                   '{ label = 3, uz = "-0.01*t" }')
            + body("ground", cuboid([0, 0, -1], [1.5, 1.5, 0], [6*f, 6*f, 4*f]), STEEL, *CORNER,
                   "{ label = 1, uz = 0 }")
            + touching("punch", 1, "ground", 3) + force("press", "reaction", "punch", 3)
            + quantity("sinks", "displacement", "ground", ", point = [0, 0, 0]", "z")
            + stresses("punch", "ground") + STEP)


def loaded_ground(f):
    return (body("ground", cuboid([0, 0, -1], [1, 1, 0], [5*f, 5*f, 5*f]), STEEL, *CORNER,
                   "{ label = 1, uz = 0 }",
                 '{ label = 3, tz = "-0.01*t*exp(-8*(x^2 + y^2))" }')
            + quantity("sinks", "displacement", "ground", ", point = [0, 0, 0]", "z")
            + force("floor", "reaction", "ground", 1)
            + force("floor_moment", "reaction", "ground", 1, "moment_y")
            + stresses("ground") + STEP)


def clamped(f):
    return (body("cube", cuboid(HERE, [1, 1, 1], [4*f, 4*f, 4*f]), STEEL, held(1),
                 '{ label = 3, ux = 0, uy = 0, uz = "-0.01*t" }')
            + force("press", "reaction", "cube", 3) + force("side", "displacement", "cube", 2, "x")
            + stresses("cube") + STEP)


def heavy(f):
    return (body("column", cuboid(HERE, [1, 1, 2], [3*f, 3*f, 6*f]), STEEL + 'force = { z = "-0.01*t*z" }\n',
                 *CORNER, "{ label = 1, uz = 0 }")
            + force("floor", "reaction", "column", 1)
            + force("floor_moment", "reaction", "column", 1, "moment_x")
            + force("top", "displacement", "column", 3) + stresses("column") + STEP)


def turned(f):
    return (body("ring", swept(f'shape = "rectangle", lower = [1, 0], upper = [2, 1], cells = [{4*f}, {3*f}]',
                               f'revolve = "pi/2", layers = {6*f}'), STEEL, "{ label = 1, uy = 0 }",
                 '{ label = "start", uz = 0 }', '{ label = "end", ux = 0 }',
                 '{ label = 4, pressure = "0.01*t" }')
            + force("held", "reaction", "ring", '"start"') + force("bore", "displacement", "ring", 4, "x")
            + force("moment", "reaction", "ring", '"start"', "moment_y") + stresses("ring") + STEP)


def seated(f):
    """A cylinder that stands on a block, pulled to one side: contact opens."""
    return (body("post", f'mesh = {{ shape = "cylinder", centre = [0, 0, 0], radius = 0.5, height = 1, '
                         f'cells = [{3*f}, {4*f}], keep = ["x"] }}\n', STEEL, "{ label = 4, ux = 0 }",
                 '{ label = 3, uy = 0, tz = "-0.02*t*(1 + 0.3*x)" }')
            + body("block", cuboid([0, -1, -1], [1, 1, 0], [4*f, 8*f, 4*f]), STEEL, "{ label = 4, ux = 0 }",
                   held(1))
            + touching("post", 1, "block", 3) + force("floor", "reaction", "block", 1)
            + force("floor_moment", "reaction", "block", 1, "moment_x") + stresses("post", "block") + STEP)


SCENES = {each.__name__: each for each in (
    patch, patch_coarse, leaning, bumped, given_gap, flowing, cantilever, moved_beam, creeping_beam, twisted,
    tube, shrunk, disc, ball, pushed_ball, soft_ball, two_balls, punch, loaded_ground, clamped, heavy, turned,
    seated)}


def of_degree(degree, text):
    return f"dimension = 3\ndegree = {degree}\n{text}{ALLOW}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--finer", type=int, default=3)
    parser.add_argument("--only", default="")
    parser.add_argument("--degree", type=int, default=0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for scene, make in SCENES.items():
            if options.only not in scene:
                continue
            try:
                fine = run(of_degree(2, make(options.finer)), folder, f"{scene}-fine")
            except RuntimeError as error:
                print(error)
                continue
            for degree in [options.degree] if options.degree else [1, 2]:
                try:
                    coarse = run(of_degree(degree, make(1)), folder, f"{scene}-{degree}")
                except RuntimeError as error:
                    print(error)
                    continue
                for each, found in coarse.items():
                    exact = fine[each]["value"]
                    true, size = abs(found["value"] - exact), max(abs(exact), 1e-300)
                    estimate = found["estimated_error"]
                    ratio = ""
                    if estimate is not None:
                        ratio = f"{estimate/true:8.3g}" if true > 1e-7*size else f"exact {estimate/size:.1g}"
                    print(f"{scene:14} {degree} {each:14} {found['value']:12.5g} {exact:12.5g} true "
                          f"{true/size:8.2g} ratio {ratio:8} {found.get('no_estimate', '')}", flush=True)


if __name__ == "__main__":
    main()
