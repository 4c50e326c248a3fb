"""freefem/quick.edp, the note's test with interpolation in one short script, against the program."""
import re
import subprocess
import unittest

from support import ROOT, InFolder
from codes import FREEFEM

SCRIPT = ROOT / "freefem" / "quick.edp"
NUMBER = r"(-?[\d.]+(?:e-?\d+)?)"
ROUNDING = 1e-8  # the script stops Newton's method there


class QuickLook(InFolder):
    def test_it_finds_what_the_program_finds(self):
        done = subprocess.run([FREEFEM, "-nw", "-nw", "-ne", "-v", "0", str(SCRIPT), "-steps", "5"], cwd=ROOT,
                              capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout)
        least, largest = map(float, re.search(f"von Mises +{NUMBER} to {NUMBER} Pa", done.stdout).groups())
        top, = map(float, re.search(f"mean u2 {NUMBER} m", done.stdout).groups())
        force, = map(float, re.search(f"force {NUMBER} N/m", done.stdout).groups())
        self.mortier("run", ROOT / "scenes" / "compression.toml", "--out", "out", "--set", "time.steps=5",
                     "contact.variant=interpolation",
                     'quantity=[{name="top", displacement={body="upper", label=3}, component="y"}]')
        summary = self.summary_of()
        final = summary["final"]
        self.assertAlmostEqual(least / final["von_mises_min"], 1, delta=ROUNDING)
        self.assertAlmostEqual(largest / final["von_mises_max"], 1, delta=ROUNDING)
        self.assertAlmostEqual(force / final["contact_force"], 1, delta=ROUNDING)
        self.assertAlmostEqual(top / summary["quantities"]["top"]["value"], 1, delta=ROUNDING)

    def test_it_is_short(self):
        self.assertLessEqual(len(SCRIPT.read_text().splitlines()), 150)


if __name__ == "__main__":
    unittest.main()
