"""Wrong scenes and settings: one line that names place, value and what was expected; exit code 2;
nothing is made."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))

from scenes import TWO_BLOCKS  # noqa: E402
from support import OfTwoBlocks  # noqa: E402

# What is changed in the scene above, and the message (after "mortier: ") that must come with exit code 2.
FAULTS = [
    # TOML
    ("end = 1", "end = ", "scene.toml:25: not TOML: "),
    ("[time]", "[time", "scene.toml:24: not TOML: "),
    ("steps = 4", "steps = 4\nsteps = 5", "scene.toml:27: not TOML: "),
    ("title", "a." * 100000 + "title", "scene.toml:1: a key of more than 32 names, expected a "
                                       "key of a scene"),
    ("[time]", "[time.'a.b'." + "a." * 100000 + "a]", "scene.toml:24: a key of more than 32 names, expected "
                                                      "a key of a scene"),
    # keys
    ("title", "\"\\u001b[31m\"", "scene.toml:1: unknown key ?[31m, expected one of title, plane, body"),
    ("title", "titel", "scene.toml:1: unknown key titel, did you mean title? Expected one of title, plane, "
                       "body, tool"),
    ("mesh = \"upper", "msh = \"upper", "scene.toml:5: body upper: unknown key msh, did you mean "
                                        "mesh? Expected"),
    ("poisson = 0.3, v", "nu = 0.3, v", "scene.toml:6: body upper: unknown key nu, expected one of "
                                        "young, poisson"),
    ("ux = 0\n", "vx = 0\n", "scene.toml:9: body upper: unknown key vx, did you mean ux?"),
    ("steps = 4", "step = 4", "scene.toml:26: time: unknown key step, did you mean steps?"),
    ("[time]", "[solver]\ntol = 1\n[time]", "scene.toml:25: solver: unknown key tol"),
    # missing
    ("name = \"upper\"\n", "", "scene.toml:3: body 0: name is missing, expected a string"),
    ("mesh = \"upper.mesh\"\n", "", "scene.toml:3: body upper: mesh is missing"),
    ("young = 3e11, poisson = 0.3, v", "poisson = 0.3, v",
     "scene.toml:6: body upper: young is missing, expected young > 0"),
    (", yield_stress = 1", "", "scene.toml:6: body upper: yield_stress is missing, expected "
                               "yield_stress > 0"),
    # laws
    ("young = 3e11", "law = \"nortn\", young = 3e11",
     "scene.toml:6: body upper: law = \"nortn\", expected one of elastic, perzyna, norton, "
     "maxwell, standard-solid, viscoplastic"),
    ("young = 3e11", "law = \"norton\", young = 3e11",
     "scene.toml:6: body upper: viscosity = 10, expected it beside law = \"perzyna\" or "
     "\"viscoplastic\" only"),
    ("young = 3e11", "law = \"elastic\", young = 3e11",
     "scene.toml:6: body upper: viscosity = 10, expected it beside law = \"perzyna\" or "
     "\"viscoplastic\" only"),
    ("young = 3e11", "exponent = 5, young = 3e11",
     "scene.toml:6: body upper: exponent = 5, expected it beside law = \"norton\" or "
     "\"viscoplastic\" only"),
    ("viscosity = 10, yield_stress = 1, projection = \"elasticity\"",
     "law = \"norton\", reference_stress = 1, exponent = 5",
     "scene.toml:6: body upper: reference_rate is missing, expected reference_rate > 0"),
    ("viscosity = 10, yield_stress = 1, projection = \"elasticity\"",
     "law = \"norton\", reference_stress = 1, reference_rate = 1, exponent = 0.5",
     "scene.toml:6: body upper: exponent = 0.5, expected exponent >= 1"),
    ("viscosity = 10, yield_stress = 1, projection = \"elasticity\"",
     "law = \"norton\", reference_stress = 0, reference_rate = 1, exponent = 5",
     "scene.toml:6: body upper: reference_stress = 0, expected reference_stress > 0"),
    ("viscosity = 10, yield_stress = 1, projection = \"elasticity\"",
     "law = \"norton\", reference_stress = 1, reference_rate = inf, exponent = 5",
     "scene.toml:6: body upper: reference_rate = inf, expected reference_rate > 0"),
    ("viscosity = 10, yield_stress = 1, projection = \"elasticity\"",
     "law = \"viscoplastic\", yield_stress = 1, viscosity = 1, exponent = 2",
     "scene.toml:6: body upper: exponent = 2, expected either viscosity or a power of the overstress"),
    ("viscosity = 10, yield_stress = 1, projection = \"elasticity\"",
     "law = \"viscoplastic\", yield_stress = 1, viscosity = -1",
     "scene.toml:6: body upper: viscosity = -1, expected viscosity >= 0"),
    ("viscosity = 10, yield_stress = 1, projection = \"elasticity\"",
     "law = \"viscoplastic\", yield_stress = 1, viscosity = 1, kinematic_hardening = -1",
     "scene.toml:6: body upper: kinematic_hardening = -1, expected kinematic_hardening >= 0"),
    ("viscosity = 10, yield_stress = 1, projection = \"elasticity\"",
     "law = \"viscoplastic\", yield_stress = 1, exponent = 3, reference_rate = 1",
     "scene.toml:6: body upper: reference_stress is missing, expected reference_stress > 0"),
    ("young = 3e11", "relaxation_time = 1, young = 3e11",
     "scene.toml:6: body upper: relaxation_time = 1, expected it beside law = \"maxwell\" or "
     "\"standard-solid\" only"),
    ("viscosity = 10, yield_stress = 1, projection = \"elasticity\"",
     "law = \"standard-solid\", relaxation_time = 1, relaxed_fraction = 1",
     "scene.toml:6: body upper: relaxed_fraction = 1, expected 0 < relaxed_fraction < 1"),
    ("steps = 4", "", "scene.toml:24: time: steps is missing, expected an integer >= 1"),
    ("[time]\nend = 1\nsteps = 4", "", "scene.toml:1: time is missing, expected a table [time] "
                                       "with end, steps"),
    ("label = 4\nux", "ux", "scene.toml:7: body upper: label is missing"),
    ("ux = 0\n", "", "scene.toml:7: body upper: boundary label 4 has no condition, expected one of ux, uy, "
                     "un, ut, tx, ty, pressure"),
    # types and ranges
    ("poisson = 0.3, v", "poisson = 0.6, v", "scene.toml:6: body upper: poisson = 0.6, expected -1 < "
                                             "poisson < 0.5"),
    ("young = 3e11, poisson = 0.3, v", "young = nan, poisson = 0.3, v",
     "scene.toml:6: body upper: young = nan, expected young > 0"),
    ("viscosity = 10", "viscosity = -inf", "scene.toml:6: body upper: viscosity = -inf, expected "
                                           "viscosity > 0"),
    ("young = 3e11, poisson = 0.3, v", "young = \"3e11\", poisson = 0.3, v",
     "scene.toml:6: body upper: young = \"3e11\", expected young > 0"),
    ("steps = 4", "steps = 0", "scene.toml:26: time: steps = 0, expected an integer >= 1"),
    ("steps = 4", "steps = 4.5", "scene.toml:26: time: steps = 4.5, expected an integer >= 1"),
    ("steps = 4", "steps = 1e12", "scene.toml:26: time: steps = 1e+12, expected an integer >= 1"),
    ("end = 1", "end = 2020-01-01", "scene.toml:25: time: end = a date, expected end > 0"),
    ("steps = 4", "steps = 4\nscheme = \"euler\"", "scene.toml:27: time: scheme = \"euler\", expected one of "
                                                   "backward-euler"),
    ("label = 3 }\n", "label = 3 }\nvariant = \"morta\"\n",
     "scene.toml:23: contact: variant = \"morta\", expected one of interpolation, mortar, weighted"),
    ("name = \"upper\"", "name = \"../up\"", "scene.toml:4: body ../up: name = \"../up\", expected letters, "
                                             "digits, _ and -"),
    ("material = { young = 3e11, poisson = 0.3 }", "material = \"steel\"",
     "scene.toml:17: body lower: \"steel\", expected a table"),
    ("title", "degree = 3\ntitle", "scene.toml:1: degree = 3, expected 1 or 2"),
    # data
    ("\"-10*t\"", "\"-10*\"", "scene.toml:12: body upper: ty = \"-10*\", expected an expression in x, y, t "
                              "(it ends where a value is expected, at character 5)"),
    ("\"-10*t\"", "\"-10*s\"", "scene.toml:12: body upper: ty = \"-10*s\", expected an expression in x, y, t "
                               "(unknown name s, at character 5)"),
    ("\"-10*t\"", "\"1/t\"", "scene.toml:12: body upper: ty = \"1/t\", expected a finite number, "
                             "is inf at x = "),
    ("\"-10*t\"", "inf", "scene.toml:12: body upper: ty = inf, expected a finite number, an expression in x, "
                         "y, t, or a table"),
    ("\"-10*t\"", "true", "scene.toml:12: body upper: ty = true, expected a finite number, an expression in "
                          "x, y, t, or a table"),
    # names, labels, conditions that contradict each other
    ("name = \"lower\"", "name = \"upper\"", "scene.toml:14: body upper: name = \"upper\", expected a "
                                             "name of its own"),
    ("label = 4\n", "label = 9\n", "scene.toml:9: body upper: label = 9, expected one of 1, 2, 3, 4 "
                                   "(boundary labels of "),
    ("ty = \"-10*t\"", "ty = \"-10*t\"\nuy = 1", "scene.toml:12: body upper: ty = \"-10*t\", expected one "
                                                 "condition for component y of label 3, there is one at "),
    ("label = 1, uy = 0", "label = 1, uy = 0, ux = \"x+1\"",
     "scene.toml:18: body lower: ux = \"x+1\" at (0, -1), t = 0: expected the 0 that label 4"),
    # contact
    ("body = \"lower\"", "body = \"lowr\"", "scene.toml:22: mortar side of contact: body = \"lowr\", "
                                            "expected one of upper, lower"),
    ("body = \"lower\", label = 3", "body = \"upper\", label = 1", "scene.toml:22: contact: both sides are "
     "label 1 of body upper, expected two sides"),
    ("label = 3 }\n", "label = 7 }\n", "scene.toml:22: body lower: label = 7, expected one of 1, 2, 3, 4"),
    ("label = 3 }\n", "label = 1 }\n", "scene.toml:20: contact: "),
    ("label = 3 }\n", "label = 2 }\n", "scene.toml:20: contact: "),
    # rollers, pressures, tables
    ("ux = 0\n", "un = 0\npressure = 3\n", "scene.toml:10: body upper: pressure = 3, expected one condition "
                                           "for the normal of label 4, there is one at scene.toml:9"),
    ("ux = 0\n", "un = \"1/x\"\n", "scene.toml:9: body upper: un = \"1/x\", expected a finite number, is "
                                   "inf at x = 0"),
    ("ux = 0 }, { label = 1, uy = 0 }", "ux = 0, uy = 0 }, { label = 1, un = 1 }",
     "scene.toml:18: body lower: un = 1 at (0, -1), t = 0: expected the 0 that label 4 prescribes there"),
    ("\"-10*t\"", "{ time = [0, 1], value = [0] }", "scene.toml:12: body upper: ty: value has 1 number, "
                                                    "expected 2 as time has"),
    ("\"-10*t\"", "{ time = [0, 1, 1], value = [0, 1, 2] }",
     "scene.toml:12: body upper: ty: time[2] = 1, expected times that ascend, more than 1"),
    ("\"-10*t\"", "{ time = [0], value = [0] }", "scene.toml:12: body upper: ty: time = an array, expected "
                                                 "two times or more"),
    ("\"-10*t\"", "{ time = [0, nan], value = [0, 1] }",
     "scene.toml:12: body upper: ty: time[1] = nan, expected a finite number"),
    ("\"-10*t\"", "{ time = [0, 1], value = [0, \"x\"] }", "scene.toml:12: body upper: ty: value[1] = \"x\", "
                                                           "expected a finite number"),
    ("\"-10*t\"", "{ time = [0, 1], values = [0, 1] }", "scene.toml:12: body upper: ty: unknown key values, "
                                                        "did you mean value?"),
    ("\"-10*t\"", "{ time = [0, 1] }", "scene.toml:12: body upper: ty: value is missing, expected an "
                                       "array of numbers"),
    ("\"-10*t\"", "{ time = 3, value = [0, 1] }", "scene.toml:12: body upper: ty: time = 3, expected an "
                                                  "array of numbers"),
    ("\"-10*t\"", "[0, 1]", "scene.toml:12: body upper: ty = an array, expected a finite number, an "
                            "expression in x, y, t, or a table"),
    # regions and initial stress
    ("[contact]", "region = [ { label = 7, material = { young = 1, poisson = 0 } } ]\n[contact]",
     "scene.toml:20: body lower: region label = 7, expected one of 1 (regions of lower.mesh)"),
    ("[contact]", "region = [ { label = 1 } ]\n[contact]", "scene.toml:20: body lower: region label 1 says "
                                                           "nothing, expected material or initial_stress"),
    ("[contact]", "region = [ { material = { young = 1, poisson = 0 } } ]\n[contact]",
     "scene.toml:20: body lower: label is missing, expected an integer >= 0"),
    ("[contact]", "region = [ { label = 1, material = { young = 1, poisson = 1 } } ]\n[contact]",
     "scene.toml:20: body lower, region 1: poisson = 1, expected -1 < poisson < 0.5"),
    ("[contact]", "initial_stress = { s11 = 1, s21 = 1 }\n[contact]",
     "scene.toml:20: body lower: unknown key s21, did you mean s11?"),
    ("[contact]", "initial_stress = { s11 = \"1/(x-x)\" }\n[contact]",
     "scene.toml:20: body lower: s11 = \"1/(x-x)\", expected a finite number, is inf at x = "),
    # meshes
    ("upper.mesh", "none.mesh", "scene.toml:5: body upper: mesh = \"none.mesh\", expected a "
                                "Medit .mesh file"),
    ("upper.mesh", "broken.mesh", "broken.mesh:"),
    ("upper.mesh", ".", "scene.toml:5: body upper: mesh = \".\", expected a Medit .mesh file"),
]

# Settings on the sound scene, and their messages.
FAULTY_SETTINGS = [
    ("time", "--set time: expected key=value"),
    ("time..steps=1", "--set time..steps=1: the key has an empty component"),
    ("time.stps=1", "--set time.stps=1: no stps in time, did you mean steps?"),
    ("body.uper.mesh=x", "--set body.uper.mesh=x: no uper in body, expected one of upper, lower, "
                         "or a key: name"),
    ("body.upper.boundary.7.ux=0", "--set body.upper.boundary.7.ux=0: no 7 in body.boundary, "
                                   "expected one of 4, 3"),
    ("time.steps=many", "--set time.steps=many: time: steps = \"many\", expected an integer >= 1"),
    ("time.steps.x=1", "--set time.steps.x=1: no x in time.steps"),
    ("body.upper.mesh=upper.msh", "--set body.upper.mesh=upper.msh: body upper: mesh = "
                                  "\"upper.msh\", expected"),
]


class WrongInput(OfTwoBlocks):
    def setUp(self):
        super().setUp()
        self.write(self.read("upper.mesh").replace("Triangles\n36", "Triangles\n37"), "broken.mesh")

    def test_faulty_scenes(self):
        for old, new, message in FAULTS:
            with self.subTest(new=new):
                self.assertIn(old, TWO_BLOCKS)
                self.write(TWO_BLOCKS.replace(old, new, 1))
                self.reject(message, "run", "scene.toml", "--quiet")

    def test_faulty_settings(self):
        for setting, message in FAULTY_SETTINGS:
            with self.subTest(setting=setting):
                self.reject(message, "run", "scene.toml", "--quiet", "--set", setting)


if __name__ == "__main__":
    unittest.main()
