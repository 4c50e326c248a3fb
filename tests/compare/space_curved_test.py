"""Curved surfaces in contact in space: with Gmsh's geometry, and from triangles alone."""
import unittest

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
TUBES_SCENE = """\
dimension = 3
degree = 2
[[body]]
name = "inner"
mesh = { file = "INNER" }
material = { young = 1e5, poisson = 0 }
boundary = [ { label = "left", ux = 0 }, { label = "front", uy = 0 }, { label = "start", uz = 0 },
             { label = "end", uz = 0 }, { label = "bore", pressure = 1 } ]
[[body]]
name = "outer"
mesh = { file = "OUTER" }
material = { young = 1e5, poisson = 0 }
boundary = [ { label = "left", ux = 0 }, { label = "front", uy = 0 }, { label = "start", uz = 0 } ]
[contact]
nonmortar = { body = "inner", label = "mid" }
mortar = { body = "outer", label = "mid" }
[[quantity]]
name = "peak"
largest_pressure = { body = "inner", label = "mid" }
[time]
end = 1
steps = 1
"""

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
CROSSED_SCENE = """\
dimension = 3
degree = 2
[[body]]
name = "up"
mesh = { file = "UP" }
material = { young = 1, poisson = 0.3 }
boundary = [ { label = "x", ux = 0 }, { label = "y", uy = 0 }, { label = "top", uz = -0.02 } ]
[[body]]
name = "lo"
mesh = { file = "LO" }
material = { young = 1, poisson = 0.3 }
boundary = [ { label = "x", ux = 0 }, { label = "y", uy = 0 }, { label = "top", uz = 0.02 } ]
[contact]
sides = [ { body = "up", label = "arc" }, { body = "lo", label = "arc" } ]
[[quantity]]
name = "force"
reaction = { body = "lo", label = "top" }
component = "z"
[[quantity]]
name = "peak"
largest_pressure = { body = "up", label = "arc" }
[time]
end = 1
steps = 1
"""


def cylinder(across):
    text = CYLINDER.replace("TURNED", "Rotate {{1, 1, 0}, {0, 0, 0}, Pi} { Volume{1}; }" if across else "")
    return text.replace("TOP", "-1" if across else "1").replace(
        "LOW", "3 - e, -9, -9" if across else "-9, 3 - e, -9")


class CurvedSurfaces(InSpace):
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
