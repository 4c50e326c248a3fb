#!/usr/bin/python3
"""Light and missed contact in space under --accuracy: never "reached" without contact.

Balls, rollers, crossed cylinders, a ball in a cup, a torus and a barrel on blocks: the program's own shapes,
whose lowest point is a vertex, and Gmsh's, turned by any angle, whose lowest point is between vertices. The
bodies approach each other by 1e-4 to 1e-2 of the radius, often by less than the first meshes are off their
surfaces; some are pressed by a light force beside a soft hold, some beside a second contact that presses from
the beginning. A run that calls its accuracy reached must have found the contact, with a force of at least a
fifth of what Hertz's contact of half spaces has.

    tests/compare/light_contacts_space.py [--count 60] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import math
import random
import sys

from contact_support import command, solve
from scene_parts import body, box, contact, quantity, shape, timed, written

KINDS = ("ball", "roller", "turned ball", "turned roller", "crossed cylinders", "ball in cup", "barrel",
         "torus", "second contact")
LEAST = 0.2
OPENCASCADE = 'SetFactory("OpenCASCADE");\n'
# Of a body above the plane z = 0: label 1 what is round, 2 the flat top.
GROUPS = """\
e = 1e-4 * R; top() = Surface In BoundingBox{{-9*R, -9*R, {0} - e, 9*R, 9*R, {0} + e}};
ends() = Surface In BoundingBox{{-9*R, -L - e, -9*R, 9*R, -L + e, 9*R}};
further() = Surface In BoundingBox{{-9*R, L - e, -9*R, 9*R, L + e, 9*R}};
all() = Surface{{:}}; all() -= {{top(), ends(), further()}};
Physical Volume(1) = Volume{{:}}; Physical Surface(1) = all(); Physical Surface(2) = top();
"""
HALF = "Box(9) = {{-9*R, -9*R, -9*R, 18*R, 18*R, 9*R + {0}}};\n" \
       "BooleanIntersection{{ Volume{{1}}; Delete; }}{{ Volume{{9}}; Delete; }}\n"


def turned(axis, angle):
    return f"Rotate {{{{{axis}}}, {{0, 0, R}}, {angle!r}}} {{ Volume{{1}}; }}\n"


def ball_geo(angles):
    return (OPENCASCADE + "R = 1; L = 8;\nSphere(1) = {0, 0, R, R};\n" + turned("1, 0, 0", angles[0])
            + turned("0, 1, 0", angles[1]) + HALF.format("R") + GROUPS.format("R"))


def roller_geo(angles):
    return (OPENCASCADE + "R = 1; L = 0.5;\nCylinder(1) = {0, -L, R, 0, 2*L, 0, R};\n"
            + turned("0, 1, 0", angles[0]) + HALF.format("R") + GROUPS.format("R"))


def barrel_geo(angles, crown):
    """A roller with crowned sides: turned about the y axis through its centre."""
    return (OPENCASCADE + f"R = 1; L = 0.5; C = {crown!r};\ns = C - Sqrt(C^2 - L^2);\n"
            "Point(1) = {0, -L, R}; Point(2) = {0, L, R}; Point(3) = {0, L, s}; Point(4) = {0, -L, s};\n"
            "Point(5) = {0, 0, C};\nLine(1) = {1, 2}; Line(2) = {2, 3}; Circle(3) = {3, 5, 4}; "
            "Line(4) = {4, 1};\n"
            "Curve Loop(1) = {1:4}; Plane Surface(1) = {1};\n"
            "v[] = Extrude {{0, 1, 0}, {0, 0, R}, 2*Pi} { Surface{1}; };\n"
            + turned("0, 1, 0", angles[0]) + HALF.format("R") + GROUPS.format("R"))


def torus_geo():
    return (OPENCASCADE + "R = 1; L = 8;\nTorus(1) = {0, 0, R, 2*R, R};\n" + HALF.format("R")
            + GROUPS.format("R"))


def cup_geo(radius, opening):
    return (OPENCASCADE
            + f"Box(2) = {{-1.5, -1.5, -1, 3, 3, {1 + opening!r}}};\n"
            f"Sphere(1) = {{0, 0, {radius!r}, {radius!r}}};\n"
            "BooleanDifference{ Volume{2}; Delete; }{ Volume{1}; Delete; }\n"
            "e = 1e-4; bottom() = Surface In BoundingBox{-9, -9, -1 - e, 9, 9, -1 + e};\n"
            f"cup() = Surface In BoundingBox{{-1.4, -1.4, -e, 1.4, 1.4, {opening!r} + e}};\n"
            f"flat() = Surface In BoundingBox{{-9, -9, {opening!r} - e, 9, 9, {opening!r} + e}}; "
            "cup() -= flat();\n"
            "Physical Volume(1) = Volume{:}; Physical Surface(1) = cup(); Physical Surface(2) = bottom();\n")


def lying_geo(radius, angle):
    """The upper half of a cylinder along x below the plane z = 0."""
    return (OPENCASCADE + f"R = {radius!r}; L = 0.7;\nCylinder(1) = {{-L, 0, -R, 2*L, 0, 0, R}};\n"
            f"Rotate {{{{1, 0, 0}}, {{0, 0, -R}}, {angle!r}}} {{ Volume{{1}}; }}\n"
            "Box(9) = {-9, -9, -R, 18, 18, 9};\n"
            "BooleanIntersection{ Volume{1}; Delete; }{ Volume{9}; Delete; }\n"
            "e = 1e-4; bottom() = Surface In BoundingBox{-9, -9, -R - e, 9, 9, -R + e};\n"
            "ends() = Surface In BoundingBox{-L - e, -9, -9, -L + e, 9, 9};\n"
            "further() = Surface In BoundingBox{L - e, -9, -9, L + e, 9, 9};\n"
            "all() = Surface{:}; all() -= {bottom(), ends(), further()};\n"
            "Physical Volume(1) = Volume{:}; Physical Surface(1) = all(); Physical Surface(2) = bottom();\n")


def block(cells):
    n = max(2, cells)
    return box([-1.5, -1.5, -1.5], [1.5, 1.5, 0], [2 * n, 2 * n, n])


class Scene:
    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.kind = KINDS[seed % len(KINDS)]
        self.degree = rng.choice([1, 1, 2])
        self.cells = rng.randint(2, 4)
        self.approach = 10 ** rng.uniform(-3.7, -2)
        self.young = 1000.0, 1000.0 * 10 ** rng.uniform(-1, 1)
        self.angles = [rng.uniform(0, 2 * math.pi) for _ in range(2)]
        self.size = rng.uniform(0.35, 0.7)
        self.other = rng.uniform(0.5, 2)
        self.aim = rng.choice([0.2, 0.25, 0.3])
        self.curved = 1.0  # radius of the contact
        self.line = 0.0  # length of contact along a line, or around
        self.files = {}

    @property
    def shown(self):
        return (f"{self.kind}, approach {self.approach:.2g}, {self.cells} cells, size {self.size:.2g}, "
                f"degree {self.degree}, E {self.young[0] / self.young[1]:.2g}, accuracy {self.aim}")

    def geo(self, name, text):
        self.files[name] = text
        return f'{{ file = "{name}", size = {self.size!r} }}'

    def text(self):
        depth = f"{-self.approach!r}*t"
        up, low = (1, 2), ("top", "bottom")
        lower = block(self.cells)
        if self.kind in ("ball", "second contact"):
            upper = shape("ball", centre=[0, 0, 1], radius=1, keep=["-z"], cells=self.cells)
            up = "round", "top"
        elif self.kind == "roller":
            # Along z: the block is beside it.
            self.line = 1.0
            upper = shape("cylinder", centre=[0, 0, 0], radius=1, height=1, keep=["x"],
                          cells=[self.cells + 1, 2])
            lower = box([1, -1.5, 0], [2.5, 1.5, 1], [self.cells, 2 * self.cells, 2])
            first = body("u", upper, self.young[0],
                         f'label = "left", ux = "{self.approach!r}*t", uy = 0, uz = 0')
            second = body("l", lower, self.young[1], 'label = "right", ux = 0, uy = 0, uz = 0')
            return self.scene(first, second, "round", "left", "left", "x")
        elif self.kind == "turned ball":
            upper = self.geo("u.geo", ball_geo(self.angles))
        elif self.kind == "turned roller":
            self.line = 1.0
            upper = self.geo("u.geo", roller_geo(self.angles))
        elif self.kind == "barrel":
            self.curved = math.sqrt(self.other + 1)
            upper = self.geo("u.geo", barrel_geo(self.angles, self.other + 1))
        elif self.kind == "torus":
            self.line = 4 * math.pi
            upper = self.geo("u.geo", torus_geo())
            lower = box([-3.5, -3.5, -1.5], [3.5, 3.5, 0], [10, 10, 3])
        elif self.kind == "crossed cylinders":
            self.curved = math.sqrt(self.other)
            upper = self.geo("u.geo", roller_geo(self.angles))
            lower = self.geo("l.geo", lying_geo(self.other, self.angles[1]))
        else:
            self.curved = 1 / (1 - 1 / (1.3 * (1 + self.other)))
            upper = self.geo("u.geo", ball_geo(self.angles))
            lower = self.geo("l.geo", cup_geo(1.3 * (1 + self.other), 0.2))
        if lower.startswith("{ file"):
            low = (1, 2)
        else:
            low = "top", "bottom"
        more = ""
        if self.kind == "second contact":
            # A weight on the block, which presses from the beginning.
            weight = box([-1.5, 1, 0], [1.5, 1.5, 0.5], [6, 2, 2])
            more = (body("w", weight, 1000.0, 'label = "left", ux = 0, uy = 0',
                         'label = "top", uz = "-0.01*t"')
                    + contact(("w", "bottom"), ("l", "top"), sides=True))
        first = body("u", upper, self.young[0], f'label = {written(up[1])}, ux = 0, uy = 0, uz = "{depth}"')
        second = body("l", lower, self.young[1], f"label = {written(low[1])}, ux = 0, uy = 0, uz = 0",
                      more=more)
        return self.scene(first, second, up[0], low[0], up[1], "z")

    def scene(self, upper, lower, one, other, held, axis):
        return (f"dimension = 3\ndegree = {self.degree}\n" + upper + lower
                + contact(("u", one), ("l", other), sides=True) + quantity("F", "reaction", "u", held, axis)
                + timed())

    def hertz(self):
        """Force of half spaces at this approach, of a line a lower bound of it."""
        modulus = 1 / sum(0.91 / e for e in self.young)
        if self.line:
            return self.line * math.pi / 4 * modulus * self.approach / 3
        return 4 / 3 * modulus * math.sqrt(self.curved) * self.approach ** 1.5

    def faults(self, program, unknowns=100000):
        run = solve(program, self.text(), "--accuracy", str(self.aim), "--max-unknowns", str(unknowns),
                    files=self.files, patience=400)
        if run.code not in (0, 1) or not run.summary:
            return [run.end]
        reached = run.summary["accuracy"].get("reached")
        force = abs(run.value("F"))
        self.ratio = force / self.hertz()
        self.found = f"{'reached' if reached else 'not reached'}, force {self.ratio:.3g} of Hertz's"
        if any(float(row["time[s]"]) == 0 and float(row["contact_force[N]"]) > 0 for row in run.history):
            return ["presses at t = 0, where nothing loads"]
        if not reached:
            return []
        if not force > LEAST * self.hertz():
            return [f"reached with a force of {force:.3g}, Hertz {self.hertz():.3g}"]
        return []


def examined(program, seed):
    scene = Scene(seed)
    faults = scene.faults(program)
    return f"{scene.shown}: {getattr(scene, 'found', '')}", faults


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 60))
