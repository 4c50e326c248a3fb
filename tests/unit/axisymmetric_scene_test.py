"""Scenes of bodies of revolution: numbers of whole rings, and what is refused."""
import math
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))

import support  # noqa: E402
from scene_parts import body, box, contact, quantity, timed  # noqa: E402

# A tube of radii 1 and 2 between plates, and a disc on it.
TUBE = ('plane = "axisymmetric"\n'
        + body("tube", box([1, 0], [2, 1], 3, cut="both"), 100, "label = 1, uy = 0")
        + body("disc", box([0, 1], [2, 2], 4, cut="both"), 100, "label = 3, pressure = 2")
        + contact(("tube", 3), ("disc", 1)) + quantity("below", "reaction", "tube", 1, "y")
        + quantity("energy", "stored_energy", "disc") + timed())


class Axisymmetric(support.OfTwoBlocks):
    def test_forces_are_of_the_whole_ring(self):
        self.write(TUBE)
        self.mortier("run", "scene.toml")
        summary = self.summary_of("out/scene")
        self.assertEqual(summary["plane"], "axisymmetric")
        below = summary["quantities"]["below"]
        self.assertEqual(below["unit"], "N")
        self.assertAlmostEqual(below["value"], 2 * 4 * math.pi, delta=1e-10)
        self.assertEqual(summary["quantities"]["energy"]["unit"], "J")
        self.assertLess(summary["verification"]["force_balance"], 1e-13)
        last = self.rows_of("out/scene/history.csv")[-1]
        self.assertAlmostEqual(float(last["contact_force[N]"]), 2 * 4 * math.pi, delta=1e-10)
        self.assertIn("elastic_energy[J]", last)
        self.assertIn("whole rings", self.mortier("check", "scene.toml").stdout)

    def test_units_of_a_scene(self):
        self.write('units = "mm, N, MPa"\n' + TUBE)
        self.mortier("run", "scene.toml")
        header = self.read("out/scene/history.csv").splitlines()[0].split(",")
        self.assertIn("contact_force[N]", header)
        self.assertIn("elastic_energy[N mm]", header)

    def test_what_cannot_be_is_refused(self):
        self.refuse(TUBE.replace("lower = [0, 1]", "lower = [-1, 1]"), "expected x >= 0 beside plane")
        self.refuse(TUBE.replace('component = "y"', 'component = "moment"'), "have no moment")
        self.refuse(TUBE + "[accuracy]\nbound = true\n", "no bound is known of axisymmetric bodies")
        self.refuse(TUBE.replace("{ label = 3, pressure", "{ label = 4, ux = 1 }, { label = 3, pressure"),
                    "expected the 0 that the axis prescribes there")

    def test_a_roller_on_the_axis_is_no_contradiction(self):
        self.write(TUBE.replace("{ label = 3, pressure", "{ label = 4, un = 0 }, { label = 3, pressure"))
        self.mortier("run", "scene.toml")

    def test_only_the_motion_along_the_axis_is_free(self):
        scene = TUBE.replace("{ label = 1, uy = 0 }", "{ label = 4, pressure = 1 }")
        self.write(scene.replace('reaction = { body = "tube", label = 1 }',
                                 'contact_force = { body = "tube", label = 3 }'))
        result = self.mortier("run", "scene.toml", "--quiet", code=3)
        self.assertRegex(result.stderr, r"tube: translation along \(0, -?1\)[,;]")

    def test_rounds_reach_what_is_asked(self):
        self.write(TUBE)
        self.mortier("run", "scene.toml", "--accuracy", "0.05")
        accuracy = self.summary_of("out/scene")["accuracy"]
        self.assertTrue(accuracy["reached"])


if __name__ == "__main__":
    unittest.main()
