#!/usr/bin/python3
"""Contact between two sides of one body: a clip with a slit equals two jaws that are tied behind it."""
import unittest

from scene_parts import body, contact, quantity, timed, written
from support import InFolder, values

BACK, LENGTH, SLIT = 0.5, 2.0, 0.02
COLUMNS, ROWS = 8, 2
# Labels: 1 bottom, 2 right, 3 top, 4 left, 5 and 6 the sides of the slit, 7 its end, 8 where jaws are cut.
LOWER, UPPER, BEHIND, CUT = 5, 6, 7, 8


def part(keeps, seam):
    """The cells of a grid of columns and rows that are kept, as Medit text. seam: label of the bottom of row
    2 behind the slit; 0: the jaws are one."""
    xs = [LENGTH * i / COLUMNS for i in range(COLUMNS + 1)]
    ys = [0, 0.25, 0.5, 0.5 + SLIT, 0.75 + SLIT, 1 + SLIT]
    back = int(BACK / LENGTH * COLUMNS)
    cells = [(i, j) for j in range(len(ys) - 1) for i in range(COLUMNS) if keeps(j) and (j != 2 or i < back)]
    # Row by row: the cut of prisms into tetrahedra goes by the order of vertices.
    corners = sorted({(j + b, i + a) for i, j in cells for a in (0, 1) for b in (0, 1)})
    numbers = {(i, j): k for k, (j, i) in enumerate(corners, 1)}
    points, triangles, edges = [(xs[i], ys[j]) for j, i in corners], [], []

    def label(i, j, side):
        if side == "bottom":
            return {0: 1, 2: seam, 3: UPPER}[j]
        if side == "top":
            return 3 if j == len(ys) - 2 else seam if seam and i < back else LOWER
        if side == "left":
            return 4
        return 2 if i == COLUMNS - 1 else BEHIND

    for i, j in cells:
        a, b, c, d = (numbers[at] for at in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
        triangles += [(a, b, c), (a, c, d)]
        for beside, side, edge in (((i, j - 1), "bottom", (a, b)), ((i + 1, j), "right", (b, c)),
                                   ((i, j + 1), "top", (c, d)), ((i - 1, j), "left", (d, a))):
            if beside not in cells:
                edges.append((*edge, label(i, j, side)))
    return "\n".join(["MeshVersionFormatted 2", "Dimension 2", f"Vertices {len(points)}",
                      *(f"{x!r} {y!r} 0" for x, y in points), f"Triangles {len(triangles)}",
                      *(f"{a} {b} {c} 1" for a, b, c in triangles), f"Edges {len(edges)}",
                      *(f"{a} {b} {k}" for a, b, k in edges), "End", ""])


def jaw(name, *boundary, **sweep):
    mesh = written({"file": f"{name}.mesh", **sweep})
    return body(name, mesh, "young = 1000, poisson = 0.3 LAW", *boundary)


class OneBody(InFolder):
    def setUp(self):
        super().setUp()
        self.write(part(lambda j: True, 0), "clip.mesh")
        self.write(part(lambda j: j < 2, CUT), "lower.mesh")
        self.write(part(lambda j: j > 1, CUT), "upper.mesh")

    def scenes(self, head="", how="", law="", space=False):
        """Of the clip, and of two jaws."""
        held = "ux = 0, uy = 0" + (", uz = 0" if space else "")
        press = 'ty = "-3*t"'
        sweep = {"extrude": 0.5, "layers": 1} if space else {}
        tip = [LENGTH, 1 + SLIT] + [0] * space
        numbers = [quantity("base", "reaction", "LOW", 1, "y"),
                   quantity("along", "reaction", "LOW", 1, "x"),
                   quantity("contact", "contact_force", "LOW", LOWER, "y"),
                   quantity("tip", "displacement", "UP", component="y", point=tip),
                   quantity("peak", "largest_pressure", "UP", UPPER)]
        if "friction" in how:
            numbers.append(quantity("rubbed", "friction_work", "UP", UPPER))
        text = "".join(numbers) + timed(4)
        between = contact(("UP", UPPER), ("LOW", LOWER), more=how + "\n")
        head += "dimension = 3\n" if space else ""
        clip = jaw("clip", f"label = 1, {held}", f"label = 3, {press}", **sweep)
        jaws = jaw("lower", f"label = 1, {held}", **sweep) + jaw("upper", f"label = 3, {press}", **sweep)
        tie = contact(("upper", CUT), ("lower", CUT), kind="tied", variant="interpolation")

        def named(scene, low, up):
            return scene.replace("LOW", low).replace("UP", up).replace("LAW", law)
        one, two = head + clip + between + text, head + jaws + between + tie + text
        return named(one, "clip", "clip"), named(two, "lower", "upper")

    def test_a_clip_is_two_jaws_tied_behind_the_slit(self):
        flows = ", viscosity = 100, yield_stress = 20"
        for name, options in (("plane stress", {}),
                              ("plane strain", {"head": 'plane = "strain"\n', "law": flows}),
                              ("degree 2", {"head": "degree = 2\n"}),
                              ("friction", {"how": "friction = 0.3"}),
                              ("interpolation", {"how": 'variant = "interpolation"'}),
                              ("axis", {"head": 'plane = "axisymmetric"\n'}),
                              ("finite sliding", {"how": 'sliding = "finite"'}),
                              ("space", {"space": True}),
                              ("space, friction", {"space": True, "how": "friction = 0.3"})):
            with self.subTest(name):
                one, two = self.scenes(**options)
                found, expected = values(self.run_it(one)), values(self.run_it(two))
                self.assertGreater(abs(expected["contact"]), 0.1)
                size = max(map(abs, expected.values()))
                for key, each in expected.items():
                    self.assertAlmostEqual(found[key], each, delta=1e-9 * size, msg=key)

    def test_a_slit_that_is_tied_is_none(self):
        for coupling in ("interpolation", "weighted"):
            one, _ = self.scenes(how=f'kind = "tied"\nvariant = "{coupling}"')
            peak = quantity("peak", "largest_pressure", "clip", UPPER)
            one = one.replace(peak, "")
            found = values(self.run_it(one))
            # The column of the load: the whole of it goes through the slit and its back.
            self.assertAlmostEqual(found["base"], 6, delta=1e-9)
            self.assertAlmostEqual(found["contact"], -4.5, delta=0.2)

    def test_one_side_is_not_two(self):
        one, _ = self.scenes()
        self.refuse(one.replace(f"mortar = {{ body = \"clip\", label = {LOWER} }}",
                                f"mortar = {{ body = \"clip\", label = {UPPER} }}"),
                    f"both sides are label {UPPER} of body clip, expected two sides")
        self.refuse(one + "[accuracy]\nbound = true\n", "expected two bodies beside accuracy.bound")


if __name__ == "__main__":
    unittest.main()
