"""A part of the random scenes of contact whose results are known: each names its harness."""
import unittest

import corner_forces
import disc_pressures
import light_contacts
import metamorphic
import pressed_tools
from support import PROGRAM


class RandomContacts(unittest.TestCase):
    def examine(self, harness, count, known=None, reason=""):
        for seed in range(1, count + 1):
            with self.subTest(harness=harness.__name__, seed=seed):
                if seed in (known or ()):
                    self.skipTest(reason)
                self.assertEqual(harness.examined(PROGRAM, seed)[1], [])

    def test_forces_of_corners_are_along_the_normal(self):
        self.examine(corner_forces, 20)

    def test_forces_are_those_of_the_scene_in_other_words(self):
        changed = "points inserted into a tool change its force by the mesh error"
        self.examine(metamorphic, 9, (2,), changed)

    def test_tools_are_pressed_without_hidden_overlap(self):
        self.examine(pressed_tools, 15)

    def test_light_contact_and_tipping(self):
        self.examine(light_contacts, 12)

    def test_pressures_are_those_of_hertz(self):
        self.examine(disc_pressures, 12)


if __name__ == "__main__":
    unittest.main()
