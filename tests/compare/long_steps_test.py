"""Steps that are 1e8 relaxation times long, of bodies that flow at constant volume: Newton's method ends."""
import math
import unittest

from scene_parts import body, box, contact, quantity, timed
from support import InFolder, value

YIELD, VISCOSITY, LOAD, STEPS, END = 0.1, 10, math.pi / 10, 2, 1 / 30
FLOWS = f"viscosity = {VISCOSITY}, yield_stress = {YIELD}"
LAWS = {
    "viscoplastic": f'law = "viscoplastic", {FLOWS}',
    "Perzyna": FLOWS,
    "hardening": f'law = "viscoplastic", {FLOWS}, isotropic_hardening = 1',
    "Norton": 'law = "norton", reference_stress = 1, reference_rate = 0.01, exponent = 3',
}


def scene(plane, law, scheme):
    material = f"young = 3e11, poisson = 0.3, {law}"
    return (f'plane = "{plane}"\n'
            + body("upper", box([0, 0], [1, 1], 6, cut="both"), material, "label = 4, ux = 0",
                   f"label = 3, ty = {-LOAD}")
            + body("lower", box([0, -1], [1, 0], 16, cut="both"), material, "label = 4, ux = 0",
                   "label = 1, uy = 0")
            + contact(("upper", 1), ("lower", 3), variant="mortar", swap=True)
            + quantity("top", "displacement", "upper", 3, "y") + timed(STEPS, END, scheme=scheme))


class LongSteps(InFolder):
    def solve(self, **choices):
        law = LAWS[choices.pop("law")]
        summary = self.run_it(scene(law=law, **choices), folder=f"out{len(self.names())}")
        self.assertNotIn("cut", summary["rungs"], choices)
        return summary

    def test_in_plane_strain(self):
        """Uniform: 2 eps' = -sqrt(3) (sqrt(3)/2 s - sigma_Y)/(3 viscosity), once s33 has relaxed to s22/2."""
        rate = math.sqrt(3) / 2 * (math.sqrt(3) / 2 * LOAD - YIELD) / (3 * VISCOSITY)
        for scheme in ("backward-euler", "sdirk2", "crank-nicolson"):
            for law in LAWS:
                summary = self.solve(plane="strain", law=law, scheme=scheme)
                self.assertLessEqual(summary["newton_iterations"], 25, (law, scheme))
                if law in ("viscoplastic", "Perzyna") and scheme == "backward-euler":
                    self.assertAlmostEqual(value(summary, "top") / (-2 * rate * END), 1, delta=1e-6)

    def test_about_an_axis(self):
        for scheme in ("backward-euler", "crank-nicolson"):
            summary = self.solve(plane="axisymmetric", law="viscoplastic", scheme=scheme)
            self.assertLessEqual(summary["newton_iterations"], 150, scheme)


if __name__ == "__main__":
    unittest.main()
