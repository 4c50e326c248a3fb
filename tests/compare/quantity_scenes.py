"""Scenes in the plane and about an axis whose quantities have errors that are estimated: each of the factor
of its cells."""
import json

from scene_parts import LARGE_CHANGES, body, box, contact, quantity, shape, timed, tool as rigid
from support import ROOT, mortier

STEEL = 1
FLOWS = "young = 1e3, poisson = 0.3, viscosity = 10, yield_stress = 1"


def energies(*bodies):
    return "".join(quantity(f"energy_{name}", "stored_energy", name)
                   for name in bodies)


def half_disc(cells):
    return shape("halfdisc", radius=10, core=2, lowest=[0, 0], cells=cells)


BELOW = {"cut": "both", "focus": [0, 0], "grading": [8, 8]}


def cantilever(f):
    return (body("beam", box([0, 0], [4, 1], [8 * f, 2 * f]), STEEL,
                 "label = 4, ux = 0, uy = 0", 'label = 2, ty = "0.01*t"')
            + quantity("held", "reaction", "beam", 4, "moment")
            + quantity("tip", "displacement", "beam", 2, "y")
            + quantity("point", "displacement", "beam", component="y", point=[2, 0.5])
            + energies("beam") + quantity("mises", "largest_mises", "beam")
            + timed())


def lame(f):
    return ('plane = "strain"\n'
            + body("tube", shape("annulus", inner=1, outer=2, span="quarter", cells=[8 * f, 4 * f]), STEEL,
                   "label = 3, uy = 0", "label = 4, ux = 0", 'label = 1, pressure = "0.01*t"')
            + quantity("held", "reaction", "tube", 3, "y")
            + quantity("bore", "displacement", "tube", component="x", point=[1, 0])
            + quantity("outside", "displacement", "tube", component="x", point=[2, 0])
            + energies("tube") + quantity("mises", "largest_mises", "tube")
            + timed())


def patch(f):
    return (body("upper", box([0, 1], [1, 2], [3 * f, 3 * f]), STEEL, "label = 4, ux = 0",
                 'label = 3, uy = "-0.01*t"')
            + body("lower", box([0, 0], [1, 1], [4 * f, 4 * f]), STEEL, "label = 4, ux = 0",
                   "label = 1, uy = 0")
            + contact(("upper", 1), ("lower", 3)) + pressed("upper", "lower", 3) + timed())


def pressed(upper, lower, top, contact_label=1):
    return (quantity("press", "reaction", upper, top, "y")
            + quantity("contact", "contact_force", upper, contact_label, "y")
            + quantity("pressure", "largest_pressure", upper, contact_label)
            + quantity("length", "contact_length", upper, contact_label)
            + energies(upper, lower)
            + quantity("mises", "largest_mises", lower))


def known_end(f):
    text = (ROOT / "scenes" / "exact-contact.toml").read_text()
    text = text.replace('"../shared-meshes/exact-upper.mesh"', box([-0.9, 0], [1.1, 1], [7 * f, 4 * f]))
    text = text.replace('"../shared-meshes/exact-lower.mesh"', box([-0.9, -1], [1.1, 0], [5 * f, 3 * f]))
    return (text + quantity("sinks", "displacement", "lower", component="y", point=[0, 0])
            + quantity("mean", "mean_pressure", "upper", 1, **{"from": [0.25, 0], "to": [0.75, 0]})
            + quantity("side", "displacement", "upper", 2, "y") + pressed("upper", "lower", 3))


def hertz(f):
    return (body("disc", half_disc(8 * f),
                 STEEL, 'label = 2, ux = 0, uy = "-0.1*t"')
            + body("block", box([-12, -12], [12, 0], [16 * f, 8 * f], **BELOW),
                   STEEL, "label = 1, ux = 0, uy = 0")
            + contact(("disc", 1), ("block", 3)) + pressed("disc", "block", 2)
            + quantity("sinks", "displacement", "block", component="y", point=[0, 0])
            + quantity("mean", "mean_pressure", "disc", 1, **{"from": [-0.5, 0], "to": [0.5, 0]})
            + timed())



