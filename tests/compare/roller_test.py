"""Rollers without friction may turn about their centre: they are solved where the loads do not turn them, by
both degrees alike, and the free rotation is named."""
import unittest

from seeded.contact_faults import ROLLER
from scene_parts import body, contact, quantity, shape, timed
from support import InFolder, warned

# The roller in a groove of 90 degrees, pressed down by its weight.
IN_GROOVE = ("degree = DEGREE\n"
             + body("roller",
                    shape("annulus", centre=[0, 1.4142135623730951], inner=0.5, outer=1, cells=[40, 4]), 1e3,
                    force={"y": "-LOAD*t"})
             + body("left",
                    shape("quadrilateral", corners=[[-2, 2], [-3, 1], [-1, -1], [0, 0]], cells=[6, 16]), 1e3,
                    "label = 2, ux = 0, uy = 0")
             + body("right", shape("quadrilateral", corners=[[2, 2], [0, 0], [1, -1], [3, 1]], cells=[16, 6]),
                    1e3, "label = 3, ux = 0, uy = 0") + contact(("left", 4), ("roller", 2))
             + contact(("right", 1), ("roller", 2)) + quantity("sinks", "displacement", "roller", 1, "y")
             + quantity("force", "contact_force", "roller", 2, "y") + timed())


class Roller(InFolder):
    def result(self, text):
        self.write(text)
        errors = self.mortier("run", "scene.toml", "--quiet", "--out", "out").stderr
        self.assertIn("free-rotation", warned(errors))
        return self.summary_of()

    def test_it_is_solved_and_named(self):
        force = []
        for degree in (1, 2):
            for load in (1e-5, 1):
                with self.subTest(degree=degree, load=load):
                    text = IN_GROOVE.replace("DEGREE", str(degree)).replace("LOAD", repr(load))
                    summary = self.result(text)
                    quantities = summary["quantities"]
                    self.assertLess(quantities["sinks"]["value"], 0)
                    force.append(quantities["force"]["value"]/load)
        for each in force:
            self.assertAlmostEqual(each/force[0], 1, delta=6e-3)  # the area of the polygon

    def test_between_plates(self):
        for degree in (1, 2):
            with self.subTest(degree=degree):
                summary = self.result(f"degree = {degree}\n" + ROLLER)
                self.assertGreater(summary["final"]["contact_force"], 0)

    def test_what_is_held_is_not_named(self):
        self.write(ROLLER.replace("ux = 0 } ]", "ux = 0, uy = 0 } ]"))
        self.assertNotIn("free-rotation", self.mortier("check", "scene.toml").stdout)


if __name__ == "__main__":
    unittest.main()
