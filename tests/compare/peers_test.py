"""bench/peers and the drivers of other codes: what is installed solves the small problems,
what is not says so."""
import json
import os
import subprocess
import sys
import unittest

import numpy as np

import study_support  # noqa: F401
from support import PROGRAM, ROOT, InFolder

sys.path.insert(0, str(ROOT / "bench" / "peer_codes"))
import calculix_code
import drivers
import peer
import scene
from plan import Case

STRESS_ERROR = {("mortier", "mortar"): 1e-12, ("FreeFEM", "mortar"): 1e-12, ("GetFEM", "mortar"): 1e-3,
                ("CalculiX", "mortar"): 1e-4}


class Peers(InFolder):
    def test_small_problems(self):
        done = subprocess.run([sys.executable, str(ROOT / "bench" / "peers"), "--small", "--problems",
                               "patch",
                               "separation", "cube", "--json", str(self.folder / "rows.json")],
                              capture_output=True, text=True, env={**os.environ, "MORTIER": PROGRAM})
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = json.loads(self.read("rows.json"))
        self.assertEqual(len(rows), 18)
        errors = {(row["problem"], row["code"], row["coupling"]): row.get("error") for row in rows}
        for row in rows:
            with self.subTest(problem=row["problem"], code=row["code"], coupling=row["coupling"]):
                if "error" not in row:
                    self.assertIn(row["code"], ("GetFEM", "CalculiX"))
                    self.assertIn("is not installed", row["reason"])
                    continue
                self.assertGreater(row["memory_MiB"], 5)
                if row["problem"] == "cube":
                    self.assertLess(row["error"], 1e-6)  # CalculiX prints seven digits
                elif row["problem"] == "patch" and row["coupling"] == "mortar":
                    self.assertLess(row["error"], STRESS_ERROR[row["code"], "mortar"])
                elif row["problem"] == "patch":  # every code finds the same wrong stress
                    self.assertAlmostEqual(row["error"] / errors["patch", "mortier", "interpolation"], 1,
                                           places=6)
                else:  # the opening at the far end; a penalty is not exact
                    allowed = 1e-2 if row["code"] == "CalculiX" else 5e-3
                    self.assertAlmostEqual(row["error"] / errors["separation", "mortier", "mortar"], 1,
                                           delta=5 * allowed)
        self.assertLess(abs(errors["separation", "FreeFEM", "mortar"]
                            / errors["separation", "mortier", "mortar"] - 1), 1e-9)


class Drivers(InFolder):
    def problem(self, *settings):
        document = scene.load(ROOT / "scenes" / "compression.toml", settings)
        self.write(json.dumps(document), "problem.json")
        return peer.Problem(str(self.folder / "problem.json"))

    def test_what_they_do_not_know_is_refused(self):
        for values in ((("degree", 2),), (("accuracy", 0.01),)):
            with self.assertRaisesRegex(peer.RunFailure, "takes linear triangles of the meshes"):
                drivers.require_plain(Case(values))
        with self.assertRaisesRegex(peer.RunFailure, "equal steps"):
            drivers.require_plain(Case((("scheme", "sdirk2"),)))

    def test_plane_strain_is_refused(self):
        with self.assertRaisesRegex(peer.RunFailure, "plane stress"):
            self.problem("plane=strain")

    def test_settings_reach_the_scene(self):
        problem = self.problem("contact.swap=true", "time.steps=7", "body.upper.material.poisson=0.2",
                               "body.upper.boundary.3.ty=-5", "body.lower.material={young=1, poisson=0.1}")
        self.assertEqual((problem.nonmortar, problem.nonmortar_label, problem.steps), ("lower", 3, 7))
        self.assertEqual((problem.bodies["upper"].poisson, problem.bodies["lower"].poisson), (0.2, 0.1))
        self.assertEqual([value.text for _, _, value in problem.bodies["upper"].tractions], ["-5"])
        self.assertIsNone(problem.bodies["lower"].viscosity)

    def test_sides_are_those_that_the_program_chose(self):
        text = (ROOT / "scenes" / "compression.toml").read_text()
        begin, end = text.index("nonmortar ="), text.index("\n", text.index("\nmortar =") + 1)
        sides = 'sides = [ { body = "upper", label = 1 }, { body = "lower", label = 3 } ]'
        self.write((text[:begin] + sides + text[end:]).replace("../shared-meshes",
                                                               str(ROOT / "shared-meshes")), "sides.toml")
        for swap, nonmortar in (("false", ("lower", 3)), ("true", ("upper", 1))):
            settings = [f"contact.swap={swap}"]
            script = subprocess.run([PROGRAM, "freefem", "sides.toml", "--set", *settings],
                                    capture_output=True, text=True,
                                    cwd=self.folder, env={**os.environ, "PWD": str(self.folder)})
            self.assertEqual(script.returncode, 0, script.stderr)
            document = scene.load(self.folder / "sides.toml", settings)
            drivers.take_sides(document, script.stdout)
            self.write(json.dumps(document), "problem.json")
            problem = peer.Problem(str(self.folder / "problem.json"))
            self.assertEqual((problem.nonmortar, problem.nonmortar_label), nonmortar)

    def test_contact_lines_in_their_order(self):
        annulus = subprocess.run([PROGRAM, "mesh", "annulus", "--cells", "24,2", "--span", "half",
                                  "arc.mesh"], cwd=self.folder)
        self.assertEqual(annulus.returncode, 0)
        mesh = peer.Mesh(self.folder / "arc.mesh")
        x, y = mesh.points[mesh.line(2)].T
        np.testing.assert_allclose(np.unwrap(np.arctan2(y, x)), np.linspace(np.pi, 0, 25), atol=1e-12)

    def test_contact_forces_come_from_equilibrium(self):
        problem = self.problem()
        stresses = {name: np.tile([3.0, -10.0, 0.0], (len(body.mesh.triangles), 1))
                    for name, body in problem.bodies.items()}
        lift = {"upper": 0.25, "lower": 0.0}
        displacements = {name: body.mesh.points * 0 + [0, lift[name]]
                         for name, body in problem.bodies.items()}
        nodes, position, gap, force = problem.contact_of(displacements, stresses)
        np.testing.assert_allclose(gap, 0.25, atol=1e-15)  # apart
        np.testing.assert_allclose(force, 10 / 6 * np.array([0.5, 1, 1, 1, 1, 1, 0.5]), rtol=1e-12)
        np.testing.assert_array_equal(position[:, 1], 0)

    def test_stress_of_a_linear_field(self):
        body = self.problem().bodies["lower"]
        x, y = body.mesh.points.T
        strain = body.strain(np.column_stack([2 * x + 5 * y, 3 * x - 4 * y]))
        np.testing.assert_allclose(strain, np.tile([2, -4, 8], (len(strain), 1)), atol=1e-11)
        stress = body.elastic_stress(strain)
        c = 3e11 / (1 - 0.09)
        np.testing.assert_allclose(stress[0], [c * (2 - 1.2), c * (0.6 - 4), 3e11 / 2.6 * 8], rtol=1e-10)

    def test_input_of_calculix(self):
        mesh = self.problem().bodies["upper"].mesh
        faces = calculix_code.faces(mesh, 1, 11)
        self.assertEqual(len(faces), 6)
        for line in faces:  # the face holds both ends of an edge on y = 0
            element, face = line.split(", ")
            corners = mesh.triangles[int(element) - 11]
            ends = [corners[i] for i in next(key for key, value in calculix_code.FACE.items()
                                             if value == face)]
            np.testing.assert_array_equal(mesh.points[ends, 1], 0)


if __name__ == "__main__":
    unittest.main()
