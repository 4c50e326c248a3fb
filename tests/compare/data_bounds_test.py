"""Bounds of scenes whose data are not linear on sides, or constant on triangles (data_bounds.py)."""
import statistics
import unittest

import data_bounds
from scene_parts import body, box, contact, quantity, timed
from support import PROGRAM, InFolder


class DataBounds(InFolder):
    def bound(self, top, more=(), data="", distance=None, bottom="0", settings=()):
        self.write(body("u", box([0, 0], [1, 1], [2, 2]), 1, f"label = 3, {top}", "label = 4, ux = 0", *more,
                        more=data + "\n")
                   + body("l", box([0, -1], [1, 0], [4, 4]), "young = 2, poisson = 0.2",
                          f'label = 1, ux = 0, uy = "{bottom}"')
                   + contact(("u", 1), ("l", 3), gap=distance) + timed() + "[accuracy]\nbound = true\n"
                   + quantity("f", "contact_force", "l", 3, "y"))
        self.mortier("run", "scene.toml", "--quiet", "--out", "out", *settings)
        summary = self.summary_of()
        return summary["accuracy"]["bound"], summary["quantities"]["f"]

    def test_what_lies_between_the_nodes_is_in_the_bound(self):
        # True errors, and the force, of meshes 32 times finer.
        for least, given in (
                (0.66, dict(top='ty = "-0.01*t*(1 + 5*sin(8*pi*x))"')),
                (0.166, dict(top='ux = 0, uy = "-0.02*t"', distance="0.002*sin(4*pi*x)")),
                (0.36, dict(top='ty = "-0.01*t"', more=("label = 2, ux = 0",),
                            data='initial_stress = { s11 = "-0.1*cos(pi*y)", s22 = 0, s12 = 0 }')),
                (0.99, dict(top='uy = "t*(-10 - 0.01*sin(4*pi*x))"', bottom="-10*t + 0.001*t"))):
            with self.subTest(least=least):
                bound, _ = self.bound(**given)
                self.assertNotIn("reason", bound)
                self.assertTrue(bound["energy_error"] is None or bound["energy_error"] > least, bound)
        bound, force = self.bound('uy = "-0.02*t"', distance="0.01*x^2")
        self.assertTrue(force["bound"]["lower"] < -0.01113 < force["bound"]["upper"], force)
        self.assertLess(force["bound"]["error"], 0.1 * abs(force["value"]))

    def test_body_forces_that_vary(self):
        # The force below is known: that of the traction and of the mean of the body force.
        for mean, x, y in ((0.01, "0", "-0.01*t"), (0.015, "0", "-0.01*t*(1 + y)"),
                           (0.015, "0", "-0.01*t*(1 + x)"), (0.01 / 3, "0.02*t*y^2", "-0.01*t*x^2"),
                           (0.02 / 3.14159265358979, "0.01*t*cos(pi*y)", "-0.01*t*sin(pi*x)"),
                           (0, "-0.01*t*(y - 0.5)", "0.01*t*(x - 0.5)")):
            for plane in ("stress", "strain"):
                with self.subTest(x=x, y=y, plane=plane):
                    bound, force = self.bound('ty = "-0.01*t"', data=f'force = {{ x = "{x}", y = "{y}" }}',
                                              settings=("--set", f"plane={plane}"))
                    self.assertTrue(0 < bound["energy_error"] < 0.6, bound)
                    self.assertLess(force["bound"]["lower"], -0.01 - mean + 1e-12)
                    self.assertGreater(force["bound"]["upper"], -0.01 - mean - 1e-12)
                    self.assertAlmostEqual(force["bound"]["lower"], -0.01 - mean, delta=1e-7)
                    self.assertAlmostEqual(force["bound"]["upper"], -0.01 - mean, delta=1e-7)

    def test_rounds_end_when_the_data_are_small_too(self):
        bound, _ = self.bound('ty = "-0.01*t*(1 + 5*sin(8*pi*x))"',
                              settings=("--set", "accuracy.energy=0.2"))
        self.assertLess(bound["energy_error"], 0.2)

    def test_what_cannot_be_bounded_is_named(self):
        for reason, given in (
                ("not known to be continuous", dict(top='uy = "x < 0.3 ? -0.01*t : -0.02*t"')),
                ("gap is not known to be continuous", dict(top='uy = "-0.02*t"',
                                                           distance="x < 0.3 ? 0 : 0.001"))):
            bound, _ = self.bound(**given)
            self.assertIn(reason, bound["reason"])

    def test_random_scenes(self):
        enclosed = 0
        for kind, count, most in (("linear", 3, 1.6), ("natural", 6, 1.6), ("hostile", 3, 4)):
            ratios = []
            for number in range(count):
                with self.subTest(kind=kind, number=number):
                    faults, ratio, quantities = data_bounds.measured(PROGRAM, kind, number, 4)
                    self.assertEqual(faults, [])
                    enclosed += quantities
                    ratios += [] if ratio is None else [ratio]
            print(kind, statistics.median(ratios))
            self.assertGreater(len(ratios), count // 2)
            self.assertLess(statistics.median(ratios), most)
        self.assertGreater(enclosed, 40)


if __name__ == "__main__":
    unittest.main()
