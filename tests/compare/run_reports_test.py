"""What a run says of itself is what happened: peaks, resultants, accuracy, interference, displacements."""
import json
import unittest

from seeded import ELASTIC, SCENE, Case
from support import InFolder, told


class Reports(InFolder):
    def run_case(self, case, *settings, code=0):
        """Standard output, standard error and summary.json."""
        case.write(self.folder)
        options = ["--set", *settings] if settings else []
        done = self.mortier("run", "scene.toml", "--out", "out", *options, code=code)
        return done.stdout, done.stderr, json.loads((self.folder / "out" / "summary.json").read_text())

    def test_peaks_of_a_run_that_goes_up_and_down(self):
        case = Case(ELASTIC)
        case.replace("ty = -10", 'ty = "-10*(t < 0.5 ? 2*t : 2 - 2*t)"')
        text, _, summary = self.run_case(case, "time.steps=4")
        for key in ("von_mises", "pressure", "contact_force"):
            self.assertAlmostEqual(summary["peaks"][key]["value"], 10, delta=1e-9)
            self.assertEqual(summary["peaks"][key]["time"], 0.5)
        self.assertLess(summary["final"]["von_mises_max"], 1e-6)
        self.assertEqual(summary["accuracy"]["energy_error"], 0)
        self.assertEqual(summary["accuracy"]["largest_of_run"]["energy_error"], 0)
        self.assertRegex(text, r"peaks      von Mises 10 Pa at t = 0.5 s")
        self.assertIn("meshes only: below rounding", text)

    def test_the_error_of_the_loaded_state_is_kept(self):
        case = Case(ELASTIC)
        case.replace("ty = -10", 'ty = "-10*(t < 0.5 ? 2*t : 2 - 2*t)"')
        _, _, summary = self.run_case(case, "time.steps=4", "contact.variant=interpolation")
        loaded = self.run_case(case, "time.steps=1", "time.end=0.5", "contact.variant=interpolation")[2]
        at_peak = loaded["accuracy"]["energy_error"]
        self.assertGreater(at_peak, 1e-3)
        self.assertEqual(summary["accuracy"]["energy_error"], 0)
        largest = summary["accuracy"]["largest_of_run"]
        self.assertAlmostEqual(largest["energy_error"] / at_peak, 1, delta=0.1)
        self.assertEqual(largest["time"], 0.5)
        self.assertEqual(len(summary["accuracy"]["not_reliable"]), 1)

    def test_an_unloaded_run_has_no_error(self):
        case = Case(ELASTIC)
        case.replace("ty = -10", "ty = 0")
        text, _, summary = self.run_case(case)
        self.assertEqual(summary["accuracy"]["energy_error"], 0)
        self.assertIn("below rounding", text)

    def test_resultants_are_vectors(self):
        """A traction of 10 Pa downwards on the upper block: contact pushes it up with 10 N/m."""
        _, _, summary = self.run_case(Case(ELASTIC))
        for x, y in (summary["interfaces"][0]["resultant"], summary["final"]["contact_resultant"]):
            self.assertAlmostEqual(x, 0, delta=1e-9)
            self.assertAlmostEqual(y, 10, delta=1e-9)

    def test_a_run_that_fails_says_where_to_look(self):
        """Only one corner of the upper block flows, and its law takes more than the linear solves allowed."""
        case = Case(SCENE.replace("yield_stress = 1", "yield_stress = 1e6"))
        mesh = case.upper
        for triangle in mesh.triangles:
            if all(mesh.vertices[v - 1][0] >= 0.7 and mesh.vertices[v - 1][1] <= 0.3 for v in triangle[:3]):
                triangle[3] = 2
        case.replace('\n[[body]]\nname = "lower"', """[[body.region]]
label = 2
material = { young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1 }

[[body]]
name = "lower\"""")
        case.write(self.folder)
        done = self.mortier("run", "scene.toml", "--quiet", "--out", "out", "--set", "time.steps=4",
                            "solver.max_iterations=2", code=1)
        stuck = json.loads((self.folder / "out.failed" / "summary.json").read_text())["stuck"]
        self.assertEqual(stuck["body"], "upper")
        self.assertEqual(mesh.triangles[stuck["triangle"]][3], 2)
        corners = [mesh.vertices[v - 1] for v in mesh.triangles[stuck["triangle"]][:3]]
        for at, places in zip(stuck["at"], zip(*corners)):
            self.assertAlmostEqual(at, sum(places) / 3, places=12)
        self.assertGreater(stuck["material_residual"], 1e-10)
        driving = r'scene.toml:10: body upper: ty = "-10\*t", of size \S+ at t = \S+ s and \S+ at t = \S+ s'
        self.assertRegex(stuck["driven_by"], rf"\A{driving}\Z")
        self.assertRegex(done.stderr, r", at the stress s11 = \S+, s22 = \S+, s12 = \S+; largest residual "
                                      r"of the law, Perzyna \(frobenius\): body upper at \(\S+, \S+\), "
                                      r"triangle "
                                      rf"{stuck['triangle']}; loading: {driving}; the state "
                                      r"after step \d+ is in out.failed, which mortier plot draws\n\Z")

    def test_interference_that_is_meant_is_no_accident(self):
        for overlap in ("gap", "meshed"):
            with self.subTest(overlap):
                case = Case(ELASTIC)
                case.replace("ty = -10", "uy = 0")
                if overlap == "gap":
                    case.replace("[time]", "gap = -0.002\n[time]")
                else:
                    case.upper.move(lambda x, y: (x, y - 0.002))
                text, errors, summary = self.run_case(case)
                self.assertEqual((told(errors), errors), ([], ""))
                self.assertIn("interference 0.002 m", text)
                self.assertGreater(summary["final"]["max_pressure"], 0)
                checked = json.loads(self.mortier("check", "scene.toml", "--json").stdout)
                self.assertEqual([f["id"] for f in checked["faults"]], [])

    def test_check_warns_where_a_run_does(self):
        case = Case(ELASTIC)
        case.replace("poisson = 0.3 }", "poisson = 0.3 }\ninitial_stress = { s11 = 1 }")
        _, errors, _ = self.run_case(case)
        self.assertIn("is not in equilibrium", errors)
        checked = self.mortier("check", "scene.toml").stdout
        self.assertIn("is not in equilibrium", checked)

    def test_displacements_beyond_the_body_are_named_in_the_log(self):
        case = Case(ELASTIC)
        case.replace("young = 3e11", "young = 1e-3")
        text, _, _ = self.run_case(case, "contact.sliding=allow")
        self.assertRegex(text, r"warning    displacements reach .* times the size of a body at t = 0 s")

    def test_history_has_the_peaks(self):
        case = Case(SCENE)
        _, _, summary = self.run_case(case, "time.steps=5")
        header, *rows = (self.folder / "out" / "history.csv").read_text().splitlines()
        column = header.split(",").index("von_mises_max[Pa]")
        values = [float(row.split(",")[column]) for row in rows]
        self.assertEqual(max(values), summary["peaks"]["von_mises"]["value"])


if __name__ == "__main__":
    unittest.main()
