"""Files of Gmsh: two squares side by side with a curve between them,
as a mesh in both formats and as a geometry."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))

from scene_parts import body, contact, timed  # noqa: E402
from shape_scenes import GEOMETRY_KEYS, PARTS_GEO  # noqa: E402
from support import mortier, OfTwoBlocks, told, warned  # noqa: E402

POINTS = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)]
LINES = [(1, 1, 2), (1, 2, 3), (2, 3, 6), (3, 6, 5), (3, 5, 4), (4, 4, 1), (9, 2, 5)]  # group, ends
TRIANGLES = [(1, 1, 2, 5), (1, 1, 5, 4), (2, 2, 6, 3), (2, 2, 5, 6)]  # the third is clockwise
NAMES = '$PhysicalNames\n3\n1 3 "top"\n1 4 "left"\n2 2 "right half"\n$EndPhysicalNames\n'


def format_2():
    elements = [f"{i + 1} 1 2 {g} {g} {a} {b}" for i, (g, a, b) in enumerate(LINES)]
    elements += [f"{i + 20} 2 2 {g} {g} {a} {b} {c}" for i, (g, a, b, c) in enumerate(TRIANGLES)]
    nodes = [f"{i + 1} {x} {y} 0" for i, (x, y) in enumerate(POINTS)]
    return ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + NAMES + "$Nodes\n6\n" + "\n".join(nodes) +
            f"\n$EndNodes\n$Elements\n{len(elements)}\n" + "\n".join(elements) + "\n$EndElements\n")


def format_4():
    # five curves, two surfaces
    entities = [f"{tag} 0 0 0 2 1 0 1 {tag} 0\n" for tag in (1, 2, 3, 4, 9, 1, 2)]
    nodes = [f"{i + 1}\n" for i in range(6)] + [f"{x} {y} 0\n" for x, y in POINTS]
    elements, tag = [], 1
    for dimension, items in ((1, LINES), (2, TRIANGLES)):
        for group in sorted({item[0] for item in items}):
            own = [item[1:] for item in items if item[0] == group]
            elements.append(f"{dimension} {group} {dimension} {len(own)}\n")
            for item in own:
                elements.append(f"{tag} " + " ".join(map(str, item)) + "\n")
                tag += 1
    return ("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + NAMES + "$Entities\n0 5 2 0\n" + "".join(entities) +
            "$EndEntities\n$Nodes\n1 6 1 6\n2 1 0 6\n" + "".join(nodes) +
            f"$EndNodes\n$Elements\n7 {tag - 1} 1 {tag - 1}\n" + "".join(elements) + "$EndElements\n")


def geometry():
    points = [f"Point({i + 1}) = {{{x}, {y}, 0, 0.5}};\n" for i, (x, y) in enumerate(POINTS)]
    lines = [f"Line({i + 1}) = {{{a}, {b}}};\n" for i, (_, a, b) in enumerate(LINES)]
    return "".join(points + lines) + """\
Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {-7, 2, 3, 4}; Plane Surface(2) = {2};
Physical Curve(1) = {1, 2}; Physical Curve(2) = {3}; Physical Curve("top", 3) = {4, 5};
Physical Curve("left", 4) = {6}; Physical Surface(1) = {1}; Physical Surface("right half", 2) = {2};
"""


def beside_an_ellipse(outside, size):
    """What lies in the first quadrant inside an ellipse with axes 2 and 1, or between it and a rectangle;
    curve 1 is the arc."""
    corners = [(0, 0), (2, 0), (0, 1)] + ([(3, 0), (3, 2), (0, 2)] if outside else [])
    points = [f"Point({i + 1}) = {{{x}, {y}, 0, {size}}};\n" for i, (x, y) in enumerate(corners)]
    sides = [(2, 4), (4, 5), (5, 6), (6, 3)] if outside else [(1, 2), (3, 1)]
    lines = [f"Line({i + 2}) = {{{a}, {b}}};\n" for i, (a, b) in enumerate(sides)]
    return "".join(points + ["Ellipse(1) = {2, 1, 2, 3};\n"] + lines) + (
        "Curve Loop(1) = {2, 3, 4, 5, -1};" if outside else "Curve Loop(1) = {2, 1, 3};") + """
