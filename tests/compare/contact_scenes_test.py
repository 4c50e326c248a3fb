"""The scenes of contact_scenes.py: each gives the force that is right."""
import unittest

from contact_scenes import SCENES
from support import PROGRAM

# Not right yet.
KNOWN = {
    "rounded_punch": "with 32 pieces an edge a side force of 0.06 % is left",
    "light_contact": "coarsened rows miss light contact; the run warns of the overlap only",
    "prandtl": "2.9 % above the limit load on crossed cells",
    "tipping": "coarsened and weighted rows tip a block before statics does",
    "default_while_sliding": "coarsened rows make forces fluctuate",
    "stiff_fine_core": "pressures alternate by 9 % at degree 2",
    "accuracy_alternates": "pressures alternate on adapted meshes",
}


class ContactScenes(unittest.TestCase):
    def test_scenes(self):
        for name, scene in SCENES.items():
            with self.subTest(name):
                if name in KNOWN:
                    self.skipTest(KNOWN[name])
                self.assertEqual(scene(PROGRAM), [])


if __name__ == "__main__":
    unittest.main()
