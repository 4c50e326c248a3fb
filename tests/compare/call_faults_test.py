"""Whatever call to the file system fails or is the last one:
nothing is lost (parts of the sweeps that try all)."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from call_sweep import Sweep

EVERY = 97


class CallFaults(unittest.TestCase):
    def test_every_so_many_calls(self):
        with tempfile.TemporaryDirectory() as folder:
            sweep = Sweep(folder)
            self.assertGreater(sweep.explore(1, EVERY), 60)
            self.assertEqual(sweep.findings, [])

    def test_a_lock_that_may_not_be_taken(self):
        """All of the calls with which a restart takes the stopped run, and a run anew takes it away."""
        for name, calls in (("restart over an old result", range(56, 66)),
                            ("anew instead of a restart", range(538, 560))):
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                sweep = Sweep(folder)
                done = [sweep.try_one(name, *sweep.cases[name], "EACCES", at) for at in calls]
                self.assertEqual(sweep.findings, [])
                self.assertGreater(sum("run.lock: cannot be read" in each.stderr for each in done), 3)

    def test_every_so_many_calls_of_studies(self):
        done = subprocess.run([sys.executable, Path(__file__).with_name("study_call_sweep.py"), "--part",
                               f"1/{EVERY}"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"[4-9]\d faults, 0 findings")


if __name__ == "__main__":
    unittest.main()
