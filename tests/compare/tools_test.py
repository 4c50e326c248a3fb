#!/usr/bin/python3
"""Rigid tools ([[tool]], docs/scene.md): exact solutions, balance, free motions, quantities, faults."""
import math
import unittest

from scene_parts import body, box, contact, quantity, timed, tool
from support import InFolder, set_option, value

import results  # noqa: E402

BLOCK = body("block", box([0, 0], [1, 1], [5, 4]), 100, "label = 1, uy = 0", "label = 4, ux = 0")
PLATE = tool("plate", shape="rectangle", lower=[-0.3, 1], upper=[1.4, 1.5], at=[0.25, 1], more="MOTION\n")
CONTACT = contact(("block", 3), ("plate", 1), sides=True)
TIME = timed(2)
QUANTITIES = "".join([
    *(quantity(f"{name}-{c}", kind, "plate", component=c)
      for name, kind, turn in (("reaction", "reaction", "moment"), ("contact", "contact_force", "moment"),
                               ("moves", "displacement", "rotation")) for c in ("x", "y", turn)),
    quantity("external", "external_work", "plate"), quantity("stored", "stored_energy", "block")])


def pressed(motion, extra=""):
    return BLOCK + PLATE.replace("MOTION", motion) + CONTACT + extra + QUANTITIES + TIME


# Half planes, fine around the origin.
def half_plane(young, cells, grading, lower=(-80, -80), upper=(80, 0), more=""):
    return body("ground", box(lower, upper, cells, cut="both", focus=[0, 0], grading=[grading, grading]),
                f"young = {young}, poisson = 0.3{more}", "label = 1, ux = 0, uy = 0")


ON_GROUND = contact(("ground", 3), ("tool", 1), sides=True) + timed()


