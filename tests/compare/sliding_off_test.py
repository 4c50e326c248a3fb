"""Bodies that slide along each other: how far is measured, and a run ends where they slide off each other."""
import unittest

from scene_parts import body, box, timed
from support import InFolder, warned

# A block that is pressed onto a table as long as it, and pushed along it by half of that in ten steps.
PUSHED = ("degree = DEGREE\n"
          + body("table", box([0, -1], [1, 0], [5, 3]), 1e4, "label = 1, ux = 0, uy = 0")
          + body("block", '{ shape = "rectangle", lower = [FROM, 0], upper = [TO, 0.5], cells = [4, 2] }',
                 1e4, 'label = 3, ux = "0.5*t", uy = "-1e-2*t"')
          + '[contact]\nnonmortar = { body = "NONMORTAR", label = NEAR }\n'
            'mortar = { body = "MORTAR", label = FACING }\nVARIANT\n' + timed(10))


class SlidingOff(InFolder):
    def scene(self, degree=1, blockNonmortar=True, begin=0, end=1, variant=""):
        sides = (("NONMORTAR", "block"), ("NEAR", 1), ("MORTAR", "table"), ("FACING", 3))
        if not blockNonmortar:
            sides = (("NONMORTAR", "table"), ("NEAR", 3), ("MORTAR", "block"), ("FACING", 1))
        text = PUSHED
        for word, value in (*sides, ("DEGREE", degree), ("FROM", begin), ("TO", end), ("VARIANT", variant)):
            text = text.replace(word, str(value))
        self.write(text)

    def test_a_run_ends_where_a_node_passes_the_end(self):
        for degree in (1, 2):
            for blockNonmortar in (True, False):
                for variant in ("mortar", "weighted", "interpolation"):
                    with self.subTest(degree=degree, blockNonmortar=blockNonmortar, variant=variant):
                        self.scene(degree, blockNonmortar, variant=f'variant = "{variant}"')
                        done = self.mortier("run", "scene.toml", "--quiet", "--out", "out", code=1)
                        self.assertRegex(done.stderr, r"step [4-9] at t = 0\.[4-9]: .* slides by 0\.[1-4]\d*,"
                                         r" past the end of label \d of body \w+: .*contact\.sliding")
                        summary = self.summary_of("out.failed")
                        self.assertEqual(summary["status"], "failed")
                        self.assertIn("past the end", summary["reason"])
                        self.assertIn(summary["steps"], range(4, 10))

    def test_it_goes_on_where_that_is_allowed(self):
        self.scene(variant='sliding = "allow"')
        done = self.mortier("run", "scene.toml", "--out", "out")
        self.assertIn("bodies slide along each other by up to 2 edges at t = 1", done.stdout)
        summary = self.summary_of("out")
        self.assertAlmostEqual(summary["peaks"]["sliding"]["value"], 2, delta=0.01)
        sliding = summary["interfaces"][0]["sliding"]
        self.assertAlmostEqual(sliding["slip"], 0.5, delta=1e-2)
        self.assertAlmostEqual(sliding["edges"], 2, delta=1e-2)

    def test_a_short_block_stays_on_a_long_table(self):
        self.scene(begin=0.2, end=0.4, variant='variant = "mortar"')
        done = self.mortier("run", "scene.toml", "--out", "out")
        self.assertRegex(done.stdout, r"bodies slide along each other by up to (9\.9\d*|10(\.\d+)?) edges")

    def test_small_slips_are_silent(self):
        self.scene()
        done = self.mortier("run", "scene.toml", "--out", "out", "--set", "body.block.boundary.ux=1e-3*t")
        self.assertNotIn("slide", done.stdout)
        self.assertLess(self.summary_of("out")["interfaces"][0]["sliding"]["edges"], 0.01)

    def test_check_sees_what_supports_show(self):
        self.scene()
        done = self.mortier("check", "scene.toml")
        self.assertIn("contact-slides", warned(done.stderr) or done.stdout + done.stderr)
        self.assertIn("past its end", done.stdout + done.stderr)
        self.scene(begin=0.2, end=0.4, variant='variant = "mortar"')
        done = self.mortier("check", "scene.toml")
        self.assertRegex(done.stdout + done.stderr, "10 times the length of an edge")
        self.scene()
        done = self.mortier("check", "scene.toml", "--set", "body.block.boundary.ux=1e-3*t")
        self.assertNotIn("contact-slides", done.stdout + done.stderr)

    def test_the_key(self):
        self.scene(variant='sliding = "always"')
        self.assertIn('sliding = "always", expected refuse or allow'.split(",")[0],
                      self.mortier("run", "scene.toml", "--out", "out", code=2).stderr)


if __name__ == "__main__":
    unittest.main()
