"""Bodies that do not fit together, or that nothing holds."""
from seeded.case import THIRD, fault


@fault("extent-ratio", "mesh = \"upper.mesh\"")
def _(case):
    case.lower.move(lambda x, y: (1000 * x, 1000 * y))


@fault("stiffness-ratio", "scene.toml:4")
def _(case):
    case.replace("young = 3e11", "young = 3e8")


@fault("same-mesh", "scene.toml:14")
def _(case):
    case.replace("lower.mesh", "upper.mesh")
    case.replace("label = 3 }", "label = 1 }")


@fault("bodies-overlap", ".mesh: vertex")
def _(case):
    case.scene = case.scene[:case.scene.index("[contact]")] + case.scene[case.scene.index("[time]"):]
    case.replace("label = 4\nux = 0", "label = 4\nux = 0\nuy = 0")
    case.upper.move(lambda x, y: (x, y - 0.4))


@fault("contact-missing", ".mesh: vertex")
def _(case):
    case.scene = case.scene[:case.scene.index("[contact]")] + case.scene[case.scene.index("[time]"):]
    case.replace("label = 4\nux = 0", "label = 4\nux = 0\nuy = 0")


@fault("body-alone", "[[body]]\nname = \"third\"")
def _(case):
    case.replace("[contact]", THIRD + "[contact]")


@fault("unheld-body", "scene.toml")
def _(case):
    case.replace("label = 4\nux = 0", "label = 4\nty = 0")


@fault("unheld-body", "scene.toml")
def _(case):
    case.replace("uy = 0", "tx = 0")
