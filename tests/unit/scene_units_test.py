"""Units of a scene: numbers with their own are converted, labels are the scene's, wrong ones are refused."""
import csv
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))

from scene_parts import quantity  # noqa: E402
from scenes import HELD_AND_PRESSED, TWO_BLOCKS  # noqa: E402
from support import ROOT, OfTwoBlocks  # noqa: E402

sys.path.insert(0, str(ROOT / "views"))
import runs  # noqa: E402

# TWO_BLOCKS with every number in a unit of its own.
MEASURED = TWO_BLOCKS.replace("young = 3e11", 'young = "300 GPa"').replace(
    "viscosity = 10, yield_stress = 1", 'viscosity = "1e-2 kPa s", yield_stress = "1 N/m^2"').replace(
    "end = 1\n", 'end = "1000 ms"\n').replace(
    'ty = "-10*t"', 'ty = { time = [0, "1 s"], value = [0, "-1e-2 kPa"] }')

ASKED = HELD_AND_PRESSED + (quantity("energy", "stored_energy", "upper")
                            + quantity("turns", "reaction", "lower", 1, "moment")
                            + quantity("top", "displacement", "upper", component="y", point=["500 um", 1])
                            + quantity("mises", "largest_mises", "lower"))


SI = 'units = "m, N, Pa"\n'


