"""First meshes in space that are too coarse for a contact: the run warns of the overlap, and rounds of
refinement find the contact."""
import unittest

from scene_parts import body, box, contact, quantity, shape, timed
from support import InFolder

# By Hertz 246 N for two half spaces; 250 N for these bodies on axisymmetric meshes to 0.2 %.
FORCE = -250.0
SCENE = ('dimension = 3\ndegree = 2\nunits = "mm, N, MPa"\n'
         + body("ball", shape("ball", centre=[0, 0, 5], radius=5, keep=["x", "y", "-z"], cells=4),
                'young = "210 GPa", poisson = 0.3', 'label = "left", ux = 0', 'label = "front", uy = 0',
                'label = "top", uz = -0.02')
         + body("block", box([0, 0, -10], [10, 10, 0], 4), 'young = "210 GPa", poisson = 0.3',
                'label = "left", ux = 0', 'label = "front", uy = 0', 'label = "bottom", uz = 0')
         + contact(("ball", "round"), ("block", "top"), sides=True)
         + quantity("force", "reaction", "ball", "top", "z") + timed())


class MissedContact(InFolder):
    def setUp(self):
        super().setUp()
        self.write(SCENE)

    def test_an_accuracy_finds_it(self):
        log = self.mortier("run", "scene.toml", "--accuracy", "0.08", "--out", "out").stdout
        self.assertNotIn("warning", log)
        summary = self.summary_of()
        self.assertTrue(summary["accuracy"]["reached"])
        self.assertTrue(summary["overlap"]["explained"])
        self.assertAlmostEqual(summary["quantities"]["force"]["value"] / FORCE, 1, delta=0.02)

    def test_no_more_unknowns_are_no_accuracy(self):
        done = self.mortier("run", "scene.toml", "--accuracy", "0.08", "--max-unknowns", "4000", code=1)
        self.assertIn("bodies ball and block overlap by 0.02 at (0, 0, -0.02)", done.stdout + done.stderr)

    def test_a_run_on_these_meshes_tells_the_overlap(self):
        log = self.mortier("run", "scene.toml", "--out", "out").stdout
        overlap = "bodies ball and block overlap by 0.02 at (0, 0, -0.02): no contact presses there"
        self.assertIn("warning    " + overlap, log)
        self.assertNotIn("never touched", log)
        summary = self.summary_of()
        self.assertFalse(summary["overlap"]["explained"])
        self.assertIn(overlap, summary["accuracy"]["not_reliable"])


if __name__ == "__main__":
    unittest.main()
