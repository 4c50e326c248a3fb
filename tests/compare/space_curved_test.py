"""Curved surfaces in contact in space: with Gmsh's geometry, and from triangles alone."""
import math
import unittest

import numpy as np

from scene_parts import body, contact, quantity, timed
from space_support import InSpace

# A quarter of two tubes with the radii 1, 2, 3, of one mesh.
TUBES = """\
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.4 ];
Cylinder(1) = {0, 0, 0, 0, 0, 0.4, 3, Pi/2}; Cylinder(2) = {0, 0, 0, 0, 0, 0.4, 2, Pi/2};
Cylinder(3) = {0, 0, 0, 0, 0, 0.4, 1, Pi/2};
BooleanDifference(5) = { Volume{1}; Delete; }{ Volume{2}; };
BooleanDifference(4) = { Volume{2}; Delete; }{ Volume{3}; Delete; };
Coherence;
e = 1e-4; v() = Volume{:}; i() = Volume In BoundingBox{-e, -e, -e, 2 + e, 2 + e, 0.4 + e};
o() = Volume{:}; o() -= i();
Physical Volume("inner", 1) = i(); Physical Volume("outer", 2) = o();
Physical Surface("left", 4) = Surface In BoundingBox{-e, -e, -e, e, 4, 1};
Physical Surface("front", 5) = Surface In BoundingBox{-e, -e, -e, 4, e, 1};
Physical Surface("start", 6) = Surface In BoundingBox{-e, -e, -e, 4, 4, e};
Physical Surface("end", 7) = Surface In BoundingBox{-e, -e, 0.4 - e, 4, 4, 1};
bore() = Surface In BoundingBox{-e, -e, -e, 1 + e, 1 + e, 1};
mid() = Surface In BoundingBox{-e, -e, -e, 2 + e, 2 + e, 1}; mid() -= bore();
f() = Surface In BoundingBox{-e, -e, -e, e, 4, 1}; mid() -= f();
f() = Surface In BoundingBox{-e, -e, -e, 4, e, 1}; mid() -= f();
f() = Surface In BoundingBox{-e, -e, -e, 4, 4, e}; mid() -= f();
f() = Surface In BoundingBox{-e, -e, 0.4 - e, 4, 4, 1}; mid() -= f();
Physical Surface("bore", 8) = bore(); Physical Surface("mid", 9) = mid();
Mesh.MeshSizeMax = h; Mesh.MeshSizeMin = h;
"""
TUBES_SCENE = ("dimension = 3\ndegree = 2\n"
               + body("inner", '{ file = "INNER" }', "young = 1e5, poisson = 0", 'label = "left", ux = 0',
                      'label = "front", uy = 0', 'label = "start", uz = 0', 'label = "end", uz = 0',
                      'label = "bore", pressure = 1')
               + body("outer", '{ file = "OUTER" }', "young = 1e5, poisson = 0", 'label = "left", ux = 0',
                      'label = "front", uy = 0', 'label = "start", uz = 0')
               + contact(("inner", "mid"), ("outer", "mid"))
               + quantity("peak", "largest_pressure", "inner", "mid") + timed())

# A quarter of a cylinder along y or, turned, along x; fine where it touches.
CYLINDER = """\
SetFactory("OpenCASCADE");
DefineConstant[ f = 0.03, h = 0.25 ];
Cylinder(1) = {0, 0, 1, 0, 3, 0, 1};
Box(2) = {0, 0, 0, 1, 3, 1};
BooleanIntersection{ Volume{1}; Delete; }{ Volume{2}; Delete; }
TURNED
e = 1e-4;
x() = Surface In BoundingBox{-e, -9, -9, e, 9, 9}; y() = Surface In BoundingBox{-9, -e, -9, 9, e, 9};
top() = Surface In BoundingBox{-9, -9, TOP - e, 9, 9, TOP + e};
end() = Surface In BoundingBox{LOW, 9, 9, 9};
arc() = Surface{:}; arc() -= {x(), y(), top(), end()};
Physical Volume("b", 1) = {1}; Physical Surface("arc", 1) = arc(); Physical Surface("top", 3) = top();
Physical Surface("x", 4) = x(); Physical Surface("y", 5) = y();
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval; Field[1].F = Sprintf("%g + %g*Sqrt(x^2 + y^2 + z^2)", f, h); Background Field = 1;
"""
CROSSED_SCENE = ("dimension = 3\ndegree = 2\n"
                 + body("up", '{ file = "UP" }', 1, 'label = "x", ux = 0', 'label = "y", uy = 0',
                        'label = "top", uz = -0.02')
                 + body("lo", '{ file = "LO" }', 1, 'label = "x", ux = 0', 'label = "y", uy = 0',
                        'label = "top", uz = 0.02') + contact(("up", "arc"), ("lo", "arc"), sides=True)
                 + quantity("force", "reaction", "lo", "top", "z")
                 + quantity("peak", "largest_pressure", "up", "arc") + timed())

