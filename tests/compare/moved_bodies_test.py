"""Bodies that move before they touch: what rounding leaves of their motion is no stress, whatever the law."""
import unittest

from scene_parts import body, box, contact, shape, timed
from support import InFolder

# A round body above a block, at a distance of 2e-3 below which it moves by 3e-3.
ROUND = (body("block", box([0, 0], [1, 1], [4, 4], cut="both"), 2e9, "label = 1, ux = 0, uy = 0")
         + body("round", shape("halfdisc", radius=1, core=0.3, lowest=[0.5, 1], cells=3),
                "young = 1e9, poisson = 0.3LAW", 'label = 2, ux = 0, uy = "MOTION"')
         + contact(("round", 1), ("block", 3), sides=True, gap=2e-3) + timed(None, more="STEPS\n"))
LAWS = {
    "elastic": "",
    "maxwell": ', law = "maxwell", relaxation_time = 1',
    "fast maxwell": ', law = "maxwell", relaxation_time = 1e-6',
    "standard solid": ', law = "standard-solid", relaxation_time = 1, relaxed_fraction = 0.5',
    "norton": ', law = "norton", reference_stress = 1e6, reference_rate = 1e-3, exponent = 3',
    "expression": ', law = "expression", rate11 = "1e-9*(s11-s22/2)", rate22 = "1e-9*(s22-s11/2)", '
                  'rate12 = "1.5e-9*s12"',
    "perzyna": ", viscosity = 1e9, yield_stress = 1e6",
    "plasticity": ', law = "viscoplastic", viscosity = 0, yield_stress = 1e4, kinematic_hardening = 1e8',
}
STEPS = ("steps = 4", 'steps = 4\nscheme = "sdirk2"', 'tolerance = 0.01\nscheme = "sdirk2"')

# Two blocks that are drawn apart, held to each other by a shear stress of at most 1e6, pressed or not.
APART = (body("lower", box([0, 0], [1, 1], [4, 4], cut="both"), "young = 1e9, poisson = 0.3LAW",
              "label = 1, uy = 0", "label = 4, ux = 0")
         + body("upper", box([0, 1], [1, 2], [3, 3], cut="both"), "young = 1e9, poisson = 0.3LAW",
                "label = 4, ux = 0", 'label = 3, uy = "1e-4*t"')
         + contact(("lower", 3), ("upper", 1), sides=True, shear_limit=1e6) + timed(None, more="STEPS\n"))

# A disc that a line of rollers guides, on a plate that lies loose on a block: weighted gaps of a round line
# are not zero where it touches, so the disc falls by far more than anything is strained.
RESTING = (body("block", box([0, 0], [1, 2], [4, 4], cut="rising"), "young = 4e4, poisson = 0",
                "label = 1, uy = 0", "label = 4, ux = 0")
           + body("plate", box([0, 2], [1, 2.2], [3, 3], cut="both"), "young = 3e6, poisson = 0.2",
                  "label = 4, ux = 0", more='force.y = "-1.6e-4*t"\n')
           + body("disc", shape("halfdisc", radius=1, core=0.3, lowest=[0.5, 2.2], cells=3),
                  "young = 4e4, poisson = 0.49", "label = 2, ux = 0, DRIVE")
           + contact(("plate", 1), ("block", 3)) + contact(("disc", 1), ("plate", 3), variant="weighted")
           + timed(2))

# A plate between rough lines, on a block that its own stresses lift at t = 0, when no load acts yet.
LIFTED = ('plane = "strain"\n'
          + body("block", box([0, 0], [1, 1], [4, 3]), "young = 3e3, poisson = 0.49",
                 "label = 1, ux = 0, uy = 0", initial_stress={"s22": -1.8})
          + body("plate", box([0, 1], [1, 3], [2, 1]), "young = 3e5, poisson = 0.2")
          + body("press", box([0, 3], [1, 4], [4, 4]), "young = 3e3, poisson = 0.49", "label = 2, ux = 0",
                 'label = 3, ty = "-18*t"') + contact(("plate", 1), ("block", 3), sides=True, friction=0.3)
          + contact(("press", 1), ("plate", 3), sides=True, friction=0.3) + timed(2))


class MovedBodies(InFolder):
    def test_a_body_of_any_law_approaches_another_touches_and_leaves_it(self):
        for name, law in LAWS.items():
            for motion in ("-3e-3*t", "-3e-3*sin(pi*t)", "3e-3*t"):
                for steps in STEPS:
                    if name == "plasticity" and "tolerance" in steps:
                        continue  # refused: it has no rate at a given stress
                    with self.subTest(law=name, motion=motion, steps=steps):
                        text = ROUND.replace("LAW", law).replace("MOTION", motion).replace("STEPS", steps)
                        summary = self.run_it(text)
                        self.assertLess(summary["newton_iterations"], 450)
                        force = summary["peaks"]["contact_force"]["value"]
                        if motion.startswith("-"):
                            self.assertGreater(force, 1)
                        else:
                            self.assertEqual(force, 0)

    def test_friction_between_bodies_that_part_is_none(self):
        for law in ("elastic", "standard solid"):
            for steps in STEPS:
                with self.subTest(law=law, steps=steps):
                    summary = self.run_it(APART.replace("LAW", LAWS[law]).replace("STEPS", steps))
                    self.assertLess(summary["newton_iterations"], 200)
                    self.assertLess(summary["final"]["von_mises_max"], 1e-9)

    def test_a_disc_that_falls_far_rests_on_a_loose_plate(self):
        """The load over the modulus is 1e-12 of the fall."""
        for drive in ('uy = "-1e-6*t - 8.6e-4"', 'uy = "-1e-3*t"'):
            for degree in (1, 2):
                with self.subTest(drive=drive, degree=degree):
                    summary = self.run_it(RESTING.replace("DRIVE", drive), f"degree={degree}",
                                          'contact.0.variant="weighted"')
                    self.assertLess(summary["verification"]["force_balance"], 1e-11)
                    self.assertLess(summary["newton_iterations"], 30)

    def test_what_no_load_drives_at_the_start_is_not_called_unheld(self):
        self.assertEqual(self.run_it(LIFTED)["status"], "converged")


if __name__ == "__main__":
    unittest.main()
