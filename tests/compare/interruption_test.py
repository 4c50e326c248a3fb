"""Signals are acted on within one second of work, whatever a run is at: signals.py."""
import random
import unittest

from signals import Signals, cases
from support import InFolder


class Interruption(InFolder):
    def test_at_random_moments(self):
        """Between rounds and in them, ordering, factorising, in steps, bounds, meshing; plane and space."""
        signals, rng = Signals(self.folder, latest=5), random.Random(15790)
        for name in cases():
            signals.try_one(name, rng, restarts=name.startswith("steps") or name == "rounds, flow")
        self.assertEqual(signals.findings, [])
        self.assertGreater(sum("--restart" in told for _, _, told in signals.latencies), len(cases()) // 3)


if __name__ == "__main__":
    unittest.main()
