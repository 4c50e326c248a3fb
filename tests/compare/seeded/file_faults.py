"""What cannot be read, or contradicts itself."""
from seeded.case import fault


@fault("scene", "scene.toml:4")
def _(case):
    case.replace("poisson = 0.3", "poisson = 0.6")


@fault("scene", "step = 100")
def _(case):
    case.replace("steps = 100", "step = 100")


@fault("same-body", "scene.toml:25")
def _(case):
    case.replace('body = "lower", label = 3', 'body = "upper", label = 3')


@fault("allow-unknown", "allow = ")
def _(case):
    case.scene += '[check]\nallow = ["slivers"]\n'


@fault("data", "ux = \"1 + x\"")
def _(case):
    case.replace("uy = 0", "uy = \"x\"\nux = \"1 + x\"")


@fault("data", 'ty = "')
def _(case):
    case.replace("-10*t", "-10*t/x")
