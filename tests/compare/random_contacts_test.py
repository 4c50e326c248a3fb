"""A part of the random scenes of contact whose results are known: each names its harness."""
import unittest

import corner_forces
import disc_pressures
import friction_scenes
import friction_works
import light_contacts
import metamorphic
import pressed_tools
import touching
from support import PROGRAM


class RandomContacts(unittest.TestCase):
    def examine(self, harness, seeds):
        for seed in seeds:
            with self.subTest(harness=harness.__name__, seed=seed):
                self.assertEqual(harness.examined(PROGRAM, seed)[1], [])

    def test_forces_of_corners_are_along_the_normal(self):
        self.examine(corner_forces, range(1, 21))

    def test_forces_are_those_of_the_scene_in_other_words(self):
        # 144: a part that faces by a corner alone, whose ends are held. The others: corners of the mortar
        # line whose other side faces nothing.
        self.examine(metamorphic, (1, 2, 3, 5, 6, 7, 9, 60, 101, 144, 218, 244))

    def test_tools_are_pressed_without_hidden_overlap(self):
        # 110: the distance has a kink in the element in which contact ends.
        self.examine(pressed_tools, (*range(1, 16), 110))

    def test_light_contact_and_tipping(self):
        self.examine(light_contacts, range(1, 13))

    def test_pressures_are_those_of_hertz(self):
        self.examine(disc_pressures, range(1, 12))

    def test_bodies_that_nothing_presses_exert_no_force(self):
        # From 478 on: discs on blocks, either side nonmortar, in plane strain and about an axis.
        self.examine(touching, (*range(20), 478, 839, 1112, 1395))

    def test_with_friction_what_can_be_solved_is_solved(self):
        # 236: a thin belt, where Newton's method on sets comes nearer for more than 20 solves. 247, 329:
        # rings that contact alone holds along x, the stiff one finer. The others: thin soft rings, where the
        # rounding of forces opens gaps of 2e-8 of the length; of 1e-8 in one of six steps.
        self.examine(friction_scenes, (*range(20), 236, 247, 329, 785, 982, 553))

    def test_friction_works_are_right_and_steps_keep_the_energy(self):
        self.examine(friction_works, (4, 5, 6, 7, 10, 36, 41))


if __name__ == "__main__":
    unittest.main()
