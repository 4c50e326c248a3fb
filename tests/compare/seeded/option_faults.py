"""Options: output, tolerances, iterations."""
from seeded.case import fault


@fault("output-every", "every = ")
def _(case):
    case.scene += "[output]\nevery = 200\n"


@fault("output-large", "every = ")
def _(case):
    case.scene += "[output]\nevery = 1\n"
    case.replace("steps = 100", "steps = 100000")


@fault("tolerance-loose", "tolerance = ")
def _(case):
    case.scene += "[solver]\ntolerance = 1e-3\n"


@fault("tolerance-tight", "tolerance = ")
def _(case):
    case.scene += "[solver]\ntolerance = 1e-16\n"


@fault("iterations-few", "max_iterations = ")
def _(case):
    case.scene += "[solver]\nmax_iterations = 5\n"