class Tools(InFolder):
    def solve(self, text, *settings, code=0):
        """The summary and the last kept step."""
        self.write(text)
        done = self.mortier("run", "scene.toml", "--out", "out", *set_option(settings), code=code)
        if code:
            return done.stderr, None
        summary = self.summary_of()
        tables = results.contact_tables(self.folder / "out")
        return summary, results.mortier_run(self.folder / "out", summary, tables, results.kept_steps(
            self.folder / "out")[-1][0])

    def test_patch_under_a_flat_tool(self):
        for rows in ("variant=mortar", "variant=interpolation", "variant=weighted", "stabilised=true"):
            for degree in (1, 2):
                for plane in ("stress", "strain", "axisymmetric"):
                    with self.subTest(rows=rows, degree=degree, plane=plane):
                        text = f'degree = {degree}\nplane = "{plane}"\n' + pressed('uy = "-0.01*t"')
                        if plane == "axisymmetric":
                            text = (text.split("[[quantity]]")[0] + TIME).replace("[-0.3, 1]", "[0, 1]")
                            text = text.replace("at = [0.25, 1]\n", "").replace(
                                ", { label = 4, ux = 0 }", "")
                        _, run = self.solve(text, f"contact.{rows}")
                        exact = -1 if plane != "strain" else -1 / (1 - 0.09)
                        stress = run.bodies["block"].stress
                        self.assertLess(abs(stress[:, 1] - exact).max(), 1e-12)
                        self.assertLess(abs(stress[:, [0, 2]]).max(), 1e-12)

    def test_quantities_of_a_tool(self):
        summary, run = self.solve(pressed('uy = "-0.01*t"'))
        expected = {"reaction-x": 0, "reaction-y": -1, "reaction-moment": -0.25, "contact-x": 0,
                    "contact-y": 1, "contact-moment": 0.25, "moves-x": 0, "moves-y": -0.01,
                    "moves-rotation": 0, "external": 0.005, "stored": 0.005}
        for name, exact in expected.items():
            self.assertAlmostEqual(value(summary, name), exact, delta=1e-13, msg=name)
        self.assertIn("moves-rotation[rad]", self.read("out/history.csv"))
        plate = next(body for body in summary["bodies"] if body["name"] == "plate")
        self.assertEqual((plate["material"], plate["laws"], plate["free_dofs"]), ("rigid", [], 0))
        self.assertTrue(run.bodies["plate"].rigid)
        self.assertNotIn(b"stress", (self.folder / "out/plate_000002.vtu").read_bytes()[:2000])

    def test_prescribed_rotation(self):
        """A tool that turns about a point of its face by an angle moves the face by it, linearly."""
        summary, run = self.solve(pressed('uy = "-0.02*t"\nrotation = "0.01*t"'))
        plate = run.bodies["plate"]
        for x, u in zip(plate.points, plate.displacement):
            self.assertAlmostEqual(u[0], -0.01 * (x[1] - 1), delta=1e-15)
            self.assertAlmostEqual(u[1], -0.02 + 0.01 * (x[0] - 0.25), delta=1e-15)
        block = run.bodies["block"]
        for x, u in zip(block.points, block.displacement):
            if x[1] == 1:
                self.assertAlmostEqual(u[1], -0.02 + 0.01 * (x[0] - 0.25), delta=1e-4)
        self.assertLess(value(summary, "reaction-moment") + value(summary, "contact-moment"), 1e-13)

    def test_force_and_moment(self):
        """What forces press is what contact carries, whichever motions are free."""
        for motion, extra, forces in (
                ('fy = "-1*t"', "", (None, 1, None)),
                ('fy = "-1*t"\nmoment = "-0.3*t"', "", (None, 1, 0.3)),
                ('fy = "-1*t"\nfx = "0.1*t"\nmoment = "-0.3*t"', "friction = 0.4\n", (-0.1, 1, 0.3))):
            for variant in ("mortar", "weighted", "interpolation"):
                for degree in (1, 2):
                    with self.subTest(motion=motion, variant=variant, degree=degree):
                        summary, _ = self.solve(f"degree = {degree}\n" + pressed(motion, extra),
                                                f"contact.variant={variant}")
                        for component, force in zip(("x", "y", "moment"), forces):
                            if force is None:
                                continue
                            name = f"contact-{component}"
                            self.assertAlmostEqual(value(summary, name), force, delta=1e-13, msg=name)
                            self.assertEqual(value(summary, f"reaction-{component}"), 0)
                        self.assertLess(summary["verification"]["force_balance"], 1e-13)

    def test_forces_move_as_displacements_do(self):
        """A tool that is pressed to where a force has brought another needs that force."""
        first, _ = self.solve(pressed('fy = "-1*t"\nmoment = "-0.2*t"'))
        second, _ = self.solve(pressed(f'uy = "{value(first, "moves-y")!r}*t"\n'
                                       f'rotation = "{value(first, "moves-rotation")!r}*t"'))
        for name, force in (("reaction-y", -1), ("reaction-moment", -0.2)):
            self.assertAlmostEqual(value(second, name), force, delta=1e-11)

    def test_free_motions_are_named(self):
        for motion, message in (('fy = "-1*t"\nfx = "0.1*t"', "plate: nothing holds its translation along"),
                                ('fy = "t"', "contact cannot hold body plate: translation")):
            errors, _ = self.solve(pressed(motion), code=3)
            self.assertIn(message, errors)

    def test_hertz(self):
        """A rigid cylinder: largest pressure and half-width over those of Hertz's theory."""
        tool = '[[tool]]\nname = "tool"\nshape = "disc"\ncentre = [0, 50]\nradius = 50\nfy = "-8000*t"\n'
        text = 'plane = "strain"\n' + half_plane(70000, [100, 60], 60) + tool + ON_GROUND
        _, run = self.solve(text + quantity("y", "displacement", "tool", component="y"))
        modulus = 70000 / (1 - 0.09)
        half_width = math.sqrt(4 * 8000 * 50 / (math.pi * modulus))
        peak = 2 * 8000 / (math.pi * half_width)
        x, p = run.contact.position[:, 0], run.contact.pressure
        self.assertAlmostEqual(p.max() / peak, 1, delta=1e-2)
        self.assertAlmostEqual(abs(x[run.contact.force > 0]).max() / half_width, 1, delta=0.1)
        exact = peak * (1 - (x / half_width)**2).clip(0)**0.5
        inside = abs(x) < 0.8 * half_width
        self.assertLess(abs(p - exact)[inside].max() / peak, 1e-2)

    def test_flat_punch(self):
        tool = ('[[tool]]\nname = "tool"\nshape = "polygon"\npoints = [[0, 0], [1, 0], [1, 1], [0, 1]]\n'
                'fy = "-0.5*t"\n')
        ground = half_plane(100, [80, 60], 200, [0, -40], [40, 0])
        ground = ground.replace("focus = [0, 0]", "focus = [1, 0]")
        ground = ground.replace("uy = 0 } ]", "uy = 0 }, { label = 4, ux = 0 } ]")
        _, run = self.solve('plane = "strain"\n' + ground + tool + ON_GROUND, "contact.variant=weighted")
        x, p = run.contact.position[:, 0], run.contact.pressure
        inside = (x > 0.1) & (x < 0.8)
        exact = 1 / (math.pi * (1 - x[inside]**2)**0.5)
        self.assertLess(abs(p[inside] / exact - 1).max(), 0.05)

    def test_prandtl(self):
        """A flat punch on ideally plastic ground: the mean pressure tends to (2 + pi) times the shear yield
        stress."""
        ground = half_plane(1e5, [40, 32], 4, [0, -4], [5, 0],
                            ', law = "viscoplastic", yield_stress = 1, viscosity = 0')
        ground = ground.replace("focus = [0, 0]", "focus = [1, 0]")
        ground = ground.replace("uy = 0 } ]", "uy = 0 }, { label = 4, ux = 0 }, { label = 2, ux = 0 } ]")
        tool = ('[[tool]]\nname = "tool"\nshape = "polygon"\npoints = [[0, 0], [1, 0], [1, 1], [0, 1]]\n'
                'uy = "-3e-4*t"\n')
        text = 'plane = "strain"\n' + ground + tool + ON_GROUND.replace("steps = 1", "steps = 20")
        summary, _ = self.solve(text + quantity("mean", "reaction", "tool", component="y"))
        mean = -value(summary, "mean") / ((2 + math.pi) / math.sqrt(3))
        self.assertGreater(mean, 1)  # what displacements are left to find needs more
        self.assertLess(mean, 1.03)

    def test_a_mesh_as_a_tool(self):
        """The outline of a mesh presses as the disc of which it is a half."""
        self.mortier("mesh", "halfdisc", "--radius", "50", "--core", "4", "--cells", "16", "disc.mesh")
        force = {}
        for shape in ('mesh = "disc.mesh"', 'shape = "disc"\ncentre = [0, 50]\nradius = 50'):
            tool = f'[[tool]]\nname = "tool"\n{shape}\nuy = "-0.2*t"\n'
            summary, _ = self.solve('plane = "strain"\n' + half_plane(70000, [64, 40], 12) + tool + ON_GROUND
                                    + quantity("press", "reaction", "tool", component="y"))
            force[shape[:4]] = value(summary, "press")
        self.assertAlmostEqual(force["mesh"] / force["shap"], 1, delta=1e-6)

    def test_cone_and_wedge(self):
        """Sneddon: the force of a radius of contact, or of a half-width."""
        modulus = 100 / (1 - 0.09)
        for shape, plane, lower, points in (
                ("cone", "axisymmetric", [0, -30], "[[0, 0], [10, 1], [0, 1]]"),
                ("wedge", "strain", [-30, -30], "[[0, 0], [10, 1], [-10, 1]]\nlabels = [1, 2, 1]")):
            with self.subTest(shape):
                force = (math.pi / 20 if shape == "cone" else 0.1) * modulus  # of a radius, a half-width 1
                tool = (f'[[tool]]\nname = "tool"\nshape = "polygon"\npoints = {points}\n'
                        f'fy = "{-force!r}*t"\n')
                ground = half_plane(100, [60, 50], 60, lower, [30, 0])
                ground = ground.replace("ux = 0, ", "") if shape == "cone" else ground
                _, run = self.solve(f'plane = "{plane}"\n' + ground + tool + ON_GROUND)
                x, p = run.contact.position[:, 0], run.contact.pressure
                mean = modulus / 20 if shape == "cone" else modulus / (10 * math.pi)
                inside = (abs(x) > 0.15) & (abs(x) < 0.8)
                exact = [mean * math.acosh(1 / abs(each)) for each in x[inside]]
                self.assertLess(abs(p[inside] / exact - 1).max(), 0.04)

    def test_full_slip(self):
        text = (half_plane(100, [40, 10], 1, [0, -1], [4, 0])
                + '[[tool]]\nname = "tool"\nshape = "disc"\ncentre = [2, 2]\nradius = 2\n'
                'fy = "-min(t, 1)"\nux = "0.05*max(t - 1, 0)"\n'
                + ON_GROUND.replace("[time]\nend = 1\nsteps = 1",
                                    "friction = 0.3\n[time]\nend = 2\nsteps = 2")
                + "".join(quantity(c, "contact_force", "tool", component=c) for c in ("x", "y")))
        summary, _ = self.solve(text)
        fx, fy = value(summary, "x"), value(summary, "y")
        self.assertAlmostEqual(fx / fy, -0.3, delta=1e-10)
        self.assertAlmostEqual(fy, 1, delta=1e-13)

    def test_spline_is_as_the_disc_that_it_is(self):
        """Distances are those of the curves: a spline through points of a circle presses as the disc."""
        angles = [math.radians(10 * i) for i in range(-18, 19)]
        points = [[50 * math.sin(a), 50 - 50 * math.cos(a)] for a in angles]
        points[-1] = points[0]
        force = {}
        for shape in ('shape = "disc"\ncentre = [0, 50]\nradius = 50',
                      f'shape = "spline"\npoints = {points}'):
            tool = f'[[tool]]\nname = "tool"\n{shape}\nuy = "-0.2*t"\n'
            summary, _ = self.solve('plane = "strain"\n' + half_plane(70000, [64, 40], 12) + tool + ON_GROUND
                                    + quantity("press", "reaction", "tool", component="y"))
            force[shape[9:13]] = value(summary, "press")
        self.assertAlmostEqual(force["disc"] / force["spli"], 1, delta=2e-3)

    def test_two_tools_on_one_side(self):
        tools = "".join(f'[[tool]]\nname = "{name}"\nshape = "rectangle"\nlower = [{x}, 1]\n'
                        f'upper = [{x + 0.4}, 1.2]\nuy = "-0.01*t"\n' for name, x in (("left", -0.1),
                                                                                      ("right", 0.7)))
        contacts = "".join(f'[[contact]]\nsides = [{{ body = "block", label = 3 }}, '
                           f'{{ body = "{name}", label = 1 }}]\n' for name in ("left", "right"))
        forces = "".join(quantity(name, "reaction", name, component="y")
                         for name in ("left", "right"))
        block = BLOCK.replace("[5, 4]", '[20, 8], cut = "both"').replace("label = 4,", "label = 1,")
        summary, _ = self.solve(block + tools + contacts + forces + TIME)
        left, right = value(summary, "left"), value(summary, "right")
        self.assertAlmostEqual(left / right, 1, delta=1e-11)
        self.assertLess(left, 0)

    def test_stopped_and_resumed(self):
        self.write(pressed('fy = "-1-0.5*sin(20*t)"\nfx = "0.1*sin(9*t)"\nmoment = "-0.1-0.1*sin(7*t)"',
                           "friction = 0.4\n") + "[output]\nevery = 1\n")
        self.resume(["time.steps=400"], 20,
                    ("history.csv", "contact.csv", "plate_000400.vtu", "block_000400.vtu"))

    def test_pictures_and_plan(self):
        self.write(pressed('fy = "-1*t"\nmoment = "-0.3*t"'))
        self.mortier("run", "scene.toml", "--out", "out")
        self.assertIn("modelled   body plate: rigid: it moves as a whole, and contact alone holds 2 motions",
                      self.mortier("check", "scene.toml").stdout)
        self.mortier("plot", "out", "--out", "picture.png")
        self.mortier("report", "out", "--out", "report.html")
        self.assertIn('"rigid":true', self.read("report.html").replace(" ", ""))

    def test_accuracy(self):
        """Meshes of bodies are refined, outlines are not."""
        tool = '[[tool]]\nname = "tool"\nshape = "disc"\ncentre = [0, 50]\nradius = 50\nfy = "-8000*t"\n'
        text = 'plane = "strain"\n' + half_plane(70000, [8, 6], 4) + tool + ON_GROUND
        summary, run = self.solve(text + "[accuracy]\nenergy = 0.1\n")
        self.assertLess(summary["accuracy"]["energy_error"], 0.1)
        self.assertEqual(len(run.bodies["tool"].points), 720)
        self.assertGreater(len(run.bodies["ground"].points), 200)

    def test_forces_in_freefem(self):
        """They are written, and refused where they turn a tool that contact follows."""
        text = pressed('fy = "-1*t"\nmoment = "-0.3*t"')
        self.write(text)
        self.mortier("freefem", "scene.toml", "script.edp")
        self.assertIn("freeTool(2, 0.25, 1, 0, 0., 1, -1.*t, 1, -0.3*t);", self.read("script.edp"))
        self.write(text.replace(CONTACT, CONTACT + 'sliding = "finite"\n'))
        self.reject("scene.toml:13: tool plate: a tool that turns beside sliding", "freefem", "scene.toml",
                    "script.edp")

    def test_faults(self):
        good = pressed('uy = "-0.01*t"')
        for old, new, message in (
                ('uy = "-0.01*t"', 'uy = 0\nfy = 1', "scene.toml:13: tool plate: fy = 1, expected either it"),
                ('uy = "-0.01*t"', 'uy = "x*t"',
                 'scene.toml:12: tool plate: uy = "x*t", expected a function of t alone'),
                ('uy = "-0.01*t"', "radius = 2", "scene.toml:12: tool plate: radius"),
                ("upper = [1.4, 1.5]", "upper = [1.4, 0.5]", "scene.toml:10: tool plate: upper"),
                ('shape = "rectangle"\nlower', 'shape = "ball"\nlower', "scene.toml:8: tool plate: shape"),
                ('shape = "rectangle"\nlower = [-0.3, 1]\nupper = [1.4, 1.5]',
                 'shape = "polygon"\npoints = [[0, 1], [0, 2], [1, 1]]',
                 "scene.toml:8: tool plate: shape: runs clockwise"),
                ('sides = [ { body = "block", label = 3 }, { body = "plate", label = 1 } ]',
                 'nonmortar = { body = "plate", label = 1 }\nmortar = { body = "block", label = 3 }',
                 "scene.toml:14: contact: a tool as the nonmortar side"),
                (CONTACT, "", "scene.toml:6: tool plate: in no contact"),
                ('name = "plate"', 'name = "block"', "scene.toml:6: tool block: name"),
                (BLOCK, "", "scene.toml:1: body is missing"),
                (TIME, TIME + "[accuracy]\nbound = true\n", "scene.toml:6: tool plate: a tool, expected"),
                (TIME, TIME + '[solver]\nmethod = "penalty-duality"\n', "scene.toml:6: tool plate: a tool"),
                ('stored_energy = { body = "block" }', 'stored_energy = { body = "plate" }',
                 "scene.toml:56: quantity stored"),
                ('reaction = { body = "plate" }', 'reaction = { body = "plate", label = 1 }',
                 "scene.toml:17: quantity reaction-x"),
                (CONTACT, CONTACT + "swap = true\n", "scene.toml:15: contact: swap = true, expected it only"),
                ('uy = "-0.01*t"', "moment = 1\nrotation = 1",
                 "scene.toml:12: tool plate: moment = 1, expected")):
            with self.subTest(new):
                self.assertIn(old, good)
                self.write(good.replace(old, new, 1))
                self.reject(message, "run", "scene.toml", "--out", "out")


if __name__ == "__main__":
    unittest.main()
