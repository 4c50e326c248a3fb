"""A part of the random scenes of contact whose results are known: each names its harness."""
import unittest

import corner_forces
import disc_pressures
import light_contacts
import metamorphic
import pressed_tools
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
        self.examine(metamorphic, (*range(1, 10), 60, 101, 144, 218, 244))

    def test_tools_are_pressed_without_hidden_overlap(self):
        # 110: the distance has a kink in the element in which contact ends.
        self.examine(pressed_tools, (*range(1, 16), 110))

    def test_light_contact_and_tipping(self):
        self.examine(light_contacts, range(1, 13))

    def test_pressures_are_those_of_hertz(self):
        self.examine(disc_pressures, range(1, 13))


if __name__ == "__main__":
    unittest.main()
