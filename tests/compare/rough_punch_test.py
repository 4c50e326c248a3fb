"""A rough rigid parabola on a half plane: the part of the contact that sticks is known (Spence 1975), and the
program finds the steps that it takes."""
import re
import subprocess
import sys
import unittest

from support import PROGRAM, ROOT


class RoughPunch(unittest.TestCase):
    def test_sticks_where_it_should(self):
        done = subprocess.run([sys.executable, ROOT / "bench/rough_punch.py", "--program", PROGRAM, "--cells",
                               "40", "--width", "100", "--tolerance", "0.1", "--equal", "1"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("c/a 0.7071", done.stdout)  # the shear stress leaving the pressure alone
        found = re.findall(r"(\d+) steps: c/a ([\d.]+), dissipated ([\d.]+)", done.stdout)
        (steps, chosen, work), (one, once, work_once) = [map(float, row) for row in found]
        self.assertAlmostEqual(chosen, 0.680, delta=0.014)
        self.assertEqual(one, 1)
        self.assertLess(once, 0.3)
        self.assertGreater(work_once, 10*work)
        self.assertLess(steps, 200)


if __name__ == "__main__":
    unittest.main()
