"""A part of the tools of pressed_tools.py: none is lost under the block, none ends without need."""
import unittest

from pressed_tools import examined
from support import PROGRAM

SEEDS = range(1, 16)


class PressedTools(unittest.TestCase):
    def test_tools_are_pressed_without_hidden_overlap(self):
        for seed in SEEDS:
            shown, faults = examined(PROGRAM, seed)
            with self.subTest(seed=seed, shown=shown):
                self.assertEqual(faults, [])


if __name__ == "__main__":
    unittest.main()
