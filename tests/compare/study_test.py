"""mortier study: complete tables, orders that theory knows, restart, runs that fail, wrong inputs."""
import csv
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import support

sys.path.insert(0, str(support.ROOT / "study"))

import analysis  # noqa: E402
import measure  # noqa: E402
import plan  # noqa: E402
import process  # noqa: E402
import results  # noqa: E402
from expressions import Expression  # noqa: E402
from problems import RunFailure, StudyError  # noqa: E402

MORTIER = os.environ.get("MORTIER", str(support.ROOT / "build" / "mortier"))
STUDIES = support.ROOT / "scenes" / "studies"

# Time: all steps land on first yield (t = 0.1); the exact value is twice eps_22 of the projection `elasticity`.
TIME = f"""
scene = "{support.ROOT}/scenes/compression.toml"
[mesh]
upper = {{ kind = "crisscross", cells = [2], lower = [0, 0], upper = [1, 1] }}
lower = {{ kind = "crisscross", cells = [5], lower = [0, -1], upper = [1, 0] }}
[[error]]
name = "u2"
quantity = "displacement_min_y"
exact = -0.39250058416512
[[error]]
name = "u2 of a finer run"
quantity = "displacement_min_y"
[[error]]
name = "displacement"
quantity = "displacement"
[reference]
steps = 1000
scheme = "sdirk2"
[[sweep]]
name = "backward Euler"
scheme = "backward-euler"
steps = [50, 100, 200]
[[sweep]]
name = "SDIRK2"
scheme = "sdirk2"
steps = [50, 100, 200]
[[compare]]
error = "u2"
at = 1e-3
dear = "backward Euler"
cheap = {{ sweep = "SDIRK2" }}
"""

SPACE = f"""
scene = "{support.ROOT}/scenes/compression.toml"
[mesh]
upper = {{ kind = "crisscross", cells = [3, 6, 12], lower = [0, 0], upper = [1, 1] }}
lower = {{ kind = "crisscross", cells = [8, 16, 32], lower = [0, -1], upper = [1, 0] }}
[[error]]
quantity = "energy"
exact = {{ s11 = "0", s22 = "-10*t", s12 = "0" }}
[[sweep]]
variant = ["mortar", "interpolation"]
level = [0, 1, 2]
time.steps = 4
"""

WRONG = [  # what is changed in SPACE, and the message that comes with exit code 2
    ("scene = ", "scen = ", "study.toml:2: unknown key scen, did you mean scene?"),
    ("compression.toml", "none.toml", "study.toml:2: scene = "),
    ("[mesh]", "[mesh", "study.toml:3: not TOML: "),
    ("[mesh]", "[[mesh]]", "study.toml:3: mesh = "),
    ("upper = { kind", "uper = { kind", "study.toml:4: mesh: uper, expected one of the bodies upper, lower"),
    ("cells = [3, 6, 12]", "cells = [3, 6]", "study.toml:3: mesh: upper: 2, lower: 3 levels, expected as many for each body"),
    ("cells = [3, 6, 12]", "cells = [3, 6, 0]", "study.toml:4: mesh upper: cells = [3, 6, 0], expected a list of N or"),
    ("cells = [3, 6, 12]", "cels = [3, 6, 12]", "study.toml:4: mesh upper: cells is missing"),
    ("kind = \"crisscross\", cells = [3", "kind = \"cross\", cells = [3", "study.toml:4: mesh upper: kind = \"cross\", expected one of"),
    ("lower = [0, 0]", "lower = [0, nan]", "study.toml:4: mesh upper: lower = [0, NaN], expected [X, Y]"),
    ("\"energy\"", "\"enrgy\"", "study.toml:7: error 0: quantity = \"enrgy\", expected one of energy, displacement"),
    ("exact = {", "exct = {", "study.toml:8: error energy: unknown key exct, did you mean exact?"),
    ("exact = { s11 = \"0\", s22 = \"-10*t\", s12 = \"0\" }", "", "study.toml:6: error energy: exact is missing, expected exact or a table"),
    ("s22 = \"-10*t\"", "s22 = \"-10*s\"", "study.toml:8: exact: s22 = \"-10*s\", expected a number or an expression in x, y, t (unknown name s)"),
    ("s22 = \"-10*t\"", "s22 = \"__import__('os')\"", "study.toml:8: exact: s22 = "),
    ("s22 = \"-10*t\"", "s22 = \"(1\"", "study.toml:8: exact: s22 = \"(1\", expected"),
    ("s22 = \"-10*t\", ", "", "study.toml:8: exact: s22 is missing"),
    ("[[sweep]]\n", "[[sweep]]\nlevl = 1\n", "study.toml:10: sweep sweep 0: unknown axis levl, did you mean level?"),
    ("level = [0, 1, 2]", "level = [0, 1, 3]", "study.toml:11: sweep sweep 0: level = 3, expected a level below 3"),
    ("level = [0, 1, 2]", "level = []", "study.toml:11: sweep sweep 0: level = [], expected one value or more"),
    ("level = [0, 1, 2]", "steps = [1.5]", "study.toml:11: sweep sweep 0: steps = 1.5, expected integers >= 1"),
    ("level = [0, 1, 2]", "code = \"abaqus\"", "study.toml:11: sweep sweep 0: code = \"abaqus\", expected one of mortier"),
    ("level = [0, 1, 2]", "steps = 2\ntolerance = 1e-3", "study.toml:12: sweep sweep 0: steps and tolerance, expected one"),
    ("[[sweep]]", "[swep]", "study.toml:9: unknown key swep, did you mean sweep?"),
    ("[[sweep]]\n", "[[compare]]\nerror = \"u\"\n[[sweep]]\n", "study.toml:10: compare 0: error = \"u\", expected the name of an error"),
    ("[[sweep]]\n", "[[compare]]\nerror = \"energy\"\nat = 0\n[[sweep]]\n", "study.toml:11: compare 0: at = 0, expected a number > 0"),
    ("[[sweep]]\n", "repeat = 0\n[[sweep]]\n", "study.toml:9: error energy: unknown key repeat"),
]


