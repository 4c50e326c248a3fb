"""mortier freefem: a scene as data for the FreeFEM method, and what that does not know."""
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))
import support  # noqa: E402
from scenes import TWO_BLOCKS  # noqa: E402

ALL = "(all that the FreeFEM method knows)"


class WithoutLoad(support.OfTwoBlocks):
    def test_freefem_verifies_a_scene_without_a_load(self):
        if shutil.which("FreeFem++-nw") is None:
            self.skipTest("FreeFEM is not installed")
        self.write(TWO_BLOCKS.replace('"-10*t"', "0").replace("steps = 4", "steps = 1"))
        self.mortier("freefem", "scene.toml", "scene.edp")
        done = subprocess.run(["FreeFem++-nw", "-nw", "-ne", "-v", "0", "scene.edp", "-quiet", "-out", "out"],
                              cwd=self.folder, capture_output=True)
        self.assertEqual(done.returncode, 0, done.stdout)


class Script(support.OfTwoBlocks):
    def setUp(self):
        super().setUp()
        (self.folder / "freefem").mkdir()
        self.write("", "freefem/bodies.idp")

    def script(self, *settings):
        result = self.mortier("freefem", "scene.toml", "scene.edp", "--set", *settings)
        self.assertEqual((result.stdout, result.stderr), ("", ""))
        return self.read("scene.edp").splitlines()

    def test_two_blocks(self):
        text = self.script("contact.swap=true", "body.upper.force.x=3/2*ln(2)*x")
        for line in ["macro eachBody(what) what(1) what(2) //", "string name1 = \"upper\";",
                     "real lambda1 = 10, sigmaY1 = 1;  // viscosity [Pa s] (0: elastic body), "
                     "yield stress [Pa]",
                     "macro loads1 + simpson(1, 3, (-10.*t)*v2) + midpoints(1, (3./2.*log(2.)*x)*v1) //",
                     "macro supports2 + on(4, u1 = 0.) + on(1, u2 = 0.) //",
                     "macro loads2 + int2d(Body2)(0.*v2) //",
                     "int[int, int] contact = [[2, 3, 1, 1]];", "string variant = \"mortar\";",
                     "int steps = 4;  // backward Euler, equal steps", "include \"freefem/bodies.idp\"",
                     "include \"freefem/strain.idp\"", "include \"freefem/supports.idp\""]:
            self.assertIn(line, text)
        self.assertNotIn("rollers", "".join(text))
        self.assertNotIn("distances", "".join(text))

    def test_loads_that_the_rules_of_elements_do_not_integrate(self):
        text = self.script("body.upper.force.x=exp(x)", "body.upper.boundary.3.ty=-t*exp(x)")
        self.assertIn("macro loads1 + int1d(Body1, 3, qfe = qf5pE)((-t*exp(x))*v2) "
                      "+ int2d(Body1, qft = qf9pT)((exp(x))*v1) //", text)

    def test_rollers_and_distances(self):
        text = self.script("body.upper.boundary.4.un=0", "body.lower.boundary.1.ut=x*t", "contact.gap=x/10")
        self.assertIn("macro rollers roller(1, 4, normal, 0.) roller(2, 1, tangent, x*t) "
                      "//  body, label, direction, displacement", text)
        self.assertIn("macro distances distance(1, 1, 2, x/10.) //  interface, its bodies, distance", text)
        self.assertIn("macro distances distance(1, 1, 2, 0.) //  interface, its bodies, distance",
                      self.script("contact.initial=close"))

    def test_sides_that_the_program_chooses(self):
        self.write(TWO_BLOCKS[:TWO_BLOCKS.index("[contact]")] + TWO_BLOCKS[TWO_BLOCKS.index("[time]"):] +
                   "[contact]\nsides = [ { body = 'upper', label = 1 }, { body = 'lower', label = 3 } ]\n")
        self.assertIn("int[int, int] contact = [[2, 3, 1, 1]];", self.script("time.steps=4"))

    def test_choices_stand_in_parentheses(self):
        for data, freefem in (
                ("t < 1 ? 2*t : t < 2 ? 3 : 4", "t < 1. ? (2.*t) : (t < 2. ? (3.) : (4.))"),
                ("t < 1 ? t < 0.5 ? 1 : 2 : 3", "t < 1. ? (t < 0.5 ? (1.) : (2.)) : (3.)"),
                ("max(t > 1 ? 1 : 0, (x < 0 ? 1 : 2)*y)+1e-3",
                 "max(t > 1. ? (1.) : (0.), (x < 0. ? (1.) : (2.))*y)+1e-3"),
                ("{time=[0, 2], value=[1, 5]}",
                 "(t < 0. ? (1.) : ((t < 2. ? (1. + (2.)*(t - (0.))) : (5.))))")):
            with self.subTest(data):
                text = self.script(f"body.lower.force.x={data}", f"body.upper.boundary.3.ty={data}")
                places = "x" in data
                self.assertIn("macro loads2 + int2d(Body2, qft = qf9pT)((" if places else
                              "macro loads2 + midpoints(2, (", "\n".join(text))
                self.assertIn(f"({freefem})*v1) //", "\n".join(text))
                self.assertIn("macro loads1 + int1d(Body1, 3, qfe = qf5pE)((" if places else
                              "macro loads1 + simpson(1, 3, (", "\n".join(text))
                self.assertIn(f"({freefem})*v2) //", "\n".join(text))

    def test_names_of_files_have_every_printable_character(self):
        for mark in " ~!'":
            with self.subTest(mark):
                name = f"up{mark}.mesh"
                self.write(self.read("upper.mesh"), name)
                self.assertIn(f'string meshFile1 = "{name}";', self.script(f"body.upper.mesh={name}"))

    def test_what_is_not_known(self):
        for setting, message in (
                ("time.scheme=sdirk2", "scene.toml: scheme = sdirk2, expected backward-euler"),
                ("time.tolerance=1e-3", "scene.toml: tolerance = 0.001, expected equal steps, or those of "
                                        "a run (--steps-of)"),
                ("body.upper.initial_stress.s11=1", "scene.toml:3: body upper: regions or initial stress, "
                                                    "expected neither")):
            with self.subTest(setting):
                self.reject(f"{message} {ALL}", "freefem", "scene.toml", "--set", setting)

    def test_corners(self):
        head, edges = self.read("upper.mesh").split("Edges\n")
        edges, triangles = edges.split("Triangles")
        edges = edges.replace(" 2\n", " 1\n")  # label 1 below and on the right
        self.write(head + "Edges\n" + edges + "Triangles" + triangles, "upper.mesh")
        self.reject("scene.toml:20: contact: a line with corners, or a closed one on the nonmortar side, "
                    f"expected lines without corners, an open one on the nonmortar side {ALL}",
                    "freefem", "scene.toml")

    def test_quadratic_triangles_with_curved_sides(self):
        arc = 'mesh = { shape = "halfdisc", radius = 1, core = 0.3, lowest = [0, 0], cells = 4 }\n'
        scene = TWO_BLOCKS.replace('mesh = "upper.mesh"\n', arc).replace("label = 4\nux", "label = 2\nux")
        scene = scene.replace("label = 3\nty", "label = 2\nty")
        self.assertIn(arc, scene)
        self.write(scene)
        self.assertEqual(self.mortier("freefem", "scene.toml", "linear.edp").returncode, 0)
        self.reject("scene.toml:5: body upper: a mesh with curved sides, expected straight ones beside "
                    f"degree = 2 {ALL}", "freefem", "scene.toml", "quadratic.edp", "--set", "degree=2")

    def test_no_interface(self):
        self.write(TWO_BLOCKS[:TWO_BLOCKS.index("[contact]")] + TWO_BLOCKS[TWO_BLOCKS.index("[time]"):])
        self.reject(f"scene.toml: no contact interface, expected one at least {ALL}", "freefem", "scene.toml")


if __name__ == "__main__":
    unittest.main()
