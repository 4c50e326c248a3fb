"""The "+-" of values that are known, in two scenes of each kind of known_scenes.py."""
import unittest

import known_scenes
import known_values
from support import PROGRAM


class KnownValues(unittest.TestCase):
    def test_plus_minus_holds_what_it_says(self):
        found = []
        for seed in range(2 * len(known_scenes.KINDS)):
            values, message = known_values.values_of(PROGRAM, seed)
            self.assertEqual(message, "")
            found += values
        for text, right in known_values.judged(found, least_not_wide=0.95):
            with self.subTest(text):
                self.assertTrue(right, known_values.violations(found))


if __name__ == "__main__":
    unittest.main()
