"""degree = 2 from the scene to the results: what it computes, writes and says."""
import unittest

import meshio
import numpy as np

from scene_parts import body, contact, timed
from scenes import HELD_AND_PRESSED
from support import InFolder, set_option

BLOCK = ("degree = 2\n"
         + body("block", '"block.mesh"', "young = 100, poisson = 0.3, viscosity = 1, yield_stress = 1",
                "label = 1, uy = 0", "label = 4, ux = 0", 'label = 3, ty = "-3*t"') + timed(6))


class Quadratic(InFolder):
    def setUp(self):
        super().setUp()
        self.mortier("mesh", "crisscross", "--cells", "4", "--lower", "0,0", "--upper", "1,1", "block.mesh")
        self.write(BLOCK)

    def run_to(self, folder, *settings):
        self.mortier("run", "scene.toml", "--out", folder, *set_option(settings))
        return meshio.read(self.folder / folder / "block_000006.vtu")

    def test_uniform_flow_is_that_of_linear_triangles(self):
        linear, quadratic = self.run_to("one", "degree=1"), self.run_to("two")
        self.assertEqual([cells.type for cells in quadratic.cells], ["triangle6"])
        for name in ("stress", "viscoplastic_strain", "von_mises"):
            np.testing.assert_allclose(quadratic.cell_data[name][0], linear.cell_data[name][0], atol=1e-11)
        corners = quadratic.point_data["displacement"][:len(linear.points)]
        np.testing.assert_allclose(corners, linear.point_data["displacement"], atol=1e-11)
        summary = self.summary_of("two")
        self.assertEqual(summary["nodes"], len(quadratic.points))
        self.assertEqual(summary["dofs"], 2 * len(quadratic.points))

    def test_the_plan_names_it(self):
        self.assertIn("quadratic displacements", self.mortier("check", "scene.toml").stdout)
        self.assertNotIn("quadratic", self.mortier("check", "scene.toml", "--set", "degree=1").stdout)


TWO_BLOCKS = ("degree = 2\n"
              + body("upper", '"upper.mesh"', "young = 100, poisson = 0.3, viscosity = 1, yield_stress = 1",
                     'label = 3, ux = "0.01*t", uy = "-0.05*t*(1 + x)*(2 - t)"')
              + body("lower", '"lower.mesh"', "young = 30, poisson = 0.2, viscosity = 2, yield_stress = 0.7",
                     "label = 1, ux = 0, uy = 0") + contact(("upper", 1), ("lower", 3)) + timed(6, 1.5)
              + "[output]\nevery = 1\n")


class InContact(InFolder):
    def setUp(self):
        super().setUp()
        for name, cells, low, high in (("upper", "3", "0,0", "1,1"), ("lower", "5", "-0.2,-1", "1.1,0")):
            self.mortier("mesh", "crisscross", "--cells", cells, "--lower", low, "--upper", high,
                         f"{name}.mesh")
        self.write(TWO_BLOCKS)

    def test_every_variant_scheme_and_plane_is_solved(self):
        heights = {}
        for variant in ("weighted", "mortar", "interpolation"):
            for scheme in ("backward-euler", "crank-nicolson", "sdirk2"):
                for plane in ("stress", "strain"):
                    with self.subTest(variant=variant, scheme=scheme, plane=plane):
                        summary = self.run_it(None, f"contact.variant={variant}", f"time.scheme={scheme}",
                                               f"plane={plane}")
                        self.assertEqual(summary["status"], "converged")
                        self.assertLess(summary["verification"]["force_balance"], 1e-9)
                        heights[variant, scheme, plane] = summary["final"]["displacement_min"][1]
        for plane in ("stress", "strain"):  # the cones agree but for the meshes' error
            self.assertAlmostEqual(heights["mortar", "sdirk2", plane], heights["weighted", "sdirk2", plane],
                                   delta=1e-3)

    def test_the_newton_method_and_penalty_duality_agree(self):
        newton = self.run_it(None, "time.steps=2")["final"]
        dual = self.run_it(None, "time.steps=2", "solver.method=penalty-duality")["final"]
        self.assertAlmostEqual(dual["contact_force"], newton["contact_force"], delta=1e-6)

    def test_pressure_at_the_vertices_is_nowhere_negative(self):
        self.run_it()
        rows = [line.split(",") for line in self.read("out/contact.csv").splitlines()]
        pressure = rows[0].index("pressure")
        self.assertEqual(len(rows) - 1, 7 * 4)  # of three elements, at t = 0 and after every step
        self.assertTrue(all(float(row[pressure]) >= 0 for row in rows[1:]))

    def test_mortar_has_a_condition_at_every_node_of_the_trace(self):
        self.run_it(None, "contact.variant=mortar")
        self.assertEqual(len(self.read("out/contact.csv").splitlines()) - 1, 7 * 7)

    def test_forces_of_quantities_balance(self):
        self.write(TWO_BLOCKS + HELD_AND_PRESSED)
        quantities = self.run_it()["quantities"]
        self.assertAlmostEqual(quantities["held"]["value"], -quantities["pressed"]["value"], delta=1e-11)


if __name__ == "__main__":
    unittest.main()
