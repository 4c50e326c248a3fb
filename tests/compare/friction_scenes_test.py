"""A part of the random scenes with friction: what another engine or the other side solves is solved."""
import unittest

from friction_scenes import explore
from support import PROGRAM

COUNT = 20
# A thin belt: Newton's method on sets comes nearer for more than 20 solves.
BELT = 236
# Rings that contact alone holds along x, the stiff one finer: a path of contact from the springs on.
RINGS = (247, 329)
# Thin soft rings: the rounding of forces opens gaps of 2e-8 of the length; of 1e-8 in one of six steps.
SOFT = (785, 982, 553)
SECONDS = 30


class FrictionScenes(unittest.TestCase):
    def test_what_can_be_solved_is_solved(self):
        results = explore(PROGRAM, 0, COUNT, SECONDS)
        for seed in (BELT, *RINGS, *SOFT):
            results += explore(PROGRAM, seed, 1, SECONDS)
        for result in results:
            with self.subTest(seed=result["seed"]):
                self.assertIn(result["code"], (0, 3), result["told"])


if __name__ == "__main__":
    unittest.main()
