"""What cannot be read, or contradicts itself."""
from seeded.case import fault


fault("scene", "scene.toml:4")(lambda case: case.replace("poisson = 0.3", "poisson = 0.6"))
fault("scene", "step = 100")(lambda case: case.replace("steps = 100", "step = 100"))
fault("same-side", "scene.toml:25")(
    lambda case: case.replace('body = "lower", label = 3', 'body = "upper", label = 1'))


@fault("allow-unknown", "allow = ")
def _(case):
    case.scene += '[check]\nallow = ["slivers"]\n'


fault("data", "ux = \"1 + x\"")(lambda case: case.replace("uy = 0", "uy = \"x\"\nux = \"1 + x\""))
fault("data", 'ty = "')(lambda case: case.replace("-10*t", "-10*t/x"))


@fault("start", 'start = "."')
def _(case):
    case.raw["state"] = "of another program\n"
    case.scene = 'start = "."\n' + case.scene
