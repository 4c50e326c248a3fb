"""Loads and supports that are not finite at some time inside a run are named, with point and time."""
import json
import math
import unittest

from scene_parts import body, shape, timed, written
from scenes import TWO_BLOCKS
from support import InFolder, OfTwoBlocks



class DataInTime(OfTwoBlocks):
    def undefined(self, begin, end, datum="ty", time="steps = 25"):
        """A scene whose datum is not finite between two times."""
        value = f'"-1e-11*t*(t > {begin} && t < {end} ? 1/(t - t) : 1)"'
        text = TWO_BLOCKS.replace('ty = "-10*t"', f"{datum} = {value}").replace("steps = 4", time)
        self.write(text)

    def failed(self, datum, time):
        """The run ends with the datum and the time; the states before are kept."""
        errors = self.mortier("run", "scene.toml", "--out", "out", code=1).stderr
        for part in (f"body upper: {datum} = ", "expected a finite number, is -inf at x = ", f"t = {time}"):
            self.assertIn(part, errors.splitlines()[-1])
        return json.loads((self.folder / "out.failed" / "summary.json").read_text())

    def test_equal_steps_end_before_it(self):
        for datum in ("ty", "uy"):
            with self.subTest(datum):
                self.undefined(0.26, 0.3, datum)
                summary = self.failed(datum, 0.28)
                self.assertEqual(summary["steps"], 6)
                self.assertLess(summary["newton_iterations"], 100)

    def test_before_a_run_whose_steps_are_chosen_by_their_error(self):
        for scheme in ("backward-euler", "sdirk2"):
            self.undefined(0.7375, 0.7475, time=f'scheme = "{scheme}"\ntolerance = 1e-2')
            self.reject("scene.toml:12: body upper: ty = ", "run", "scene.toml", "--out", "out")

    def test_between_the_samples_of_such_a_run(self):
        """The first stage of sdirk2 lies at 0.2929 of the first step, 1/4000."""
        self.undefined(7e-5, 8e-5, time='steps = 4000\nscheme = "sdirk2"\ntolerance = 1e-2')
        self.assertLess(self.failed("ty", "7.32233047033631")["newton_iterations"], 100)

    def test_a_tolerance_that_is_not_reached(self):
        """The top jumps, and the stress relaxes in less than doubles tell two times apart by."""
        text = TWO_BLOCKS.replace('ty = "-10*t"', 'uy = "t < 0.5 ? 0 : -1e-12"')
        text = text.replace("young = 3e11", "young = 3e15")
        self.write(text.replace("steps = 4", 'scheme = "sdirk2"\ntolerance = 1e-3'))
        done = self.mortier("run", "scene.toml", "--out", "out", code=1)
        why = r"estimated error \S+ above tolerance 0.001 after \d trial"
        self.assertRegex(done.stderr.splitlines()[-1],
                         rf"scene.toml: time.tolerance 0.001 not reached: {why}.*; "
                         "the last result is in out$")
        self.assertIn("(tolerance 0.001, not reached)", done.stdout)
        self.assertEqual(self.names("."), ["lower.mesh", "out", "scene.toml", "upper.mesh"])
        summary = self.summary_of()
        self.assertEqual(summary["status"], "converged")
        self.assertRegex(summary["reason"], why)
        self.assertFalse(summary["accuracy"]["time_reached"])
        self.assertGreater(summary["accuracy"]["time"], 1e-3)

    def test_a_tolerance_that_is_reached(self):
        summary = self.run_it(TWO_BLOCKS.replace("steps = 4", 'scheme = "sdirk2"\ntolerance = 1e-3'))
        self.assertTrue(summary["accuracy"]["time_reached"])
        self.assertNotIn("reason", summary)


class OneDisplacement(InFolder):
    def turned(self, angle, off=0.0):
        """A square turned by `angle`: its left side rolls, its top is moved along it by a course that passes
        zero."""
        c, s = math.cos(angle), math.sin(angle)
        corners = [[c*x - s*y, s*x + c*y] for x, y in ((0, 0), (1, 0), (1, 1.1), (0, 1.1))]
        course = (0.0, 6e-4, -3e-4, 1.8e-4)
        ux, uy = (written({"time": [0, 0.3, 0.6, 1], "value": values})
                  for values in ([s*v + off*v for v in course], [-c*v for v in course]))
        self.write(body("a", shape("quadrilateral", cells=2, corners=corners), 1000, "label = 4, un = 0",
                        "label = 1, ux = 0, uy = 0", f"label = 3, ux = {ux}, uy = {uy}") + timed(2))

    def test_supports_agree_to_rounding_of_the_whole_course(self):
        for i in range(5):
            self.turned(0.1 + 0.7*i)
            self.mortier("run", "scene.toml", "--quiet", "--out", f"out{i}")

    def test_what_differs_is_refused(self):
        self.turned(0.1, 1e-6)
        self.assertIn("label 3", self.mortier("run", "scene.toml", "--out", "out", code=2).stderr)


if __name__ == "__main__":
    unittest.main()
