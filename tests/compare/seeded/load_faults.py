"""Loads: none, too large, abrupt."""
from seeded.case import ELASTIC, fault


fault("no-load", "scene.toml:1")(lambda case: case.replace("\"-10*t\"", "0"))
fault("large-displacement", "uy = \"0.7*t\"")(lambda case: case.replace("uy = 0", "uy = \"0.7*t\""))
fault("initial-load", 'ty = "')(lambda case: case.replace("-10*t", "-5-5*t"))


@fault("load-on-support", "scene.toml:7")
def _(case):
    """Supports on the last edges to the left and right of one that carries a traction."""
    case.replace("[[body.boundary]]\nlabel = 4", "[[body.boundary]]\nlabel = 6\ntx = \"t\"\n"
                 "[[body.boundary]]\nlabel = 7\nux = 0\n[[body.boundary]]\nlabel = 4")
    case.upper.relabel(lambda x, y, label: label if y < 1 or not 0.3 < x < 0.9 else 6 if 0.5 < x
                       < 0.66 else 7)


fault("kink-between-steps", 'ty = "')(lambda case: case.replace("-10*t", "t < 0.123 ? -10*t : -1.23"))
fault("initial-stress", "scene.toml", ELASTIC)(
    lambda case: case.replace("poisson = 0.3 }", "poisson = 0.3 }\ninitial_stress = { s11 = 1 }"))


@fault("load-between-steps", "ty = \"-10")
def _(case):
    case.replace('"-10*t"', '"-10*t*(1.5+sin(100*pi*t))"')
    case.replace("steps = 100", "steps = 10")


fault("datum-unresolved", "ty = \"-10")(
    lambda case: case.replace('"-10*t"', '"-10*t*(2+sin(1e6*x)+sin(7e5*x))"'))
fault("datum-between-nodes", "ux = \"1e-14", ELASTIC)(
    lambda case: case.replace("ux = 0", 'ux = "1e-14*t*sin(20*pi*y)"'))
