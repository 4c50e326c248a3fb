"""A ball whose surface is held is pressed into a plastic body with hardening, in two large steps."""
import unittest

from support import InFolder

SCENE = """\
plane = "axisymmetric"
[[body]]
name = "ball"
mesh = { shape = "quarterdisc", radius = 0.6, core = 0.12, cells = 6, lowest = [0, 1] }
material = { young = 2e9, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = "-0.01*t" } ]
[[body]]
name = "body"
boundary = [ { label = 1, ux = 0, uy = 0 } ]
[body.mesh]
shape = "rectangle"
lower = [0, 0]
upper = [0.5641895835477563, 1]
cells = [12, 12]
cut = "both"
focus = [0, 1]
grading = [20, 40]
[body.material]
young = 2e5
poisson = 0.3
law = "viscoplastic"
yield_stress = 489.8979485566356
viscosity = 0
isotropic_hardening = 2331.002331002331
[contact]
nonmortar = { body = "body", label = 3 }
mortar = { body = "ball", label = 1 }
[time]
end = 1
steps = 2
[check]
allow = ["large-strain", "large-displacement", "stiffness-ratio"]
"""


class PressedBall(InFolder):
    def setUp(self):
        super().setUp()
        self.summary = self.run_it(SCENE)

    # Without a line search two steps are cut into ten, with 480 linear solves.
    def test_a_line_search_solves_both_steps(self):
        self.assertLess(self.summary["newton_iterations"], 200)
        self.assertEqual(self.summary["rungs"], {"newton": 2})

    # Over the energy of the ball, which is rounding, the error was 1e54.
    def test_the_error_of_a_body_without_stress_is_over_the_stress_of_all(self):
        bodies = self.summary["accuracy"]["bodies"]
        self.assertLess(bodies["ball"], bodies["body"])


if __name__ == "__main__":
    unittest.main()
