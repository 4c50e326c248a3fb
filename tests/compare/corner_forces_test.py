"""A part of the random corners of corner_forces.py: forces along the normal of the slope."""
import unittest

from corner_forces import examined
from support import PROGRAM

COUNT = 20


class CornerForces(unittest.TestCase):
    def test_forces_are_along_the_normal(self):
        for seed in range(1, COUNT + 1):
            shown, faults = examined(PROGRAM, seed)
            with self.subTest(seed=seed, shown=shown):
                self.assertEqual(faults, [])


if __name__ == "__main__":
    unittest.main()
