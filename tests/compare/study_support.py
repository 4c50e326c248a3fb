"""What the tests of mortier study share; its modules can be imported after this one."""
import csv
import os
import sys

from support import ROOT, InFolder, mortier

STUDIES = ROOT / "scenes" / "studies"
sys.path.insert(0, str(ROOT / "study"))

SPACE = f"""
scene = "{ROOT}/scenes/compression.toml"
[mesh]
upper = {{ kind = "crisscross", cells = [3, 6, 12], lower = [0, 0], upper = [1, 1] }}
lower = {{ kind = "crisscross", cells = [8, 16, 32], lower = [0, -1], upper = [1, 0] }}
[[error]]
quantity = "energy"
exact = {{ s11 = "0", s22 = "-10*t", s12 = "0" }}
[[sweep]]
variant = ["mortar", "interpolation"]
level = [0, 1, 2]
time.steps = 4
"""


class StudyTest(InFolder):
    def setUp(self):
        super().setUp()
        self.path, self.out = self.folder / "study.toml", self.folder / "out"

    def study(self, *options, code=0):
        """mortier study on the study of this test: what it prints. Its runs are those of the same program,
        whatever the environment names."""
        done = mortier("study", self.path, "--out", self.out, *options, cwd=self.folder, timeout=600,
                       env={**os.environ, "MORTIER": "no such program"})
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def rows(self):
        with open(self.out / "study.csv", newline="") as file:
            return list(csv.DictReader(file))
