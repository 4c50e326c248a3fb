#!/usr/bin/python3
"""Parts of CAD under --accuracy: the vertices of refined boundaries lie on the surfaces of the part.

Primitives and what people make of them (holes, fillets, chamfers, booleans, lofts, pipes, turned and extruded
splines) by Gmsh's kernels, as .geo, .step and .brep. Each is held at a plane side and loaded by its weight,
on coarse first meshes, with so high an accuracy that meshes are refined as often as unknowns allow. Every
vertex of the last boundary has to be within 1e-10 of the size of a surface of the part, and of every
surface that it is next to, asked of Gmsh anew. Vertices that stay on their chord must be named as such.

    tests/compare/cad_parts.py [--count 50] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import random
import re
import sys
import tempfile
from pathlib import Path

import numpy as np

import gmsh_support
from contact_support import command, solve

NEAR = 1e-10
# Closer than this a vertex is on the surface, or should be: those beside a fillet are farther off.
BESIDE = 1e-7
OPENCASCADE = 'SetFactory("OpenCASCADE");\n'
BUILT_IN = 'SetFactory("Built-in");\n'
DIFFERENCE = "BooleanDifference{{ Volume{{{0}}}; Delete; }}{{ Volume{{{1}}}; Delete; }}\n"
UNION = "BooleanUnion{{ Volume{{{0}}}; Delete; }}{{ Volume{{{1}}}; Delete; }}\n"
COMMON = "BooleanIntersection{{ Volume{{{0}}}; Delete; }}{{ Volume{{{1}}}; Delete; }}\n"


def block(number, x, y, z, dx, dy, dz):
    return f"Box({number}) = {{{x}, {y}, {z}, {dx}, {dy}, {dz}}};\n"


def bar(number, x, y, z, dx, dy, dz, r):
    return f"Cylinder({number}) = {{{x}, {y}, {z}, {dx}, {dy}, {dz}, {r}}};\n"


def holed(r):
    return block(1, 0, 0, 0, 3, 2, 1) + bar(2, 1.5, 1, -1, 0, 0, 3, r(0.3, 0.7)) + DIFFERENCE.format(1, 2)


def blind_hole(r):
    return block(1, 0, 0, 0, 2, 2, 2) + bar(2, 1, 1, 1, 0, 0, 2, r(0.3, 0.6)) + DIFFERENCE.format(1, 2)


def countersunk(r):
    d = r(0.2, 0.4)
    return (block(1, 0, 0, 0, 3, 3, 1) + bar(2, 1.5, 1.5, -1, 0, 0, 3, d)
            + f"Cone(3) = {{1.5, 1.5, 0.6, 0, 0, 0.6, {d / 2}, {2 * d}}};\n" + DIFFERENCE.format(1, "2, 3"))


def round_bar(r):
    return bar(1, 0, 0, 0, 0, 0, r(1, 3), r(0.5, 1))


def ball(r):
    return (f"Sphere(1) = {{0, 0, 0, {r(0.5, 2)}}};\n" + block(2, -3, -3, -r(0.2, 0.4), 6, 6, 6)
            + COMMON.format(1, 2))


def cone(r):
    return f"Cone(1) = {{0, 0, 0, 0, 0, {r(1, 2)}, {r(0.8, 1.2)}, {r(0.2, 0.5)}}};\n"


def torus_part(r):
    return f"Torus(1) = {{0, 0, 0, {r(1.5, 3)}, {r(0.3, 0.7)}, {r(1, 3)}}};\n"


def edges_of_top():
    return "e() = Abs(Boundary{ Surface{6}; });\n"


def filleted(r):
    return block(1, 0, 0, 0, 2, 2, 1) + edges_of_top() + f"Fillet{{1}}{{ e() }}{{ {r(0.1, 0.3)} }}\n"


def filleted_corner(r):
    return block(1, 0, 0, 0, 2, 2, 1.5) + f"Fillet{{1}}{{ 6, 2, 8, 1, 5 }}{{ {r(0.15, 0.35)} }}\n"


def chamfered(r):
    d = r(0.1, 0.3)
    return (block(1, 0, 0, 0, 2, 2, 1) + bar(2, 1, 1, -1, 0, 0, 3, 0.5)
            + "BooleanDifference(3) = { Volume{1}; "
            "Delete; }{ Volume{2}; Delete; };\n"
            + f"Chamfer{{3}}{{ 1, 3 }}{{ 1, 1 }}{{ {d} }}\n")


def crossed_bars(r):
    return bar(1, 0, 0, -2, 0, 0, 4, 1) + bar(2, -2, 0, 0, 4, 0, 0, r(0.5, 0.9)) + UNION.format(1, 2)


def crossed_hole(r):
    return bar(1, 0, 0, -2, 0, 0, 4, 1) + bar(2, -2, 0, 0, 4, 0, 0, r(0.3, 0.7)) + DIFFERENCE.format(1, 2)


def slanted_hole(r):
    return (block(1, 0, 0, 0, 3, 2, 1) + bar(2, 0.8, 1, -0.5, r(0.5, 1.5), 0, 2, 0.35)
            + DIFFERENCE.format(1, 2))


def off_centre_hole(r):
    return bar(1, 0, 0, -2, 0, 0, 4, 1) + bar(2, -2, r(0.2, 0.4), 0, 4, 0, 0, 0.4) + DIFFERENCE.format(1, 2)


def drilled_ball(r):
    return ("Sphere(1) = {0, 0, 0, 1};\n" + bar(2, 0, 0, -2, 0, 0, 4, r(0.3, 0.5))
            + block(3, -2, -2, -2, 4, 4, 1.5)
            + DIFFERENCE.format(1, "2, 3"))


def ball_on_block(r):
    return block(1, -1, -1, -1, 2, 2, 1) + f"Sphere(2) = {{0, 0, {r(0, 0.4)}, 0.7}};\n" + UNION.format(1, 2)


def dimpled(r):
    return (block(1, -1, -1, -1, 2, 2, 1) + f"Sphere(2) = {{0, 0, {r(0.1, 0.5)}, 0.8}};\n"
            + DIFFERENCE.format(1, 2))


def bracket(r):
    return (block(1, 0, 0, 0, 3, 2, 0.5) + block(2, 0, 0, 0, 0.5, 2, 2)
            + "BooleanUnion(3) = { Volume{1}; Delete; }"
            "{ Volume{2}; Delete; };\n" + bar(4, 2, 1, -1, 0, 0, 2, r(0.3, 0.5))
            + bar(5, -1, 1, 1.3, 2, 0, 0, r(0.2, 0.4)) + DIFFERENCE.format(3, "4, 5"))


def flange(r):
    holes = "".join(bar(10 + k, 1.4 * x, 1.4 * y, -1, 0, 0, 3, 0.2)
                    for k, (x, y) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))))
    return (bar(1, 0, 0, 0, 0, 0, 0.5, 2) + bar(2, 0, 0, 0, 0, 0, 1.5, 1)
            + "BooleanUnion(3) = { Volume{1}; Delete; }"
            "{ Volume{2}; Delete; };\n" + bar(4, 0, 0, -1, 0, 0, 4, r(0.5, 0.8)) + holes
            + DIFFERENCE.format(3, "4, 10:13"))


def tube(r):
    return bar(1, 0, 0, 0, 0, 0, 2, 1) + bar(2, 0, 0, -1, 0, 0, 4, r(0.5, 0.8)) + DIFFERENCE.format(1, 2)


def capsule(r):
    d = r(0.5, 1)
    return (bar(1, 0, 0, 0, 0, 0, 2, d) + f"Sphere(2) = {{0, 0, 2, {d}}};\n" + UNION.format(1, 2))


def ellipsoid(r):
    return ("Sphere(1) = {0, 0, 0, 1};\n"
            + f"Dilate {{{{0, 0, 0}}, {{1, {r(0.5, 0.9)}, {r(1.2, 1.6)}}}}} {{ Volume{{1}}; }}\n"
            + block(2, -3, -3, -0.5, 6, 6, 6) + COMMON.format(1, 2))


def loft(r):
    return (f"Circle(1) = {{0, 0, 0, 1}}; Circle(2) = {{0, 0, 1, {r(0.5, 0.8)}}}; "
            f"Circle(3) = {{0, 0, 2, {r(0.8, 1.3)}}};\n"
            "Curve Loop(1) = {1}; Curve Loop(2) = {2}; Curve Loop(3) = {3};\nThruSections(1) = {1, 2, 3};\n")


def spline_points(r, shift=0.0):
    ys = [0, r(0.1, 0.3), r(-0.3, -0.1), r(0, 0.2), 0]
    return "".join(f"Point({i + 1}) = {{{i}, {1 + shift + y}, 0}};\n" for i, y in enumerate(ys))


def extruded_spline(r):
    return (spline_points(r)
            + "Point(6) = {4, 0, 0}; Point(7) = {0, 0, 0};\nBSpline(1) = {1:5}; Line(2) = {5, 6}; "
            "Line(3) = {6, 7}; Line(4) = {7, 1};\nCurve Loop(1) = {1:4}; Plane Surface(1) = {1};\n"
            "Extrude {0, 0, 1} { Surface{1}; }\n")


def turned_spline(r):
    return (spline_points(r)
            + "Point(6) = {4, 0.4, 0}; Point(7) = {0, 0.4, 0};\nBSpline(1) = {1:5}; Line(2) = {5, 6}; "
            "Line(3) = {6, 7}; Line(4) = {7, 1};\nCurve Loop(1) = {1:4}; Plane Surface(1) = {1};\n"
            f"Extrude {{{{1, 0, 0}}, {{0, 0, 0}}, {r(1, 3)}}} {{ Surface{{1}}; }}\n")


def bent_pipe(r):
    return ("Point(1) = {0, 0, 0}; Point(2) = {0, 0, 2}; Point(3) = {1.5, 0, 3}; Point(4) = {3, 0, 3};\n"
            "BSpline(1) = "
            f"{{1, 2, 3, 4}}; Wire(1) = {{1}}; Disk(1) = {{0, 0, 0, {r(0.3, 0.6)}}};\n"
            "Extrude { Surface{1}; } Using Wire {1}\nDelete{ Surface{1}; }\n")


def pocket(r):
    d = r(0.15, 0.3)
    return (block(1, 0, 0, 0, 3, 3, 1) + block(2, 0.7, 0.7, 0.5, 1.6, 1.6, 1)
            + f"Fillet{{2}}{{ 13, 15, 17, 19 }}{{ {d} }}\n"
            + DIFFERENCE.format(1, 2))


def eighth_of_ball(r):
    d = r(0.5, 2)
    return (f"Point(1) = {{0, 0, 0}}; Point(2) = {{{d}, 0, 0}}; Point(3) = {{0, {d}, 0}}; "
            f"Point(4) = {{0, 0, {d}}};\n"
            "Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 2}; "
            "Line(4) = {1, 2}; Line(5) = {1, 3};"
            "Line(6) = {1, 4};\nCurve Loop(1) = {1, 2, 3}; Surface(1) = {1}; Curve Loop(2) = {4, 1, -5}; "
            "Plane Surface(2) = {2};\nCurve Loop(3) = {5, 2, -6}; Plane Surface(3) = {3}; "
            "Curve Loop(4) = {6, 3, -4}; "
            "Plane Surface(4) = {4};\nSurface Loop(1) = {1:4}; Volume(1) = {1};\n")


def extruded_sector(r):
    d = r(0.8, 2)
    return (f"Point(1) = {{0, 0, 0}}; Point(2) = {{{d}, 0, 0}}; Point(3) = {{0, {d}, 0}};\n"
            "Circle(1) = {2, 1, 3}; "
            "Line(2) = {1, 2}; Line(3) = {3, 1};\nCurve Loop(1) = {2, 1, 3}; Plane Surface(1) = {1};\n"
            f"Extrude {{0, 0, {r(0.5, 1.5)}}} {{ Surface{{1}}; }}\n")


# (what it is, made by Gmsh's own kernel)
KINDS = [(holed, False), (blind_hole, False), (countersunk, False), (round_bar, False), (ball, False),
         (cone, False), (torus_part, False), (filleted, False), (filleted_corner, False), (chamfered, False),
         (crossed_bars, False), (crossed_hole, False), (slanted_hole, False), (off_centre_hole, False),
         (drilled_ball, False), (ball_on_block, False), (dimpled, False), (bracket, False), (flange, False),
         (tube, False), (capsule, False), (ellipsoid, False), (loft, False), (extruded_spline, False),
         (turned_spline, False), (bent_pipe, False), (pocket, False), (eighth_of_ball, True),
         (extruded_sector, True)]


def scene(file, size, held):
    return (f'dimension = 3\n[[body]]\nname = "part"\nmesh = {{ file = "{file}", size = {size!r} }}\n'
            "material = { young = 1000, poisson = 0.3 }\n"
            f"boundary = [ {{ label = {held}, ux = 0, uy = 0, uz = 0 }} ]\nforce = {{ x = 0.3, z = -1 }}\n"
            "[time]\nend = 1\nsteps = 1\n")


def boundary_vertices(cells):
    """Of tetrahedra: those of triangles that belong to one of them."""
    triangles = np.sort(np.concatenate([cells[:, list(k)] for k in ((0, 1, 2), (0, 1, 3), (0,
    2, 3), (1, 2, 3))]))
    found, count = np.unique(np.sort(triangles, axis=1), axis=0, return_counts=True)
    return np.unique(found[count == 1])


def distances(path, points):
    """By surfaces and points."""
    gmsh_support.open_file(path)
    return np.array([np.linalg.norm(np.array(gmsh_support.nearest(number, points)) - points, axis=1)
                     for number in gmsh_support.surfaces()])


def examined(program, seed, unknowns=40000, rounds=3):
    kind, own = KINDS[seed % len(KINDS)]
    rng = random.Random(seed)
    form = "geo" if own else rng.choice(["geo", "step", "brep"])
    text = (BUILT_IN if own else OPENCASCADE) + kind(lambda a, b: round(rng.uniform(a, b), 4))
    shown = f"{kind.__name__}.{form}"
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / f"part.{form}"
        (Path(name) / "part.geo").write_text(text)
        gmsh_support.open_file(Path(name) / "part.geo")
        if form != "geo":
            gmsh_support.write(path)
            gmsh_support.open_file(path)
        planes = [number for number, shape in gmsh_support.surfaces().items() if shape == "Plane"]
        run = solve(program, scene(str(path), 0.8, planes[0]), "--accuracy", "0.01", "--max-unknowns",
                    str(unknowns), fields=True, patience=300)
        if run.code not in (0, 1) or "part" not in run.bodies:
            return shown, [run.end or "no result"]
        part = run.bodies["part"]
        points = np.array(part.points)[boundary_vertices(np.array(part.tetrahedra))]
        size = np.ptp(points, axis=0).max()
        away = distances(path, points) / size
    nearest = away.min(axis=0)
    between = np.where(away < BESIDE, away, 0).max()
    made = len(run.summary["rounds"])
    named = [int(n) for text in run.summary["accuracy"]["not_reliable"]
             for n in re.findall(r"would turn over: (\d+)", text)]
    off = int((nearest > NEAR).sum())
    shown += (f", {made} rounds, {len(points)} vertices, off {nearest.max():.1e}, between {between:.1e}, "
              f"named {sum(named)}")
    faults = []
    if made < rounds:
        faults.append(f"{made} rounds")
    if off > sum(named):
        faults.append(f"{off} vertices off their surface, by up to {nearest.max():.2g} of the size, "
                      f"{sum(named)} named")
    if between > NEAR and not named:
        faults.append(f"vertices between surfaces off one of them by {between:.2g} of the size")
    if off or named:
        faults.append(f"{off} vertices are off, {sum(named)} named")
    return shown, faults


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 50))
