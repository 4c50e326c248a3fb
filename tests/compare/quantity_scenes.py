"""Scenes in the plane and about an axis whose quantities have errors that are estimated: each of the factor
of its cells."""
import json

from support import ROOT, mortier

STEP = "[time]\nend = 1\nsteps = 1\n"
STEEL = "material = { young = 1, poisson = 0.3 }\n"
FLOWS = "material = { young = 1e3, poisson = 0.3, viscosity = 10, yield_stress = 1 }\n"
ALLOW = '[check]\nallow = ["large-strain", "large-displacement", "large-rotation", "sliver"]\n'


def rectangle(lower, upper, cells, more=""):
    return (f'mesh = {{ shape = "rectangle", lower = {list(lower)}, upper = {list(upper)}, '
            f'cells = {list(cells)}{more} }}\n')


def body(name, mesh, material, *boundary):
    return f'[[body]]\nname = "{name}"\n{mesh}{material}boundary = [ {", ".join(boundary)} ]\n'


def quantity(name, key, of, more="", component=None):
    text = f'[[quantity]]\nname = "{name}"\n{key} = {{ body = "{of}"{more} }}\n'
    return text + (f'component = "{component}"\n' if component else "")


def energies(*bodies):
    return "".join(quantity(f"energy_{name}", "stored_energy", name)
                   for name in bodies)


def contact(nonmortar, label, mortar, other, more=""):
    return (f'[[contact]]\nnonmortar = {{ body = "{nonmortar}", label = {label} }}\n'
            f'mortar = {{ body = "{mortar}", label = {other} }}\n{more}')


def half_disc(cells):
    return f'mesh = {{ shape = "halfdisc", radius = 10, core = 2, lowest = [0, 0], cells = {cells} }}\n'


def cantilever(f):
    return (body("beam", rectangle([0, 0], [4, 1], [8 * f, 2 * f]), STEEL,
                 "{ label = 4, ux = 0, uy = 0 }", '{ label = 2, ty = "0.01*t" }')
            + quantity("held", "reaction", "beam", ", label = 4", "moment") + "about = [0, 0]\n"
            + quantity("tip", "displacement", "beam", ", label = 2", "y")
            + quantity("point", "displacement", "beam", ", point = [2, 0.5]", "y")
            + energies("beam") + quantity("mises", "largest_mises", "beam")
            + STEP)


def lame(f):
    return ('plane = "strain"\n'
            + body("tube", f'mesh = {{ shape = "annulus", inner = 1, outer = 2, span = "quarter", cells = '
                           f'[{8 * f}, {4 * f}] }}\n', STEEL,
                   "{ label = 3, uy = 0 }", "{ label = 4, ux = 0 }", '{ label = 1, pressure = "0.01*t" }')
            + quantity("held", "reaction", "tube", ", label = 3", "y")
            + quantity("bore", "displacement", "tube", ", point = [1, 0]", "x")
            + quantity("outside", "displacement", "tube", ", point = [2, 0]", "x")
            + energies("tube") + quantity("mises", "largest_mises", "tube")
            + STEP)


def patch(f):
    return (body("upper", rectangle([0, 1], [1, 2], [3 * f, 3 * f]), STEEL, "{ label = 4, ux = 0 }",
                 '{ label = 3, uy = "-0.01*t" }')
            + body("lower", rectangle([0, 0], [1, 1], [4 * f, 4 * f]), STEEL, "{ label = 4, ux = 0 }",
                   "{ label = 1, uy = 0 }")
            + contact("upper", 1, "lower", 3) + pressed("upper", "lower", 3) + STEP)


def pressed(upper, lower, top, contact_label=1):
    return (quantity("press", "reaction", upper, f", label = {top}", "y")
            + quantity("contact", "contact_force", upper, f", label = {contact_label}", "y")
            + quantity("pressure", "largest_pressure", upper, f", label = {contact_label}")
            + quantity("length", "contact_length", upper, f", label = {contact_label}")
            + energies(upper, lower)
            + quantity("mises", "largest_mises", lower))


def known_end(f):
    text = (ROOT / "scenes" / "exact-contact.toml").read_text()
    text = text.replace('mesh = "../shared-meshes/exact-upper.mesh"\n',
                        rectangle([-0.9, 0], [1.1, 1], [7 * f, 4 * f]))
    text = text.replace('mesh = "../shared-meshes/exact-lower.mesh"\n',
                        rectangle([-0.9, -1], [1.1, 0], [5 * f, 3 * f]))
    return (text + quantity("sinks", "displacement", "lower", ", point = [0, 0]", "y")
            + quantity("mean", "mean_pressure", "upper", ", label = 1, from = [0.25, 0], to = [0.75, 0]")
            + quantity("side", "displacement", "upper", ", label = 2", "y") + pressed("upper", "lower", 3))


