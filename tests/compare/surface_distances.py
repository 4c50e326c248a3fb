#!/usr/bin/python3
"""Contact pressures of curved bodies in space: as drawn, against those with the distance given.

Pairs of parts drawn with Gmsh: crossed cylinders (radii 1:1, 1:2, 1:5), a pin in a bore, a ball in a cup, a
cone in a cone, tubes shrunk on each other on other meshes, tubes of one mesh, four ridges on a plane, a torus
on a plane, with about ten edges on the contact. Each is solved with the exact distance (`gap`), with that of
the geometry, and with that of the triangles alone (the same mesh in a Medit file). Nodal pressures of the
geometry are within 5 % of the largest of those of the exact distance, those of the triangles within 10 %. Of
the shrink fit with quadratic displacements they are compared with Lame's pressure: a distance that is given
is taken along the normals of rows, to which triangles are inclined, and is farther from that.

    tests/compare/surface_distances.py [--only NAME ...] [--degree 1 2] [--scale F ...] [--mortier PROGRAM]

`--scale` multiplies the sizes of the elements: with several of them (2 1 0.5: 5, 10 and 20 edges) the slopes
of the logarithms of the largest and of the mean square differences over that of the size are printed.
"""
import argparse
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import gmsh
import numpy as np

EDGE = 1e-6
WITHIN = {"geo": 0.05, "mesh": 0.10}


def box(*corners):
    return gmsh.model.occ.addBox(*corners)


def common(volume, *corners):
    return gmsh.model.occ.intersect([(3, volume)], [(3, box(*corners))])[0]


def without(body, tools):
    return gmsh.model.occ.cut(body, [(3, tool) for tool in tools])[0]


def draw(folder, name, build, size, label):
    """Writes NAME.brep and NAME.geo, and the mesh of that without its geometry."""
    gmsh.initialize(["", "-v", "1"])
    try:
        build()
        gmsh.model.occ.synchronize()
        gmsh.write(f"{folder}/{name}.brep")
        gmsh.clear()
        gmsh.model.occ.importShapes(f"{folder}/{name}.brep")
        gmsh.model.occ.synchronize()
        labels = {}
        for _, tag in gmsh.model.getEntities(2):
            lower, upper = (gmsh.model.getBoundingBox(2, tag)[k:k + 3] for k in (0, 3))
            labels.setdefault(label(gmsh.model.getType(2, tag), lower, upper), []).append(tag)
        volumes = {}
        for _, tag in gmsh.model.getEntities(3):
            volumes[gmsh.model.occ.getCenterOfMass(3, tag)] = tag
    finally:
        gmsh.finalize()
    text = [f'SetFactory("OpenCASCADE"); v() = ShapeFromFile("{name}.brep");']
    # One volume, or two of which the first is nearer to the axis.
    ordered = sorted(volumes, key=lambda x: x[0]**2 + x[1]**2)
    text += [f'Physical Volume("{n}") = {{{volumes[x]}}};' for n, x in zip(("one", "two"), ordered)]
    text += [f'Physical Surface("{n}") = {{{", ".join(map(str, tags))}}};'
             for n, tags in sorted(labels.items())]
    text += ["Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;",
             f'Field[1] = MathEval; Field[1].F = "{size}"; Background Field = 1;', ""]
    (folder / f"{name}.geo").write_text("\n".join(text))


def at(lower, upper, axis, value):
    return abs(lower[axis] - value) < 1e-4 and abs(upper[axis] - value) < 1e-4


class Pair:
    """Two parts, nonmortar first: how they are drawn, supports and the distance at nonmortar nodes."""

    def __init__(self, gap, supports, uniform=None, **parts):
        self.gap, self.supports, self.uniform, self.parts = gap, supports, uniform, parts

    def draw(self, folder):
        for name, (build, size, label) in self.parts.items():
            draw(folder, name, build, size, label)
            for body in ("one", "two") if name == "both" else (name,):
                done = subprocess.run([PROGRAM, "mesh", "convert", f"{name}.geo", f"{body}.mesh", "--region",
                                       body if name == "both" else "one"],
                                      cwd=folder, capture_output=True, text=True)
                if done.returncode:
                    raise RuntimeError(done.stderr)

    def scene(self, kind, degree):
        lines = ["dimension = 3", f"degree = {degree}"]
        for name, supports in zip(("one", "two"), self.supports):
            alone = name in self.parts or kind == "mesh"
            file = f'file = "{name}.{kind}"' if alone else f'file = "both.{kind}", region = "{name}"'
            lines += ["[[body]]", f'name = "{name}"', f"mesh = {{ {file} }}",
                      "material = { young = 1, poisson = 0.3 }", f"boundary = [ {supports} ]"]
        lines += ["[contact]", 'nonmortar = { body = "one", label = "arc" }',
                  'mortar = { body = "two", label = "arc" }']
        return "\n".join([*lines, "GAP", "[time]", "end = 1", "steps = 1", ""])


