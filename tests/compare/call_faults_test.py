"""Whatever call to the file system fails or is the last one: nothing is lost (a part of call_sweep.py, which tries all)."""
import tempfile
import unittest

from call_sweep import Sweep

EVERY = 89


class CallFaults(unittest.TestCase):
    def test_every_so_many_calls(self):
        with tempfile.TemporaryDirectory() as folder:
            sweep = Sweep(folder)
            self.assertGreater(sweep.explore(1, EVERY), 60)
            self.assertEqual(sweep.findings, [])


if __name__ == "__main__":
    unittest.main()
