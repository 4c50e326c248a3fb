"""A rough rigid parabola on a half plane: the part of the contact that sticks is known (Spence 1975), and the
program finds the steps that it takes."""
import os
import sys
import tempfile
import unittest
from pathlib import Path

from support import PROGRAM, ROOT

os.environ["MORTIER"] = PROGRAM
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "bench" / "hard")]
import hard  # noqa: E402
import known  # noqa: E402


class RoughPunch(unittest.TestCase):
    def test_sticks_where_it_should(self):
        (row,) = (row for row in hard.rows.ROWS if row.case == "Rough punch")
        with tempfile.TemporaryDirectory() as name:
            found = []
            for settings in ((), ("time={end=1, steps=1}",)):
                run, _ = known.solve(row, settings, Path(name) / str(len(found)))
                found.append((run.summary["steps"], row.read(run), run.summary["final"]["friction_work"]))
        (steps, chosen, work), (one, once, work_once) = found
        self.assertAlmostEqual(chosen, 0.680, delta=0.014)
        self.assertEqual(one, 1)
        self.assertLess(once, 0.3)
        self.assertGreater(work_once, 10*work)
        self.assertLess(steps, 200)


if __name__ == "__main__":
    unittest.main()
