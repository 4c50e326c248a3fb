"""The comparison fails when it should: every injected fault is caught, by its exit code and with its name."""
import json
import shutil
import unittest

import meshio
import numpy as np

import support
from codes import run_freefem, run_mortier

# Interpolation: its stress varies from triangle to triangle, so that nothing hides in a constant field.
SETTINGS = ["contact.variant=interpolation", "time.steps=20"]


class Faults(support.InSharedFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        run_mortier(cls.folder / "mortier", SETTINGS)
        run_freefem(cls.folder / "freefem", SETTINGS)

    def setUp(self):
        for code in ("mortier", "freefem"):
            shutil.rmtree(self.folder / f"{code}-faulty", ignore_errors=True)
            shutil.copytree(self.folder / code, self.folder / f"{code}-faulty")
        self.ours, self.theirs = self.folder / "mortier-faulty", self.folder / "freefem-faulty"

    def caught(self, code, word):
        """The comparison ends with this code and names the fault."""
        status, output = support.script("compare.py", self.ours, self.theirs)
        self.assertEqual(status, code, output)
        self.assertIn(word, output.splitlines()[-1])

    # ---- no fault ----
    def test_without_a_fault_the_codes_agree(self):
        status, output = support.script("compare.py", self.ours, self.theirs)
        self.assertEqual(status, 0, output)

    # ---- numbers ----
    def edit(self, name, change):
        path = self.theirs / name
        table = np.loadtxt(path, ndmin=2)
        change(table)
        np.savetxt(path, table, fmt="%.17g")

    def test_one_nodal_displacement_off_by_a_millionth(self):
        def change(table):
            table[40, 1] *= 1 + 1e-6
        self.edit("upper.displacement.txt", change)
        self.caught(1, "displacement upper")

    def test_one_displacement_of_ours_off_by_a_millionth(self):
        path = self.ours / "lower_000020.vtu"
        mesh = meshio.read(path)
        mesh.point_data["displacement"][300, 1] *= 1 + 1e-6
        meshio.write(path, mesh)
        self.caught(1, "displacement lower")

    def test_sign_of_one_shear_stress(self):
        row = int(np.argmax(np.abs(np.loadtxt(self.theirs / "lower.stress.txt")[:, 2])))

        def change(table):
            table[row, 2] *= -1
        self.edit("lower.stress.txt", change)
        self.caught(1, "stress lower")

    def test_sign_of_the_shear_stress(self):
        def change(table):
            table[:, 2] *= -1
        self.edit("upper.stress.txt", change)
        self.caught(1, "stress upper")

    def test_stress_components_exchanged(self):
        def change(table):
            table[:, [0, 1]] = table[:, [1, 0]]
        self.edit("upper.stress.txt", change)
        self.caught(1, "stress upper")

    def test_two_triangles_exchanged(self):
        def change(table):
            table[[0, 1]] = table[[1, 0]]
        self.edit("upper.stress.txt", change)
        self.caught(1, "stress upper")

    def test_one_contact_force_off_by_a_millionth(self):
        def change(table):
            table[3, 4] *= 1 + 1e-6
        self.edit("contact.txt", change)
        self.caught(1, "contact force")

    def test_forces_shifted_by_a_contact_node(self):
        def change(table):
            table[:, 4] = np.roll(table[:, 4], 1)
        self.edit("contact.txt", change)
        self.caught(1, "contact force")

    def test_contact_node_moved(self):
        def change(table):
            table[2, 1] += 1e-9
        self.edit("contact.txt", change)
        self.caught(1, "contact position")

    def test_other_contact_vertex(self):
        def change(table):
            table[2, 0] += 1
        self.edit("contact.txt", change)
        self.caught(1, "other vertices")

    def test_one_scalar_off_by_a_millionth(self):
        for key in ("von_mises_max", "von_mises_min", "interpenetration", "contact_force"):
            with self.subTest(key):
                self.setUp()

                def change(summary, key=key):
                    summary["final"][key] *= 1 + 1e-6
                self.edit_summary(change)
                self.caught(1, key)

    def edit_summary(self, change):
        path = self.theirs / "summary.json"
        summary = json.loads(path.read_text())
        change(summary)
        path.write_text(json.dumps(summary))

    # ---- another problem ----
    def solve(self, *settings):
        """Our run of other data, in place of the right one."""
        shutil.rmtree(self.ours)
        run_mortier(self.ours, [*SETTINGS, *settings])

    def test_bodies_swapped(self):
        for kind in ("displacement", "stress"):
            upper, lower = (self.theirs / f"{name}.{kind}.txt" for name in ("upper", "lower"))
            keep = upper.read_text()
            upper.write_text(lower.read_text())
            lower.write_text(keep)
        self.caught(1, "body")

    def test_other_nonmortar_side(self):
        self.solve("contact.swap=true")
        self.caught(1, "nonmortar")

    def test_other_projection(self):
        self.solve("body.material.projection=frobenius")
        self.caught(1, "projection")

    def test_other_projection_under_the_same_name(self):
        self.solve("body.material.projection=frobenius")
        self.pretend("projection", "elasticity")
        self.caught(1, "displacement")

    def test_mortar_for_interpolation(self):
        self.solve("contact.variant=mortar")
        self.caught(1, "contact: mortar and interpolation")

    def test_mortar_under_the_name_of_interpolation(self):
        self.solve("contact.variant=mortar")
        self.pretend("contact", "interpolation")
        self.caught(1, "stress")

    def pretend(self, key, value):
        path = self.ours / "summary.json"
        path.write_text(json.dumps(json.loads(path.read_text()) | {key: value}))

    def test_one_step_fewer(self):
        self.solve("time.steps=19")
        self.caught(1, "displacement")

    def test_viscosity_off_by_a_millionth(self):
        self.solve("body.upper.material.viscosity=10.00001")
        self.caught(1, "displacement upper")

    def test_yield_stress_of_one_body_off_by_a_millionth(self):
        self.solve("body.lower.material.yield_stress=1.000001")
        self.caught(1, "displacement lower")

    def test_other_poisson_ratio(self):
        self.solve("body.material.poisson=0.31")
        self.caught(1, "displacement")

    def test_other_load(self):
        self.solve("body.upper.boundary.3.ty=-10.0001*t")
        self.caught(1, "stress")

    def test_meshes_exchanged(self):
        self.solve("body.upper.mesh=shared-meshes/upper-crisscross-16.mesh",
                   "body.lower.mesh=shared-meshes/lower-crisscross-6.mesh")
        self.caught(1, "vertices")

    # ---- no result ----
    def test_missing_files(self):
        for run, name, named in (("theirs", "upper.stress.txt", "upper.stress.txt"),
                                 ("theirs", "lower.displacement.txt", "lower.displacement.txt"),
                                 ("theirs", "summary.json", "summary.json"),
                                 ("theirs", "contact.txt", "contact.txt"),
                                 ("ours", "contact.csv", "contact.csv"),
                                 ("ours", "upper_000020.vtu", "upper_000020.vtu")):
            with self.subTest(name):
                self.setUp()
                (getattr(self, run) / name).unlink()
                self.caught(2, named)

    def test_missing_folder(self):
        shutil.rmtree(self.ours)
        self.caught(2, "no such folder")

    def test_not_a_number(self):
        for name, column in (("upper.displacement.txt", 0), ("lower.stress.txt", 1), ("contact.txt", 4)):
            with self.subTest(name):
                self.setUp()

                def change(table, column=column):
                    table[2, column] = np.nan
                self.edit(name, change)
                self.caught(2, "not finite")

    def test_not_a_number_in_the_summary(self):
        self.edit_summary(lambda summary: summary["final"].update(von_mises_max=float("nan")))
        self.caught(2, "summary.json")

    def test_a_line_is_missing(self):
        path = self.theirs / "lower.displacement.txt"
        path.write_text("".join(path.read_text().splitlines(keepends=True)[:-1]))
        self.caught(1, "vertices")

    def test_a_file_cut_short(self):
        path = self.ours / "lower_000020.vtu"
        path.write_bytes(path.read_bytes()[:-3000])
        self.caught(2, "lower_000020.vtu")

    def test_a_run_that_failed(self):
        self.edit_summary(lambda summary: summary.update(status="verification failed"))
        self.caught(2, "expected converged")


if __name__ == "__main__":
    unittest.main()
