"""Rigid tools in space: patches, statics, friction, bodies as stiff as tools, motions that nothing holds."""
import math
import unittest

from scene_parts import body, box, contact, quantity, timed, tool
from support import InFolder

BLOCK = ("dimension = 3\n"
         + body("block", box([-1, -1, -1], [1, 1, 0], [6, 5, 3]), 1000, 'label = "bottom", SUPPORT')
         + '[[contact]]\nsides = [ { body = "tool", label = LABEL }, { body = "block", label = "top" } ]\n'
           "REST\n"
         + tool("tool", more="MOTION\n") + timed())
PLATE = 'mesh = { shape = "cuboid", lower = [-2, -2, 0], upper = [2, 2, 1], cells = [3, 4, 1] }\n'
BALL = 'mesh = { shape = "ball", centre = [0.1, -0.05, 1.5], radius = 1.5, cells = 8, keep = ["-z"] }\n'
ALL_HELD = "ux = 0, uy = 0, uz = 0"
# A quarter of a half space: on its outer sides it moves as under a point force (Boussinesq).
QUARTER = """\
SetFactory("OpenCASCADE");
Box(1) = {0, 0, -10, 10, 10, 10};
Physical Volume(1) = {1};
Physical Surface("x") = {1}; Physical Surface("y") = {3};
Physical Surface("outer") = {2, 4, 5}; Physical Surface("top") = {6};
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval; Background Field = 1;
Field[1].F = "0.15 + 0.35*Max(0, Sqrt(x*x + y*y + z*z) - 1.2)";
"""
CONE = """\
SetFactory("OpenCASCADE");
Cone(1) = {0, 0, 0, 0, 0, HEIGHT, 0, 3}; Box(2) = {0, 0, -1, 9, 9, 9};
BooleanIntersection(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Physical Volume(1) = {3}; Physical Surface("round") = {1};
rest() = Surface{:}; rest() -= {1}; Physical Surface("rest") = rest();
Mesh.MeshSizeMax = 0.25;
"""
HALF_SPACE = ("dimension = 3\ndegree = 2\n"
              + body("block", '"block.geo"', 1000, 'label = "x", ux = 0', 'label = "y", uy = 0',
                     'label = "outer", ux = "x*(ACROSS)", uy = "y*(ACROSS)", uz = "DOWN"')
              + contact(("block", "top"), ("tool", "LABEL"), sides=True)
              + tool("tool", more="mesh = MESH\nfz = FORCE\n")
              + quantity("depth", "displacement", "tool", component="z")
              + quantity("peak", "largest_pressure", "block", "top") + timed())


def quantities(kind, *components, about=""):
    return "".join(f'[[quantity]]\nname = "{kind}-{c}"\n{kind} = {{ body = "tool" }}\ncomponent = "{c}"\n'
                   f'{about if c.startswith("moment") else ""}' for c in components)


def scene(motion, label='"bottom"', support=ALL_HELD, rest=""):
    return (BLOCK.replace("MOTION", motion).replace("LABEL", label).replace("SUPPORT", support)
            .replace("REST", rest))