Plane Surface(1) = {1};
Physical Curve("arc", 1) = {1}; Physical Curve("held", 2) = {2}; Physical Surface(1) = {1};
"""


FILES = {"a.msh": format_2, "b.msh": format_4, "c.geo": geometry}
SCENE = """
[[body]]
name = "plate"
mesh = "a.msh"
material = { young = 100, poisson = 0 }
boundary = [ { label = "left", ux = 0 }, { label = 1, uy = 0 }, { label = "top", pressure = 6 } ]
region = [ {label = "right half", material = {young = 100, poisson = 0, viscosity = 1, yield_stress = 50}} ]
[time]
end = 1
steps = 1
"""

# What is changed in the scene above, or in the mesh, and the message that must come with exit code 2.
WRONG_LABELS = [
    ("label = \"left\"", "label = \"lft\"",
     "label = \"lft\", expected one of left, top (boundaries of a.msh)"),
    ("\"right half\"", "\"half\"", "label = \"half\", expected one of right half (regions of a.msh)"),
    ("label = \"left\"", "label = true", "label = true, expected an integer >= 0, or a name in the mesh"),
    ("a.msh", "upper.mesh", "label = \"left\", the mesh upper.mesh has no names of boundaries"),
]
WRONG_MESHES = [
    ("20 2 2 1 1 1 2 5", "20 21 2 1 1 1 2 5 1 2 5 1 2 5 1",
     "elements of Gmsh's type 21, expected linear or quadratic triangles"),
    ("5 1 1 0", "5 1 1 3", "node 5 is at z = 3"),
    (format_2(), "$MeshFormat\n", ""),
]


class GmshFiles(OfTwoBlocks):
    def test_gmsh_files(self):
        for name, text in FILES.items():
            self.write(text(), name)
        self.write(SCENE)
        if "this build is without" in mortier("mesh", "info", "a.msh", cwd=self.folder).stderr:
            self.check_refused()
            self.skipTest("this build is without Gmsh")
        self.check_read()
        self.check_linted()
        self.check_wrong()

    def test_curves_of_a_geometry(self):
        # The two meshes of an ellipse, which no circle fits, touch as the curves do, not as the polygons.
        for name, outside, size in (("in.geo", False, 0.11), ("out.geo", True, 0.15)):
            self.write(beside_an_ellipse(outside, size), name)
        if "this build is without" in mortier("mesh", "info", "in.geo", cwd=self.folder).stderr:
            self.skipTest("this build is without Gmsh")
        self.write("".join(f"""[[body]]
