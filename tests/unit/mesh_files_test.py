"""Mesh files of other programs: a strip of 2 by 1 (by 1), cut and labelled alike whatever the file, or
refused with the reason."""
import itertools
import sys
import unittest
from pathlib import Path

import meshio
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))

from support import ROOT, InFolder, mortier, warned  # noqa: E402

sys.path.insert(0, str(ROOT / "views"))
import mesh_files  # noqa: E402

EDGES = {"triangle": ((0, 1), (1, 2), (2, 0)), "quad": ((0, 1), (1, 2), (2, 3), (3, 0)),
         "tetra": ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
         "wedge": ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
         "hexahedron": ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5),
                        (2, 6), (3, 7)), "line": ((0, 1),)}
SIMPLICES = {"triangle": 16, "quad": 16, "tetra": 96, "hexahedron": 96, "wedge": 96, "pyramid": 192}
HEX = np.array(list(itertools.product((0, 1), repeat=3)))[[0, 4, 6, 2, 1, 5, 7, 3]]
KUHN = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
PARTS = {"triangle": [[0, 1, 2], [0, 2, 3]], "quad": [[0, 1, 2, 3]], "hexahedron": [list(range(8))],
         "wedge": [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]], "tetra": KUHN,
         "pyramid": [[0, 3, 2, 1, 8], [4, 5, 6, 7, 8], [0, 1, 5, 4, 8], [1, 2, 6, 5, 8], [2, 3, 7, 6, 8],
                     [3, 0, 4, 7, 8]]}
