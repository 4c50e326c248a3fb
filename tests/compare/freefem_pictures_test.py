"""The FreeFEM scripts draw what they solve: -ps FILE on any scene that mortier freefem writes,
with steps and meshes changed."""
import re
import unittest

import meshio
import numpy as np

from support import ROOT, InFolder, mortier
from codes import FREEFEM, call


def triangles(text):
    """Filled triangles of a PostScript file of FreeFEM; the squares of its legend are left out."""
    found = [np.array(points.split(), float).reshape(-1, 2)
             for points in re.findall(r"^bF ([\d. -]+) eF", text, re.M)]
    return np.array([each for each in found if len(each) == 3])


class Pictures(InFolder):
    def draw(self, scene, *words):
        script, picture = self.folder / "scene.edp", self.folder / "a.ps"
        done = mortier("freefem", ROOT / scene, script, cwd=ROOT)
        self.assertEqual(done.returncode, 0, done.stderr)
        output, _ = call([FREEFEM, "-nw", "-nw", "-ne", "-v", "0", script, "-quiet", "-out",
                          self.folder / "out", "-ps", picture, *words])
        return picture.read_text(errors="replace"), output

    def test_scenes(self):
        for scene in ("exact-contact", "stack", "cut-ring", "thick-cylinder"):
            with self.subTest(scene):
                text, output = self.draw(f"scenes/{scene}.toml", "-steps", 2)
                low, high = re.search(r"^von Mises +(\S+) \.\. (\S+) Pa", output, re.M).groups()
                words = re.search(r"von Mises (\S+) to (\S+), p up to (\S+?)[,)]", text)
                self.assertAlmostEqual(float(words[1]) / float(low), 1, delta=1e-4)
                self.assertAlmostEqual(float(words[2]) / float(high), 1, delta=1e-4)
                self.assertGreater(float(words[3]), 0)
                self.assertTrue(text.startswith("%!PS"))
                self.assertGreater(len(text), 50000)

    def test_triangles_are_the_deformed_ones(self):
        text, _ = self.draw("scenes/compression.toml", "-steps", 4, "-variant", "interpolation")
        drawn = triangles(text)
        moved, middles = [], []
        for name, file in (("upper", "upper-crisscross-6"), ("lower", "lower-crisscross-16")):
            mesh = meshio.read(ROOT / "shared-meshes" / f"{file}.mesh")
            moved.append(mesh.points[:, :2] + np.loadtxt(self.folder / "out" / f"{name}.displacement.txt"))
            middles.append(moved[-1][mesh.cells_dict["triangle"]].mean(1))
        moved, middles = np.concatenate(moved), np.concatenate(middles)
        # The drawing is the plane, scaled and shifted, its points whole numbers: every triangle is there,
        # at its place.
        self.assertEqual(len(drawn), len(middles))
        corners = drawn.reshape(-1, 2)
        scale = np.ptp(corners, axis=0) / np.ptp(moved, axis=0)
        self.assertAlmostEqual(scale[0] / scale[1], 1, delta=2e-3)
        expected = corners.min(0) + scale * (middles - moved.min(0))
        distance = np.abs(expected[:, None] - drawn.mean(1)).max(-1).min(1)
        self.assertLess(distance.max(), 3)

    def test_pressure_and_other_meshes(self):
        """The note's test: the pressure is 10 at every node with the projection; other meshes draw more."""
        sizes = []
        for words in (("-steps", 4), ("-steps", 3, "-mesh1", "fine.mesh"),
                      ("-steps", 4, "-variant", "interpolation")):
            if "fine.mesh" in words:
                mortier("mesh", "crisscross", "--cells", "12", self.folder / "fine.mesh")
                words = [self.folder / word if word == "fine.mesh" else word for word in words]
            text, _ = self.draw("scenes/compression.toml", *words)
            pressure = float(re.search(r"p up to ([\d.e+-]+)", text)[1])
            if "interpolation" in words:
                self.assertGreater(pressure, 10.5)
            else:
                self.assertAlmostEqual(pressure, 10, delta=1e-3)
            sizes.append(len(text))
        self.assertGreater(sizes[1], sizes[0])


if __name__ == "__main__":
    unittest.main()
