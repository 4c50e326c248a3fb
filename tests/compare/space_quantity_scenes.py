"""Scenes in space whose quantities have errors that are estimated: each of the factor of its cells."""
from quantity_scenes import STEEL
from scene_parts import body, box, contact, quantity, shape, stresses, timed

HERE = [0, 0, 0]


def held(label):
    return f"label = {label}, ux = 0, uy = 0, uz = 0"


def force(name, kind, of, label, component="z"):
    return quantity(name, kind, of, label, component)


def touching(nonmortar, label, mortar, other, **keys):
    sizes = "".join(quantity(name, kind, nonmortar, label) for name, kind in (
        ("pressure", "largest_pressure"), ("mean", "mean_pressure"), ("area", "contact_area")))
    return (contact((nonmortar, label), (mortar, other), **keys) + sizes
            + force("contact", "contact_force", nonmortar, label)
            + force("contact_moment", "contact_force", nonmortar, label, "moment_y"))


ENDS = 'label = "start", uz = 0', 'label = "end", uz = 0'
CORNER = "label = 4, ux = 0", "label = 5, uy = 0"


def blocks(upper, lower, load, material=STEEL):
    """A unit cube on another, with planes of symmetry."""
    return (body("upper", box(HERE, [1, 1, 1], upper), material, *CORNER, f"label = 3, {load}")
            + body("lower", box([0, 0, -1], [1, 1, 0], lower), material, *CORNER, "label = 1, uz = 0")
            + touching("upper", 1, "lower", 3) + force("floor", "reaction", "lower", 1)
            + force("floor_moment", "reaction", "lower", 1, "moment_x")
            + force("top", "displacement", "upper", 3) + stresses("upper", "lower") + timed())


def patch(f):
    return blocks([3*f, 3*f, 3*f], [4*f, 4*f, 4*f], 'tz = "-0.01*t"')


def patch_coarse(f):
    return blocks([2*f, 2*f, 2*f], [5*f, 4*f, 3*f], 'uz = "-0.01*t"')


def leaning(f):
    return blocks([3*f, 3*f, 3*f], [4*f, 4*f, 4*f], 'tz = "-0.01*t*(1 + 0.8*x - 0.5*y)"')


def given_gap(f):
    """A paraboloid between two cubes."""
    return blocks([6*f, 6*f, 4*f], [5*f, 5*f, 4*f], 'uz = "-0.05*t"').replace(
        "mortar = { body = \"lower\", label = 3 }\n", "mortar = { body = \"lower\", label = 3 }\n"
        'gap = "0.1*(x^2 + y^2)"\n')


def cantilever(f):
    return (body("beam", box(HERE, [4, 1, 1], [8*f, 2*f, 2*f]), STEEL, held(4),
                 'label = 2, tz = "0.01*t", ty = "0.003*t"')
            + force("held", "reaction", "beam", 4) + force("held_moment", "reaction", "beam", 4, "moment_y")
            + force("tip", "displacement", "beam", 2)
            + quantity("point", "displacement", "beam", component="z", point=[2, 0.5, 0.5]) + stresses("beam")
            + timed())


def twisted(f):
    return (body("bar", box([-0.5, -0.5, 0], [0.5, 0.5, 2], [3*f, 3*f, 4*f]), STEEL,
                 held(1), 'label = 3, ux = "-0.05*y*t", uy = "0.05*x*t"')
            + force("torque", "reaction", "bar", 3, "moment_z")
            + force("held", "reaction", "bar", 1, "moment_z")
            + quantity("point", "displacement", "bar", component="y", point=[0.5, 0, 1])
            + stresses("bar") + timed())


def tube(f):
    mesh = shape("annulus", inner=1, outer=2, span="quarter", cells=[6*f, 3*f], extrude=1, layers=2*f)
    return (body("tube", mesh, STEEL, "label = 3, uy = 0", "label = 4, ux = 0", *ENDS,
                 'label = 1, pressure = "0.01*t"')
            + force("held", "reaction", "tube", 3, "y") + force("axial", "reaction", "tube", "end")
            + quantity("bore", "displacement", "tube", 1, "x")
            + quantity("outside", "displacement", "tube", 2, "x") + stresses("tube") + timed())


def ball(f):
    mesh = shape("ball", centre=[0, 0, 1], radius=1, cells=5*f, keep=["x", "y", "-z"])
    return (body("ball", mesh, STEEL, *CORNER, 'label = 3, uz = "-0.1*t"')
            + body("block", box([0, 0, -1], [1, 1, 0], [6*f, 6*f, 5*f]), STEEL, *CORNER, "label = 1, uz = 0")
            + touching("ball", 7, "block", 3) + force("press", "reaction", "ball", 3)
            + stresses("ball", "block") + timed())


def pushed_ball(f):
    return ball(f).replace('uz = "-0.1*t"', 'tz = "-0.02*t"').replace(
        force("press", "reaction", "ball", 3), force("sinks", "displacement", "ball", 3))


def punch(f):
    return (body("punch", box(HERE, [0.5, 0.5, 0.5], [3*f, 3*f, 3*f]), STEEL, *CORNER,
                   'label = 3, uz = "-0.01*t"')
            + body("ground", box([0, 0, -1], [1.5, 1.5, 0], [6*f, 6*f, 4*f]), STEEL, *CORNER,
                   "label = 1, uz = 0")
            + touching("punch", 1, "ground", 3) + force("press", "reaction", "punch", 3)
            + quantity("sinks", "displacement", "ground", component="z", point=[0, 0, 0])
            + stresses("punch", "ground") + timed())
