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
    # regions and initial stress
    ("[contact]", "region = [ { label = 7, material = { young = 1, poisson = 0 } } ]\n[contact]", "scene.toml:20: body lower: region label = 7, expected one of 1 (regions of lower.mesh)"),
    ("[contact]", "region = [ { label = 1 } ]\n[contact]", "scene.toml:20: body lower: region label 1 says nothing, expected material or initial_stress"),
    ("[contact]", "region = [ { material = { young = 1, poisson = 0 } } ]\n[contact]", "scene.toml:20: body lower: label is missing, expected an integer >= 0"),
    ("[contact]", "region = [ { label = 1, material = { young = 1, poisson = 1 } } ]\n[contact]", "scene.toml:20: body lower, region 1: poisson = 1, expected -1 < poisson < 0.5"),
    ("[contact]", "initial_stress = { s11 = 1, s23 = 1 }\n[contact]", "scene.toml:20: body lower: unknown key s23, did you mean s22?"),
    ("[contact]", "initial_stress = { s11 = \"1/(x-x)\" }\n[contact]", "scene.toml:20: body lower: s11 = \"1/(x-x)\", expected a finite number, is inf at x = "),
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

    def test_gmsh_files(self):
        # Two squares side by side with a curve between them, in both formats and as a geometry; Gmsh may be missing.
        points = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)]
        lines = [(1, 1, 2), (1, 2, 3), (2, 3, 6), (3, 6, 5), (3, 5, 4), (4, 4, 1), (9, 2, 5)]
        triangles = [(1, 1, 2, 5), (1, 1, 5, 4), (2, 2, 6, 3), (2, 2, 5, 6)]  # the third is clockwise
        names = '$PhysicalNames\n3\n1 3 "top"\n1 4 "left"\n2 2 "right half"\n$EndPhysicalNames\n'
        elements = [f"{i + 1} 1 2 {g} {g} {a} {b}" for i, (g, a, b) in enumerate(lines)]
        elements += [f"{i + 20} 2 2 {g} {g} {a} {b} {c}" for i, (g, a, b, c) in enumerate(triangles)]
        with open("a.msh", "w") as file:
            file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names + "$Nodes\n6\n")
            file.writelines(f"{i + 1} {x} {y} 0\n" for i, (x, y) in enumerate(points))
            file.write(f"$EndNodes\n$Elements\n{len(elements)}\n" + "\n".join(elements) + "\n$EndElements\n")
        with open("b.msh", "w") as file:
            file.write("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + names + "$Entities\n0 5 2 0\n")
            file.writelines(f"{tag} 0 0 0 2 1 0 1 {tag} 0\n" for tag in (1, 2, 3, 4, 9))
            file.writelines(f"{tag} 0 0 0 2 1 0 1 {tag} 0\n" for tag in (1, 2))
            file.write("$EndEntities\n$Nodes\n1 6 1 6\n2 1 0 6\n" + "".join(f"{i + 1}\n" for i in range(6)))
            file.writelines(f"{x} {y} 0\n" for x, y in points)
            file.write(f"$EndNodes\n$Elements\n7 {len(elements)} 1 {len(elements)}\n")
            tag = 1
            for dimension, kind, items in ((1, 1, lines), (2, 2, triangles)):
                for group in sorted({item[0] for item in items}):
                    own = [item[1:] for item in items if item[0] == group]
                    file.write(f"{dimension} {group} {kind} {len(own)}\n")
                    for item in own:
                        file.write(f"{tag} " + " ".join(map(str, item)) + "\n")
                        tag += 1
            file.write("$EndElements\n")
        with open("c.geo", "w") as file:
            file.writelines(f"Point({i + 1}) = {{{x}, {y}, 0, 0.5}};\n" for i, (x, y) in enumerate(points))
            file.writelines(f"Line({i + 1}) = {{{a}, {b}}};\n" for i, (_, a, b) in enumerate(lines))
            file.write("Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1};\nCurve Loop(2) = {-7, 2, 3, 4}; Plane Surface(2) = {2};\n"
                       "Physical Curve(1) = {1, 2}; Physical Curve(2) = {3}; Physical Curve(\"top\", 3) = {4, 5};\n"
                       "Physical Curve(\"left\", 4) = {6}; Physical Surface(1) = {1}; Physical Surface(\"right half\", 2) = {2};\n")
        scene = """
            [[body]]
            name = "plate"
            mesh = "a.msh"
            material = { young = 100, poisson = 0 }
            boundary = [ { label = "left", ux = 0 }, { label = 1, uy = 0 }, { label = "top", pressure = 6 } ]
            region = [ { label = "right half", material = { young = 100, poisson = 0, viscosity = 1, yield_stress = 50 } } ]
            [time]
            end = 1
            steps = 1
            """
        self.write(scene)
        info = mortier("mesh", "info", "a.msh")
        if "this build is without" in info.stderr:
            for name in ["a.msh", "b.msh", "c.geo"]:
                self.reject(mortier("mesh", "info", name), f"{name}: read by Gmsh, which this build is without")
                self.reject(mortier("run", "scene.toml", "--quiet", "--set", f"body.plate.mesh={name}"), f"{name}: read by Gmsh")
            return
        for name in ["a.msh", "b.msh", "c.geo"]:
            with self.subTest(name=name):
                info = mortier("mesh", "info", name)
                self.assertEqual((info.returncode, info.stderr), (0, ""))
                for part in ["area       2 m^2", "label 1 ", "label 2 ", "label 3 ", "label 4 ", "length 2 m", "region 1 ", "region 2 "]:
                    self.assertIn(part, info.stdout)
                self.assertNotIn("label 9", info.stdout)
                result = mortier("run", "scene.toml", "--quiet", "--set", f"body.plate.mesh={name}", "--out", "plate")
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                plate = json.loads(read("plate/summary.json"))
                self.assertAlmostEqual(plate["final"]["displacement_min"][1], -0.06, places=12)
                self.assertAlmostEqual(plate["final"]["von_mises_min"], 6, places=10)
                self.assertEqual(plate["bodies"][0]["material"], "Perzyna (frobenius), elastic")
        self.assertEqual(mortier("mesh", "info", "a.msh").stdout.count("4"), mortier("mesh", "info", "b.msh").stdout.count("4"))
        for old, new, message in [
                ("label = \"left\"", "label = \"lft\"", "scene.toml:6: body plate: label = \"lft\", expected one of left, top (boundaries of a.msh)"),
                ("\"right half\"", "\"half\"", "scene.toml:7: body plate: label = \"half\", expected one of right half (regions of a.msh)"),
                ("label = \"left\"", "label = true", "scene.toml:6: body plate: label = true, expected an integer >= 0, or a name in the mesh"),
                ("a.msh", "upper.mesh", "scene.toml:6: body plate: label = \"left\", the mesh upper.mesh has no names of boundaries")]:
            with self.subTest(new=new):
                self.write(scene.replace(old, new, 1))
                self.reject(mortier("run", "scene.toml", "--quiet"), message)
        text = read("a.msh")
        for old, new, message in [("20 2 2 1 1 1 2 5", "20 3 2 1 1 1 2 5 4", "elements of Gmsh's type 3, expected linear triangles"),
                                  ("5 1 1 0", "5 1 1 3", "node 5 is at z = 3"),
                                  (text, "$MeshFormat\n", "")]:
            with self.subTest(new=new[:20]):
                self.assertIn(old, text)
                with open("x.msh", "w") as file:
                    file.write(text.replace(old, new, 1))
                self.reject(mortier("mesh", "info", "x.msh"), "x.msh: " + message)
        self.reject(mortier("mesh", "info", "none.msh"), "none.msh: not a file")

    def test_thin_triangles_are_told(self):
        self.assertEqual(mortier("mesh", "crisscross", "--cells", "100,1", "upper.mesh").returncode, 0)
        result = mortier("run", "scene.toml", "--quiet")
        self.assertEqual(result.returncode, 0)
        self.assertIn("warning: scene.toml:5: body upper: 400 of 400 triangles of upper.mesh are thin; the worst is triangle", result.stderr)

    def test_mesh_info(self):
        text = mortier("mesh", "info", "lower.mesh").stdout
        for part in ["vertices   23", "triangles  32", "label 3     4 edges, length 1 m", "y -1 .. 0 m", "aspect ratio"]:
            self.assertIn(part, text)


if __name__ == "__main__":
    unittest.main()
