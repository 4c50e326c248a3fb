"""Scenes whose every string is hostile: nothing runs, nothing is written outside (a part of
hostile_sweep.py)."""
import tempfile
import unittest

from hostile_sweep import Sweep


class Hostile(unittest.TestCase):
    def test_some_scenes(self):
        with tempfile.TemporaryDirectory() as folder:
            sweep = Sweep(folder)
            for seed in range(1000000, 1000040):
                sweep.try_one(seed, pictures=seed % 20 == 0)
        self.assertEqual(sweep.findings, [])
        for command in ("check", "run", "freefem", "study"):
            self.assertGreater(sweep.codes[command, 0], 5)


if __name__ == "__main__":
    unittest.main()
