"""The built program from outside: exit codes, one-line messages on wrong input, output that other programs read.

Usage: cli_test.py [PROGRAM]   (or the environment variable MORTIER)
"""

import csv
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import meshio
import numpy as np

if len(sys.argv) > 1 and not sys.argv[-1].startswith("-"):
    os.environ["MORTIER"] = sys.argv.pop()
PROGRAM = os.path.abspath(os.environ["MORTIER"])

SCENE = """\
title = "two blocks"

[[body]]
name = "upper"
mesh = "upper.mesh"
material = { young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1 }
[[body.boundary]]
label = 4
ux = 0
[[body.boundary]]
label = 3
ty = "-10*t"

[[body]]
name = "lower"
mesh = "lower.mesh"
material = { young = 3e11, poisson = 0.3 }
boundary = [ { label = 4, ux = 0 }, { label = 1, uy = 0 } ]

[contact]
nonmortar = { body = "upper", label = 1 }
mortar = { body = "lower", label = 3 }

[time]
end = 1
steps = 4
"""

# What is changed in the scene above, and the message (after "mortier: ") that must come with exit code 2.
FAULTS = [
    # TOML
    ("end = 1", "end = ", "scene.toml:25: not TOML: "),
    ("[time]", "[time", "scene.toml:24: not TOML: "),
    ("steps = 4", "steps = 4\nsteps = 5", "scene.toml:27: not TOML: "),
    ("title", "a." * 100000 + "title", "scene.toml:1: a key of more than 32 names, expected a key of a scene"),
    ("[time]", "[time.'a.b'." + "a." * 100000 + "a]", "scene.toml:24: a key of more than 32 names, expected a key of a scene"),
    # keys
    ("title", "\"\\u001b[31m\"", "scene.toml:1: unknown key ?[31m, expected one of title, body"),
    ("title", "titel", "scene.toml:1: unknown key titel, did you mean title? Expected one of title, body, contact"),
    ("mesh = \"upper", "msh = \"upper", "scene.toml:5: body upper: unknown key msh, did you mean mesh? Expected"),
    ("poisson = 0.3, v", "nu = 0.3, v", "scene.toml:6: body upper: unknown key nu, expected one of young, poisson"),
    ("ux = 0\n", "vx = 0\n", "scene.toml:9: body upper: unknown key vx, did you mean ux?"),
    ("steps = 4", "step = 4", "scene.toml:26: time: unknown key step, did you mean steps?"),
    ("[time]", "[solver]\ntol = 1\n[time]", "scene.toml:25: solver: unknown key tol"),
    # missing
    ("name = \"upper\"\n", "", "scene.toml:3: body 0: name is missing, expected a string"),
    ("mesh = \"upper.mesh\"\n", "", "scene.toml:3: body upper: mesh is missing"),
    ("young = 3e11, poisson = 0.3, v", "poisson = 0.3, v", "scene.toml:6: body upper: young is missing, expected young > 0"),
    (", yield_stress = 1", "", "scene.toml:6: body upper: yield_stress is missing, expected yield_stress > 0"),
    ("steps = 4", "", "scene.toml:24: time: steps is missing, expected an integer >= 1"),
    ("[time]\nend = 1\nsteps = 4", "", "scene.toml:1: time is missing, expected a table [time] with end, steps"),
    ("label = 4\nux", "ux", "scene.toml:7: body upper: label is missing"),
    ("ux = 0\n", "", "scene.toml:7: body upper: boundary label 4 has no condition, expected one of ux, uy, un, ut, tx, ty, pressure"),
    # types and ranges
    ("poisson = 0.3, v", "poisson = 0.6, v", "scene.toml:6: body upper: poisson = 0.6, expected -1 < poisson < 0.5"),
    ("young = 3e11, poisson = 0.3, v", "young = nan, poisson = 0.3, v", "scene.toml:6: body upper: young = nan, expected young > 0"),
    ("viscosity = 10", "viscosity = -inf", "scene.toml:6: body upper: viscosity = -inf, expected viscosity > 0"),
    ("young = 3e11, poisson = 0.3, v", "young = \"3e11\", poisson = 0.3, v", "scene.toml:6: body upper: young = \"3e11\", expected young > 0"),
    ("steps = 4", "steps = 0", "scene.toml:26: time: steps = 0, expected an integer >= 1"),
    ("steps = 4", "steps = 4.5", "scene.toml:26: time: steps = 4.5, expected an integer >= 1"),
    ("steps = 4", "steps = 1e12", "scene.toml:26: time: steps = 1e+12, expected an integer >= 1"),
    ("end = 1", "end = 2020-01-01", "scene.toml:25: time: end = a date, expected end > 0"),
    ("steps = 4", "steps = 4\nscheme = \"euler\"", "scene.toml:27: time: scheme = \"euler\", expected one of backward-euler"),
    ("label = 3 }\n", "label = 3 }\nvariant = \"morta\"\n", "scene.toml:23: contact: variant = \"morta\", expected one of interpolation, mortar"),
    ("name = \"upper\"", "name = \"../up\"", "scene.toml:4: body ../up: name = \"../up\", expected letters, digits, _ and -"),
    ("material = { young = 3e11, poisson = 0.3 }", "material = \"steel\"", "scene.toml:17: body lower: \"steel\", expected a table"),
    # data
    ("\"-10*t\"", "\"-10*\"", "scene.toml:12: body upper: ty = \"-10*\", expected an expression in x, y, t (unexpected end"),
    ("\"-10*t\"", "\"-10*s\"", "scene.toml:12: body upper: ty = \"-10*s\", expected an expression in x, y, t (unexpected token \"s\""),
    ("\"-10*t\"", "\"1/t\"", "scene.toml:12: body upper: ty = \"1/t\", expected a finite number, is inf at x = "),
    ("\"-10*t\"", "inf", "scene.toml:12: body upper: ty = inf, expected a finite number, an expression in x, y, t, or a table"),
    ("\"-10*t\"", "true", "scene.toml:12: body upper: ty = true, expected a finite number, an expression in x, y, t, or a table"),
    # names, labels, conditions that contradict each other
    ("name = \"lower\"", "name = \"upper\"", "scene.toml:14: body upper: name = \"upper\", expected a name of its own"),
    ("label = 4\n", "label = 9\n", "scene.toml:9: body upper: label = 9, expected one of 1, 2, 3, 4 (boundary labels of "),
    ("ty = \"-10*t\"", "ty = \"-10*t\"\nuy = 1", "scene.toml:12: body upper: ty = \"-10*t\", expected one condition for component y of label 3, there is one at "),
    ("label = 1, uy = 0", "label = 1, uy = 0, ux = \"x+1\"", "scene.toml:18: body lower: ux = \"x+1\" at (0, -1), t = 0: expected the 0 that label 4"),
    # contact
    ("body = \"lower\"", "body = \"lowr\"", "scene.toml:22: mortar side of contact: body = \"lowr\", expected one of upper, lower"),
    ("body = \"lower\"", "body = \"upper\"", "scene.toml:22: contact: both sides are body upper, expected two bodies"),
    ("label = 3 }\n", "label = 7 }\n", "scene.toml:22: body lower: label = 7, expected one of 1, 2, 3, 4"),
    ("label = 3 }\n", "label = 1 }\n", "scene.toml:20: contact: "),
    ("label = 3 }\n", "label = 2 }\n", "scene.toml:20: contact: "),
    # rollers, pressures, tables
    ("ux = 0\n", "un = 0\npressure = 3\n", "scene.toml:10: body upper: pressure = 3, expected one condition for the normal of label 4, there is one at scene.toml:9"),
    ("ux = 0\n", "un = \"1/x\"\n", "scene.toml:9: body upper: un = \"1/x\", expected a finite number, is inf at x = 0"),
    ("ux = 0 }, { label = 1, uy = 0 }", "ux = 0, uy = 0 }, { label = 1, un = 1 }", "scene.toml:18: body lower: un = 1 at (0, -1), t = 0: expected the 0 that label 4 prescribes there"),
    ("\"-10*t\"", "{ time = [0, 1], value = [0] }", "scene.toml:12: body upper: ty: value has 1 numbers, expected 2 as time has"),
    ("\"-10*t\"", "{ time = [0, 1, 1], value = [0, 1, 2] }", "scene.toml:12: body upper: ty: time[2] = 1, expected times that ascend, more than 1"),
    ("\"-10*t\"", "{ time = [0], value = [0] }", "scene.toml:12: body upper: ty: time = an array, expected two times or more"),
    ("\"-10*t\"", "{ time = [0, nan], value = [0, 1] }", "scene.toml:12: body upper: ty: time[1] = nan, expected a finite number"),
    ("\"-10*t\"", "{ time = [0, 1], value = [0, \"x\"] }", "scene.toml:12: body upper: ty: value[1] = \"x\", expected a finite number"),
    ("\"-10*t\"", "{ time = [0, 1], values = [0, 1] }", "scene.toml:12: body upper: ty: unknown key values, did you mean value?"),
    ("\"-10*t\"", "{ time = [0, 1] }", "scene.toml:12: body upper: ty: value is missing, expected an array of numbers"),
    ("\"-10*t\"", "{ time = 3, value = [0, 1] }", "scene.toml:12: body upper: ty: time = 3, expected an array of numbers"),
    ("\"-10*t\"", "[0, 1]", "scene.toml:12: body upper: ty = an array, expected a finite number, an expression in x, y, t, or a table"),
    # meshes
    ("upper.mesh", "none.mesh", "scene.toml:5: body upper: mesh = \"none.mesh\", expected a Medit .mesh file"),
    ("upper.mesh", "broken.mesh", "broken.mesh:"),
    ("upper.mesh", ".", "scene.toml:5: body upper: mesh = \".\", expected a Medit .mesh file"),
]

