"""degree = 2 from the scene to the results: what it computes, writes and says."""
import json
import unittest

import meshio
import numpy as np

from support import ROOT, InFolder

COOK = 23.9618  # deflection of Cook's membrane, of elements of second order on 64 cells (cook_test.cpp)

BLOCK = """degree = 2
[[body]]
name = "block"
mesh = "block.mesh"
material = { young = 100, poisson = 0.3, viscosity = 1, yield_stress = 1 }
boundary = [ { label = 1, uy = 0 }, { label = 4, ux = 0 }, { label = 3, ty = "-3*t" } ]
[time]
end = 1
steps = 6
"""


class Quadratic(InFolder):
    def setUp(self):
        super().setUp()
        self.mortier("mesh", "crisscross", "--cells", "4", "--lower", "0,0", "--upper", "1,1", "block.mesh")
        self.write(BLOCK)

    def run_to(self, folder, *settings):
        self.mortier("run", "scene.toml", "--out", folder, *(["--set", *settings] if settings else []))
        return meshio.read(self.folder / folder / "block_000006.vtu")

    def test_uniform_flow_is_that_of_linear_triangles(self):
        linear, quadratic = self.run_to("one", "degree=1"), self.run_to("two")
        self.assertEqual([cells.type for cells in quadratic.cells], ["triangle6"])
        for name in ("stress", "viscoplastic_strain", "von_mises"):
            np.testing.assert_allclose(quadratic.cell_data[name][0], linear.cell_data[name][0], atol=1e-11)
        corners = quadratic.point_data["displacement"][:len(linear.points)]
        np.testing.assert_allclose(corners, linear.point_data["displacement"], atol=1e-11)
        summary = json.loads(self.read("two/summary.json"))
        self.assertEqual(summary["nodes"], len(quadratic.points))
        self.assertEqual(summary["dofs"], 2 * len(quadratic.points))

    def test_cook(self):
        self.mortier("mesh", "quadrilateral", "--cells", "8", "--corners", "0,0", "48,44", "48,60", "0,44", "cook.mesh")
        errors = []
        for degree in (1, 2):
            self.mortier("run", str(ROOT / "scenes/cook.toml"), "--out", "cook", "--set", f"degree={degree}",
                         f"body.mesh={self.folder / 'cook.mesh'}")
            mesh = meshio.read(self.folder / "cook/panel_000001.vtu")
            tip = np.argmin(np.abs(mesh.points[:, 0] - 48) + np.abs(mesh.points[:, 1] - 52))
            errors.append(abs(mesh.point_data["displacement"][tip, 1] - COOK))
        self.assertGreater(errors[0], 6)
        self.assertLess(errors[1], 0.2)

    def test_the_plan_names_it(self):
        self.assertIn("quadratic displacements", self.mortier("check", "scene.toml").stdout)
        self.assertNotIn("quadratic", self.mortier("check", "scene.toml", "--set", "degree=1").stdout)


if __name__ == "__main__":
    unittest.main()
