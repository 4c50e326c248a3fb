"""Contact: sides that do not face each other, and conditions that contradict it."""
import math

from seeded.case import ELASTIC, THIRD, Mesh, fault


fault("contact-line", "scene.toml:24")(
    lambda case: case.upper.relabel(lambda x, y, label: 5 if y == 0 and 0.3 < x < 0.6 else label))


@fault("contact-labels-swapped", "[contact]")
def _(case):
    case.replace('body = "upper", label = 1', 'body = "upper", label = 3')
    case.replace('body = "lower", label = 3', 'body = "lower", label = 1')


fault("contact-normals", "[contact]")(
    lambda case: case.replace('body = "lower", label = 3', 'body = "lower", label = 1'))
fault("contact-not-facing", "[contact]")(
    lambda case: case.replace('body = "lower", label = 3', 'body = "lower", label = 2'))
fault("contact-no-overlap", "[contact]")(lambda case: case.lower.move(lambda x, y: (x + 1.5, y)))
fault("contact-penetration", "[contact]")(lambda case: case.lower.move(lambda x, y: (x, y + 0.05)))
fault("contact-overlap", "[contact]")(lambda case: case.lower.move(lambda x, y: (x + 0.8, y)))


# Meshes of one cosine: no circle.
@fault("contact-polygon", "[contact]")
def _(case):
    case.scene = ELASTIC
    for mesh in (case.upper, case.lower):
        mesh.move(lambda x, y: (x, y + 0.2 * math.cos(3 * x)))


fault("gap-large", "[contact]")(lambda case: case.lower.move(lambda x, y: (x, y - 5)))


@fault("contact-slides", "[contact]")
def _(case):
    case.replace("label = 4\nux = 0\n[[body.boundary]]\nlabel = 3", 'label = 4\nux = "0.15*t"\n'
                 "[[body.boundary]]\nlabel = 3")


# A ring between two blocks, held by a point that it may turn about its centre with.
ROLLER = """\
[[body]]
name = "roller"
mesh = { shape = "annulus", centre = [0, 1], inner = 0.5, outer = 1, cells = [32, 4] }
material = { young = 1e3, poisson = 0.3 }
point = [ { at = [0.5, 1], ux = 0 } ]
[[body]]
name = "table"
mesh = { shape = "rectangle", lower = [-1, -1], upper = [1, 0], cells = [16, 6] }
material = { young = 1e3, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = 0 } ]
[[body]]
name = "plate"
mesh = { shape = "rectangle", lower = [-1, 2], upper = [1, 2.5], cells = [16, 4] }
material = { young = 1e3, poisson = 0.3 }
boundary = [ { label = 3, ux = 0, uy = "-2e-2*t" } ]
[[contact]]
nonmortar = { body = "table", label = 3 }
mortar = { body = "roller", label = 2 }
[[contact]]
nonmortar = { body = "plate", label = 1 }
mortar = { body = "roller", label = 2 }
[time]
end = 1
steps = 1
"""


@fault("free-rotation", "scene.toml:1")
def _(case):
    case.scene = ROLLER


@fault("contact-side-twice", "mortar = { body = \"upper\", label = 1 }\nnonmortar")
def _(case):
    case.third = Mesh(1.5, -1, 2.5, 0, 8, 8)
    case.replace("[contact]", THIRD.replace("label = 1", "label = 2") + "[[contact]]")
    case.upper.move(lambda x, y: (2.5 * x, y))
    case.replace("[time]", "[[contact]]\nmortar = { body = \"upper\", label = 1 }\n"
                           "nonmortar = { body = \"third\", label = 3 }\n\n[time]")


@fault("contact-size-ratio", "[contact]")
def _(case):
    case.lower = Mesh(0, -1, 1, 0, 70, 20)


@fault("nonmortar-coarser", "scene.toml:24")
def _(case):
    case.lower = Mesh(0, -1, 1, 0, 32, 16)


fault("friction-large", "[contact]")(
    lambda case: case.replace("label = 3 }\n", "label = 3 }\nfriction = 1.2\n"))


@fault("interpolation-unmatched", "[contact]")
def _(case):
    case.replace("label = 3 }\n", "label = 3 }\nvariant = \"interpolation\"\n")
    case.replace("steps = 100", "steps = 101")


@fault("load-on-contact", "scene.toml:10")
def _(case):
    case.replace("label = 4\nux = 0\n", "label = 4\nux = 0\n[[body.boundary]]\nlabel = 1\nty = \"-t\"\n")


@fault("support-on-contact", "scene.toml:10")
def _(case):
    case.replace("label = 4\nux = 0\n", "label = 4\nux = 0\n[[body.boundary]]\nlabel = 1\nux = 0\n")


@fault("contact-meets-support", "scene.toml:8")
def _(case):
    case.replace("ux = 0", "ux = 0\nuy = 0")
    case.replace("label = 3 }\n", "label = 3 }\nvariant = \"interpolation\"\n")


@fault("memory", "[contact]")
def _(case):
    case.upper = Mesh(0, 0, 14000, 1, 14000, 1)
    case.lower = Mesh(0, -1, 14000, 0, 14000, 1)
    case.replace("label = 3 }\n", "label = 3 }\nfriction = 0.3\n")
    case.limit = 4 << 30


# Supports that press the blocks into each other, by an eighth of their heights.
fault("large-strain", "[contact]", ELASTIC)(
    lambda case: case.replace("label = 3\nty = -10", 'label = 3\nuy = "-0.25*t"'))
# A side that is turned by six degrees.
fault("large-rotation", 'uy = "0.11', ELASTIC)(
    lambda case: case.replace("label = 3\nty = -10", 'label = 3\nuy = "0.11*x*t-0.05*t"'))