class SceneUnits(OfTwoBlocks):
    def run_of(self, name, text, *settings):
        (self.folder / f"{name}.toml").write_text(text)
        run = self.mortier("run", f"{name}.toml", "--out", name, *settings)
        return run.stdout, list(csv.reader(self.read(f"{name}/history.csv").splitlines()))

    def test_numbers_with_units_are_those_without(self):
        _, plain = self.run_of("plain", TWO_BLOCKS)
        _, measured = self.run_of("measured", 'units = "m, N, Pa"\n' + MEASURED)
        self.assertNotIn("units", self.summary_of("plain"))
        energy = plain[0].index("elastic_energy[J/m]")
        self.assertEqual(measured[0][energy], "elastic_energy[N m/m]")
        for a, b in zip(plain[1:], measured[1:]):
            for name, x, y in zip(plain[0], a, b):
                if name != "rung":
                    self.assertAlmostEqual(float(x), float(y), delta=1e-9 * abs(float(x)) + 1e-15, msg=name)

    def test_a_scene_in_hours_is_that_in_seconds(self):
        _, plain = self.run_of("plain", TWO_BLOCKS)
        log, hours = self.run_of("hours", 'units = "m, N, Pa, h"\n' + MEASURED)
        self.assertIn("  time[h]  ", log)
        self.assertEqual(hours[0][1:3], ["time[h]", "time_step[h]"])
        for a, b in zip(plain[1:], hours[1:]):
            for name, x, y in zip(plain[0], a, b):
                if name != "rung":
                    expected = float(x) / (3600 if name.startswith("time") else 1)
                    self.assertAlmostEqual(expected, float(y), delta=1e-9 * abs(expected) + 1e-15, msg=name)
        self.assertEqual(self.summary_of("hours")["units"]["time"], "h")
        self.assertEqual(runs.read(self.folder / "hours").time_unit, "h")
        self.mortier("freefem", "hours.toml", "hours.edp")
        self.assertIn("// viscosity [Pa h]", self.read("hours.edp"))

    def test_temperatures_have_units(self):
        """Differences: a degree Celsius is a kelvin, one of Fahrenheit five ninths of it."""
        def top(expansion, temperature, units=SI):
            blocks = TWO_BLOCKS.replace("young = 3e11", f"young = 3e11, expansion = {expansion}")
            blocks = blocks.replace('name = "upper"\n', f'name = "upper"\ntemperature = {temperature}\n')
            asked = ASKED[len(HELD_AND_PRESSED):].replace('"500 um"', "0.5")
            _, rows = self.run_of("hot", units + blocks + asked)
            return float(rows[-1][next(i for i, name in enumerate(rows[0]) if name.startswith("top["))])

        plain = top("1.2e-11", "3")
        for expansion, temperature in (('"1.2e-11 1/K"', '"3 K"'), ('"1.2e-11 1/degC"', '"3 \u00b0C"'),
                                       ('"1.2e-11 1/K"', '"5.4 degF"'),
                                       ('1.2e-11', '{ time = [0, "1 s"], value = ["3 degC", "3 K"] }')):
            with self.subTest(expansion=expansion, temperature=temperature):
                self.assertAlmostEqual(top(expansion, temperature)/plain, 1, delta=1e-12)
        for units, key, value, expected in (
                (SI, "expansion", "1.2e-11 K", "a number in 1/K or of degC or degF"),
                (SI, "expansion", "1.2e-11 1/MPa", "a number in 1/K or of degC or degF"),
                ("", "expansion", "1.2e-11 1/K", "without them no number has a unit")):
            with self.subTest(key=key, value=value, units=units):
                (self.folder / "wrong.toml").write_text(
                    units + TWO_BLOCKS.replace("young = 3e11", f'young = 3e11, {key} = "{value}"'))
                told = self.mortier("run", "wrong.toml", code=2).stderr
                self.assertIn(f'{key} = "{value}", expected {expected}' if units else expected, told)

    def test_every_material_has_units(self):
        flow = 'viscosity = 10, yield_stress = 1, projection = "elasticity"'
        units = 'units = "mm, N, MPa, h"\n'
        for law, key, value, plain in (
                ('law = "norton", exponent = 3, reference_rate = 1e-4', "reference_stress", "2 GPa", 2000),
                ('law = "norton", exponent = 3, reference_stress = 10', "reference_rate", "1e-3 1/s", 3.6),
                ('law = "maxwell"', "relaxation_time", "30 min", 0.5)):
            with self.subTest(key):
                rows = []
                for given in (f'"{value}"', plain):
                    text = TWO_BLOCKS.replace(flow, f"{law}, {key} = {given}")
                    text = text.replace("[contact]", "[contact]\nsliding = 'allow'")  # strains are large
                    _, history = self.run_of("law", units + text)
                    rows.append(history[-1])
                self.assertEqual(*rows)

    def test_labels_are_those_of_the_scene(self):
        text = 'units = "mm, N, MPa"\n' + TWO_BLOCKS.replace("young = 3e11", 'young = "300 GPa"') + ASKED
        log, history = self.run_of("out", text)
        for column in ("penetration[mm^2]", "max_pressure[MPa]", "contact_force[N/mm]",
                       "displacement_max[mm]",
                       "elastic_energy[N mm/mm]", "held[N/mm]", "energy[N mm/mm]", "turns[N]", "top[mm]",
                       "mises[MPa]", "time[s]"):
            self.assertIn(column, history[0])
        self.assertIn("  penetration[mm^2]  max p[MPa]  viscoplastic  force[N/mm]\n", log)
        self.assertRegex(log, r"\nquantities held 10 N/mm \+- 0, .* mises \S+ MPa at \(\S+, \S+\) \+- 0\n")
        for wrong in (r"\bPa\b", r"N/m\b", r"\d m\b"):
            self.assertNotRegex(log, wrong)
        summary = self.summary_of()
        self.assertEqual(summary["units"], {"length": "mm", "force": "N", "stress": "MPa", "time": "s"})
        self.assertEqual(summary["quantities"]["top"]["unit"], "mm")
        result = runs.read(self.folder / "out")
        self.assertEqual((result.length_unit, result.stress_unit), ("mm", "MPa"))
        script = self.mortier("freefem", "out.toml", "out.edp")
        self.assertEqual(script.returncode, 0)
        self.assertIn("real E1 = 3e+05, nu1 = 0.3;  // [MPa], [-]", self.read("out.edp"))
        self.assertIn('string unitLength = "mm";', self.read("out.edp"))
        checked = self.mortier("check", "out.toml", "--set", "body.lower.material.young=3e9").stdout
        self.assertIn("have young = 3e+05 MPa and 3e+09 MPa", checked)

    def test_what_is_wrong_is_told_in_one_line(self):
        scene = 'units = "mm, N, MPa"\n' + TWO_BLOCKS
        (self.folder / "scene.toml").write_text(scene)
        (self.folder / "plain.toml").write_text(TWO_BLOCKS)
        for name, setting, message in (
                ("scene", "units=mm, N, Pa",
                 'units = "mm, N, Pa", expected a consistent set: 1 Pa is 1e-06 N/mm^2'),
                ("scene", "units=mm, N", "expected a length, a force and a stress"),
                ("scene", "units=furlong, N, Pa", '"furlong" is no unit that is known'),
                ("scene", "units=3", "units = 3, expected a length, a force and a stress"),
                ("scene", "body.upper.material.young=3 mm",
                 'young = "3 mm", expected a number in MPa or what can be converted to it'),
                ("scene", "body.upper.material.young=3 GPas", "GPas is no unit that is known"),
                ("scene", "body.upper.material.viscosity=3 MPa", "expected a number in MPa s"),
                ("scene", "body.upper.material.poisson=0.3 mm", "expected -1 < poisson < 0.5"),
                ("scene", "body.upper.material.young=-3 GPa", "young = -3000, expected young > 0"),
                ("scene", "body.upper.material.young=1e999 GPa", "expected young > 0"),
                ("scene", "body.upper.boundary.ty=3 N/mm", "expected a number in MPa"),
                ("scene", "time.end=1 m", "expected a number in s"),
                ("scene", "units=mm, N, MPa, h, s", "each once"),
                ("scene", "contact.shear_limit=3 s", "expected a number in MPa"),
                ("plain", "body.upper.material.young=3 GPa",
                 'young = "3 GPa", expected a number, or units = "m, N, Pa" at the top of the scene'),
                ("plain", "body.upper.boundary.ty=3 kPa", "without them no number has a unit")):
            with self.subTest(setting):
                told = self.mortier("run", f"{name}.toml", "--quiet", "--set", setting, code=2).stderr
                self.assertIn(message, told)
                self.assertEqual(told.count("\n"), 1, told)
                self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    unittest.main()
