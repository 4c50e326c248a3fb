"""A part of the drawings of touching.py: bodies that nothing presses exert no force."""
import tempfile
import unittest
from pathlib import Path

from support import PROGRAM
from touching import Drawing, force_of

COUNT = 20

# A half disc on a block: with one nonmortar side or the other, and around an axis.
TOUCHING = """\
plane = "PLANE"
[[body]]
name = "disc"
mesh = { shape = "SHAPEdisc", radius = 50, core = 8, cells = 6 }
material = { young = 210000, poisson = 0.3 }
boundary = [ { label = 2, ux = 0, uy = 0 } ]
[[body]]
name = "block"
mesh = { shape = "rectangle", lower = [LEFT, -60], upper = [60, 0], cells = [40, 20], \
         focus = [0, 0], grading = 12 }
material = { young = 70000, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = 0 } ]
[contact]
nonmortar = { body = "disc", label = 1 }
mortar = { body = "block", label = 3 }
swap = SWAP
variant = "mortar"
[time]
end = 1
steps = 1
"""


class Touching(unittest.TestCase):
    def force(self, drawing):
        with tempfile.TemporaryDirectory() as folder:
            force, words = force_of(drawing, PROGRAM, Path(folder))
        self.assertEqual((force, words), (0, ""))

    def test_drawings_that_nothing_presses(self):
        for seed in range(COUNT):
            drawing = Drawing(seed)
            with self.subTest(seed=seed, shows=drawing.shows):
                self.force(drawing)

    def test_a_disc_on_a_block(self):
        for plane, shape, left in (("strain", "half", -60), ("axisymmetric", "quarter", 0)):
            for swap in ("false", "true"):
                with self.subTest(plane=plane, swap=swap):
                    drawing = Drawing(0)
                    drawing.files = {}
                    drawing.scene = TOUCHING
                    for word, value in (("PLANE", plane), ("SHAPE", shape), ("LEFT", left), ("SWAP", swap)):
                        drawing.scene = drawing.scene.replace(word, str(value))
                    self.force(drawing)


if __name__ == "__main__":
    unittest.main()