# Settings on the sound scene, and their messages.
FAULTY_SETTINGS = [
    ("time", "--set time: expected key=value"),
    ("time..steps=1", "--set time..steps=1: the key has an empty component"),
    ("time.stps=1", "--set time.stps=1: no stps in time, did you mean steps?"),
    ("body.uper.mesh=x", "--set body.uper.mesh=x: no uper in body, expected one of upper, lower, or a key: name"),
    ("body.upper.boundary.7.ux=0", "--set body.upper.boundary.7.ux=0: no 7 in body.boundary, expected one of 4, 3"),
    ("time.steps=many", "--set time.steps=many: time: steps = \"many\", expected an integer >= 1"),
    ("time.steps.x=1", "--set time.steps.x=1: no x in time.steps"),
    ("body.upper.mesh=upper.msh", "--set body.upper.mesh=upper.msh: body upper: mesh = \"upper.msh\", expected"),
]

USAGE = [[], ["bla"], ["run"], ["run", "--frobnicate"], ["run", "scene.toml", "--threads", "0"], ["run", "none.toml"],
         ["mesh"], ["mesh", "crisscross", "x.mesh"], ["mesh", "info", "none.mesh"], ["freefem"], ["mesh", "rectangle", "--cells", "2,a", "x.mesh"],
         ["run", "scene.toml", "--out", "."]]