name = "{name}"
mesh = "{name}.geo"
material = {{ young = 100, poisson = 0.3 }}
boundary = [ {{ label = "held", ux = 0, uy = 0 }} ]
""" for name in ("in", "out")) + contact(("in", "arc"), ("out", "arc")) + timed() + "[output]\nevery = 1\n")
        run = self.mortier("run", "scene.toml", "--quiet", "--out", "ellipse")
        interface = self.summary_of("ellipse")["interfaces"][0]
        self.assertEqual(interface["sagitta"], 0)
        self.assertNotIn("no circle", run.stderr)
        gaps = [abs(float(row["gap"]))
                for row in self.rows_of("ellipse/contact.csv")
                if row["step"] == "0"]
        self.assertGreater(len(gaps), 10)
        self.assertLess(max(gaps), 1e-10)  # the polygons are off each other by up to 6e-3
        # Refined: new vertices are on the ellipse.
        self.mortier("run", "scene.toml", "--quiet", "--out", "refined", "--accuracy", "0.1",
                     "--set", "degree=2")
        for name in ("in", "out"):
            self.mortier("mesh", "convert", f"{name}.geo", f"{name}.mesh")
            arc = self.points_on_the_arc(f"refined/{name}.mesh")
            self.assertGreater(len(arc), len(self.points_on_the_arc(f"{name}.mesh")))
            for x, y in arc:
                self.assertLess(abs((x / 2)**2 + y**2 - 1), 1e-10)

    def points_on_the_arc(self, name):
        words = self.read(name).split()

        def rows(section):
            begin = words.index(section) + 2
            return [words[begin + 3 * i:begin + 3 * i + 3] for i in range(int(words[begin - 1]))]
        vertices = rows("Vertices")
        ends = {int(v) for a, b, label in rows("Edges") for v in (a, b) if label == "1"}
        return [tuple(map(float, vertices[v - 1][:2])) for v in ends]

    def hasGmsh(self):
        return "this build is without" not in mortier("mesh", "info", "parts.geo", cwd=self.folder).stderr

    def test_two_bodies_in_one_geometry(self):
        # Each region is a body of its own: pressed on each other they carry 6, and pulled apart they part.
        self.write(PARTS_GEO, "parts.geo")
        self.write(GEOMETRY_KEYS)
        if not self.hasGmsh():
            self.skipTest("this build is without Gmsh")
        run = self.mortier("run", "scene.toml", "--quiet", "--out", "pressed")
        self.assertEqual(told(run.stderr), [])
        self.assertEqual(warned(run.stderr), ["large-strain"])
        summary = self.summary_of("pressed")
        self.assertAlmostEqual(summary["final"]["von_mises_min"], 6, places=10)
        self.assertAlmostEqual(summary["final"]["von_mises_max"], 6, places=10)
        self.assertAlmostEqual(summary["final"]["displacement_min"][0], -0.06 * 3, places=10)
        checked = mortier("check", "scene.toml", cwd=self.folder)
        self.assertIn("\n0 errors", checked.stdout)
        self.mortier("run", "scene.toml", "--quiet", "--set", "body.right.boundary.right.tx=6", code=3)
        # The same body twice is named.
        both = mortier("check", "scene.toml", "--set", "body.right.mesh.region=['left half', 'right half']",
                       cwd=self.folder)
        self.assertIn("[bodies-overlap]", both.stdout)

    def test_meshes_of_a_geometry_as_asked_for(self):
        self.write(PARTS_GEO, "parts.geo")
        self.write(GEOMETRY_KEYS)
        if not self.hasGmsh():
            self.skipTest("this build is without Gmsh")
        for size, fewest, most in ((0.5, 20, 200), (0.1, 300, 3000)):
            self.mortier("mesh", "convert", "parts.geo", "all.mesh", "--size", str(size))
            lines = self.read("all.mesh").splitlines()
            count = int(lines[lines.index("Triangles") + 1])
            self.assertTrue(fewest < count < most, count)
        self.mortier("mesh", "convert", "parts.geo", "right.mesh", "--region", "right half")
        info = self.mortier("mesh", "info", "right.mesh").stdout
        for part in ("area       1\n", "length 1, base", "length 1, between", "triangles, right half"):
            self.assertIn(part, info)

    def test_a_converted_mesh_keeps_what_was_drawn(self):
        self.write(PARTS_GEO, "parts.geo")
        plain = GEOMETRY_KEYS.replace(", parameters = { width = 1.5 }",
                                      "").replace(", size = 0.25", "").replace(", size = 0.2", "")
        self.write(plain)
        if not self.hasGmsh():
            self.skipTest("this build is without Gmsh")
        left = '{ file = "parts.geo", region = "left half" }'
        right = '{ file = "parts.geo", region = ["right half"] }'
        for name in ("left", "right"):
            self.mortier("mesh", "convert", "parts.geo", f"{name}.mesh", "--region", f"{name} half")
        final = []
        for scene in (plain, plain.replace(left, '"left.mesh"').replace(right, '"right.mesh"')):
            final.append(self.run_it(scene, folder="run")["final"])
        self.assertEqual(*final)
        self.reject('--set contact.mortar.label=betwen: body right: label = "betwen", expected one of '
                    'base, between', "run", "scene.toml", "--quiet",
                    "--set", "contact.mortar.label=betwen")

    def test_what_a_geometry_does_not_have(self):
        self.write(PARTS_GEO, "parts.geo")
        self.write(GEOMETRY_KEYS)
        if not self.hasGmsh():
            self.skipTest("this build is without Gmsh")
        for setting, message in (
                ("body.left.mesh.parameters.wdth=2", "parts.geo: no constant wdth, expected one that its "
                                                     "DefineConstant names: depth, width"),
                ("body.left.mesh.region=middle", "parts.geo: no region middle, expected one of 1 (left "
                                                 "half), 2 (right half)"),
                ("body.left.mesh.region=3", "parts.geo: no region 3, expected one of 1 (left half), 2 "
                                            "(right half)"),
                ("body.left.mesh.region=[]", "region = an array, expected one label or more"),
                ("body.left.mesh.size=0", "size = 0, expected size > 0"),
                ("body.left.mesh.parameters.width=a", "parameters.width = \"a\", expected a finite number"),
                ("body.left.mesh.file=upper.mesh", "upper.mesh: size or parameters, expected only for a "
                                                   "geometry that Gmsh meshes")):
            with self.subTest(setting):
                done = mortier("run", "scene.toml", "--quiet", "--set", setting, cwd=self.folder)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(message, done.stderr)
                self.assertEqual(done.stderr.count("\n"), 1)
        long = f'DefineConstant[ note = {{1, Name "{300000 * "x"}"}}, '
        self.write(PARTS_GEO.replace("DefineConstant[", long), "long.geo")
        self.reject("long.geo: no constant wdth, expected one that its DefineConstant names: depth, note, "
                    "width", "run", "scene.toml", "--quiet", "--set", "body.left.mesh.file=long.geo",
                    "body.left.mesh.parameters.wdth=2")

    def check_refused(self):
        for name in FILES:
            self.reject(f"{name}: read by Gmsh, which this build is without", "mesh", "info", name)
            self.reject(f"{name}: read by Gmsh", "run", "scene.toml", "--quiet", "--set",
                        f"body.plate.mesh={name}")

    def check_read(self):
        for name in FILES:
            with self.subTest(name=name):
                info = self.mortier("mesh", "info", name)
                self.assertEqual(info.stderr, "")
                for part in ["area       2\n", "label 1 ", "label 2 ", "label 3 ", "label 4 ", "length 2: x ",
                             "region 1 ", "region 2 "]:
                    self.assertIn(part, info.stdout)
                self.assertNotIn("label 9", info.stdout)
                run = self.mortier("run", "scene.toml", "--quiet", "--set", f"body.plate.mesh={name}",
                                   "--out", "plate")
                self.assertEqual(told(run.stderr), [])
                self.assertEqual(warned(run.stderr), ["large-strain", "large-strain", "yield-over-young",
                                                      "initial-load"])
                plate = self.summary_of("plate")
                self.assertAlmostEqual(plate["final"]["displacement_min"][1], -0.06, places=12)
                self.assertAlmostEqual(plate["final"]["von_mises_min"], 6, places=10)
                self.assertEqual(plate["bodies"][0]["material"], "Perzyna (frobenius), elastic")
        # The kink of an expression on a label that has a name: a step ends there.
        self.mortier("run", "scene.toml", "--quiet", "--out", "plate", "--set",
                     "time={end=1, tolerance=1e-2, scheme='sdirk2'}",
                     "body.plate.boundary.top.pressure='t < 0.37 ? t : 0.37'")
        self.assertIn("0.37",
                      [row["time[s]"] for row in self.rows_of("plate/history.csv")])
        fours = [self.mortier("mesh", "info", name).stdout.count("4") for name in ("a.msh", "b.msh")]
        self.assertEqual(*fours)

    def check_linted(self):
        """Names that the mesh has are no fault; those that it has not are named with those that there are."""
        for old, new, message in [
                ("left", "left", None),
                ("label = \"left\"", "label = \"lft\"",
                 'scene.toml:6: error: body plate: no edge of a.msh has label "lft"; there are: 1 '
                 '(bottom), 2 (right), 3 "top" (top), 4 "left" (left); take one of the labels there are, '
                 'or label the edges [missing-label]'),
                ("\"right half\"", "\"half\"",
                 'scene.toml:7: error: body plate: no triangle of a.msh is in region "half"; there are: 1, 2 '
                 '"right half"; take one of the regions there are, or label the triangles [missing-region]')]:
            self.write(SCENE.replace(old, new, 1))
            lines = mortier("check", "scene.toml", cwd=self.folder).stdout.splitlines()
            self.assertEqual([line for line in lines if "error: " in line], [message] if message else [])
            region = "half" if "half" in new else "right half"
            self.assertTrue(any(f": body plate, region {region}: " in line for line in lines), lines)

    def check_wrong(self):
        for old, new, message in WRONG_LABELS:
            with self.subTest(new=new):
                self.write(SCENE.replace(old, new, 1))
                line = 7 if old == "\"right half\"" else 6
                self.reject(f"scene.toml:{line}: body plate: {message}", "run", "scene.toml", "--quiet")
        for old, new, message in WRONG_MESHES:
            with self.subTest(new=new[:20]):
                self.assertIn(old, format_2())
                self.write(format_2().replace(old, new, 1), "x.msh")
                self.reject("x.msh: " + message, "mesh", "info", "x.msh")
        self.reject("none.msh: not a file", "mesh", "info", "none.msh")

    def test_step_files(self):
        # A plate of 20 mm by 10 mm with a round hole of radius 2 mm, written by Gmsh's OpenCASCADE.
        plate = (Path(__file__).parent / "plate.step").read_text()
        self.write(plate, "plate.step")
        if "this build is without" in mortier("mesh", "info", "plate.step", cwd=self.folder).stderr:
            self.skipTest("this build is without Gmsh")
        self.write(plate.replace("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT($,.METRE.)"), "metres.step")
        self.write('SetFactory("OpenCASCADE"); Merge "plate.step";\n'
                   'Physical Curve("hole", 7) = {5}; Physical Surface("plate", 1) = {1};\n', "named.geo")
        self.assertRegex(self.mortier("mesh", "info", "plate.step").stdout,
                         r"(?s)x 0 \.\. 20, y 0 \.\. 10\n.*label 1 .*length 20: x 0 \.\. 20, y \d+\n"
                         r".*label 5 .*region 1 ")
        self.assertIn("x 0 .. 20000,", self.mortier("mesh", "info", "metres.step").stdout)
        self.assertRegex(self.mortier("mesh", "info", "named.geo").stdout, "label 7 .*, hole: ")
        self.write(body("plate", '{ file = "plate.step", size = 1 }', 2.1e5, "label = 2, tx = 10",
                        "label = 4, tx = -10",
                        point=[{"at": [0, 0], "ux": 0, "uy": 0}, {"at": [20, 0], "uy": 0}]) + timed())
        # The hole is known as a circle: nothing is said of a polygon.
        self.mortier("run", "scene.toml", "--quiet", "--out", "o", "--accuracy", "0.1")
        accuracy = self.summary_of("o")["accuracy"]
        self.assertTrue(accuracy["reached"])
        self.assertEqual(accuracy["not_reliable"], [])

    def test_files_that_are_damaged_or_do_more_than_meshes(self):
        for name, text in (("few.msh", format_2().replace("$Nodes\n6\n", "$Nodes\n5\n")),  # Gmsh crashes
                           ("gone-2.msh", format_2().replace("\n6 2 1 0\n", "\n")),
                           ("gone-4.msh", format_4().replace("1 6 1 6\n2 1 0 6\n1\n",
                                                             "1 6 1 6\n2 1 0 6\n77\n")),
                           ("call.geo", 'SystemCall "touch ran";\n' + geometry()),
                           ("cut.msh", format_4()[:420]),
                           ("bytes.geo", "Point(1) = {0, 0, \xff\xfe};\n"),  # of which Gmsh shows some
                           ("bytes.msh", "$MeshFormat\n4.1 1 8\n\x01\x00\x00\x00" + "\xff" * 300)):
            (self.folder / name).write_bytes(text.encode("latin-1"))
            with self.subTest(name):
                done = mortier("mesh", "info", name, cwd=self.folder, errors="strict")
                self.assertEqual(done.returncode, 2)
                self.assertTrue(done.stderr.startswith(f"mortier: {name}: ") and done.stderr.count("\n") == 1,
                                done.stderr)
        self.write("mine", "mine.txt")
        self.write(geometry() + 'Printf("x") > "mine.txt";\nMesh 2; Save "saved.msh"; Save "mine.txt";\n',
                   "writes.geo")
        mortier("mesh", "info", "writes.geo", cwd=self.folder)
        self.assertEqual(self.read("mine.txt"), "mine")
        self.assertEqual({"saved.msh", "ran"} & set(self.names()), set())


if __name__ == "__main__":
    unittest.main()
