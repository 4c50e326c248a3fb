"""The cases in which the codes are compared: the note's test on every shared pair of meshes."""
import itertools
from dataclasses import dataclass

# name: nonmatching pairs, upper and lower; the third is unstructured, graded in opposite directions
PAIRS = {
    "6/16": ("upper-crisscross-6", "lower-crisscross-16"),
    "16/6": ("upper-crisscross-16", "lower-crisscross-6"),
    "7/11": ("upper-unstructured-7", "lower-unstructured-11"),
}
PROJECTIONS = ("elasticity", "frobenius", "compliance")
VARIANTS = ("mortar", "interpolation")
SIDES = ("upper", "lower")


@dataclass(frozen=True)
class Case:
    pair: str
    projection: str
    variant: str
    nonmortar: str
    steps: int

    def __str__(self):
        return f"{self.pair} {self.projection} {self.variant} nonmortar {self.nonmortar} N={self.steps}"

    @property
    def folder(self):
        return str(self).replace("/", "-").replace(" ", "_").replace("=", "")

    @property
    def settings(self):
        upper, lower = PAIRS[self.pair]
        swap = "true" if self.nonmortar == "lower" else "false"
        return [f"body.upper.mesh=shared-meshes/{upper}.mesh", f"body.lower.mesh=shared-meshes/{lower}.mesh",
                f"body.material.projection={self.projection}", f"contact.variant={self.variant}",
                f"contact.swap={swap}", f"time.steps={self.steps}"]


def all_cases():
    return [Case(*each) for each in itertools.product(PAIRS, PROJECTIONS, VARIANTS, SIDES, (20, 100))]


def quick_cases():
    """Every pair, projection, variant, side and N at least once."""
    return ([Case("6/16", *choice, "upper", 20) for choice in itertools.product(PROJECTIONS, VARIANTS)]
            + [Case("16/6", "frobenius", variant, "lower", 20) for variant in VARIANTS]
            + [Case("16/6", "elasticity", "interpolation", "upper", 20)]
            + [Case("7/11", "elasticity", variant, "upper", 20) for variant in VARIANTS]
            + [Case("7/11", "compliance", "interpolation", "lower", 20)]
            + [Case("6/16", "elasticity", variant, "upper", 100) for variant in VARIANTS]
            # step 10 has several solutions (docs/theory.md)
            + [Case("7/11", "elasticity", "interpolation", "upper", 100)])
