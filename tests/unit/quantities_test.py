"""Quantities of a scene: columns of the history, the log and the summary, and what cannot be asked for."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))

from scene_parts import quantity  # noqa: E402
from scenes import HELD_AND_PRESSED, TWO_BLOCKS  # noqa: E402
from support import OfTwoBlocks, mortier  # noqa: E402

ASKED = HELD_AND_PRESSED + (quantity("turns", "reaction", "lower", 1, "moment", about=[0.5, 0])
                            + quantity("sinks", "displacement", "upper", component="y", point=[0.25, 1])
                            + quantity("top", "displacement", "upper", 3, "y"))


ENERGIES = "".join(f"""
[[quantity]]
name = "{name}"
{what}
""" for name, what in (
    ("upper-work", "work = { body = 'upper' }"), ("upper-stored", "stored_energy = { body = 'upper' }"),
    ("upper-heat", "dissipated_energy = { body = 'upper' }"), ("lower-work", "work = { body = 'lower' }"),
    ("lower-stored", "stored_energy = { body = 'lower' }"),
    ("lower-heat", "dissipated_energy = { body = 'lower' }"),
    ("outside", "external_work = { body = 'upper' }"),
    ("press", "largest_pressure = { body = 'upper', label = 1 }"),
    ("touch", "contact_length = { body = 'lower', label = 3 }"),
    ("stress", "largest_mises = { body = 'lower' }")))


class Quantities(OfTwoBlocks):
    def test_columns_log_and_summary(self):
        self.write(TWO_BLOCKS + ASKED)
        run = self.mortier("run", "scene.toml", "--out", "out")
        rows = self.rows_of("out/history.csv")
        self.assertEqual(len(rows), 4)
        for i, row in enumerate(rows):
            load = 10 * (i + 1) / 4
            self.assertAlmostEqual(float(row["held[N/m]"]), load, delta=1e-11)
            self.assertAlmostEqual(float(row["pressed[N/m]"]), -load, delta=1e-11)
            self.assertAlmostEqual(float(row["turns[N]"]), 0, delta=1e-10)
            self.assertAlmostEqual(float(row["sinks[m]"]) / float(row["top[m]"]), 1, places=12)
        final = self.summary_of()["quantities"]
        self.assertEqual(final["held"]["value"], float(rows[-1]["held[N/m]"]))
        self.assertEqual(final["turns"]["unit"], "N")
        self.assertRegex(run.stdout, r"\nquantities held 10 N/m \+- 0, pressed -10 N/m \+- 0, "
                                     r"turns .* N \+- 0, sinks -\S+ m \+- 0, top -\S+ m \+- 0\n")
        self.assertIn("0 errors", self.mortier("check", "scene.toml").stdout)

    def test_energies_and_largest_values(self):
        self.write(TWO_BLOCKS + ENERGIES)
        for scheme in "backward-euler", "crank-nicolson", "sdirk2":
            run = self.mortier("run", "scene.toml", "--out", "out", "--set", f"time.scheme={scheme}",
                               "time.steps=40")
            rows = self.rows_of("out/history.csv")
            summary = self.summary_of()
            final = summary["quantities"]
            for row in rows:  # the lower body is elastic
                value = {name.split("[")[0]: float(row[name]) for name in row if name != "rung"}
                self.assertAlmostEqual(value["lower-work"] / value["lower-stored"], 1, delta=1e-11)
                self.assertEqual(value["lower-heat"], 0)
                self.assertAlmostEqual(value["stress"] / value["von_mises_max"], 1, delta=1e-11)
                self.assertAlmostEqual(value["press"] / value["max_pressure"], 1, delta=1e-12)
                self.assertAlmostEqual(value["touch"], 1, delta=1e-12)
            self.assertEqual(final["stress"]["unit"], "Pa")
            self.assertEqual(len(final["stress"]["at"]), 2)
            self.assertNotIn("at", final["touch"])
            self.assertEqual(final["lower-work"]["unit"], "J/m")
            balance = final["upper-stored"]["value"] + final["upper-heat"]["value"]
            self.assertGreater(final["upper-heat"]["value"], 0.5 * balance)
            self.assertAlmostEqual(balance / final["upper-work"]["value"], 1,
                                   delta=0.03 if scheme == "backward-euler" else 1e-3)
            for name, quantity in final.items():
                column = [float(row[f"{name}[{quantity['unit']}]"]) for row in rows] + [quantity["start"]]
                self.assertEqual(quantity["largest"]["value"], max(column))
                self.assertEqual(quantity["smallest"]["value"], min(column))
            self.assertEqual(final["press"]["largest"]["time"], 1)
            self.assertEqual([final[name]["estimated_error"] for name in ("lower-stored", "press", "touch",
                                                                         "stress")], [0, 0, 0, 0])
            self.assertIn("summed over the steps", final["upper-heat"]["no_estimate"])
            self.assertRegex(run.stdout, r"\nquantities .*upper-heat \S+ J/m \(no estimate: [^\n]*"
                                         r" stress \S+ Pa at \(\S+, \S+\) \+- 0\n"
                                         r" +\+-: estimated error because of the meshes[^\n]*\n"
                                         r"range      .*press 0 \(t = 0 s\) to 10 \(t = 1 s\)")

    def test_mean_pressures(self):
        part = ', from = [0.2, 0], to = [0.6, 0]'
        self.write(TWO_BLOCKS + "".join(
            f"[[quantity]]\nname = \"{name}\"\nmean_pressure = {{ body = \"{body}\", label = {label}{of} }}\n"
            for name, body, label, of in (("all", "upper", 1, ""), ("part", "upper", 1, part),
                                          ("soft", "lower", 3, part + ", margin = 0.1"))))
        run = self.mortier("run", "scene.toml", "--out", "out")
        rows = self.rows_of("out/history.csv")
        for i, row in enumerate(rows):
            for name in ("all", "part", "soft"):
                self.assertAlmostEqual(float(row[name + "[Pa]"]), 10 * (i + 1) / 4, delta=1e-11)
        self.assertRegex(run.stdout, r"\nquantities all 10 Pa \+- 0, part 10 Pa \+- 0, soft 10 Pa \+- 0\n")
        for of, message in (
                (", from = [0.2, 0]", "to"), (", margin = 0.1", "expected it only beside from and to"),
                (part + ", margin = -1", "margin = -1, expected"),
                (", from = [0.2, 0], to = [0.2, 0]", "from and to are one point of the line"),
                (", from = [0.2, 0.5], to = [0.6, 0]", "from is not on the line"),
                (", from = [0.2, 0], to = [0.6, 9]", "to is not on the line")):
            with self.subTest(of):
                errors = self.mortier(
                    "run", "scene.toml", "--quiet", "--out", "none", "--set",
                    f"quantity=[{{name='a', mean_pressure={{body='upper', label=1{of}}}}}]", code=2).stderr
                self.assertIn(message, errors)
                self.assertFalse((self.folder / "none").exists())
        errors = self.mortier("run", "scene.toml", "--quiet", "--set",
                              "quantity=[{name='a', mean_pressure={body='upper', label=3}}]", code=2).stderr
        self.assertIn("label 3 of body upper is no side of a contact", errors)

    def test_what_cannot_be_asked_for(self):
        self.write(TWO_BLOCKS + ASKED)
        for setting, message in (
                ("quantity.held.reaction.label=2", "quantity held: label 2 of body lower has no prescribed "
                                                   "displacement"),
                ("quantity.held.reaction.label=9", "body lower: label = 9, expected one of 1, 2, 3, 4"),
                ("quantity.held.reaction.body=middle", "quantity held: reaction: body = \"middle\", expected "
                                                       "one of upper, lower"),
                ("quantity.pressed.contact_force.label=1",
                 "quantity pressed: label 1 of body lower is no side of a contact"),
                ("quantity.sinks.displacement.point=[3, 3]",
                 "quantity sinks: point = [3, 3], expected a point of body upper"),
                ("quantity.sinks.displacement.point=[3]", "quantity sinks: displacement: point = an array, "
                                                          "expected two numbers"),
                ("quantity.sinks.component=moment",
                 "quantity sinks: component = \"moment\", expected one of x, y"),
                ("quantity.held.about=[0, 0]", "quantity held: about = an array, expected it only "
                                               "beside component"),
                ("quantity.held.name=top", "quantity top: name = \"top\", expected a name of its own, "
                                           "there is one at"),
                ("quantity.held.name=a,b", "quantity a,b: name = \"a,b\", expected letters, digits, _ and -"),
                ("quantity.held.displacement={body='upper', label=3}",
                 "quantity held: more than one of reaction, contact_force"),
                ("quantity.held.work={body='upper'}", "quantity held: more than one of reaction"),
                ("quantity=[{name='a', work={body='upper'}, component='x'}]",
                 "quantity a: component = \"x\", expected it only beside forces and displacements"),
                ("quantity=[{name='a', stored_energy={body='upper', label=1}}]", "unknown key label"),
                ("quantity=[{name='a', stored_energy={body='none'}}]", "expected one of upper, lower"),
                ("quantity=[{name='a', contact_length={body='upper', label=3}}]",
                 "quantity a: label 3 of body upper is no side of a contact"),
                ("quantity=[{name='a', largest_pressure={body='upper', label=2}}]",
                 "quantity a: label 2 of body upper is no side of a contact"),
                ("quantity=[{name='a', component='x'}]", "quantity a: none of reaction, contact_force")):
            with self.subTest(setting):
                errors = self.mortier("run", "scene.toml", "--quiet", "--set", setting, code=2).stderr
                self.assertIn(message, errors)
                self.assertFalse((self.folder / "out").exists())
                checked = mortier("check", "scene.toml", "--set", setting, cwd=self.folder)
                self.assertEqual(checked.returncode, 2)
                self.assertIn(": error: ", checked.stdout)


if __name__ == "__main__":
    unittest.main()
