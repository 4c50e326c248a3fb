"""Friction work in 16 steps and the energy of each step: some scenes of friction_works.py."""
import unittest

import friction_works
from support import PROGRAM


class FrictionWorks(unittest.TestCase):
    def test_works_are_right_and_steps_keep_the_energy(self):
        for seed in (4, 5, 6, 7, 10, 36, 41):
            with self.subTest(seed=seed):
                self.assertEqual(friction_works.examined(PROGRAM, seed)[1], [])


if __name__ == "__main__":
    unittest.main()
