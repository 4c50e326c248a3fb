"""Bodies that do not fit together, or that nothing holds."""
from seeded.case import THIRD, Mesh, fault


fault("extent-ratio", "mesh = \"upper.mesh\"")(
    lambda case: case.lower.move(lambda x, y: (1000 * x, 1000 * y)))
fault("stiffness-ratio", "scene.toml:4")(lambda case: case.replace("young = 3e11", "young = 3e8"))


@fault("bodies-overlap", ".mesh: vertex")
def _(case):
    case.scene = case.scene[:case.scene.index("[contact]")] + case.scene[case.scene.index("[time]"):]
    case.replace("label = 4\nux = 0", "label = 4\nux = 0\nuy = 0")
    case.upper.move(lambda x, y: (x, y - 0.4))


@fault("contact-missing", ".mesh: vertex")
def _(case):
    case.scene = case.scene[:case.scene.index("[contact]")] + case.scene[case.scene.index("[time]"):]
    case.replace("label = 4\nux = 0", "label = 4\nux = 0\nuy = 0")


fault("body-alone", "[[body]]\nname = \"third\"")(lambda case: case.replace("[contact]", THIRD + "[contact]"))
fault("unheld-body", "scene.toml")(lambda case: case.replace("label = 4\nux = 0", "label = 4\nty = 0"))
fault("unheld-body", "scene.toml")(lambda case: case.replace("uy = 0", "tx = 0"))


@fault("unheld-body", "scene.toml")
def _(case):
    """A part of its own that nothing holds."""
    part = Mesh(2, 0, 3, 1, 2, 2)
    part.relabel(lambda x, y, label: 9)
    case.upper.add(part)


@fault("unheld-body", "scene.toml")
def _(case):
    """Pulled off later in the run, over a gap that is open."""
    case.upper.move(lambda x, y: (x, y + 0.1))
    case.replace("-10*t", "20*t*(t - 0.5)")


@fault("unheld-body", "scene.toml")
def _(case):
    """Held by no contact that is closed: the upper block moves, and stays apart."""
    case.upper.move(lambda x, y: (x, y + 0.1 + 0.2 * abs(x - 0.5)))
    case.replace("label = 4\nux = 0", "label = 3\nuy = \"-0.01*t\"")
    case.replace("label = 3\nty = \"-10*t\"", "label = 4\nty = 0")
