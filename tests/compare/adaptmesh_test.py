"""FreeFEM with its own mesh adaptation (freefem/adapted.idp): on the meshes that it ends with mortier finds
the same solution, and its error falls as that of adapted quadratic elements should."""
import re
import subprocess
import unittest

import numpy as np

from study_support import STUDIES, StudyTest
from support import ROOT

import codes  # noqa: E402
import results  # noqa: E402


class Adaptmesh(StudyTest):
    def test_mortier_finds_the_same_solution_on_its_meshes(self):
        for swap in ("false", "true"):
            with self.subTest(swap=swap):
                settings = ["degree=2", f"contact.swap={swap}", "contact.stabilised=false"]
                meshes = []
                for body, low, cells in (("upper", 0, "4,2"), ("lower", -1, "6,3")):
                    meshes.append(f"body.{body}.mesh={self.folder}/{body}.mesh")
                    self.mortier("mesh", "crisscross", "--cells", cells, f"--lower=-0.9,{low}",
                                 "--upper", f"1.1,{low + 1}", f"{body}.mesh")
                self.mortier("freefem", ROOT / "scenes/exact-contact.toml", "scene.edp", "--set", *settings,
                             *meshes)
                script = self.folder / "scene.edp"
                script.write_text(codes.adapted(script.read_text()))
                subprocess.run([codes.FREEFEM, "-nw", "-nw", "-ne", "-v", "0", script, "-accuracy", "0.002",
                                "-out", self.folder / "other"], check=True, stdout=subprocess.DEVNULL)
                other = results.read_freefem(self.folder / "other")
                meshes = [f"body.{body}.mesh={self.folder}/other/{body}.mesh" for body in other.bodies]
                self.mortier("run", ROOT / "scenes/exact-contact.toml", "--quiet", "--out", f"own-{swap}",
                             "--set", *settings, *meshes)
                own = results.read_mortier(self.folder / f"own-{swap}")
                self.assertGreaterEqual(other.summary["rounds"], 2)
                for name, body in own.bodies.items():
                    self.assert_near(other.bodies[name].displacement, body.displacement, 1e-9)
                    self.assert_near(other.bodies[name].stress_at_points, body.stress_at_points, 1e-8)
                order = np.argsort(other.contact.position[:, 0]), np.argsort(own.contact.position[:, 0])
                self.assert_near(other.contact.force[order[0]], own.contact.force[order[1]], 1e-8)

    def assert_near(self, one, other, part):
        self.assertEqual(one.shape, other.shape)
        self.assertLess(np.abs(one - other).max(), part * np.abs(other).max())

    def test_its_error_falls_with_order_one_in_the_unknowns(self):
        text = (STUDIES / "adaptmesh.toml").read_text().replace("repeat = 3\n", "").replace(
            "../exact-contact.toml", f"{ROOT}/scenes/exact-contact.toml")
        text = text[:text.index("[[compare]]")]
        text = re.sub(r'\[\[sweep\]\]\nname = "mortier"(.|\n)*?\n\n', "", text)
        self.path.write_text(re.sub(r"accuracy = .*", "accuracy = [3e-3, 5e-4]", text))
        self.study()
        rows = self.rows()
        self.assertEqual([row["status"] for row in rows], ["done", "done"], rows)
        dofs, errors = (np.log([float(row[key]) for row in rows]) for key in ("dofs", "error energy"))
        order = (errors[1] - errors[0]) / (dofs[1] - dofs[0])
        print(f"unknowns {np.exp(dofs)}, errors {np.exp(errors)}, order {order:.2f}")
        self.assertLess(order, -0.85)
        self.assertLess(np.exp(errors[1]), 1e-3)

    def test_what_it_does_not_know_is_told(self):
        self.path.write_text(f"""scene = "{ROOT}/scenes/compression.toml"
[[error]]
quantity = "contact_force"
exact = 10
[[sweep]]
code = "freefem"
degree = [1, 2]
accuracy = 0.1
steps = 1
""")
        self.study(code=1)
        self.assertEqual([row["status"] for row in self.rows()], ["failed"] * 2)
        reasons = [row["reason"] for row in self.rows()]
        self.assertIn("of degree 2 only", reasons[0])
        self.assertIn("for two elastic bodies", reasons[1])


if __name__ == "__main__":
    unittest.main()
