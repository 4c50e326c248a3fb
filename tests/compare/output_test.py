"""What mortier writes is read back by meshio, named by ParaView's collection, drawn and tabulated."""
import csv
import json
import unittest
import xml.etree.ElementTree as xml

import meshio
import numpy as np

import support
from codes import run_freefem, run_mortier
import results

STEPS = 5


class Output(support.InSharedFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for variant in ("mortar", "interpolation"):
            settings = [f"time.steps={STEPS}", f"contact.variant={variant}", "output.every=2"]
            run_mortier(cls.folder / f"mortier-{variant}", settings)
            run_freefem(cls.folder / f"freefem-{variant}", settings)
        cls.run_folder = cls.folder / "mortier-interpolation"

    def test_meshio_reads_the_fields(self):
        for name, cells in (("upper", 6), ("lower", 16)):
            mesh = meshio.read(self.run_folder / f"{name}_{STEPS:06d}.vtu")
            medit = meshio.read(support.ROOT / "shared-meshes" / f"{name}-crisscross-{cells}.mesh")
            self.assertEqual(mesh.points.dtype, np.float64)
            np.testing.assert_array_equal(mesh.points[:, :2], medit.points[:, :2])
            np.testing.assert_array_equal(mesh.cells_dict["triangle"], medit.cells_dict["triangle"])
            summary = json.loads((self.run_folder / "summary.json").read_text())
            nonmortar = summary["interfaces"][0]["nonmortar"]
            self.assertEqual(set(mesh.point_data), {"displacement", *(["contact_pressure", "gap", "nonmortar"]
                                                                      if name == nonmortar else [])})
            self.assertEqual(set(mesh.cell_data),
                             {"stress", "von_mises", "viscoplastic_strain", "viscoplastic", "region",
                              "error"})
            triangles = len(mesh.cells_dict["triangle"])
            self.assertEqual(mesh.point_data["displacement"].shape, (len(mesh.points), 3))
            for key, shape in (("stress", (triangles, 3)), ("viscoplastic_strain", (triangles, 3)),
                               ("von_mises", (triangles,)), ("viscoplastic", (triangles,)),
                               ("error", (triangles,))):
                self.assertEqual(mesh.cell_data[key][0].shape, shape, key)
            s11, s22, s12 = mesh.cell_data["stress"][0].T
            np.testing.assert_allclose(mesh.cell_data["von_mises"][0],
                                       np.sqrt(s11**2 + s22**2 - s11 * s22 + 3 * s12**2), rtol=1e-14)
            self.assertTrue((mesh.cell_data["viscoplastic"][0] == 1).all())
            accuracy = json.loads((self.run_folder / "summary.json").read_text())["accuracy"]["bodies"][name]
            self.assertAlmostEqual(np.linalg.norm(mesh.cell_data["error"][0]), accuracy, delta=1e-13)
            self.assertGreater(accuracy, 0.01)

    def test_nodes_of_nonmortar_sides_have_pressure_and_gap(self):
        run = results.read(self.run_folder)
        name = run.summary["interfaces"][0]["nonmortar"]
        values = meshio.read(self.run_folder / f"{name}_{STEPS:06d}.vtu").point_data
        self.assertEqual(sorted(np.flatnonzero(values["nonmortar"])), sorted(set(run.contact.vertex)))
        for field, known in (("contact_pressure", run.contact.pressure), ("gap", run.contact.gap)):
            np.testing.assert_allclose(values[field][run.contact.vertex], known, rtol=1e-12, atol=1e-25)
            others = np.delete(values[field], run.contact.vertex)
            self.assertTrue((others == 0).all())
            self.assertGreater(len(others), len(run.contact.vertex))

    def test_viscoplastic_strain_is_what_elasticity_leaves_of_the_strain(self):
        young, poisson = 3e11, 0.3
        mesh = meshio.read(self.run_folder / f"upper_{STEPS:06d}.vtu")
        points, triangles = mesh.points[:, :2], mesh.cells_dict["triangle"]
        u = mesh.point_data["displacement"][:, :2]
        a, b, c = points[triangles].transpose(1, 0, 2)
        edges = np.stack([b - a, c - a], axis=1)
        ua, ub, uc = u[triangles].transpose(1, 0, 2)
        D = np.linalg.solve(edges, np.stack([ub - ua, uc - ua], axis=1))  # D[:, j, i] = d u_i / d x_j
        strain = np.column_stack([D[:, 0, 0], D[:, 1, 1], (D[:, 0, 1] + D[:, 1, 0]) / 2])
        s11, s22, s12 = mesh.cell_data["stress"][0].T
        elastic = np.column_stack([s11 - poisson * s22, s22 - poisson * s11, (1 + poisson) * s12]) / young
        np.testing.assert_allclose(mesh.cell_data["viscoplastic_strain"][0], strain - elastic, atol=1e-10)

    def test_collection_names_every_kept_step(self):
        entries = xml.parse(self.run_folder / "fields.pvd").getroot().find("Collection").findall("DataSet")
        kept = [0, 2, 4, STEPS]
        self.assertEqual([float(entry.get("timestep")) for entry in entries],
                         [step / STEPS for step in kept for _ in range(2)])
        for entry in entries:
            meshio.read(self.run_folder / entry.get("file"))

    def test_tables(self):
        with open(self.run_folder / "contact.csv", newline="") as file:
            contact = list(csv.DictReader(file))
        kept = [str(step) for step in (0, 2, 4, STEPS) for _ in range(7)]
        self.assertEqual([row["step"] for row in contact], kept)
        last = [row for row in contact if row["step"] == str(STEPS)]
        self.assertAlmostEqual(sum(float(row["force"]) for row in last), 10, delta=1e-9)
        with open(self.run_folder / "history.csv", newline="") as file:
            self.assertEqual(len(list(csv.DictReader(file))), STEPS)

    def test_summary_has_its_keys(self):
        summary = json.loads((self.run_folder / "summary.json").read_text())
        keys = ("scene status contact nonmortar projection triangles nodes dofs steps newton_iterations "
                "max_iterations_in_a_step factorisations wall_time_s solve_time_s peak_memory_mib final "
                "verification")
        self.assertLessEqual(set(keys.split()), set(summary))
        final = ("time von_mises_min von_mises_max interpenetration displacement_min displacement_max "
                 "contact_force active_nodes")
        self.assertLessEqual(set(final.split()), set(summary["final"]))
        self.assertLessEqual(set("force_balance material_residual gap_on_active complementarity".split()),
                             set(summary["verification"]))
        self.assertEqual((summary["triangles"], summary["nodes"], summary["steps"]), (1168, 630, STEPS))

    def test_figures(self):
        out = self.folder / "figures"
        status, output = support.script("figures.py", self.folder / "mortier-mortar", self.run_folder,
                                        "--out", out)
        self.assertEqual(status, 0, output)
        for name in ("figure-1-mortar", "figure-2-interpolation", "figure-3-contact-line"):
            self.assertEqual((out / f"{name}.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
            self.assertGreater((out / f"{name}.png").stat().st_size, 20000)
            self.assertTrue(xml.parse(out / f"{name}.svg").getroot().tag.endswith("svg"))

    def test_table(self):
        status, output = support.script("table.py", self.folder, "--json", self.folder / "table.json")
        self.assertEqual(status, 0, output)
        rows = json.loads((self.folder / "table.json").read_text())
        runs = [(variant, code) for variant in ("mortar", "interpolation") for code in ("mortier", "FreeFEM")]
        self.assertEqual([(row["variant"], row["code"]) for row in rows], runs)
        for row in rows[:2]:
            self.assertLess(abs(row["error_backward_euler"]), 1e-12)
            self.assertLess(abs(row["von_mises_max"] - 10), 1e-9)


if __name__ == "__main__":
    unittest.main()