def held(**values):
    """Supports: sides and the components that are held there, or moved along z."""
    return ", ".join(f'{{ label = "{label}", {motion} }}' for label, motion in values.items())


def labelling(arc, **planes):
    """Names of surfaces: `arc` of those that are curved and of its type, planes by axis and coordinate."""
    def label(kind, lower, upper):
        for name, (axis, value) in planes.items():
            if at(lower, upper, axis, value):
                return name
        return "arc" if arc(kind, lower, upper) else "rest"
    return label


def curved(kind, lower, upper):
    return kind != "Plane"


def crossed(ratio, scale):
    size = f"{0.015 * scale} + 0.08*Sqrt(x^2 + y^2 + z^2)"
    two = ratio
    return Pair(f"1-sqrt(max(0,1-x^2))+{two}-sqrt(max(0,{two}^2-y^2))",
                (held(x="ux = 0", y="uy = 0", far="uz = -0.01"),
                 held(x="ux = 0", y="uy = 0", far="uz = 0.01")),
                one=(lambda: common(gmsh.model.occ.addCylinder(0, 0, 1, 0, 3, 0, 1), 0, 0, 0, 1, 3, 1), size,
                     labelling(curved, x=(0, 0), y=(1, 0), far=(2, 1))),
                two=(lambda: common(gmsh.model.occ.addCylinder(0, 0, -two, 3, 0, 0, two),
                                    0, 0, -two, 3, two, two),
                     size, labelling(curved, x=(0, 0), y=(1, 0), far=(2, -two))))


def between(along, across, apart):
    """From a circle or sphere of radius 1 to one about it, `apart` larger, which it touches below."""
    # Of the centre, along the normal.
    moved = f"(-{apart}*({along}+{apart})/sqrt({across}+({along}+{apart})^2))"
    return f"-1-{moved}+sqrt({moved}^2-{apart}^2+{1 + apart}^2)"


def pin(scale):
    size = f"{0.06 * scale} + 0.15*Fabs(x) + 0.15*Fabs(y + 1)"
    thick = 0.2

    def block():
        without([(3, box(0, -2, 0, 2, 2, thick))], [gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, thick, 1.02)])

    return Pair(between("y", "x^2", 0.02),
                (held(x="ux = 0", start="uz = 0", end="uz = 0", far="uy = -0.02"),
                 held(x="ux = 0", start="uz = 0", end="uz = 0", far="uy = 0")),
                one=(lambda: common(gmsh.model.occ.addCylinder(0, -0.02, 0, 0, 0, thick, 1),
                                    0, -2, 0, 2, 1.98, thick),
                     size, labelling(curved, x=(0, 0), start=(2, 0), end=(2, thick), far=(1, -0.02))),
                two=(block, size, labelling(curved, x=(0, 0), start=(2, 0), end=(2, thick), far=(1, -2))))


def cup(scale):
    size = f"{0.07 * scale} + 0.2*Sqrt(x^2 + y^2 + (z + 1)^2)"

    def block():
        without([(3, box(0, 0, -2.5, 2, 2, 2.5))], [gmsh.model.occ.addSphere(0, 0, 0, 1.05)])

    return Pair(between("z", "x^2+y^2", 0.05),
                (held(x="ux = 0", y="uy = 0", far="uz = -0.05"), held(x="ux = 0", y="uy = 0", far="uz = 0")),
                one=(lambda: common(gmsh.model.occ.addSphere(0, 0, -0.05, 1), 0, 0, -2, 2, 2, 1.95), size,
                     labelling(curved, x=(0, 0), y=(1, 0), far=(2, -0.05))),
                two=(block, f"1.3*({size})", labelling(curved, x=(0, 0), y=(1, 0), far=(2, -2.5))))