def study(path, out, *options):
    return subprocess.run([MORTIER, "study", str(path), "--out", str(out), *options], capture_output=True, text=True)


def rows_of(out):
    with open(Path(out) / "study.csv", newline="") as file:
        return list(csv.DictReader(file))


class Studies(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.out = self.folder / "out"

    def run_study(self, text, *options):
        path = self.folder / "study.toml"
        path.write_text(text)
        result = study(path, self.out, *options)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.orders = {(name, error): (float(order), where) for order, where, error, name in
                       re.findall(r"^order (\S+) in (\S+) +([^:]+): (.*) \(\d+ runs\)$", result.stdout, re.M)}
        return result.stdout

    def assert_order(self, name, error, low, high, where):
        order, found = self.orders[name, error]
        self.assertEqual(found, where)
        self.assertTrue(low < order < high, f"{name}, {error}: order {order}, expected {low} to {high}")

    def assert_complete(self, count):
        rows = rows_of(self.out)
        self.assertEqual(len(rows), count)
        for row in rows:
            self.assertEqual(row["status"], "done", row["reason"])
            for column, value in row.items():
                if column.startswith("error ") or column in ("wall_time[s]", "memory[MiB]", "dofs", "iterations"):
                    self.assertGreater(float(value), 0, column)
        return rows

    # ---- orders that theory knows ----
    def test_time_schemes_have_their_orders(self):
        output = self.run_study(TIME)
        self.assert_complete(6)
        self.assert_order("backward Euler", "u2", 0.97, 1.03, "k")
        self.assert_order("SDIRK2", "u2", 1.8, 2.1, "k")
        self.assert_order("SDIRK2", "u2 of a finer run", 1.8, 2.2, "k")
        self.assert_order("backward Euler", "displacement", 0.97, 1.03, "k")
        self.assertIn("u2 = 0.001: backward Euler  over  SDIRK2", output)
        # Backward Euler's error is 1.13/N: 1130 steps, against the 50 of SDIRK2 at most (2 solves each).
        self.assertNotIn("dofs", output[output.index("u2 = 0.001"):])
        dear, cheap = re.search(r"iterations +(\S+) \(extrapolated\) / (\S+) \(at most\)", output).groups()
        self.assertTrue(1100 < float(dear) < 1300 and 100 <= float(cheap) <= 130, output)

    def test_interpolation_has_order_one_half_and_mortar_is_exact(self):
        self.run_study(SPACE)
        rows = self.assert_complete(6)
        self.assert_order("sweep 0, interpolation", "energy", 0.4, 0.65, "h")
        self.assertLess(max(float(row["error energy"]) for row in rows if row["variant"] == "mortar"), 1e-10)

    def test_contact_with_a_known_end(self):
        text = (STUDIES / "exact-contact.toml").read_text()
        text = text.replace('"exact-contact.scene', f'"{STUDIES}/exact-contact.scene')
        self.run_study(text.replace("level = [0, 1, 2, 3, 4]", "level = [1, 2, 3]"))
        rows = self.assert_complete(6)
        self.assert_order("mortar", "energy", 0.95, 1.05, "h")
        self.assert_order("interpolation", "energy", 0.8, 0.93, "h")
        self.assert_order("mortar", "contact pressure", 0.8, 1.35, "h")
        self.assert_order("interpolation", "contact pressure", -0.2, 0.2, "h")
        finest = {row["variant"]: float(row["error energy"]) for row in rows if row["level"] == "3"}
        self.assertAlmostEqual(finest["mortar"] / 1.546e-2, 1, delta=5e-3)  # reference values of another program
        self.assertAlmostEqual(finest["interpolation"] / 1.963e-2, 1, delta=5e-3)

    # ---- restart, failures, files ----
    def test_finished_runs_are_kept(self):
        text = SPACE.replace("[0, 1, 2]", "[0, 1]")
        self.run_study(text)
        path = self.out / "study.csv"
        lines = path.read_text().splitlines(keepends=True)
        column = lines[0].split(",").index("wall_time[s]")
        kept = lines[1].split(",")
        kept[column] = "123.0"
        path.write_text("".join([lines[0], ",".join(kept), *lines[3:]]))  # one row marked, one gone
        output = self.run_study(text)
        self.assertIn("4 runs, 3 of them done before", output)
        walls = [float(row["wall_time[s]"]) for row in self.assert_complete(4)]
        self.assertEqual([wall == 123 for wall in walls], [True, False, False, False])
        # A wider sweep keeps them too; another exact solution does not.
        self.assertIn("6 runs, 4 of them done before", self.run_study(SPACE))
        self.assertIn("6 runs, 0 of them done before", self.run_study(SPACE.replace("-10*t", "-11*t")))

    def test_another_scene_or_mesh_is_another_study(self):
        (self.folder / "scene.toml").write_text((support.ROOT / "scenes" / "compression.toml").read_text()
                                                .replace("../shared-meshes", str(self.folder)))
        meshes = support.ROOT / "shared-meshes"
        for name in ("upper-crisscross-6.mesh", "lower-crisscross-16.mesh"):
            (self.folder / name).write_text((meshes / name).read_text())
        path = self.folder / "study.toml"
        path.write_text(f'scene = "scene.toml"\n{SPACE[SPACE.index("[[error]]"):SPACE.index("[[sweep]]")]}'
                        '[[sweep]]\nsteps = 2\n')

        def keys():
            done = plan.read(path)
            return [done.key(case) for case in done.cases()]
        first = keys()
        self.assertEqual(first, keys())
        for name in ("scene.toml", "lower-crisscross-16.mesh"):
            with open(self.folder / name, "a") as file:
                file.write("\n# other\n")
            self.assertNotEqual(first, keys())
            first = keys()

    def test_a_run_that_fails_is_a_row_with_its_reason(self):
        text = SPACE.replace("level = [0, 1, 2]", "level = 0\nbody.upper.material.young = [-1, 3e11]")
        self.run_study(text.replace('variant = ["mortar", "interpolation"]', 'variant = "interpolation"')
                       + '[[sweep]]\nname = "codes"\ncode = "freefem"\nscheme = ["sdirk2", "backward-euler"]\nsteps = 2\n')
        rows = rows_of(self.out)
        self.assertEqual([row["status"] for row in rows], ["failed", "done", "failed", "done"])
        self.assertIn("body upper: young = -1, expected young > 0", rows[0]["reason"])
        self.assertIn("scheme = sdirk2, expected backward-euler", rows[2]["reason"])
        again = study(self.folder / "study.toml", self.out)
        self.assertIn("4 runs, 2 of them done before", again.stdout)  # what failed is tried again
        report = (self.out / "report.html").read_text()
        self.assertTrue("young = -1, expected young" in report)

    def test_other_codes(self):
        text = (STUDIES / "exact-contact.toml").read_text()
        text = text[:text.index("[[sweep]]")].replace('"exact-contact.scene', f'"{STUDIES}/exact-contact.scene')
        self.out = Path("out")  # relative: some codes run in a folder of their own
        path = self.folder / "study.toml"
        path.write_text(text + '[[sweep]]\nlevel = 1\ncode = ["mortier", "freefem", "getfem", "calculix"]\n')
        result = subprocess.run([MORTIER, "study", path.name, "--out", "out"], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = rows_of(self.folder / "out")
        ours = float(rows[0]["error energy"])
        for row, allowed in zip(rows, (0, 1e-6, 0.02, 0.1)):  # FreeFEM integrates the tractions by another rule
            with self.subTest(row["code"]):
                if row["code"] in ("getfem", "calculix") and row["status"] == "failed":
                    self.assertIn("is not installed", row["reason"])
                    continue
                self.assertLessEqual(abs(float(row["error energy"]) / ours - 1), allowed, row["reason"])
                self.assertAlmostEqual(float(row["error contact force"]), float(rows[0]["error contact force"]), delta=0.02)

    def test_no_result_at_all_is_code_one(self):
        path = self.folder / "study.toml"
        path.write_text(SPACE.replace("time.steps = 4", "body.material.poisson = 0.7")
                        .replace('["mortar", "interpolation"]', '"interpolation"'))
        self.assertEqual(study(path, self.out).returncode, 1)

    def test_report_holds_everything(self):
        self.run_study(SPACE.replace("[0, 1, 2]", "[0, 1]"))
        names = sorted(path.name for path in self.out.iterdir())
        for cost in ("wall-time", "memory", "dofs"):
            for kind in ("svg", "png"):
                self.assertIn(f"energy-{cost}.{kind}", names)
        self.assertEqual(len(names), 8)  # no run folder, no temporary file is left
        report = (self.out / "report.html").read_text()
        self.assertEqual(report.count("data:image/svg+xml;base64,"), 3)
        self.assertEqual(re.findall(r"(?:src|href)=\"?(?!\"?data:).{20}", report), [])
        for row in rows_of(self.out):
            self.assertTrue(f"<td>{float(row['error energy']):.3e}</td>" in report)

    def test_a_study_that_is_stopped_leaves_no_process_and_goes_on(self):
        text = SPACE.replace("time.steps = 4", "time.steps = [1, 1000000]").replace("[0, 1, 2]", "0")
        path = self.folder / "study.toml"
        path.write_text(text.replace('["mortar", "interpolation"]', '"mortar"'))
        process = subprocess.Popen([MORTIER, "study", path, "--out", self.out, "--jobs", "1"], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        while "1/2" not in process.stdout.readline():
            self.assertIsNone(process.poll())
        process.terminate()
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1)
        self.assertIn("interrupted; finished runs are kept", errors)
        self.assertEqual([row["status"] for row in rows_of(self.out)], ["done"])
        self.assertNotIn(str(self.out), subprocess.run(["ps", "ax", "-o", "args"], capture_output=True, text=True).stdout)

    def test_wrong_inputs(self):
        path = self.folder / "study.toml"
        for old, new, message in WRONG:
            with self.subTest(new=new):
                self.assertIn(old, SPACE)
                path.write_text(SPACE.replace(old, new, 1))
                with self.assertRaises(StudyError) as caught:
                    plan.read(path)
                self.assertTrue(str(caught.exception).startswith(f"{self.folder}/{message}"),
                                f"\nexpected {message}\nis       {caught.exception}")
                self.assertNotIn("\n", str(caught.exception))

    def test_wrong_inputs_of_the_program(self):
        path = self.folder / "study.toml"
        path.write_text(SPACE.replace("levl", "level").replace("cells = [3", "cells = [0"))
        for arguments, message in (((path,), f"mortier: {path}:4: mesh upper: cells = "),
                                   ((self.folder / "none.toml",), f"mortier: {self.folder}/none.toml: No such file"),
                                   ((self.folder,), f"mortier: {self.folder}: Is a directory"),
                                   ((path, "--jobs", "0"), "--jobs: Value 0 not in range"), ((), "STUDY")):
            with self.subTest(arguments=arguments):
                result = subprocess.run([MORTIER, "study", *map(str, arguments)], capture_output=True, text=True,
                                        cwd=self.folder)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(message, result.stderr)
                self.assertTrue(result.stderr.startswith("mortier: "), result.stderr)
                self.assertFalse((self.folder / "out").exists())

    def test_other_files_are_never_replaced(self):
        self.out.mkdir()
        (self.out / "thesis.txt").write_text("mine")
        path = self.folder / "study.toml"
        path.write_text(SPACE)
        self.assertEqual(study(path, self.out).returncode, 2)
        self.assertEqual([each.name for each in self.out.iterdir()], ["thesis.txt"])


def square(cells):
    """A body on the unit square with the fields u = (x, 2 y), s = (x, 1, 0) at the centroids."""
    n = cells + 1
    x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
    points = np.column_stack([x.ravel(), y.ravel()])
    a = (np.arange(cells)[:, None] * n + np.arange(cells)).ravel()
    triangles = np.vstack([np.column_stack([a, a + 1, a + n]), np.column_stack([a + 1, a + n + 1, a + n])])
    stress = np.column_stack([points[triangles].mean(1)[:, 0], np.ones(len(triangles)), np.zeros(len(triangles))])
    return results.Run("test", Path("."), {"b": results.Body(points * [1, 2], stress, points, triangles)}, None, {})


class Norms(unittest.TestCase):
    MATERIALS = {"b": (2.0, 0.25)}

    def exact(self, **components):
        return measure.Exact({"": {c: Expression(e) for c, e in components.items()}}, [], 1.0)

    def test_linear_displacements_are_exact(self):
        error = measure.field_error("displacement", square(3), self.exact(ux="x", uy="2*y*t"), self.MATERIALS)
        self.assertLess(error, 1e-15)

    def test_energy_norm_of_a_known_difference(self):
        # s - exact = (x - xc, 0, 0): the energy of a linear function about its mean, h^2/18 |T| a right triangle,
        # over that of (x, 1, 0): (1/3 + 1 - 2 nu/2).
        error = measure.field_error("energy", square(4), self.exact(s11="x", s22="1", s12="0"), self.MATERIALS)
        self.assertAlmostEqual(error, np.sqrt(1 / 16 / 18 / (1 / 3 + 1 - 0.25)), places=12)

    def test_against_a_finer_run(self):
        coarse, fine = square(2), square(8)
        self.assertLess(measure.field_error("displacement", coarse, fine, self.MATERIALS), 1e-14)
        self.assertEqual(measure.field_error("energy", fine, fine, self.MATERIALS), 0)
        difference = measure.field_error("energy", coarse, fine, self.MATERIALS)
        exact = measure.field_error("energy", coarse, self.exact(s11="x", s22="1", s12="0"), self.MATERIALS)
        self.assertAlmostEqual(difference / exact, np.sqrt(1 - 1 / 16), delta=2e-3)  # what the finer run lacks

    def test_pressure_from_nodal_forces(self):
        s = np.array([0, 0.2, 0.7, 1.0])
        mass = np.array([[2, 1, 0, 0], [1, 7, 2.5, 0], [0, 2.5, 8, 1.5], [0, 0, 1.5, 3]]) * 0.2 / 6
        run = results.Run("test", Path("."), {}, results.Contact(np.arange(4), np.column_stack([s, 0 * s]), 0 * s,
                                                                 mass @ (1 + s)), {})
        self.assertLess(measure.pressure_error(run, self.exact(p="1 + x")), 1e-14)

    def test_expressions(self):
        x = np.array([-1.0, 0.5])
        for text, value in (("2^3^0.5", 2**3**0.5), ("-2^2", -4), ("x < 0 ? -1 : x > 0.4 && x < 1 ? 2 : 3", [-1, 2]),
                            ("max(x, 0) + min(1, 2)", [1, 1.5]), ("abs(x ? x : 1)", [1, 0.5]), ("1e-3*t", 2e-3)):
            np.testing.assert_allclose(Expression(text)(x, 0 * x, 2.0), np.broadcast_to(value, 2), err_msg=text)
        for text in ("x.real", "[1]", "lambda: 1", "open('f')", "x[0]", "'a'", "x if x else y", "z", "sin", "1 +", ")("):
            with self.assertRaises(ValueError, msg=text):
                Expression(text)(x, x, 0.0)

    def test_front_and_equal_error(self):
        self.assertEqual(analysis.front([(1, 1), (2, 2), (3, 0.5), (2.5, 0.9), (4, 0.5)]), [0, 3, 2])
        rows = [{"steps": n, "error e": 1 / n, "wall_time[s]": n} for n in (1, 2, 4, 8)]
        line = analysis.Series("s", {}, "steps", rows)
        self.assertAlmostEqual(analysis.order(line, "e")[0], 1, places=12)
        for at, value, how in ((0.3, 1 / 0.3, "between runs"), (0.01, 100, "extrapolated"), (2, 1, "at most")):
            found = analysis.cost_at(line, "e", at, "wall_time")
            self.assertAlmostEqual(found.value, value, places=9)
            self.assertEqual(found.how, how)

    def test_memory_and_time_of_a_process(self):
        cost, output = process.measured([sys.executable, "-c", "a = bytearray(300 << 20); print(len(a))"])
        self.assertEqual(output.strip(), str(300 << 20))
        self.assertTrue(300 < cost.memory < 340, cost.memory)
        small, _ = process.measured(["true"])
        self.assertLess(small.memory, 20)
        with self.assertRaisesRegex(RunFailure, "stopped after 0.2 s"):
            process.measured(["sleep", "60"], timeout=0.2)
        with self.assertRaisesRegex(RunFailure, "out of luck"):
            process.measured(["sh", "-c", "echo out of luck; exit 3"])


if __name__ == "__main__":
    unittest.main()
