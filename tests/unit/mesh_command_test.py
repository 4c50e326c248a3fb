"""mortier mesh: families of meshes, and what is reported of them."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))

from support import OfTwoBlocks  # noqa: E402


class MeshCommand(OfTwoBlocks):
    def test_mesh_families(self):
        for arguments, triangles, labels in [
                (["rectangle", "--cells", "4,3", "--cut", "both", "--focus", "0.5,1", "--grading", "3,2"], 48,
                 [1, 2, 3, 4]),
                (["quadrilateral", "--cells", "3,2", "--corners", "0,0", "48,44", "48,60", "0,44"], 12,
                 [1, 2, 3, 4]),
                (["annulus", "--cells", "8,2", "--span", "half", "--inner", "0.5", "--centre", "1,0"], 64,
                 [1, 2, 3, 4]),
                (["annulus", "--cells", "8,2", "--cut", "rising"], 32, [1, 2]),
                (["halfdisc", "--cells", "3", "--radius", "50", "--core", "10", "--lowest", "0,1"],
                 4 * (2 * 9 + 12 * 6), [1, 2, 3])]:
            with self.subTest(arguments=arguments):
                result = self.mortier("mesh", *arguments, "family.mesh")
                self.assertEqual(result.stderr, "")
                self.assertIn(f"{triangles} triangles; labels 1", result.stdout)
                text = self.mortier("mesh", "info", "family.mesh").stdout
                self.assertEqual([int(line.split()[1]) for line in text.splitlines()
                                  if line.startswith("label")], labels)
        for arguments, message in [
                (["rectangle", "--cells", "2", "--cut", "up"],
                 '--cut up: cut = "up", expected one of rising, falling, both'),
                (["rectangle", "--cells", "2", "--grading", "2"],
                 "--grading 2: grading = 2, expected it beside focus"),
                (["rectangle", "--cells", "2", "--grading", "2", "--focus", "3,0"],
                 "rectangle 2x2 of (0, 0) to (1, 1): focus (3, 0)"),
                (["annulus", "--cells", "8,2", "--span", "third"],
                 '--span third: span = "third", expected one of quarter, half, full'),
                (["annulus", "--cells", "8,2", "--inner", "3"],
                 "annulus of radii 3 and 2 about (0, 0), expected"),
                (["quadrilateral", "--cells", "2", "--corners", "0,0", "0,1", "1,1", "1,0"],
                 "quadrilateral (0, 0)"),
                (["quarterdisc", "--cells", "2", "--core", "0.5"],
                 "half disc of radius 1 on (0, 0): core 0.5, expected"),
                (["halfdisc", "--cells", "2", "--core", "0.5"],
                 "half disc of radius 1 on (0, 0): core 0.5, expected")]:
            with self.subTest(arguments=arguments):
                self.reject(message, "mesh", *arguments, "x.mesh")
                self.assertNotIn("x.mesh", self.names())

    def test_mesh_info(self):
        text = self.mortier("mesh", "info", "lower.mesh").stdout
        for part in ["vertices   23", "triangles  32", "label 3     4 edges, length 1: x 0 .. 1, y 0\n",
                     "y -1 .. 0\n", "aspect ratio"]:
            self.assertIn(part, text)


if __name__ == "__main__":
    unittest.main()
