"""Materials: values out of range, and yield against load and steps."""
from seeded.case import ELASTIC, fault


@fault("poisson-limit", "poisson = 0.4999")
def _(case):
    case.replace("poisson = 0.3", "poisson = 0.4999")
    case.scene = "plane = \"strain\"\n" + case.scene.replace("mesh = ", "volume = \"pointwise\"\nmesh = ")


@fault("flow-locks", "viscosity = ")
def _(case):
    case.scene = ("plane = \"axisymmetric\"\n" +
                  case.scene.replace("mesh = ", "volume = \"pointwise\"\nmesh = "))


fault("poisson-negative", "poisson = -0.3")(lambda case: case.replace("poisson = 0.3", "poisson = -0.3"))
fault("projection-unused", "projection = ", ELASTIC)(
    lambda case: case.replace("poisson = 0.3", "poisson = 0.3, projection = \"elasticity\""))
fault("large-strain", "young = 70", ELASTIC)(lambda case: case.replace("young = 3e11", "young = 70", 2))
fault("yield-over-young", "yield_stress = 2e11")(
    lambda case: case.replace("yield_stress = 1", "yield_stress = 2e11"))
fault("never-yields", "yield_stress = 1e6")(
    lambda case: case.replace("yield_stress = 1", "yield_stress = 1e6"))
fault("yields-at-once", "steps = ")(lambda case: case.replace("-10*t", "-1000*t"))
fault("few-steps-across-yield", "steps = ")(lambda case: case.replace("steps = 100", "steps = 5"))
fault("viscosity-large", "viscosity = 1e16")(lambda case: case.replace("viscosity = 10", "viscosity = 1e16"))
fault("viscosity-small", "viscosity = 1e-6")(lambda case: case.replace("viscosity = 10", "viscosity = 1e-6"))


@fault("scheme-rings", "scheme = ")
def _(case):
    case.scene += 'scheme = "crank-nicolson"\n'
