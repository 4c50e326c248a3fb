"""mortier study: complete tables, orders that theory knows, restart, runs that fail."""
import concurrent.futures
import re
import subprocess
import sys
import unittest

from study_support import SPACE, STUDIES, StudyTest
from support import HANGS, PROGRAM, ROOT, mortier

import results

# Time: all steps land on first yield (t = 0.1); the exact value is twice eps_22 of the projection
# `elasticity`.
TIME = f"""
scene = "{ROOT}/scenes/compression.toml"
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


class Studies(StudyTest):
    def run_study(self, text, *options):
        self.path.write_text(text)
        self.output = self.study(*options).stdout
        self.orders = {(name, error): (float(order), where) for order, where, error, name in
                       re.findall(r"^order (\S+) in (\S+) +([^:]+): (.*) \(\d+ runs\)$", self.output, re.M)}
        return self.output

    def assert_order(self, name, error, low, high, where):
        self.assertIn((name, error), self.orders, f"{self.output}{(self.out / 'study.csv').read_text()}")
        order, found = self.orders[name, error]
        self.assertEqual(found, where)
        self.assertTrue(low < order < high, f"{name}, {error}: order {order}, expected {low} to {high}")

    def assert_complete(self, count):
        rows = self.rows()
        self.assertEqual(len(rows), count)
        for row in rows:
            self.assertEqual(row["status"], "done", row["reason"])
            for column, value in row.items():
                if column.startswith("error ") or column in ("wall_time[s]", "memory[MiB]", "dofs",
                                                             "iterations"):
                    self.assertGreater(float(value), 0, column)
        return rows

    def test_results_read_at_the_same_time_leave_standard_output_as_it_was(self):
        run = self.folder / "run"
        mortier("run", STUDIES.parent / "exact-contact.toml", "--out", run, "--set", "time.steps=1")
        field = next(run.glob("*.vtu"))
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            out = sys.stdout
            list(pool.map(lambda _: results.read_vtu(field), range(40)))
        self.assertIs(sys.stdout, out)

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

    def test_contact_with_a_known_end(self):
        text = (STUDIES / "exact-contact.toml").read_text()
        text = text.replace('"../exact-contact', f'"{STUDIES.parent}/exact-contact')
        self.run_study(text.replace("level = [0, 1, 2, 3, 4]", "level = [1, 2, 3]"))
        rows = self.assert_complete(6)
        self.assert_order("mortar", "energy", 0.95, 1.05, "h")
        self.assert_order("interpolation", "energy", 0.8, 0.93, "h")
        self.assert_order("mortar", "contact pressure", 0.8, 1.35, "h")
        self.assert_order("interpolation", "contact pressure", -0.2, 0.2, "h")
        finest = {row["variant"]: float(row["error energy"]) for row in rows if row["level"] == "3"}
        # reference values of another program
        self.assertAlmostEqual(finest["mortar"] / 1.546e-2, 1, delta=5e-3)
        self.assertAlmostEqual(finest["interpolation"] / 1.963e-2, 1, delta=5e-3)

    def test_true_error_estimate_and_proved_bound(self):
        text = (STUDIES / "bound.toml").read_text()
        text = text.replace('"../exact-contact', f'"{STUDIES.parent}/exact-contact')
        self.run_study(text.replace("level = [0, 1, 2, 3]", "level = [0, 1]"))
        rows = self.assert_complete(6)
        for row in rows:
            error = float(row["error energy"])
            self.assertAlmostEqual(float(row["estimate"]) / error, 1, delta=0.06)
            if row["sweep"] == "without":
                self.assertEqual(row["bound"], "")
            else:
                self.assertTrue(1 < float(row["bound"]) / error < 1.25, row)

    def test_quadratic_and_adapted_meshes_on_contact_with_a_known_end(self):
        text = (STUDIES / "accuracy.toml").read_text()
        text = text[:text.index("[[sweep]]")].replace('"../exact-contact', f'"{STUDIES.parent}/exact-contact')
        output = self.run_study(text + """
