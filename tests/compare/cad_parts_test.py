"""A few of the parts of cad_parts.py: vertices of refined boundaries lie on the surfaces of the geometry."""
import unittest

import cad_parts
import gmsh_support
from support import PROGRAM

# One surface, planes and cylinders, a curve between two cylinders, a fillet, splines; .geo, .step and .brep.
SEEDS = {6: "torus_part", 8: "filleted_corner", 11: "crossed_hole", 27: "eighth_of_ball"}


@unittest.skipUnless(gmsh_support.available(), "the library of Gmsh is not there")
class Parts(unittest.TestCase):
    def test_vertices_lie_on_the_surfaces(self):
        for seed, name in SEEDS.items():
            with self.subTest(name):
                shown, faults = cad_parts.examined(PROGRAM, seed, unknowns=6000, rounds=2)
                self.assertTrue(shown.startswith(name), shown)
                self.assertEqual(faults, [], shown)


if __name__ == "__main__":
    unittest.main()