def cone(scale):
    size = str(0.13 * scale)

    def plug():
        common(gmsh.model.occ.addCone(0, 0, 0, 0, 0, 1, 0.7, 1), 0, 0, 0, 2, 2, 1)

    def socket():
        without([(3, box(0, 0, -0.2, 1.8, 1.8, 1))],
                [gmsh.model.occ.addCone(0, 0, -0.2, 0, 0, 1.4, 0.64, 1.06)])

    return Pair("0", (held(x="ux = 0", y="uy = 0", far="uz = -0.01"),
                      held(x="ux = 0", y="uy = 0", far="uz = 0")),
                one=(plug, size, labelling(curved, x=(0, 0), y=(1, 0), far=(2, 1))),
                two=(socket, f"1.2*{size}", labelling(curved, x=(0, 0), y=(1, 0), far=(2, -0.2))))


def tube(inner, outer, thick):
    whole = common(gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, thick, outer), 0, 0, 0, outer, outer, thick)
    without(whole, [gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, thick, inner)])


def radius(value):
    """Curved surfaces that reach to a radius."""
    return lambda kind, lower, upper: kind != "Plane" and abs(max(upper[0], upper[1]) - value) < 1e-4


TUBES = (held(x="ux = 0", y="uy = 0", start="uz = 0", end="uz = 0"),) * 2


def shrink(scale):
    planes = dict(x=(0, 0), y=(1, 0), start=(2, 0), end=(2, 0.4))
    # Lame, plane strain, young 1, poisson 0.3: interference 0.001 at radius 2 of tubes 1 to 2 and 2 to 3.
    lame = 0.001 / (1 - 0.3**2) / (2 * (5 / 3 + 13 / 5))
    return Pair("-0.001", TUBES, lame,
                one=(lambda: tube(1, 2, 0.4), str(0.3 * scale), labelling(radius(2), **planes)),
                two=(lambda: tube(1.999, 3, 0.4), str(0.37 * scale), labelling(radius(1.999), **planes)))


def one_mesh(scale):
    def both():
        occ = gmsh.model.occ
        quarter = common(occ.addCylinder(0, 0, 0, 0, 0, 0.4, 3), 0, 0, 0, 3, 3, 0.4)
        ring = occ.cut(quarter, [(3, occ.addCylinder(0, 0, 0, 0, 0, 0.4, 1))])[0]
        middle = occ.addCylinder(0, 0, 0, 0, 0, 0.4, 2)
        inside = occ.intersect(ring, [(3, middle)], removeObject=False, removeTool=False)[0]
        outside = occ.cut(ring, [(3, middle)])[0]
        occ.fragment(inside, outside)

    planes = dict(x=(0, 0), y=(1, 0), start=(2, 0), end=(2, 0.4))
    names = labelling(radius(2), **planes)
    bore = radius(1)
    supports = held(x="ux = 0", y="uy = 0", start="uz = 0", end="uz = 0")
    return Pair("0", (supports + ', { label = "bore", pressure = 0.001 }', supports),
                both=(both, str(0.3 * scale),
                      lambda *surface: "bore" if bore(*surface) else names(*surface)))


def ridges(scale):
    near = "Sqrt(({0})*({0}) + z*z)".format("Fabs(Fabs(x - 1) - 0.5)")
    size = f"{0.045 * scale} + 0.25*{near}"

    def plate():
        occ = gmsh.model.occ
        rods = [(3, occ.addCylinder(x, 0, 0.5, 0, 0.3, 0, 0.5)) for x in (0.5, 1.5)]
        body = occ.fuse([(3, box(0, 0, 0.5, 2, 0.3, 0.5))], rods)[0]
        occ.intersect(body, [(3, box(0, 0, 0, 2, 0.3, 1))])

    planes = dict(x=(0, 0), y=(1, 0), end=(1, 0.3))
    gap = "0.5-sqrt(max(0,0.25-min((x-0.5)^2,(x-1.5)^2)))"
    return Pair(gap, (held(x="ux = 0", y="uy = 0", end="uy = 0", far="uz = -0.03"),
                      held(x="ux = 0", y="uy = 0", end="uy = 0", far="uz = 0")),
                one=(plate, size, labelling(lambda kind, lower, upper: kind != "Plane" and lower[2] < 0.1,
                                            far=(2, 1), **planes)),
                two=(lambda: box(0, 0, -1, 2.2, 0.3, 1), f"1.3*({size})",
                     labelling(lambda kind, lower, upper: at(lower, upper, 2, 0), far=(2, -1), **planes)))