def tool(f):
    return (rigid("disc", shape="disc", centre=[0, 10], radius=10, uy="-0.1*t")
            + body("block", box([-12, -12], [12, 0], [16 * f, 8 * f], **BELOW), STEEL,
                   "label = 1, ux = 0, uy = 0")
            + contact(("block", 3), ("disc", 1), sides=True)
            + quantity("press", "reaction", "disc", component="y")
            + quantity("contact", "contact_force", "block", 3, "y")
            + quantity("pressure", "largest_pressure", "block", 3)
            + quantity("length", "contact_length", "block", 3) + energies("block") + timed())


def pushed_tool(f):
    press, sinks = (quantity(name, kind, "disc", component="y")
                    for name, kind in (("press", "reaction"), ("sinks", "displacement")))
    return tool(f).replace('uy = "-0.1*t"', 'fy = "-0.05*t"').replace(press, sinks)


def punch(f):
    return (body("punch", box([-1, 0], [1, 1], [6 * f, 3 * f]), STEEL,
                 'label = 3, ux = 0, uy = "-0.01*t"')
            + body("ground", box([-4, -4], [4, 0], [16 * f, 8 * f]), STEEL,
                   "label = 1, ux = 0, uy = 0")
            + contact(("punch", 1), ("ground", 3)) + pressed("punch", "ground", 3)
            + quantity("sinks", "displacement", "ground", component="y", point=[0, 0]) + timed())


def rough(f):
    return (body("upper", box([0, 1], [1, 2], [4 * f, 4 * f]), STEEL,
                 'label = 3, ux = "0.01*t", uy = "-0.02"')
            + body("lower", box([-0.5, 0], [1.5, 1], [7 * f, 4 * f]), STEEL,
                   "label = 1, ux = 0, uy = 0")
            + contact(("upper", 1), ("lower", 3), friction=0.3) + pressed("upper", "lower", 3)
            + quantity("shear", "reaction", "upper", 3, "x")
            + quantity("rub", "friction_work", "upper", 1)
            + timed(4))


def creeping_tube(f):
    def ring(inner, outer, around):
        return shape("annulus", inner=inner, outer=outer, span="quarter", cells=[around * f, 3 * f])
    flows = "young = 1e5, poisson = 0.3, viscosity = 10, yield_stress = 1"
    return ('plane = "strain"\n'
            + body("liner", ring(1, 1.5, 6), flows, "label = 3, uy = 0",
                   "label = 4, ux = 0", 'label = 1, pressure = "1.2*min(t, 1)"')
            + body("jacket", ring(1.5, 2, 8), flows, "label = 3, uy = 0",
                   "label = 4, ux = 0")
            + contact(("liner", 2), ("jacket", 1), initial="close")
            + quantity("bore", "displacement", "liner", component="x", point=[1, 0])
            + quantity("held", "reaction", "liner", 3, "y")
            + quantity("pressure", "largest_pressure", "liner", 2)
            + quantity("heat", "dissipated_energy", "liner")
            + quantity("work", "work", "liner")
            + energies("liner", "jacket") + timed(10, 5))


def flowing_beam(f):
    return (body("beam", box([0, 0], [4, 1], [8 * f, 2 * f]), FLOWS,
                 "label = 4, ux = 0, uy = 0", 'label = 2, uy = "-0.02*t"')
            + quantity("held", "reaction", "beam", 4, "y")
            + quantity("middle", "displacement", "beam", component="y", point=[2, 0.5])
            + quantity("heat", "dissipated_energy", "beam")
            + energies("beam") + timed(20))


def creeping_beam(f):
    return flowing_beam(f).replace('uy = "-0.02*t"', 'ty = "-0.1"').replace(
        "viscosity = 10, yield_stress = 1",
        'law = "norton", reference_stress = 1, reference_rate = 1e-2, exponent = 4')


def run(text, folder, name):
    """The quantities of a run."""
    (folder / f"{name}.toml").write_text(text if "[check]" in text else text + LARGE_CHANGES)
    done = mortier("run", folder / f"{name}.toml", "--out", folder / name, "--quiet")
    assert done.returncode == 0, f"{name}: {done.stderr.strip()}"
    return json.loads((folder / name / "summary.json").read_text())["quantities"]
