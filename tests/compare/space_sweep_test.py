"""Bodies in space made of plane meshes: extruded ones are those of plane strain, turned ones those of
revolution; labels, and what is wrong."""
import json
import unittest

import meshio

from scene_parts import body, box, contact, quantity, shape, timed
from support import InFolder, values

GEO = """\
SetFactory("OpenCASCADE");
Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {2, 1, 0}; Point(4) = {1, 1.6, 0};
Point(5) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Spline(3) = {3, 4, 5}; Line(4) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Curve("floor", 1) = {1}; Physical Curve("roof", 7) = {3}; Physical Surface("cam", 4) = {1};
"""


def part(mesh, *boundary, head="dimension = 3", more=""):
    return f"{head}\n" + body("part", "{ " + mesh + " }", 100, *boundary, more=more) + timed()


class SpaceSweep(InFolder):
    def values(self, text):
        return values(self.run_it(text))

    def stress(self):
        mesh = meshio.read(sorted((self.folder / "out").glob("part_*.vtu"))[-1])
        return mesh.cell_data["stress"][0]

    def test_a_uniform_stress_is_exact(self):
        """The patch test: a bar is pulled along its axis."""
        for mesh, first, second in (
                ('shape = "rectangle", cells = [3, 2], extrude = 2, layers = 3', "[0, 0, 0]", "[1, 0, 0]"),
                ('shape = "annulus", cells = [9, 2], cut = "falling", extrude = 2, layers = 2', "[1, 0, 0]",
                 "[2, 0, 0]"),
                ('shape = "rectangle", cut = "both", cells = 2, revolve = "pi/2", layers = 3', "[0, 0, 0]",
                 "[1, 0, 0]")):
            for degree in (1, 2):
                with self.subTest(mesh, degree=degree):
                    along, ends = ("z", ("start", "end")) if "extrude" in mesh else ("y", (1, 3))
                    across = "y" if along == "z" else "z"
                    self.run_it(part(
                        mesh, f"label = {json.dumps(ends[0])}, u{along} = 0",
                        f"label = {json.dumps(ends[1])}, t{along} = 3",
                        head=f"dimension = 3\ndegree = {degree}",
                        more=f"[[body.point]]\nat = {first}\nux = 0\nu{across} = 0\n"
                             f"[[body.point]]\nat = {second}\nu{across} = 0\n"))
                    for row in self.stress():  # xx, yy, zz, xy, yz, xz
                        for k, value in enumerate(row):
                            self.assertAlmostEqual(value, 3 if k == "xyz".index(along) else 0, delta=1e-11)

    def test_an_extruded_part_is_that_of_plane_strain(self):
        """Held at both ends: the finer the layers, the nearer to the plane mesh; one layer has diagonals."""
        conditions = "label = 1, ux = 0, uy = 0", 'label = 3, tx = "1", ty = "x"'
        top = quantity("top", "displacement", "part", 3, "y")
        plane = self.values(part('shape = "rectangle", cells = 8, cut = "both"', *conditions,
                                 head='plane = "strain"\ndegree = 2', more=top))["top"]
        space = self.values(part('shape = "rectangle", cells = 4, cut = "both", extrude = 0.5, layers = 2',
                                 *conditions, 'label = "start", uz = 0', 'label = "end", uz = 0',
                                 head="dimension = 3\ndegree = 2", more=top))["top"]
        self.assertAlmostEqual(space / plane, 1, delta=2e-2)

    def test_a_turned_part_is_that_of_revolution(self):
        """A thick ring under pressure inside; a quarter of it between planes of symmetry."""
        mesh = 'shape = "rectangle", lower = [1, 0], upper = [2, 0.5], cells = [6, 2]'
        conditions = "label = 1, uy = 0", "label = 3, uy = 0", "label = 4, pressure = 5"
        ring = self.values(part(
            mesh, *conditions, head='plane = "axisymmetric"\ndegree = 2',
            more=quantity("outside", "displacement", "part", component="x", point=[2, 0])))["outside"]
        lame = 2 * 5 / 3 * (1 + 0.3) / 100 * (0.4 * 2 + 4 / 2) / 2
        self.assertAlmostEqual(ring / lame, 1, delta=1e-3)
        last = None
        for layers in (4, 8, 16):
            quarter = self.values(part(
                f'{mesh}, revolve = "pi/2", layers = {layers}', *conditions, 'label = "start", uz = 0',
                'label = "end", ux = 0', head="dimension = 3\ndegree = 2",
                more=quantity("outside", "displacement", "part", component="x", point=[2, 0, 0])))["outside"]
            error = abs(quarter / ring - 1)
            if last is not None:
                self.assertLess(error, 0.35 * last)  # of chords: second order
            last = error
        self.assertLess(last, 2e-3)

    def test_a_file_is_extruded_with_its_names(self):
        self.write(GEO, "cam.geo")
        mesh = 'file = "cam.geo", size = 0.5, region = "cam", '
        held = 'label = "floor", ux = 0, uy = 0, uz = 0'
        values = self.values(part(mesh + "extrude = 3, layers = 4", held, 'label = "roof", ty = -2',
                                  'label = "end", tz = 0',
                                  more=quantity("floor", "reaction", "part", "floor", "y")))
        self.assertGreater(values["floor"], 2 * 3 * 2)  # the arc is longer than its width
        self.assertLess(values["floor"], 2 * 3 * 2.6)
        # Turned all around: no ends.
        around = mesh + 'revolve = "2*pi", layers = 12'
        self.assertEqual(self.run_it(part(around, held, 'label = "roof", ty = -2'))["status"], "converged")
        self.refuse(part(around, held, 'label = "end", ty = -2'), 'label = "end", expected one of')

    def test_contact_of_an_extruded_and_a_turned_body(self):
        """A cone frustum that turns about y presses on an extruded block."""
        self.write("dimension = 3\n"
                   + body("upper",
                          shape("quadrilateral", corners=[[0, 0], [0.5, 0], [1, 1], [0, 1]], cells=3,
                                revolve="pi/2", layers=4), 100, 'label = "start", uz = 0',
                          'label = "end", ux = 0', "label = 3, uy = -0.01")
                   + body("lower", box([0, -1], [1, 0], 4, extrude=1, layers=4), 100,
                          "label = 1, ux = 0, uy = 0, uz = 0", "label = 4, ux = 0",
                          'label = "start", uz = 0') + contact(("upper", 1), ("lower", 3))
                   + quantity("force", "contact_force", "lower", 3, "y")
                   + quantity("floor", "reaction", "lower", 1, "y") + timed())
        said = self.mortier("check", "scene.toml").stdout
        self.assertIn("0 errors", said)
        values = self.values(self.read("scene.toml"))
        self.assertAlmostEqual(values["force"] / values["floor"], -1, delta=1e-9)
        self.assertGreater(values["floor"], 0.05)

    def test_what_is_wrong_is_named(self):
        shape = 'shape = "rectangle", cells = 2'
        for mesh, message in (
                (shape, "expected cuboid, cylinder, ball, a plane shape beside extrude or revolve"),
                (shape + ", extrude = 1", "layers"),
                (shape + ", extrude = 0, layers = 1", "extrude = 0, expected extrude > 0"),
                (shape + ", extrude = 1, layers = 0", "layers = 0, expected an integer >= 1"),
                (shape + ", extrude = 1, layers = 1.5", "layers = 1.5, expected an integer >= 1"),
                (shape + ", extrude = 1, revolve = 1, layers = 1", "extrude or revolve, not both"),
                (shape + ", revolve = 90, layers = 9", "revolve = 90, expected an angle above 0, at most 2"),
                (shape + ', revolve = "x", layers = 9', "an angle above 0, at most 2 pi"),
                (shape + ", revolve = -1, layers = 9", "an angle above 0, at most 2 pi"),
                (shape + ', revolve = "2*pi", layers = 2', "layers that turn by half a circle"),
                (shape + ", layers = 2", "beside extrude or revolve"),
                (shape + ", lower = [-1, 0], revolve = 1, layers = 2", "expected x >= 0 beside revolve"),
                ('shape = "cuboid", cells = 2, extrude = 1, layers = 1', "extrude = 1, expected of")):
            with self.subTest(mesh):
                self.refuse(part(mesh, "label = 1, un = 0"), message)
        self.refuse(part(shape + ", extrude = 1, layers = 1", "label = 1, un = 0", head=""),
                    "expected it with dimension = 3 only")


if __name__ == "__main__":
    unittest.main()