def torus(scale):
    size = f"{0.045 * scale} + 0.25*Sqrt((Sqrt(x^2 + y^2) - 1)^2 + z^2)"
    planes = dict(x=(0, 0), y=(1, 0))
    return Pair("0.4-sqrt(max(0,0.16-(sqrt(x^2+y^2)-1)^2))",
                (held(x="ux = 0", y="uy = 0", far="uz = -0.03"), held(x="ux = 0", y="uy = 0", far="uz = 0")),
                one=(lambda: common(gmsh.model.occ.addTorus(0, 0, 0.4, 1, 0.4), 0, 0, 0, 2, 2, 0.4), size,
                     labelling(curved, far=(2, 0.4), **planes)),
                two=(lambda: box(0, 0, -1, 2, 2, 1), f"1.3*({size})",
                     labelling(lambda kind, lower, upper: at(lower, upper, 2, 0), far=(2, -1), **planes)))


PAIRS = {"crossed-1": lambda s: crossed(1, s), "crossed-2": lambda s: crossed(2, s),
         "crossed-5": lambda s: crossed(5, s), "pin-in-bore": pin, "ball-in-cup": cup, "cone-in-cone": cone,
         "shrink-fit": shrink, "one-mesh": one_mesh, "four-ridges": ridges, "torus": torus}


def pressures(folder, text, name):
    (folder / f"{name}.toml").write_text(text)
    done = subprocess.run([PROGRAM, "run", f"{name}.toml", "--quiet", "--out", name], cwd=folder,
                          capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)
    with open(folder / name / "contact.csv", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["time"] == "1"]
    return (np.array([[float(row[c]) for c in "xyz"] for row in rows]),
            np.array([float(row["pressure"]) for row in rows]))


def at_nodes(exact, found):
    """Pressures at the nodes nearest to those of the other run: the same but for digits of a file."""
    return np.array([found[1][np.argmin(((found[0] - x)**2).sum(1))] for x in exact[0]])


def compared(name, scale, degrees, differences):
    """Prints how far pressures are off. Returns the number of faults."""
    faults = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        pair = PAIRS[name](scale)
        pair.draw(folder)
        for degree in degrees:
            text = pair.scene("geo", degree)
            exact = pressures(folder, text.replace("GAP", f'gap = "{pair.gap}"'), "exact")
            reference = exact[1]
            if degree == 2 and pair.uniform:
                reference = np.full(len(exact[1]), pair.uniform)
            largest = reference.max()
            pressed = np.count_nonzero(exact[1] > 0)
            line = f"{name} degree {degree}: {len(exact[1])} nodes, {pressed} pressed, "
            line += f"largest {largest:.4g}"
            for kind, within in WITHIN.items():
                found = pressures(folder, pair.scene(kind, degree).replace("GAP", ""), kind)
                off = np.abs(at_nodes(exact, found) - reference) / largest
                differences.setdefault((degree, kind), []).append([off.max(), np.sqrt(np.mean(off**2))])
                line += f"; {kind} off by {100 * off.max():.2g} %"
                if off.max() > within and scale <= 1:
                    faults += 1
                    line += " FAULT"
            print(line, flush=True)
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", default=sorted(PAIRS))
    parser.add_argument("--degree", nargs="+", type=int, default=[1, 2])
    parser.add_argument("--scale", nargs="+", type=float, default=[1])
    parser.add_argument("--mortier", default="build/mortier")
    options = parser.parse_args()
    global PROGRAM
    PROGRAM = str(Path(options.mortier).resolve())
    faults = 0
    for name in options.only:
        found = {}  # by degree and kind: differences for each scale
        for scale in options.scale:
            faults += compared(name, scale, options.degree, found)
        for (degree, kind), off in found.items():
            if len(options.scale) > 1:
                largest, mean = np.polyfit(np.log(options.scale), np.log(off), 1)[0]
                print(f"{name} degree {degree}: {kind} slope {largest:.2g}, of mean squares {mean:.2g}")
    print(f"{faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