def hertz(f):
    return (body("disc", half_disc(8 * f),
                 STEEL, '{ label = 2, ux = 0, uy = "-0.1*t" }')
            + body("block", rectangle([-12, -12], [12, 0], [16 * f, 8 * f], ', cut = "both", focus = [0, 0], '
                                      'grading = [8, 8]'),
                   STEEL, "{ label = 1, ux = 0, uy = 0 }")
            + contact("disc", 1, "block", 3) + pressed("disc", "block", 2)
            + quantity("sinks", "displacement", "block", ", point = [0, 0]", "y")
            + quantity("mean", "mean_pressure", "disc", ", label = 1, from = [-0.5, 0], to = [0.5, 0]")
            + STEP)



def tool(f):
    return ('[[tool]]\nname = "disc"\nshape = "disc"\ncentre = [0, 10]\nradius = 10\nuy = "-0.1*t"\n'
            + body("block", rectangle([-12, -12], [12, 0], [16 * f, 8 * f], ', cut = "both", focus = [0, 0], '
                                      'grading = [8, 8]'), STEEL, "{ label = 1, ux = 0, uy = 0 }")
            + '[contact]\nsides = [ { body = "block", label = 3 }, { body = "disc", label = 1 } ]\n'
            + quantity("press", "reaction", "disc", "", "y")
            + quantity("contact", "contact_force", "block", ", label = 3", "y")
            + quantity("pressure", "largest_pressure", "block", ", label = 3")
            + quantity("length", "contact_length", "block", ", label = 3") + energies("block") + STEP)


def pushed_tool(f):
    return tool(f).replace('uy = "-0.1*t"', 'fy = "-0.05*t"').replace(
        quantity("press", "reaction", "disc", "", "y"), quantity("sinks", "displacement", "disc", "", "y"))


def punch(f):
    return (body("punch", rectangle([-1, 0], [1, 1], [6 * f, 3 * f]), STEEL,
                 '{ label = 3, ux = 0, uy = "-0.01*t" }')
            + body("ground", rectangle([-4, -4], [4, 0], [16 * f, 8 * f]), STEEL,
                   "{ label = 1, ux = 0, uy = 0 }")
            + contact("punch", 1, "ground", 3) + pressed("punch", "ground", 3)
            + quantity("sinks", "displacement", "ground", ", point = [0, 0]", "y") + STEP)


def rough(f):
    return (body("upper", rectangle([0, 1], [1, 2], [4 * f, 4 * f]), STEEL,
                 '{ label = 3, ux = "0.01*t", uy = "-0.02" }')
            + body("lower", rectangle([-0.5, 0], [1.5, 1], [7 * f, 4 * f]), STEEL,
                   "{ label = 1, ux = 0, uy = 0 }")
            + contact("upper", 1, "lower", 3, "friction = 0.3\n") + pressed("upper", "lower", 3)
            + quantity("shear", "reaction", "upper", ", label = 3", "x")
            + quantity("rub", "friction_work", "upper", ", label = 1")
            + "[time]\nend = 1\nsteps = 4\n")


def creeping_tube(f):
    ring = 'mesh = {{ shape = "annulus", inner = {}, outer = {}, span = "quarter", cells = [{}, {}] }}\n'
    flows = "material = { young = 1e5, poisson = 0.3, viscosity = 10, yield_stress = 1 }\n"
    return ('plane = "strain"\n'
            + body("liner", ring.format(1, 1.5, 6 * f, 3 * f), flows, "{ label = 3, uy = 0 }",
                   "{ label = 4, ux = 0 }", '{ label = 1, pressure = "1.2*min(t, 1)" }')
            + body("jacket", ring.format(1.5, 2, 8 * f, 3 * f), flows, "{ label = 3, uy = 0 }",
                   "{ label = 4, ux = 0 }")
            + contact("liner", 2, "jacket", 1, 'initial = "close"\n')
            + quantity("bore", "displacement", "liner", ", point = [1, 0]", "x")
            + quantity("held", "reaction", "liner", ", label = 3", "y")
            + quantity("pressure", "largest_pressure", "liner", ", label = 2")
            + quantity("heat", "dissipated_energy", "liner")
            + quantity("work", "work", "liner")
            + energies("liner", "jacket") + "[time]\nend = 5\nsteps = 10\n")


def flowing_beam(f):
    return (body("beam", rectangle([0, 0], [4, 1], [8 * f, 2 * f]), FLOWS,
                 "{ label = 4, ux = 0, uy = 0 }", '{ label = 2, uy = "-0.02*t" }')
            + quantity("held", "reaction", "beam", ", label = 4", "y")
            + quantity("middle", "displacement", "beam", ", point = [2, 0.5]", "y")
            + quantity("heat", "dissipated_energy", "beam")
            + energies("beam") + "[time]\nend = 1\nsteps = 20\n")


def creeping_beam(f):
    return flowing_beam(f).replace('uy = "-0.02*t"', 'ty = "-0.1"').replace(
        "viscosity = 10, yield_stress = 1",
        'law = "norton", reference_stress = 1, reference_rate = 1e-2, exponent = 4')


def run(text, folder, name):
    """The quantities of a run."""
    (folder / f"{name}.toml").write_text(text if "[check]" in text else text + ALLOW)
    done = mortier("run", folder / f"{name}.toml", "--out", folder / name, "--quiet")
    assert done.returncode == 0, f"{name}: {done.stderr.strip()}"
    return json.loads((folder / name / "summary.json").read_text())["quantities"]
