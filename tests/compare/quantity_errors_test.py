"""Errors of quantities as they are estimated on one mesh, against those on meshes of four times the cells."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bench"))

import quantity_errors as scenes  # noqa: E402
from support import InFolder  # noqa: E402


class QuantityErrors(InFolder):
    def of(self, make, degree=1):
        """Quantity -> estimated error, true one, and all of the summary."""
        texts = [f"degree = {degree}\n" + make(factor) for factor in (1, 4)]
        coarse, fine = (scenes.run(text, self.folder, name) for text, name in zip(texts, ("coarse", "fine")))
        return {name: (each["estimated_error"], abs(each["value"] - fine[name]["value"]), each)
                for name, each in coarse.items()}

    def test_they_are_about_the_true_ones(self):
        for make, degree, names in (
                (scenes.cantilever, 1, ("tip", "point", "energy_beam")),
                (scenes.lame, 2, ("bore", "outside")), (scenes.known_end, 1, ("sinks", "side")),
                (scenes.hertz, 2, ("press", "pressure")), (scenes.tool, 1, ("press",)),
                (scenes.pushed_tool, 1, ("sinks",)), (scenes.punch, 1, ("press", "contact", "sinks")),
                (scenes.rough, 1, ("press", "shear")), (scenes.creeping_beam, 1, ("middle",))):
            errors = self.of(make, degree)
            for name in names:
                with self.subTest(scene=make.__name__, degree=degree, quantity=name):
                    estimated, true, _ = errors[name]
                    self.assertGreater(estimated / true, 0.4)
                    # The error of stabilised contact is smaller than the estimate knows.
                    self.assertLess(estimated / true, 4 if make is scenes.hertz else 2.6)

    def test_what_equilibrium_alone_decides_has_none(self):
        for make, name in ((scenes.cantilever, "held"), (scenes.lame, "held"),
                           (scenes.pushed_tool, "contact")):
            estimated, _, each = self.of(make)[name]
            self.assertLess(estimated, 1e-10 * abs(each["value"]))

    def test_a_patch_has_none(self):
        self.assertEqual({name: error for name, (error, _, _) in self.of(scenes.patch).items()},
                         dict.fromkeys(("press", "contact", "pressure", "length", "energy_upper",
                                        "energy_lower", "mises"), 0))

    def test_where_stresses_are_unbounded_there_is_an_order(self):
        estimated, _, each = self.of(scenes.cantilever)["mises"]  # at the clamped end: sin^2 = ..., l = 0.758
        self.assertIsNone(estimated)
        self.assertAlmostEqual(each["unbounded_order"], 0.242, delta=0.002)
        self.assertEqual(each["no_estimate"], "stresses are unbounded there")
        self.assertNotIn("unbounded_order", self.of(scenes.lame)["mises"][2])
        estimated, _, each = self.of(scenes.punch)["pressure"]
        self.assertIsNone(estimated)
        self.assertIn("contact ends at a corner", each["no_estimate"])

    def test_sums_over_steps_have_none_and_it_is_said(self):
        estimated, _, each = self.of(scenes.creeping_tube)["heat"]
        self.assertIsNone(estimated)
        self.assertIn("summed over the steps", each["no_estimate"])


if __name__ == "__main__":
    unittest.main()