[[sweep]]
name = "uniform"
degree = [1, 2]
level = [1, 2, 3]
[[sweep]]
name = "adapted"
degree = 2
level = 0
accuracy = [0.03, 0.003]
[[sweep]]
name = "codes"
degree = 2
level = 2
code = "freefem"
[[compare]]
error = "energy"
at = 3e-3
dear = { sweep = "uniform", degree = 1 }
cheap = "adapted"
""")
        *rows, freefem = self.rows()
        self.assert_order("uniform, degree 1", "energy", 0.9, 1.05, "h")
        self.assert_order("uniform, degree 2", "energy", 1.2, 1.8, "h")
        for row in rows:
            self.assertEqual(row["status"], "done", row["reason"])
            if row["accuracy"]:
                self.assertLess(float(row["error energy"]), float(row["accuracy"]))
        same = next(row for row in rows if (row["degree"], row["level"]) == ("2", "2"))
        self.assertEqual(same["dofs"], freefem["dofs"])
        self.assertAlmostEqual(float(freefem["error energy"]) / float(same["error energy"]), 1, delta=1e-4)
        ratio = re.search(r"dofs .* = (\S+) times", output)
        self.assertGreater(float(ratio[1]), 100)

    # ---- restart, failures, files ----
    def test_finished_runs_are_kept_and_the_report_holds_everything(self):
        text = SPACE.replace("[0, 1, 2]", "[0, 1]")
        self.run_study(text)
        path = self.out / "study.csv"
        lines = path.read_text().splitlines(keepends=True)
        column = lines[0].split(",").index("wall_time[s]")
        kept = lines[1].split(",")
        kept[column] = "123.0"
        path.write_text("".join([lines[0], ",".join(kept), *lines[3:]]))  # one row marked, one gone
        # A wider sweep keeps them too; another exact solution does not.
        self.assertIn("6 runs, 3 of them done before", self.run_study(SPACE))
        rows = self.assert_complete(6)
        self.assertEqual([float(row["wall_time[s]"]) == 123 for row in rows], [True, *[False] * 5])
        # Interpolation has order one half, mortar is exact.
        self.assert_order("sweep 0, interpolation", "energy", 0.4, 0.65, "h")
        self.assertLess(max(float(row["error energy"]) for row in rows if row["variant"] == "mortar"), 1e-10)
        self.check_report(rows)
        other = text.replace("[0, 1]", "0").replace("-10*t", "-11*t")
        self.assertIn("2 runs, 0 of them done before", self.run_study(other))

    def check_report(self, rows):
        names = sorted(path.name for path in self.out.iterdir())
        for cost in ("wall-time", "memory", "dofs"):
            for kind in ("svg", "png"):
                self.assertIn(f"energy-{cost}.{kind}", names)
        self.assertEqual(len(names), 9)  # no run folder, no temporary file is left
        report = (self.out / "report.html").read_text()
        self.assertEqual(report.count("data:image/svg+xml;base64,"), 3)
        self.assertEqual(re.findall(r"(?:src|href)=\"?(?!\"?data:).{20}", report), [])
        for row in rows:
            self.assertTrue(f"<td>{float(row['error energy']):.3e}</td>" in report)

    def test_a_run_that_fails_is_a_row_with_its_reason(self):
        text = SPACE.replace("level = [0, 1, 2]", "level = 0\nbody.upper.material.young = [-1, 3e11]")
        self.run_study(text.replace('variant = ["mortar", "interpolation"]', 'variant = "interpolation"')
                       + '[[sweep]]\nname = "codes"\ncode = "freefem"\n'
                         'scheme = ["sdirk2", "backward-euler"]\nsteps = 2\n')
        rows = self.rows()
        self.assertEqual([row["status"] for row in rows], ["failed", "done", "failed", "done"])
        self.assertIn("body upper: young = -1, expected young > 0", rows[0]["reason"])
        self.assertIn("scheme = sdirk2, expected backward-euler", rows[2]["reason"])
        self.assertIn("4 runs, 2 of them done before", self.study().stdout)  # what failed is tried again
        report = (self.out / "report.html").read_text()
        self.assertTrue("young = -1, expected young" in report)

    def test_another_code(self):
        text = (STUDIES / "exact-contact.toml").read_text()
        text = text[:text.index("[[sweep]]")].replace('"../exact-contact', f'"{STUDIES.parent}/exact-contact')
        self.path.write_text(text + '[[sweep]]\nlevel = 0\ncode = ["mortier", "freefem"]\n')
        self.mortier("study", "study.toml", "--out", "out")
        rows = self.rows()
        ours = float(rows[0]["error energy"])
        # FreeFEM integrates the tractions by another rule
        for row, allowed in zip(rows, (0, 1e-6)):
            with self.subTest(row["code"]):
                self.assertLessEqual(abs(float(row["error energy"]) / ours - 1), allowed, row["reason"])
                self.assertAlmostEqual(float(row["error contact force"]),
                                       float(rows[0]["error contact force"]), delta=0.02)

    def test_no_result_at_all_is_code_one(self):
        self.path.write_text(SPACE.replace("time.steps = 4", "body.material.poisson = 0.7")
                             .replace('["mortar", "interpolation"]', '"interpolation"'))
        self.study(code=1)

    def test_a_study_that_is_stopped_leaves_no_process_and_goes_on(self):
        text = SPACE.replace("time.steps = 4", "time.steps = [1, 1000000]").replace("[0, 1, 2]", "0")
        self.path.write_text(text.replace('["mortar", "interpolation"]', '"mortar"'))
        process = subprocess.Popen([PROGRAM, "study", self.path, "--out", self.out, "--jobs", "1"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while "1/2" not in process.stdout.readline():
            self.assertIsNone(process.poll())
        process.terminate()
        _, errors = process.communicate(timeout=HANGS)
        self.assertEqual(process.returncode, 1)
        self.assertIn("interrupted; finished runs are kept", errors)
        self.assertEqual([row["status"] for row in self.rows()], ["done"])
        self.assertNotIn(str(self.out), subprocess.run(["ps", "ax", "-o", "args"], capture_output=True,
                                                       text=True).stdout)


if __name__ == "__main__":
    unittest.main()
