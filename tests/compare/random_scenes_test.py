"""A part of the random scenes: every one ends soon, with a result or with the motion that nothing holds."""
import unittest

from random_scenes import Scene, explore
from support import PROGRAM

FIRST, COUNT = 176, 58
# A body that was moved before the first step and is free of stress.
MOVED = 30
# Crank-Nicolson rings at 1e4 yield stresses: the interior point method must begin beyond them.
RINGING = 287
# The error of a step is told too large until it is as short as time resolves,
# where rounding makes it a little longer.
SHORTEST = 275
SECONDS = 10


class RandomScenes(unittest.TestCase):
    def test_every_scene_ends_with_a_result_or_an_unheld_motion(self):
        results = explore(PROGRAM, FIRST, COUNT, SECONDS)
        for seed in (MOVED, RINGING, SHORTEST):
            results += explore(PROGRAM, seed, 1, SECONDS)
        for result in results:
            with self.subTest(seed=result["seed"]):
                self.assertIn(result["code"], (0, 3), result["told"])
                if result["code"] == 3:
                    self.assertEqual(result["classes"]["held by contact alone"], "yes")
                    self.assertRegex(result["told"], "contact cannot hold|nothing holds")
        self.assertGreater(sum(result["code"] == 0 for result in results), COUNT * 3 // 4)

    def test_scenes_do_not_depend_on_what_was_made_before(self):
        first = Scene(7)
        Scene(8)
        again = Scene(7)
        self.assertEqual((first.text, first.meshes, first.classes), (again.text, again.meshes, again.classes))


if __name__ == "__main__":
    unittest.main()
