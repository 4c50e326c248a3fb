"""Rollers without friction may turn about their centre: they are solved where the loads do not turn them, by
both degrees alike, and the free rotation is named."""
import unittest

from seeded.contact_faults import ROLLER
from support import InFolder, warned

# The roller in a groove of 90 degrees, pressed down by its weight.
IN_GROOVE = """\
degree = DEGREE
[[body]]
name = "roller"
mesh = { shape = "annulus", centre = [0, 1.4142135623730951], inner = 0.5, outer = 1, cells = [40, 4] }
material = { young = 1e3, poisson = 0.3 }
force = { y = "-LOAD*t" }
[[body]]
name = "left"
mesh = { shape = "quadrilateral", corners = [[-2, 2], [-3, 1], [-1, -1], [0, 0]], cells = [6, 16] }
material = { young = 1e3, poisson = 0.3 }
boundary = [ { label = 2, ux = 0, uy = 0 } ]
[[body]]
name = "right"
mesh = { shape = "quadrilateral", corners = [[2, 2], [0, 0], [1, -1], [3, 1]], cells = [16, 6] }
material = { young = 1e3, poisson = 0.3 }
boundary = [ { label = 3, ux = 0, uy = 0 } ]
[[contact]]
nonmortar = { body = "left", label = 4 }
mortar = { body = "roller", label = 2 }
[[contact]]
nonmortar = { body = "right", label = 1 }
mortar = { body = "roller", label = 2 }
[[quantity]]
name = "sinks"
displacement = { body = "roller", label = 1 }
component = "y"
[[quantity]]
name = "force"
contact_force = { body = "roller", label = 2 }
component = "y"
[time]
end = 1
steps = 1
"""


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
