"""Options: output, tolerances, iterations."""
from seeded.case import fault


@fault("output-large", "every = ")
def _(case):
    case.scene += "[output]\nevery = 1\n"
    case.replace("steps = 100", "steps = 100000")


@fault("tolerance-loose", "tolerance = ")
def _(case):
    case.scene += "[solver]\ntolerance = 1e-3\n"