# A thin slice of a roller in a groove of 90 degrees, half of it.
GROOVE = """\
SetFactory("OpenCASCADE");
DefineConstant[ f = 0.06, W = 0.3 ];
R = 10;
Cylinder(1) = {0, 0, R*Sqrt(2), 0, W, 0, R}; Box(2) = {-2*R, -1, -R, 2*R, W + 2, 5*R};
BooleanIntersection(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Box(4) = {-30, 0, -20, 30, W, 38};
Point(101) = {0, -1, 0}; Point(102) = {0, -1, 40}; Point(103) = {-40, -1, 40};
Line(101) = {101, 102}; Line(102) = {102, 103}; Line(103) = {103, 101};
Curve Loop(101) = {101:103}; Plane Surface(101) = {101};
w[] = Extrude {0, 30, 0} { Surface{101}; };
BooleanDifference(6) = { Volume{4}; Delete; }{ Volume{w[1]}; Delete; };
Physical Volume("roller") = {3}; Physical Volume("block") = {6};
Physical Surface("round") = {1}; Physical Surface("upper x") = {2}; Physical Surface("upper y") = {3, 4};
Physical Surface("lower y") = {6, 8}; Physical Surface("bottom") = {9}; Physical Surface("lower x") = {10};
Physical Surface("flank") = {11};
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval; Background Field = 1;
Field[1].F = Sprintf("%g + 0.4*Max(0, Sqrt((x + 7.0710678)^2 + (z - 7.0710678)^2) - 0.34)", f);
"""
GROOVE_SCENE = ("dimension = 3\n"
                + body("roller", '{ file = "groove.geo", region = "roller" }', 210e3,
                       'label = "upper x", ux = 0', 'label = "upper y", uy = 0', force={"z": -1.0610329539})
                + body("block", '{ file = "groove.geo", region = "block" }', "young = 70e3, poisson = 0.33",
                       'label = "lower x", ux = 0', 'label = "lower y", uy = 0', 'label = "bottom", uz = 0')
                + contact(("roller", "round"), ("block", "flank"))
                + quantity("z", "contact_force", "roller", "round", "z") + timed())


def cylinder(across):
    text = CYLINDER.replace("TURNED", "Rotate {{1, 1, 0}, {0, 0, 0}, Pi} { Volume{1}; }" if across else "")
    return text.replace("TOP", "-1" if across else "1").replace(
        "LOW", "3 - e, -9, -9" if across else "-9, 3 - e, -9")


class CurvedSurfaces(InSpace):
    def test_a_roller_presses_along_a_groove_as_that_of_hertz(self):
        self.write(GROOVE, "groove.geo")
        for degree, size, part, within in ((1, 0.038, 0.85, 0.1), (2, 0.057, 0.7, 0.05)):
            with self.subTest(degree=degree):
                values = self.run_scene(GROOVE_SCENE, f"degree={degree}", *(
                    f"body.{name}.mesh.parameters.f={size}" for name in ("roller", "block")))
                force = math.sqrt(2)*abs(values["z"])/0.3
                modulus = 1/((1 - 0.3**2)/210e3 + (1 - 0.33**2)/70e3)
                width = math.sqrt(4*force*10/(math.pi*modulus))
                rows = [row for row in self.rows_of("out/contact.csv")
                        if row["time"] == "1"]
                x, z, found = (np.array([float(row[c]) for row in rows]) for c in ("x", "z", "pressure"))
                way = 10*(np.arctan2(z - 10*math.sqrt(2), x) + 3*math.pi/4)/width
                inside = np.abs(way) < part
                self.assertGreater(inside.sum(), 30)
                off = found[inside]*math.pi*width/(2*force) - np.sqrt(1 - way[inside]**2)
                self.assertLess(np.abs(off).max(), within)

    def test_bodies_of_one_mesh_touch_everywhere(self):
        """Lame: the pressure where the tubes meet is that in one tube."""
        self.write(TUBES, "two.geo")
        exact = (9/4 - 1)/(9 - 1)
        text = TUBES_SCENE.replace('"INNER"', '"two.geo", region = "inner"').replace(
            '"OUTER"', '"two.geo", region = "outer"')
        values = self.run_scene(text)
        self.assertLess(abs(values["peak"]/exact - 1), 0.1)
        self.assertEqual(self.summary["interfaces"][0]["sagitta"], 0)

    def test_crossed_cylinders_press_as_with_the_distance_given(self):
        given = "contact.gap=2-sqrt(max(0,1-x^2))-sqrt(max(0,1-y^2))"
        for name, across in (("up", False), ("lo", True)):
            self.write(cylinder(across), name + ".geo")
            self.mortier("mesh", "convert", name + ".geo", name + ".mesh")  # triangles without a geometry
        scene = CROSSED_SCENE.replace("UP", "up.geo").replace("LO", "lo.geo")
        exact = self.run_scene(scene, given)
        for kind in (".geo", ".mesh"):
            values = self.run_scene(scene.replace(".geo", kind))
            for name in ("peak", "force"):
                with self.subTest(kind, quantity=name):
                    self.assertLess(abs(values[name]/exact[name] - 1), 0.02)


if __name__ == "__main__":
    unittest.main()