FACES = {"hexahedron": [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
         "wedge": [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]],
         "tetra": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
         "pyramid": [[0, 1, 2, 3], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
         "quad": EDGES["quad"], "triangle": EDGES["triangle"]}


class Strip:
    """Cells, the sides at x = 0, y = 1 and x = 2, and the cells of the half x > 1 ("right half")."""

    def __init__(self, kind, quadratic=False):
        self.kind, self.points, self.index = kind, [], {}
        self.space = kind not in ("triangle", "quad")
        self.cells, self.sides = [], {"left": [], "top": [], "right": []}
        for i, j, k in itertools.product(range(4), range(2), range(2 if self.space else 1)):
            corners = (HEX + (i, j, k)) * (0.5, 0.5, 0.5 if self.space else 0)
            places = list(map(tuple, corners if self.space else corners[:4])) + [tuple(corners.mean(axis=0))]
            for part in PARTS[kind]:
                cell = [self.node(places[v]) for v in part]
                self.cells.append(cell)
                for face in FACES[kind]:
                    side = [cell[v] for v in face]
                    for name, axis, at in (("left", 0, 0), ("top", 1, 1), ("right", 0, 2)):
                        if all(abs(self.points[v][axis] - at) < 1e-12 for v in side):
                            self.sides[name].append(side)
        self.quadratic = quadratic
        self.full = [self.with_middles(cell, kind) for cell in self.cells] if quadratic else self.cells
        self.right = [c for c, cell in enumerate(self.cells)
                      if np.mean([self.points[v][0] for v in cell]) > 1]

    def node(self, place):
        if place not in self.index:
            self.index[place] = len(self.points)
            self.points.append(place)
        return self.index[place]

    def with_middles(self, cell, kind):
        return cell + [self.node(tuple((np.array(self.points[cell[a]]) + self.points[cell[b]]) / 2))
                       for a, b in EDGES[kind]]

    def meshio(self):
        """A mesh with the references 1 left, 2 top, 3 right, and 11 and 12 of the halves."""
        kind = self.kind + {"triangle": "6", "quad": "8", "tetra": "10", "wedge": "15",
                            "hexahedron": "20"}[self.kind] if self.quadratic else self.kind
        blocks = [(kind, self.full)]
        references = [[12 if c in self.right else 11 for c in range(len(self.cells))]]
        for k, name in enumerate(self.sides):
            for count in (2, 3, 4):
                rows = [side for side in self.sides[name] if len(side) == count]
                if rows:
                    blocks.append(({2: "line", 3: "triangle", 4: "quad"}[count], rows))
                    references.append([k + 1] * len(rows))
        return meshio.Mesh(np.array(self.points), [(k, np.array(c)) for k, c in blocks],
                           cell_data={"gmsh:physical": [np.array(r) for r in references],
                                      "gmsh:geometrical": [np.array(r) for r in references]})


NOT_IN_MESHIO = {("pyramid", True), ("wedge", True)}
ABAQUS = {("triangle", False): ("CPS3", "CPE3", "CAX3", "S3"),
          ("triangle", True): ("CPS6", "CPE6", "CAX6", "STRI65"),
          ("quad", False): ("CPS4R", "CPE4H"), ("quad", True): ("CPE8R", "CAX8"),
          ("tetra", False): ("C3D4", "c3d4h", "DC3D4"), ("tetra", True): ("C3D10", "C3D10M"),
          ("wedge", False): ("C3D6",), ("wedge", True): ("C3D15",), ("pyramid", False): ("C3D5",),
          ("hexahedron", False): ("C3D8", "C3D8R", "C3D8I"), ("hexahedron", True): ("C3D20R",)}


def inp(strip, of_type, wrap=lambda text: text):
    """Sets of nodes; two blocks of nodes, elements over two lines, numbers from 101."""
    nodes = [f"{v + 101}, {x!r}, {y!r}, {z!r}" for v, (x, y, z) in enumerate(strip.points)]
    lines = ["*Heading", "** a comment", "*NODE, NSET=Nall", *nodes[:5], "*Node, nset=nall", *nodes[5:],
             f"*Element, type={of_type}, elset=Eall"]
    for c, cell in enumerate(strip.full):
        words = [str(c + 1)] + [str(v + 101) for v in cell]
        lines += [", ".join(words)] if len(words) <= 9 else [", ".join(words[:9]) + ",", ", ".join(words[9:])]
    lines += ["*Elset, elset=right half", *(f"{c + 1}," for c in strip.right)]
    for name in strip.sides:
        lines += [f"*Nset, nset={name}", *sorted({f"{v + 101}" for side in strip.sides[name] for v in side})]
    return wrap("\n".join([*lines, "*Material, name=steel", "*Elastic", "2.1e5, 0.3", "*Step", "*Static",
                           "0.1, 1.", "*End Step", ""]))


def medit(strip, end="End\n"):
    mesh = strip.meshio()
    names = {"line": "Edges", "triangle": "Triangles", "quad": "Quadrilaterals", "tetra": "Tetrahedra",
             "wedge": "Prisms", "pyramid": "Pyramids", "hexahedron": "Hexahedra"}
    sections = {}
    for block, labels in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
        sections.setdefault(names[block.type], []).extend(
            " ".join(map(str, [*(row + 1), label])) for row, label in zip(block.data, labels))
    text = "MeshVersionFormatted 2\n\nDimension 3\n\nVertices\n" + f"{len(mesh.points)}\n"
    text += "".join(f"{x!r} {y!r} {z!r} 0\n" for x, y, z in mesh.points.tolist())
    return text + "".join(f"\n{name}\n{len(rows)}\n" + "\n".join(rows) + "\n"
                          for name, rows in sections.items()) + end


def bulk(strip, head="", tail="ENDDATA\n"):
    """Nastran, free fields: properties are regions, shells on the boundary labels."""
    card = {"tetra": "CTETRA", "hexahedron": "CHEXA", "wedge": "CPENTA", "triangle": "CTRIA3",
            "quad": "CQUAD4"}
    lines = [f"GRID,{v + 1},,{x:.6f},{y:.6f},{z:.6f}" for v, (x, y, z) in enumerate(strip.points)]
    number = 0
    mesh = strip.meshio()
    for block, references in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
        for row, reference in zip(block.data + 1, references):
            number += 1
            words = [card[block.type] if block.type != "line" else "CBAR", str(number), str(reference),
                     *map(str, row)] if block.type in card else ["CROD", str(number), str(reference),
                                                                 *map(str, row)]
            lines.append(",".join(words[:9]) + (",+\n+," + ",".join(words[9:]) if len(words) > 9 else ""))
    return head + "\n".join(lines) + "\n" + tail


BULK = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\nCTETRA,1,7,1,2,3,4\n"


def columns(cards):
    return "\n".join("".join(word.ljust(8) for word in card.split(",")) for card in cards.split("\n"))


class MeshFiles(InFolder):
    def info(self, name):
        done = self.mortier("mesh", "info", name)
        self.assertEqual(done.stderr, "")
        return done.stdout

    def is_strip(self, strip, name, labels=("left", "top"), regions=("right half",)):
        """The file is the strip: its measure, its elements, its sides and half of it."""
        text = self.info(name)
        self.assertIn("volume     2\n" if strip.space else "area       2\n", text)
        elements = SIMPLICES[strip.kind]
        self.assertRegex(text, rf"\n(triangles |tetrahedra) +{elements}\n", name)
        for label, size in zip(labels, (1, 2)):
            found = [line for line in text.splitlines() if line.startswith("label") and
                     (f", {label}" in line or line.split()[1] == label or f"+{label}" in line)]
            self.assertTrue(found, f"{label} of {name}: {text}")
            self.assertAlmostEqual(sum(float(line.replace(",", " ").replace(":", " ").split()[5])
                                       for line in found), size, 9, text)
        for region in regions:
            self.assertRegex(text, rf"region .* {elements // 2} (triangles|tetrahedra).*{region}|"
                                   rf"region {region} +{elements // 2} ", text)

    def test_abaqus(self):
        for (kind, quadratic), types in ABAQUS.items():
            strip, path = Strip(kind, quadratic), str(self.folder / "a.inp")
            self.write(inp(strip, types[0]), "a.inp")
            self.is_strip(strip, "a.inp")
            read = mesh_files.answer(path)
            for each in types[1:]:  # without a process each
                with self.subTest(each):
                    self.write(inp(strip, each), "a.inp")
                    self.assertEqual(mesh_files.answer(path), read)

    def test_medit_with_and_without_end(self):
        for kind in SIMPLICES:
            strip = Strip(kind)
            for end in ("End\n", "", "\n# label 2 = top\n"):
                with self.subTest(kind=kind, end=end):
                    self.write(medit(strip, end), "a.mesh")
                    self.is_strip(strip, "a.mesh", ("1", "2"), ("12",))

    def test_what_meshio_reads(self):
        for kind, quadratic in itertools.product(SIMPLICES, (False, True)):
            if (kind, quadratic) in NOT_IN_MESHIO:
                continue
            strip = Strip(kind, quadratic)
            for extension in ("vtk", "vtu"):
                with self.subTest(kind=kind, quadratic=quadratic, extension=extension):
                    meshio.write(self.folder / f"a.{extension}", strip.meshio())
                    self.is_strip(strip, f"a.{extension}", ("1", "2"), ("12",))

    def test_what_gmsh_reads(self):
        for kind, quadratic in itertools.product(SIMPLICES, (False, True)):
            if (kind, quadratic) in NOT_IN_MESHIO:
                continue
            strip = Strip(kind, quadratic)
            meshio.write(self.folder / "a.msh", strip.meshio(), file_format="gmsh22", binary=False)
            if "this build is without" in mortier("mesh", "info", "a.msh", cwd=self.folder).stderr:
                self.skipTest("this build is without Gmsh")
            with self.subTest(kind=kind, quadratic=quadratic):
                self.is_strip(strip, "a.msh", ("1", "2"), ("12",))
            for name, head in (("a.bdf", ""), ("a.nas", "SOL 101\nCEND\nBEGIN BULK\n")):
                if quadratic or kind == "pyramid":
                    continue
                with self.subTest(kind=kind, name=name):
                    self.write(bulk(strip, head), name)
                    self.is_strip(strip, name, ("1", "2"), ("12",))

    def refused(self, message, *command):
        """One line, exit code 2."""
        done = mortier(*command, cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertIn(message, done.stderr)

    def test_damaged_files(self):
        sound = inp(Strip("tetra"), "C3D4")
        flat = inp(Strip("triangle"), "CPS3")
        seen = set()
        for of, text, message in [
                ("a.inp", sound.replace("101, 0.0,", "101, nan,"),
                 "a.inp:4: node 101 at nan, 0.0, 0.0, expected"),
                ("a.inp", sound.replace("\n1, 101, ", "\n1, 999, "),
                 "element 1 has node 999, which is not there"),
                ("a.inp", sound.replace("C3D4", "COH3D6"), "elements of type COH3D6, expected C3D4, C3D10"),
                ("a.inp", sound[:sound.index("*Elset") - 4],
                 "end of file, expected the other nodes of element 96"),
                ("a.inp", sound[:sound.index("*Elset") - 1], "end of file within a line"),
                ("a.inp", sound.replace("*Nset, nset=left\n", "*Nset, nset=left\n9999,\n"),
                 "set left has 9999, which is not there"),
                ("a.inp", sound.replace("*Node,", "*Ngen,"), "*NGEN, expected all nodes and elements"),
                ("a.inp", sound.replace("*Step", "*Surface, name=s\nEall, S7\n*Step"), "side S7 of a tetra"),
                ("a.inp", "*Heading\n", "no *NODE, expected an input file of Abaqus or CalculiX"),
                ("a.inp", "4 1 0 0 0\n1 0 0 0\n", "a.inp: no *NODE, expected an input file of Abaqus"),
                ("a.inp", flat[:flat.index("*Element")], "no cells of a plane or of space"),
                ("a.inp", flat + "*Element, type=CPS3\n99, 101, 102\n*Step\n",
                 "the other nodes of element 99"),
                ("a.vtu", "<VTKFile", "a.vtu: meshio cannot read it: "),
                ("a.vtk", "# vtk DataFile Version 3.0\n", "a.vtk: meshio cannot read it: "),
                ("a.vtu", "", "a.vtu: meshio cannot read it: ReadError: in _parse_raw_binary"),
                ("a.msh", "4 2 4\n0 0 1\n", "a.msh:1: expected $MeshFormat, with which meshes of Gmsh begin; "
                 "files of other kinds: .msh, .geo, "),
                ("a.bdf", BULK.replace("1,7,1", "1,,1"), "a.bdf:5: CTETRA: field 3 of this line is blank"),
                ("a.nas", columns(BULK.replace("1,7,1", "1,,1")), "a.nas:5: CTETRA: field 3 of this line"),
                ("a.bdf", BULK.replace("4\n", "4,5,,+\n+,7,8,9,10\n"),
                 "a.bdf:6: CTETRA: the last field of the line before is blank"),
                ("a.bdf", BULK.replace("GRID,2,,", "GRID,2,5,"), "a.bdf:2: node 2 in the system of"),
                ("a.bdf", BULK.lower(), "a.bdf:1: grid, expected cards in capital letters"),
                ("a.meshb", "\x01\0\0\0", "a.meshb: meshio cannot read it: "),
                ("a.mesh", "*NODE\n", "a.mesh:1: '*NODE', expected MeshVersionFormatted as the first word "
                 "of a Medit file; files of other kinds: .msh, .geo, "),
                ("a.stl", "solid a\n", "a.stl:1: 'solid', expected MeshVersionFormatted"),
                ("a.mesh", medit(Strip("hexahedron"))[:-40], "a.mesh:"),
        ]:
            with self.subTest(message):
                self.write(text, of)
                if of not in seen:
                    self.refused(message, "mesh", "info", of)
                seen.add(of)
                self.write("mine", "b.mesh")
                self.refused(message, "mesh", "convert", of, "b.mesh")
                self.assertEqual(self.read("b.mesh"), "mine")

    def test_folded_and_flat_tetrahedra(self):
        strip = Strip("tetra")
        for move, message in (((1.2, 0, 0), "on the same side of the triangle that they share: the mesh is "
                               "folded"), ((0.5, 0, 0), " is flat, expected a volume")):
            moved = Strip("tetra")
            moved.points[strip.index[(0.5, 0.5, 0.5)]] = tuple(np.add((0.5, 0.5, 0.5), move))
            self.write(medit(moved), "a.mesh")
            self.refused(message, "mesh", "info", "a.mesh")

    def test_slivers_are_warned(self):
        strip = Strip("tetra")
        strip.points = [(x, y, z * 1e-3) for x, y, z in strip.points]
        self.write(medit(strip), "a.mesh")
        self.write('dimension = 3\ndegree = 2\n' + BODY.replace("%", "a.mesh")
                   .replace('"left"', "1").replace('"right"', "3"))
        done = mortier("check", "scene.toml", cwd=self.folder)
        self.assertRegex(done.stdout, r"a.mesh: tetrahedron \d+: warning: 96 tetrahedra with an aspect ratio "
                                      r"above 20 \(regular: 1\), this one has \d+; .* \[sliver\]")

    def test_the_dimension_is_named(self):
        self.write(inp(Strip("tetra"), "C3D4"), "solid.inp")
        self.write(inp(Strip("triangle"), "CPS3"), "flat.inp")
        self.write(medit(Strip("tetra")), "solid.mesh")
        for name in ("solid.inp", "solid.mesh"):
            self.write(BODY.replace("%", name))
            self.refused("or dimension = 3 at the top of the scene for a body in space", "run", "scene.toml")
        self.write("dimension = 3\n" + BODY.replace("%", "flat.inp"))
        self.refused("no tetrahedra, expected a body in space; triangles in a plane become one with extrude",
                     "run", "scene.toml")

    def test_groups_share_sides(self):
        # The set of all nodes holds every side: what the scene names decides.
        self.write(inp(Strip("hexahedron"), "C3D8"), "a.inp")
        scene = "dimension = 3\n" + BODY.replace("%", "a.inp").replace("[time]", POINTS + "[time]")
        self.write(scene)
        run = self.mortier("run", "scene.toml", "--quiet", "--out", "o")
        self.assertEqual(warned(run.stderr)[0], "mesh-changed")
        self.assertIn("warning: a.inp: cells with more corners are cut into tetrahedra; ", run.stderr)
        final = self.summary_of("o")["final"]
        self.assertAlmostEqual(final["von_mises_max"], 6, 9)
        self.assertAlmostEqual(final["von_mises_min"], 6, 9)
        both = scene.replace("boundary = [", 'boundary = [ { label = "Nall", ux = 0 },')
        self.write(both)
        self.refused("is in the groups Nall and left, and the scene names both", "run", "scene.toml")
        self.mortier("mesh", "convert", "a.inp", "b.mesh")
        self.assertIn("# label ", self.read("b.mesh"))

    def test_surfaces_in_several_groups_of_gmsh(self):
        self.write('SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 1};\n'
                   'Physical Volume("cube", 1) = {1};'
                   'Physical Surface("all", 2) = {1:6}; Physical Surface("left", 3) = {1};\n'
                   'Physical Surface("right", 4) = {2};\n', "a.geo")
        self.write("dimension = 3\n" + BODY.replace('"%"', '{ file = "a.geo", size = 0.5 }')
                   .replace("[time]", POINTS + "[time]"))
        if "this build is without" in mortier("mesh", "info", "a.geo", cwd=self.folder).stderr:
            self.skipTest("this build is without Gmsh")
        self.assertAlmostEqual(self.run_it(folder="o")["final"]["von_mises_min"], 6, 9)
        self.refused("is in the groups all and left, and the scene names both", "run", "scene.toml", "--set",
                     "body.a.boundary.right.label=all")

    def test_labels_between_regions_are_told(self):
        self.write("""Point(1) = {0, 0, 0, 1}; Point(2) = {1, 0, 0, 1}; Point(3) = {2, 0, 0, 1};
Point(4) = {2, 1, 0, 1}; Point(5) = {1, 1, 0, 1}; Point(6) = {0, 1, 0, 1};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Line(7) = {2, 5}; Line Loop(1) = {1, 7, 5, 6}; Line Loop(2) = {2, 3, 4, -7};
Plane Surface(1) = {1}; Plane Surface(2) = {2};
Physical Curve("left", 1) = {6}; Physical Curve("middle", 2) = {7};
Physical Surface("one", 1) = {1}; Physical Surface("other", 2) = {2};
""", "a.geo")
        told = mortier("mesh", "info", "a.geo", cwd=self.folder)
        if "this build is without" in told.stderr:
            self.skipTest("this build is without Gmsh")
        line = "label 2     not on the boundary, middle: sides of single regions"
        self.assertIn(line, told.stdout)
        self.assertNotIn("not on the boundary, left", told.stdout)
        self.assertIn(line, mortier("mesh", "convert", "a.geo", "all.mesh", cwd=self.folder).stdout)
        one = mortier("mesh", "convert", "a.geo", "one.mesh", "--region", "one", cwd=self.folder).stdout
        self.assertNotIn("not on the boundary", one)
        self.assertIn("length 1, middle", mortier("mesh", "info", "one.mesh", cwd=self.folder).stdout)

    def test_parts_of_abaqus(self):
        # Two parts with the same numbers, one of them moved; sides by a surface.
        part = inp(Strip("triangle"), "CPS3", lambda text: text[text.index("*NODE"):text.index("*Material")])
        self.write("".join(f"*Part, name={name}\n{part}*End Part\n" for name in ("one", "two")) +
                   "*Assembly, name=a\n*Instance, name=one-1, part=one\n*End Instance\n"
                   "*Instance, name=two-1, part=two\n0, 1, 0\n*End Instance\n"
                   "*Elset, elset=_e, internal, instance=two-1, generate\n1, 16, 1\n"
                   "*Surface, type=ELEMENT, name=edge\n_e, S3\n*End Assembly\n", "a.inp")
        self.mortier("mesh", "convert", "a.inp", "two.mesh", "--region", "two")
        text = self.info("two.mesh")
        self.assertIn("extents    x 0 .. 2, y 1 .. 2\n", text)
        self.assertIn("edge", text)


BODY = """[[body]]
name = "a"
mesh = "%"
material = { young = 100, poisson = 0 }
boundary = [ { label = "left", ux = 0 }, { label = "right", pressure = 6 } ]
[time]
end = 1
steps = 1
"""
POINTS = "point = [ { at = [0, 0, 0], uy = 0, uz = 0 }, { at = [0, 0, 1], uy = 0 } ]\n"


if __name__ == "__main__":
    unittest.main()