def read(path):
    with open(path) as file:
        return file.read()


def mortier(*arguments, **options):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=60, **options)


class Cli(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        os.chdir(self.folder.name)
        self.addCleanup(os.chdir, "/")
        self.assertEqual(mortier("mesh", "crisscross", "--cells", "3", "upper.mesh").returncode, 0)
        self.assertEqual(mortier("mesh", "crisscross", "--cells", "4,2", "--lower", "0,-1", "--upper", "1,0", "lower.mesh").returncode, 0)
        with open("upper.mesh") as mesh, open("broken.mesh", "w") as broken:
            broken.write(mesh.read().replace("Triangles\n36", "Triangles\n37"))
        self.write(SCENE)

    def write(self, text):
        with open("scene.toml", "w") as scene:
            scene.write(text)

    def reject(self, result, message):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertTrue(result.stderr.startswith("mortier: " + message), f"\nexpected {message}\nis       {result.stderr}")
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertFalse(os.path.exists("out"))

    def test_faulty_scenes(self):
        for old, new, message in FAULTS:
            with self.subTest(new=new):
                self.assertIn(old, SCENE)
                self.write(SCENE.replace(old, new, 1))
                self.reject(mortier("run", "scene.toml", "--quiet"), message)

    def test_faulty_settings(self):
        for setting, message in FAULTY_SETTINGS:
            with self.subTest(setting=setting):
                self.reject(mortier("run", "scene.toml", "--quiet", "--set", setting), message)

    def test_usage(self):
        for arguments in USAGE:
            with self.subTest(arguments=arguments):
                result = mortier(*arguments)
                self.assertEqual(result.returncode, 2)
                if arguments not in ([], ["mesh"]):
                    self.assertTrue(result.stderr.startswith("mortier: "), result.stderr)
                    self.assertEqual(result.stderr.count("\n"), 1, result.stderr)

    def test_help_and_version(self):
        for arguments in [["--help"], ["run", "--help"], ["mesh", "--help"], ["mesh", "crisscross", "--help"],
                          ["mesh", "rectangle", "--help"], ["mesh", "quadrilateral", "--help"], ["mesh", "annulus", "--help"],
                          ["mesh", "halfdisc", "--help"], ["mesh", "info", "--help"], ["freefem", "--help"], ["--version"]]:
            result = mortier(*arguments)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertTrue(result.stdout)

    def test_body_that_nothing_holds(self):
        self.write(SCENE.replace("label = 4\nux = 0", "label = 4\ntx = 0", 1))
        result = mortier("run", "scene.toml", "--quiet")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("upper", result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertEqual([name for name in os.listdir("out") if ".tmp-" in name], [])

    def test_step_that_cannot_be_solved_leaves_the_old_result(self):
        self.assertEqual(mortier("run", "scene.toml", "--quiet").returncode, 0)
        before = read("out/scene/summary.json")
        result = mortier("run", "scene.toml", "--quiet", "--set", "solver.max_iterations=1", "solver.tolerance=1e-30")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(read("out/scene/summary.json"), before)
        self.assertEqual(json.loads(read("out/scene.failed/summary.json"))["status"], "failed")
        self.assertEqual(sorted(os.listdir("out")), ["scene", "scene.failed"])
        self.assertEqual(mortier("run", "scene.toml", "--quiet").returncode, 0)
        self.assertEqual(os.listdir("out"), ["scene"])

    def test_interrupted_run_can_go_on(self):
        process = subprocess.Popen([PROGRAM, "run", "scene.toml", "--quiet", "--set", "time.steps=1000000"], stderr=subprocess.PIPE)
        deadline = time.monotonic() + 20
        while not (os.path.isdir("out") and os.listdir("out")) and time.monotonic() < deadline:
            time.sleep(0.01)
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        told = process.communicate(timeout=20)[1].decode()
        self.assertEqual(process.returncode, 1)
        self.assertRegex(told, r"^mortier: scene.toml: interrupted after step \d+; mortier run --restart out/scene goes on\n$")
        folder, = os.listdir("out")
        self.assertTrue(folder.startswith("scene.tmp-"))
        self.assertIn("checkpoint", os.listdir("out/" + folder))

    def test_output_that_cannot_be_written(self):
        open("file", "w").close()
        self.assertEqual(mortier("run", "scene.toml", "--quiet", "--out", "file/out").returncode, 1)
        self.assertEqual(mortier("mesh", "crisscross", "--cells", "2", "file/x.mesh").returncode, 1)

    def test_output_reads_back(self):
        result = mortier("run", "--set", "output.every=2", "body.material.projection=elasticity", "scene.toml", "--out", "result")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        rows = [line for line in result.stdout.splitlines() if line.split()[0].isdigit()]
        self.assertEqual(len(rows), 4)
        self.assertIn("verification", result.stdout.splitlines()[-1])

        summary = json.loads(read("result/summary.json"))
        self.assertEqual(summary["status"], "converged")
        self.assertEqual(summary["triangles"], 36 + 32)
        self.assertEqual(summary["projection"], "elasticity")
        self.assertLess(summary["verification"]["force_balance"], 1e-9)
        self.assertAlmostEqual(summary["final"]["contact_force"], 10, places=9)
        self.assertGreater(summary["peak_memory_mib"], 1)
        for name in ("mortier", "Eigen", "CHOLMOD", "UMFPACK", "BLAS", "toml++", "muParser"):
            self.assertRegex(summary["versions"][name], r"\d+\.\d+")

        self.assertEqual(sorted(name for name in os.listdir("result") if name.endswith(".vtu")),
                         [f"{body}_{step:06}.vtu" for body in ("lower", "upper") for step in (0, 2, 4)])
        for body, triangles, vertices in (("upper", 36, 25), ("lower", 32, 23)):
            mesh = meshio.read(f"result/{body}_000004.vtu")
            self.assertEqual(mesh.points.dtype, np.float64)
            self.assertEqual(mesh.points.shape, (vertices, 3))
            self.assertEqual(mesh.cells_dict["triangle"].shape, (triangles, 3))
            original = meshio.read(f"{body}.mesh")
            np.testing.assert_array_equal(mesh.points[:, :2], original.points)
            np.testing.assert_array_equal(mesh.cells_dict["triangle"], original.cells_dict["triangle"])
            np.testing.assert_allclose(mesh.cell_data["stress"][0], np.tile([0, -10, 0], (triangles, 1)), atol=1e-7)
            np.testing.assert_allclose(mesh.cell_data["von_mises"][0], 10, rtol=1e-8)
            self.assertEqual(mesh.point_data["displacement"].shape, (vertices, 3))
            self.assertEqual(set(mesh.cell_data["viscoplastic"][0]), {1 if body == "upper" else 0})
            self.assertEqual(mesh.cell_data["viscoplastic_strain"][0].shape, (triangles, 3))
            self.assertEqual(set(mesh.cell_data["region"][0]), set(original.cell_data_dict["medit:ref"]["triangle"]))

        history = list(csv.DictReader(read("result/history.csv").splitlines()))
        self.assertEqual([float(row["time[s]"]) for row in history], [0.25, 0.5, 0.75, 1])
        rungs = [row["rung"] for row in history]
        self.assertEqual(summary["rungs"], {rung: rungs.count(rung) for rung in rungs})
        contact = list(csv.DictReader(read("result/contact.csv").splitlines()))
        self.assertEqual([row["step"] for row in contact], ["0"] * 4 + ["2"] * 4 + ["4"] * 4)
        last = contact[-4:]
        self.assertAlmostEqual(sum(float(row["force"]) for row in last), 10, places=9)
        self.assertEqual({row["active"] for row in last}, {"1"})

    def test_quiet_prints_nothing(self):
        result = mortier("run", "scene.toml", "--quiet")
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))

    def test_freefem_script(self):
        os.mkdir("freefem")
        open("freefem/bodies.idp", "w").close()
        result = mortier("freefem", "scene.toml", "scene.edp", "--set", "contact.swap=true",
                         "body.upper.force.x=3/2*ln(2)*x^2", "body.upper.boundary.3.pressure={time=[0, 2], value=[1, 5]}")
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        script = read("scene.edp")
        for part in ["real lambda1 = 10, sigmaY1 = 1;", "real lambda2 = 0,", "int1d(Body1, 3)((-10.*t)*v2)",
                     "int2d(Body1)((3./2.*log(2.)*x^2.)*v1)", "int1d(Body1, 3)((-((t < 0. ? 1. : (t < 2. ? 1. + (2.)*(t - (0.)) : 5.))))*(N.x*v1 + N.y*v2))", "macro supports2 + on(4, u1 = 0.) + on(1, u2 = 0.) //",
                     "string nonmortar = \"lower\";", "int contactLabel1 = 1, contactLabel2 = 3;", "int steps = 4;",
                     "include \"freefem/bodies.idp\""]:
            self.assertIn(part, script)
        self.reject(mortier("freefem", "scene.toml", "--set", "body.upper.boundary.4.un=0"), "--set body.upper.boundary.4.un=0: body upper: un = 0: the FreeFEM method knows no rollers")
        self.write(SCENE[:SCENE.index("[contact]")] + SCENE[SCENE.index("[time]"):])
        self.reject(mortier("freefem", "scene.toml"), "scene.toml: 2 bodies and 0 contact interfaces, expected two")

    def test_mesh_families(self):
        for arguments, triangles, labels in [
                (["rectangle", "--cells", "4,3", "--cut", "both", "--focus", "0.5,1", "--grading", "3,2"], 48, [1, 2, 3, 4]),
                (["quadrilateral", "--cells", "3,2", "--corners", "0,0", "48,44", "48,60", "0,44"], 12, [1, 2, 3, 4]),
                (["annulus", "--cells", "8,2", "--span", "half", "--inner", "0.5", "--centre", "1,0"], 32, [1, 2, 3, 4]),
                (["annulus", "--cells", "8,2"], 32, [1, 2]),
                (["halfdisc", "--cells", "3", "--radius", "50", "--core", "10", "--lowest", "0,1"], 2 * (2 * 9 + 12 * 6), [1, 2, 3])]:
            with self.subTest(arguments=arguments):
                result = mortier("mesh", *arguments, "family.mesh")
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                self.assertIn(f"{triangles} triangles; labels 1", result.stdout)
                text = mortier("mesh", "info", "family.mesh").stdout
                self.assertEqual([int(line.split()[1]) for line in text.splitlines() if line.startswith("label")], labels)
        for arguments, message in [
                (["rectangle", "--cells", "2", "--cut", "up"], "--cut up: expected one of rising, falling, both"),
                (["rectangle", "--cells", "2", "--grading", "2"], "--grading 2: expected with --focus X,Y"),
                (["rectangle", "--cells", "2", "--grading", "2", "--focus", "3,0"], "rectangle 2x2 of (0, 0) to (1, 1): focus (3, 0)"),
                (["annulus", "--cells", "8,2", "--span", "third"], "--span third: expected one of quarter, half, full"),
                (["annulus", "--cells", "8,2", "--inner", "3"], "annulus of radii 3 and 2 about (0, 0), expected"),
                (["quadrilateral", "--cells", "2", "--corners", "0,0", "0,1", "1,1", "1,0"], "quadrilateral (0, 0)"),
                (["halfdisc", "--cells", "2", "--core", "0.5"], "half disc of radius 1 on (0, 0): core 0.5, expected")]:
            with self.subTest(arguments=arguments):
                self.reject(mortier("mesh", *arguments, "x.mesh"), message)
                self.assertFalse(os.path.exists("x.mesh"))

    def test_mesh_info(self):
        text = mortier("mesh", "info", "lower.mesh").stdout
        for part in ["vertices   23", "triangles  32", "label 3     4 edges, length 1 m", "y -1 .. 0 m", "aspect ratio"]:
            self.assertIn(part, text)


if __name__ == "__main__":
    unittest.main()
