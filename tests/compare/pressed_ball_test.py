"""A ball whose surface is held is pressed into a plastic body with hardening, in two large steps."""
import unittest

from scene_parts import body, contact, shape, timed
from support import InFolder

SCENE = ('plane = "axisymmetric"\n'
         + body("ball", shape("quarterdisc", radius=0.6, core=0.12, cells=6, lowest=[0, 1]), 2e9,
                'label = 1, ux = 0, uy = "-0.01*t"')
         + '[[body]]\nname = "body"\nboundary = [ { label = 1, ux = 0, uy = 0 } ]\n[body.mesh]\n'
           'shape = "rectangle"\nlower = [0, 0]\nupper = [0.5641895835477563, 1]\ncells = [12, 12]\n'
           'cut = "both"\nfocus = [0, 1]\ngrading = [20, 40]\n[body.material]\nyoung = 2e5\n'
           'poisson = 0.3\nlaw = "viscoplastic"\nyield_stress = 489.8979485566356\nviscosity = 0\n'
           "isotropic_hardening = 2331.002331002331\n" + contact(("body", 3), ("ball", 1)) + timed(2)
         + '[check]\nallow = ["large-strain", "large-displacement", "stiffness-ratio"]\n')


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
