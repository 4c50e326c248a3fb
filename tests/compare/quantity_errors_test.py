"""Errors of quantities as they are estimated on one mesh, against those on meshes of four times the cells."""
import re
import unittest

import quantity_scenes as scenes
from scene_parts import body, box, quantity, timed
from support import InFolder


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
                    estimated, true, _ = errors[name]  # twice the estimate and 40 % of what cancels in it
                    self.assertGreater(estimated / true, 0.8)
                    # The error of stabilised contact is smaller than the estimate knows.
                    self.assertLess(estimated / true, 10 if make is scenes.hertz else 7)

    def test_heat_between_the_points_of_the_stress_is_in_it(self):
        """A bar between walls: the force is E alpha times the mean temperature, that of points is another."""
        def heated(f):
            return (body("bar", box([0, 0], [2, 1], [4 * f, 2 * f]),
                         "young = 1, poisson = 0.3, expansion = 1e-3", "label = 1, uy = 0",
                         "label = 2, ux = 0", "label = 4, ux = 0",
                         temperature="t*x*(2 - x)")
                    + quantity("wall", "reaction", "bar", 2, "x")
                    + quantity("top", "displacement", "bar", 3, "y") + timed())

        for name in ("wall", "top"):
            estimated, true, _ = self.of(heated)[name]
            self.assertGreater(true, 0)
            self.assertTrue(0.8 < estimated / true < 5.2, estimated / true)

    def test_what_equilibrium_alone_decides_has_none(self):
        for make, name in ((scenes.cantilever, "held"), (scenes.lame, "held"),
                           (scenes.pushed_tool, "contact")):
            estimated, _, each = self.of(make)[name]
            self.assertLess(estimated, 1e-10 * abs(each["value"]))

    def test_where_the_stress_is_not_known_values_have_none(self):
        """A disc on few cells: the stress is off by more than itself. Of the punch on as few it is not."""
        def coarse(text):
            text = re.sub(r"cells = \[(\d+), (\d+)\]", lambda at: "cells = [{}, {}]".format(
                *(max(1, int(each)//8) for each in at.groups())), text)
            return re.sub(r"cells = (\d+)", lambda at: f"cells = {max(2, int(at[1])//8)}", text)

        found = scenes.run(coarse(scenes.hertz(1)), self.folder, "hertz")
        for name in ("press", "contact", "sinks"):
            self.assertIsNone(found[name]["estimated_error"])
            self.assertRegex(found[name]["no_estimate"], r"the estimated error of the stress is \d{3} %")
        found = scenes.run(coarse(scenes.punch(1)), self.folder, "punch")
        self.assertGreater(found["press"]["estimated_error"], 0)

    def test_a_patch_has_none(self):
        self.assertEqual({name: error for name, (error, _, _) in self.of(scenes.patch).items()},
                         dict.fromkeys(("press", "contact", "pressure", "length", "energy_upper",
                                        "energy_lower", "mises"), 0))

    def test_where_stresses_are_unbounded_there_is_none(self):
        estimated, _, each = self.of(scenes.cantilever)["mises"]  # at the clamped end
        self.assertIsNone(estimated)
        self.assertIn("unbounded there, at a corner or an end of a support", each["no_estimate"])
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
