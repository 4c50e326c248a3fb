"""Supports at points: what they hold, what they carry, and places that are no vertex."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))

import support  # noqa: E402
from scene_parts import body, box, quantity, timed  # noqa: E402

# A block of 2 by 1 that shear on all sides and a pressure at its ends load; both balance.
FREE = (body("block", box([0, 0], [2, 1], [4, 2], cut="both"), 100, "label = 1, tx = -2", "label = 3, tx = 2",
             'label = 2, ty = 2, tx = "y*(1-y)"', 'label = 4, ty = -2, tx = "-y*(1-y)"', more="POINTS\n")
        + timed())
AT_THE_BASE = """\
[[body.point]]
at = [0, 0]
ux = 0
uy = 0
[[body.point]]
at = [2, 0]
uy = 0
"""
QUANTITIES = (quantity("left", "reaction", "block", component="y", point=[0, 0])
              + quantity("right", "reaction", "block", component="y", point=[2, 0])
              + quantity("turns", "reaction", "block", component="moment", point=[2, 0]))


class Points(support.OfTwoBlocks):
    def solve(self, points, *settings, more="", code=0):
        self.write(FREE.replace("POINTS", points) + more)
        run = self.mortier("run", "scene.toml", "--out", "out", "--set", "output.every=1", *settings,
                           code=code)
        return run, self.summary_of(f"out{'.failed' if code else ''}")

    def test_the_free_motion_of_two_held_components_is_named(self):
        self.write(FREE.replace("POINTS", "[[body.point]]\nat = [2, 1]\nux = 0\nuy = 0\n"))
        for command in (("run", "scene.toml", "--quiet"), ("check", "scene.toml")):
            done = support.mortier(*command, cwd=self.folder)
            self.assertEqual(done.returncode, 3)
            self.assertIn("rotation about (2, 1)", done.stdout + done.stderr)

    def test_three_motions_hold_a_balanced_body_and_carry_nothing(self):
        for degree in (1, 2):
            run, summary = self.solve(AT_THE_BASE, f"degree={degree}", more=QUANTITIES)
            for quantity in summary["quantities"].values():
                self.assertLessEqual(abs(quantity["value"]), 1e-13)
            self.assertEqual(summary["accuracy"]["not_reliable"], [])
            self.assertIn("held at the points [0, 0], [2, 0]", self.mortier("check", "scene.toml").stdout)

    def test_reactions_at_points_balance_a_load_and_are_named(self):
        run, summary = self.solve(AT_THE_BASE, "body.block.force={y=-3}", more=QUANTITIES)
        values = {name: quantity["value"] for name, quantity in summary["quantities"].items()}
        for name, value in {"left": 3, "right": 3, "turns": 6}.items():
            self.assertAlmostEqual(values[name], value, delta=1e-12)
        doubts = summary["accuracy"]["not_reliable"]
        self.assertEqual([line for line in doubts if "is held at [0, 0] by a force of 3 N/m" in line],
                         doubts[:1])
        self.assertEqual(len(doubts), 2)
        self.assertIn("is held at [2, 0] by a force of 3 N/m", " ".join(run.stdout.split()))

    def test_points_move_as_prescribed(self):
        self.solve(AT_THE_BASE.replace("uy = 0\n", 'uy = "0.25*t*(1+x)"\n'),
                   more=quantity("moves", "displacement", "block", component="y", point=[2, 0]))
        rows = self.rows_of("out/history.csv")
        self.assertEqual(float(rows[-1]["moves[m]"]), 0.75)

    def test_a_point_is_a_vertex_to_a_thousandth_of_the_edges(self):
        self.solve(AT_THE_BASE.replace("[2, 0]", "[1.9999, 1e-4]"))
        for at, message in (("[1.999, 0]", "the nearest one is at [2, 0], 0.001 away"),
                            ("[2.2, 0.1]", "the nearest one is at [2, 0], 0.224 away")):
            self.write(FREE.replace("POINTS", AT_THE_BASE.replace("[2, 0]", at)))
            done = self.mortier("run", "scene.toml", "--quiet", code=2)
            self.assertIn(f"scene.toml:11: body block: point = {at}, expected a vertex of ", done.stderr)
            self.assertIn(message, done.stderr)
            checked = support.mortier("check", "scene.toml", cwd=self.folder)
            self.assertEqual(checked.returncode, 2)
            self.assertIn("[missing-point]", checked.stdout)

    def test_what_is_wrong_is_one_line(self):
        for points, message in (
                ("[[body.point]]\nux = 0\n", "body block: at is missing"),
                ("[[body.point]]\nat = [0, 0]\n", "point [0, 0] has no condition, expected one of ux, uy"),
                ("[[body.point]]\nat = [0, 0]\nun = 0\n", "un"),
                (AT_THE_BASE + "[[body.point]]\nat = [2, 0]\nuy = 1\n",
                 "expected one condition for component y of point [2, 0], there is one at scene.toml:"),
                (AT_THE_BASE + "[[body.point]]\nat = [2, 1e-5]\nuy = 1\n",
                 "expected the 0 that point [2, 0] prescribes there")):
            with self.subTest(message):
                self.write(FREE.replace("POINTS", points))
                errors = self.mortier("run", "scene.toml", "--quiet", code=2).stderr
                self.assertIn(message, errors)
                self.assertEqual(errors.count("\n"), 1)
        self.write(FREE.replace("POINTS", AT_THE_BASE) + QUANTITIES.replace("[2, 0]", "[2, 1]"))
        self.assertIn("quantity right: point [2, 1] of body block has no prescribed displacement",
                      self.mortier("run", "scene.toml", "--quiet", code=2).stderr)

    def test_rounds_keep_the_vertices(self):
        run, summary = self.solve(AT_THE_BASE, "accuracy.energy=0.1", more=QUANTITIES)
        self.assertTrue(summary["accuracy"]["reached"])
        self.assertGreater(len(summary["rounds"]), 1)
        for quantity in summary["quantities"].values():
            self.assertLessEqual(abs(quantity["value"]), 1e-12)

    def test_there_is_no_guaranteed_bound(self):
        run, summary = self.solve(AT_THE_BASE, "accuracy.bound=true")
        self.assertIn("no guaranteed bound: block is held at a point", run.stdout)


if __name__ == "__main__":
    unittest.main()
