"""A few scenes of light_contacts_space.py: contact between the vertices of first meshes is found."""
import unittest

import gmsh_support
import light_contacts_space
from support import PROGRAM


class Found(unittest.TestCase):
    def expect_contact(self, seed, kind, least=0.8, most=1.3):
        scene = light_contacts_space.Scene(seed)
        self.assertEqual(scene.kind, kind)
        self.assertEqual(scene.faults(PROGRAM, unknowns=12000), [])
        self.assertGreater(scene.ratio, least, scene.found)
        self.assertLess(scene.ratio, most, scene.found)

    @unittest.skipUnless(gmsh_support.available(), "the library of Gmsh is not there")
    def test_the_lowest_point_of_a_ball_lies_between_vertices(self):
        self.expect_contact(2, "turned ball")

    def test_another_contact_presses(self):
        self.expect_contact(8, "second contact", most=2)


if __name__ == "__main__":
    unittest.main()