class SpaceTools(InFolder):
    def values(self, text, *settings):
        summary = self.run_it(text, *settings)
        return {name: each["value"] for name, each in summary["quantities"].items()}

    def test_a_plate_presses_uniformly_at_any_mesh(self):
        for degree in (1, 2):
            with self.subTest(degree=degree):
                values = self.values(scene(PLATE + "fz = -400", support="uz = 0", rest="")
                                     .replace('{ label = "bottom"', '{ label = "left", ux = 0 }, '
                                              '{ label = "front", uy = 0 }, { label = "bottom"')
                                     + quantities("displacement", "z")
                                     + quantities("contact_force", "z", "moment_x"), f"degree={degree}")
                rows = [row for row in self.rows_of("out/contact.csv") if row["time"] == "1"]
                for row in rows:
                    self.assertAlmostEqual(float(row["pressure"]), 100, delta=1e-9)
                self.assertAlmostEqual(values["displacement-z"], -0.1, delta=1e-12)
                self.assertAlmostEqual(values["contact_force-z"], 400, delta=1e-9)
                self.assertAlmostEqual(values["contact_force-moment_x"], 0, delta=1e-9)

    def test_a_plate_that_is_pressed_off_its_centre_tilts_into_balance(self):
        motion = PLATE + "at = [0.2, -0.1, 0]\nfz = -400\nmoment_x = 0\nmoment_y = 0\n"
        text = scene(motion) + quantities("contact_force", "z", "moment_x", "moment_y")
        text += quantities("displacement", "z", "rotation_x", "rotation_y", "rotation_z")
        values = self.values(text)
        self.assertAlmostEqual(values["contact_force-z"], 400, delta=1e-10)
        for name in ("moment_x", "moment_y"):
            self.assertAlmostEqual(values["contact_force-" + name], 0, delta=1e-10)
        # More pressed towards +x and -y: the tool turns down there.
        self.assertGreater(values["displacement-rotation_y"], 1e-3)
        self.assertGreater(values["displacement-rotation_x"], 1e-4)
        self.assertAlmostEqual(values["displacement-rotation_z"], 0, delta=1e-15)
        prescribed = [f"{values['displacement-' + c]!r}" for c in ("z", "rotation_x", "rotation_y")]
        again = self.values(scene(PLATE + "at = [0.2, -0.1, 0]\nuz = {}\nrotation_x = {}\nrotation_y = {}\n"
                                  .format(*prescribed)) + quantities("reaction", "z", "moment_x", "moment_y"))
        self.assertAlmostEqual(again["reaction-z"], -400, delta=1e-7)
        for name in ("moment_x", "moment_y"):
            self.assertAlmostEqual(again["reaction-" + name], 0, delta=1e-7)

    def test_ball_punch_and_cone_on_a_half_space(self):
        """Hertz, Boussinesq, Sneddon; contact radius 1."""
        modulus, shear, slope = 1000 / (1 - 0.3**2), 1000 / 2.6, math.tan(math.radians(80))
        ball, punch = 4 * modulus / 30, 0.02 * modulus
        depth = math.pi / (2 * slope)
        self.write(QUARTER, "block.geo")
        self.write(CONE.replace("HEIGHT", repr(3 / slope)), "cone.geo")
        for mesh, label, force, known in (
                ('{ shape = "ball", centre = [0, 0, 10], radius = 10, cells = 30, keep = ["x", "y", "-z"] }',
                 "round", ball, {"depth": (0.1, 2e-3), "peak": (1.5 * ball / math.pi, 2e-2)}),
                ('{ shape = "cylinder", cells = [16, 1], keep = ["x", "y"] }', "bottom", punch,
                 {"depth": (0.01, 2e-3)}),
                ('"cone.geo"', "round", 2 * modulus * slope * depth**2 / math.pi, {"depth": (depth, 2e-3)})):
            with self.subTest(mesh):
                c, r = force / (4 * math.pi * shear), "sqrt(x^2 + y^2 + z^2)"
                text = HALF_SPACE.replace("ACROSS", f"{c!r}*(-z/{r}^3 - 0.4/({r}*({r} - z)))").replace(
                    "DOWN", f"-{c!r}*(1.4/{r} + z^2/{r}^3)").replace("LABEL", label).replace(
                    "MESH", mesh).replace("FORCE", repr(-force / 4))
                values = self.values(text)
                for name, (exact, within) in known.items():
                    self.assertAlmostEqual(abs(values[name]) / exact, 1, delta=within, msg=name)

    def test_it_is_what_a_body_becomes_that_stiffens(self):
        approach = self.values(scene(BALL + "uz = -0.03", label='"round"')
                               + quantities("contact_force", "x", "y", "z"))
        text = scene(BALL + "uz = -0.03", label='"round"') + quantities("contact_force", "x", "y", "z")
        body = text.replace("[[tool]]", "[[body]]").replace(
            "uz = -0.03", 'material = { young = 1e9, poisson = 0.3 }\n'
            'boundary = [ { label = "top", ux = 0, uy = 0, uz = -0.03 } ]').replace(
            '{ body = "tool" }', '{ body = "tool", label = "round" }')
        body = body.replace("sides = [ { body = \"tool\", label = \"round\" }, "
                            "{ body = \"block\", label = \"top\" } ]",
                            'nonmortar = { body = "block", label = "top" }\n'
                            'mortar = { body = "tool", label = "round" }')
        stiff = self.values(body)
        for name, value in approach.items():
            self.assertAlmostEqual(stiff[name] / approach["contact_force-z"],
                                   value / approach["contact_force-z"], delta=1e-4, msg=name)

    def test_friction_holds_and_turns(self):
        """A plate on a block is dragged and turned: mu P in its direction, its moment."""
        for angle in (0, 50, 200):
            with self.subTest(angle=angle):
                way = [0.5 * math.cos(math.radians(angle)), 0.5 * math.sin(math.radians(angle))]
                values = self.values(scene(PLATE + f"fz = -40\nux = {way[0]!r}\nuy = {way[1]!r}\n",
                                           rest='friction = 0.3\nsliding = "allow"')
                                     + quantities("reaction", "x", "y"))
                self.assertAlmostEqual(values["reaction-x"], 12 * way[0] / 0.5, delta=0.01)
                self.assertAlmostEqual(values["reaction-y"], 12 * way[1] / 0.5, delta=0.01)

    def test_friction_where_supports_hold_the_block_too(self):
        """Along the sides of the block conditions depend on each other, and the law is not linear."""
        block = scene(PLATE + "MOVES", support="uz = 0", rest="friction = 0.5").replace(
            "poisson = 0.3 }", "poisson = 0.3, viscosity = 1, yield_stress = 400 }").replace(
            '{ label = "bottom"',
            '{ label = "left", ux = 0 }, { label = "front", uy = 0 }, { label = "bottom"')
        block += quantities("reaction", "z", "moment_z")
        for moves in ('uz = -0.05\nrotation_z = "0.001*t"', 'uz = -0.05\nux = "0.001*t"', "uz = -0.05"):
            with self.subTest(moves):
                values = self.values(block.replace("MOVES", moves))
                self.assertLess(values["reaction-z"], -100)

    def test_motions_that_nothing_holds_are_named(self):
        self.write(scene(BALL + "at = [0.1, -0.05, 1.5]\nuz = -0.02\nmoment_z = 1", label='"round"'))
        errors = self.mortier("run", "scene.toml", "--quiet", "--out", "out", code=3).stderr
        self.assertIn("rotation about the line through (0.1, -0.05,", errors)
        self.assertIn("along z", errors)

    def test_a_tool_of_a_file_and_swept(self):
        self.write("SetFactory(\"OpenCASCADE\");\nBox(1) = {-0.5, -0.5, 0, 1, 1, 0.4};\n"
                   "Physical Volume(1) = {1}; Physical Surface(\"lower\") = {5};\n"
                   "Physical Surface(\"rest\") = {1, 2, 3, 4, 6};\n", "punch.geo")
        force = {}
        for name, mesh, label in (
                ("file", '"punch.geo"', '"lower"'),
                ("swept", '{ shape = "rectangle", lower = [-0.5, -0.5], upper = [0.5, 0.5], cells = [2, 2], '
                          'extrude = 0.4, layers = 1 }', '"start"'),
                ("cuboid", '{ shape = "cuboid", lower = [-0.5, -0.5, 0], upper = [0.5, 0.5, 0.4], '
                           'cells = [2, 3, 1] }', '"bottom"')):
            with self.subTest(name):
                force[name] = self.values(scene(f"mesh = {mesh}\nuz = -0.01", label=label)
                                          + quantities("contact_force", "z"))["contact_force-z"]
                self.assertAlmostEqual(force[name] / force["file"], 1, delta=1e-9)

    def test_units_of_forces_and_moments(self):
        """Of a ring and in space forces are not per length."""
        text = scene(PLATE + 'at = [0.2, -0.1, 0]\nfz = "-0.4 kN"\nmoment_x = 0\nmoment_y = "2 N m"\n')
        here = quantities("displacement", "rotation_y")
        metres = self.values('units = "m, N, Pa"\n' + text + here)
        plain = self.values(text.replace('"-0.4 kN"', "-400").replace('"2 N m"', "2") + here)
        self.assertEqual(metres, plain)
        self.refuse('units = "m, N, Pa"\n' + text.replace("kN", "kN/m"), "fz")

    def test_what_is_refused(self):
        for motion, message in (
                ("uz = -0.1", "mesh"),
                (PLATE + "rotation = 0.1", "rotation = 0.1, expected none with dimension = 3"),
                (PLATE + "moment_x = 1\nrotation_x = 0", "moment_x"),
                (PLATE + 'fz = "x"', "a function of t alone"),
                ('shape = "disc"\ncentre = [0, 0]\nradius = 1', "mesh")):
            with self.subTest(message):
                self.refuse(scene(motion), message)
        self.refuse(scene(PLATE + "uz = -0.1").replace("[time]", "[accuracy]\nbound = true\n[time]"), "bound")


if __name__ == "__main__":
    unittest.main()
