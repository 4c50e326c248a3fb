"""mortier check: each fault that it knows, seeded into a sound scene, is named with its place and its remedy; sound
scenes pass in silence. Run alone: MORTIER=build/mortier /usr/bin/python3 tests/compare/check_test.py -v"""
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import support

PROGRAM = os.path.abspath(os.environ["MORTIER"])

SCENE = """\
[[body]]
name = "upper"
mesh = "upper.mesh"
material = { young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1 }
[[body.boundary]]
label = 4
ux = 0
[[body.boundary]]
label = 3
ty = "-10*t"

[[body]]
name = "lower"
mesh = "lower.mesh"
material = { young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1 }
[[body.boundary]]
label = 4
ux = 0
[[body.boundary]]
label = 1
uy = 0

[contact]
nonmortar = { body = "upper", label = 1 }
mortar = { body = "lower", label = 3 }

[time]
end = 1
steps = 100
"""
ELASTIC = SCENE.replace(", viscosity = 10, yield_stress = 1", "").replace('"-10*t"', "-10").replace("100", "1")


class Mesh:
    """A rectangle of nx x ny cells cut by both diagonals; labels 1 bottom, 2 right, 3 top, 4 left."""

    def __init__(self, x0, y0, x1, y1, nx, ny):
        self.vertices, self.triangles, self.edges = [], [], []
        at = {}
        for j in range(ny + 1):
            for i in range(nx + 1):
                at[i, j] = self.vertex(x0 + (x1 - x0) * i / nx, y0 + (y1 - y0) * j / ny)
        for j in range(ny):
            for i in range(nx):
                corners = [at[i, j], at[i + 1, j], at[i + 1, j + 1], at[i, j + 1]]
                centre = self.vertex(x0 + (x1 - x0) * (i + 0.5) / nx, y0 + (y1 - y0) * (j + 0.5) / ny)
                for k in range(4):
                    self.triangles.append([corners[k], corners[(k + 1) % 4], centre, 1])
        for i in range(nx):
            self.edges += [[at[i, 0], at[i + 1, 0], 1], [at[i + 1, ny], at[i, ny], 3]]
        for j in range(ny):
            self.edges += [[at[nx, j], at[nx, j + 1], 2], [at[0, j + 1], at[0, j], 4]]

    def vertex(self, x, y):
        self.vertices.append([x, y])
        return len(self.vertices)

    def add(self, other):
        """Another mesh beside this one, as a part of it."""
        shift = len(self.vertices)
        self.vertices += other.vertices
        self.triangles += [[a + shift, b + shift, c + shift, r] for a, b, c, r in other.triangles]
        self.edges += [[a + shift, b + shift, label] for a, b, label in other.edges]

    def move(self, function):
        self.vertices = [list(function(x, y)) for x, y in self.vertices]

    def relabel(self, function):
        """function(x, y, label) of the middle of each labelled edge."""
        for edge in self.edges:
            (xa, ya), (xb, yb) = self.vertices[edge[0] - 1], self.vertices[edge[1] - 1]
            edge[2] = function((xa + xb) / 2, (ya + yb) / 2, edge[2])

    def write(self, path):
        lines = ["MeshVersionFormatted 2", "Dimension 2", "Vertices", str(len(self.vertices))]
        lines += [f"{x!r} {y!r} 0" for x, y in self.vertices]
        lines += ["Edges", str(len(self.edges))] + [" ".join(map(str, e)) for e in self.edges]
        lines += ["Triangles", str(len(self.triangles))] + [" ".join(map(str, t)) for t in self.triangles]
        path.write_text("\n".join(lines + ["End", ""]))


class Case:
    def __init__(self, scene=SCENE):
        self.scene = scene
        self.upper = Mesh(0, 0, 1, 1, 6, 6)
        self.lower = Mesh(0, -1, 1, 0, 8, 8)
        self.raw = {}

    def replace(self, old, new, count=1):
        assert old in self.scene, old
        self.scene = self.scene.replace(old, new, count)

    def write(self, folder):
        (folder / "scene.toml").write_text(self.scene)
        self.upper.write(folder / "upper.mesh")
        self.lower.write(folder / "lower.mesh")
        for name, text in self.raw.items():
            (folder / name).write_text(text)

    def line(self, text):
        """Where the scene says it first."""
        return f"scene.toml:{self.scene[:self.scene.index(text)].count(chr(10)) + 1}"


FAULTS = []


def fault(identifier, place, scene=SCENE):
    """Declares a seeded fault: what to name, and where (a line that holds the text, or the place itself)."""
    def declare(seed):
        FAULTS.append((identifier, place, scene, seed))
        return seed
    return declare


# The file.
@fault("scene", "scene.toml:4")
def _(case):
    case.replace("poisson = 0.3", "poisson = 0.6")


@fault("scene", "step = 100")
def _(case):
    case.replace("steps = 100", "step = 100")


@fault("same-body", "scene.toml:25")
def _(case):
    case.replace('body = "lower", label = 3', 'body = "upper", label = 3')


@fault("allow-unknown", "allow = ")
def _(case):
    case.scene += '[check]\nallow = ["slivers"]\n'


@fault("data", "ux = \"1 + x\"")
def _(case):
    case.replace("uy = 0", "uy = \"x\"\nux = \"1 + x\"")


@fault("data", 'ty = "')
def _(case):
    case.replace("-10*t", "-10*t/x")


# Meshes that cannot be used.
@fault("mesh-file", "upper.mesh:1")
def _(case):
    case.raw["upper.mesh"] = "solid cube\n"


@fault("clockwise-triangle", "upper.mesh:")
def _(case):
    t = case.upper.triangles[3]
    t[0], t[1] = t[1], t[0]


@fault("degenerate-triangle", "upper.mesh:")
def _(case):
    a, b, c, _ = case.upper.triangles[0]
    (xa, ya), (xb, yb) = case.upper.vertices[a - 1], case.upper.vertices[b - 1]
    case.upper.vertices[c - 1] = [(xa + xb) / 2, (ya + yb) / 2]


@fault("repeated-triangle", "upper.mesh:")
def _(case):
    case.upper.triangles.append(case.upper.triangles[5])


@fault("unused-vertex", "upper.mesh:")
def _(case):
    case.upper.vertex(0.5, 0.5)


@fault("overlapping-triangles", "upper.mesh:")
def _(case):
    a, b, c, r = case.upper.triangles[20]
    case.upper.triangles.append([a, b, case.upper.vertex(0.45, 0.9), r])


@fault("label-inside", "upper.mesh:")
def _(case):
    a, _, c, _ = case.upper.triangles[0]
    case.upper.edges.append([a, c, 5])


@fault("label-twice", "upper.mesh:")
def _(case):
    case.upper.edges.append(case.upper.edges[0][:2] + [5])


# Meshes that are doubtful.
@fault("mesh-parts", "upper.mesh: triangle")
def _(case):
    case.upper.add(Mesh(2, 0, 2.2, 0.2, 2, 2))
    case.upper.relabel(lambda x, y, label: label if x <= 1 else 7)


@fault("duplicate-node", "upper.mesh: vertex")
def _(case):
    other = Mesh(1, 1, 1.5, 1.5, 3, 3)
    other.relabel(lambda x, y, label: 7)
    case.upper.add(other)


def cut(mesh, keep=lambda x, y: False):
    """Doubles the vertices of the line y = 1/2 for the triangles above it."""
    double = {}
    for v, (x, y) in enumerate(list(mesh.vertices), 1):
        if abs(y - 0.5) < 1e-12 and not keep(x, y) and any(
                v in t[:3] and mesh.vertices[t[2] - 1][1] > 0.5 for t in mesh.triangles):
            double[v] = mesh.vertex(x, y)
    for t in mesh.triangles:
        if mesh.vertices[t[2] - 1][1] > 0.5:
            t[:3] = [double.get(v, v) for v in t[:3]]
    for e in mesh.edges:
        if sum(mesh.vertices[v - 1][1] for v in e[:2]) > 1:
            e[:2] = [double.get(v, v) for v in e[:2]]


@fault("crack", "upper.mesh: vertex")
def _(case):
    cut(case.upper, keep=lambda x, y: x < 0.4)


@fault("hanging-node", "upper.mesh: vertex")
def _(case):
    other = Mesh(1, 0, 2, 1, 4, 9)
    other.relabel(lambda x, y, label: 7)
    case.upper.edges = [e for e in case.upper.edges if e[2] != 2]
    case.upper.add(other)


@fault("mesh-overlaps-itself", "upper.mesh: triangle")
def _(case):
    other = Mesh(0.9, 0.55, 1.7, 0.95, 3, 3)
    other.relabel(lambda x, y, label: 7)
    case.upper.add(other)


@fault("sliver", "upper.mesh: triangle")
def _(case):
    case.upper.vertices[case.upper.triangles[60][2] - 1][1] -= 0.0825


@fault("size-jump", "upper.mesh: triangle")
def _(case):
    case.upper.vertices[case.upper.triangles[60][2] - 1][1] -= 0.083


@fault("mesh-coarse", "lower.mesh")
def _(case):
    case.lower = Mesh(0, -1, 1, 0, 1, 1)


@fault("far-from-origin", "upper.mesh")
def _(case):
    for mesh in (case.upper, case.lower):
        mesh.move(lambda x, y: (x + 4194304, y))


# Labels.
@fault("missing-label", "scene.toml:10")
def _(case):
    case.replace("label = 3\n", "label = 33\n")


@fault("missing-label", "scene.toml:25")
def _(case):
    case.replace('body = "lower", label = 3', 'body = "lower", label = 9')


@fault("label-interrupted", "upper.mesh: edge from vertex")
def _(case):
    case.upper.relabel(lambda x, y, label: 8 if y == 1 and 0.4 < x < 0.6 else label)


@fault("label-interrupted", "lower.mesh: edge from vertex")
def _(case):
    case.lower.edges = [e for e in case.lower.edges if not (e[2] == 1 and e[0] in (3, 4))]


@fault("unused-label", "upper.mesh: edge from vertex")
def _(case):
    case.upper.relabel(lambda x, y, label: 8 if y == 1 and x > 0.5 else label)


@fault("stray-label", "upper.mesh: label 8")
def _(case):
    case.upper = Mesh(0, 0, 1, 1, 20, 20)
    case.upper.relabel(lambda x, y, label: 8 if x == 1 and 0.5 < y < 0.55 else label)


@fault("locked-triangle", "lower.mesh: triangle")
def _(case):
    case.replace("uy = 0", "uy = 0\nux = 0")
    case.replace("label = 4\nux = 0", "label = 4\nux = 0\nuy = 0", 2)
    corner = case.lower.vertices.index([0, -1]) + 1
    a, b = [t for t in case.lower.triangles if corner in t[:3]]
    centre = a[2]
    case.lower.vertices[centre - 1] = [0.09, -0.91]
    right, up = case.lower.vertices.index([0.125, -1]) + 1, case.lower.vertices.index([0, -0.875]) + 1
    case.lower.triangles.remove(a)
    case.lower.triangles.remove(b)
    case.lower.triangles += [[corner, right, up, 1], [right, centre, up, 1]]


@fault("regions-unused", "mesh = \"upper.mesh\"")
def _(case):
    for t in case.upper.triangles[:40]:
        t[3] = 2


# Bodies.
@fault("extent-ratio", "mesh = \"upper.mesh\"")
def _(case):
    case.lower.move(lambda x, y: (1000 * x, 1000 * y))


@fault("stiffness-ratio", "scene.toml:4")
def _(case):
    case.replace("young = 3e11", "young = 3e8")


@fault("same-mesh", "scene.toml:14")
def _(case):
    case.replace("lower.mesh", "upper.mesh")
    case.replace("label = 3 }", "label = 1 }")


@fault("bodies-overlap", ".mesh: vertex")
def _(case):
    case.scene = case.scene[:case.scene.index("[contact]")] + case.scene[case.scene.index("[time]"):]
    case.replace("label = 4\nux = 0", "label = 4\nux = 0\nuy = 0")
    case.upper.move(lambda x, y: (x, y - 0.4))


@fault("contact-missing", ".mesh: vertex")
def _(case):
    case.scene = case.scene[:case.scene.index("[contact]")] + case.scene[case.scene.index("[time]"):]
    case.replace("label = 4\nux = 0", "label = 4\nux = 0\nuy = 0")


THIRD = """\
[[body]]
name = "third"
mesh = "third.mesh"
material = { young = 3e11, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = 0 } ]

"""


@fault("body-alone", "[[body]]\nname = \"third\"")
def _(case):
    case.replace("[contact]", THIRD + "[contact]")


@fault("unheld-body", "scene.toml")
def _(case):
    case.replace("label = 4\nux = 0", "label = 4\nty = 0")


@fault("unheld-body", "scene.toml")
def _(case):
    case.replace("uy = 0", "tx = 0")


# Contact.
@fault("contact-line", "scene.toml:24")
def _(case):
    case.upper.relabel(lambda x, y, label: 5 if y == 0 and 0.3 < x < 0.6 else label)


@fault("contact-labels-swapped", "[contact]")
def _(case):
    case.replace('body = "upper", label = 1', 'body = "upper", label = 3')
    case.replace('body = "lower", label = 3', 'body = "lower", label = 1')


@fault("contact-normals", "[contact]")
def _(case):
    case.replace('body = "lower", label = 3', 'body = "lower", label = 1')


@fault("contact-not-facing", "[contact]")
def _(case):
    case.replace('body = "lower", label = 3', 'body = "lower", label = 2')


@fault("contact-no-overlap", "[contact]")
def _(case):
    case.lower.move(lambda x, y: (x + 1.5, y))


@fault("contact-penetration", "[contact]")
def _(case):
    case.lower.move(lambda x, y: (x, y + 0.05))


@fault("contact-overlap", "[contact]")
def _(case):
    case.lower.move(lambda x, y: (x + 0.8, y))


@fault("gap-large", "[contact]")
def _(case):
    case.lower.move(lambda x, y: (x, y - 5))


@fault("contact-side-twice", "mortar = { body = \"upper\", label = 1 }\nnonmortar")
def _(case):
    third = Mesh(1.5, -1, 2.5, 0, 8, 8)
    case.third = third
    case.replace("[contact]", THIRD.replace("label = 1", "label = 2") + "[[contact]]")
    case.upper.move(lambda x, y: (2.5 * x, y))
    case.replace("[time]", "[[contact]]\nmortar = { body = \"upper\", label = 1 }\n"
                           "nonmortar = { body = \"third\", label = 3 }\n\n[time]")


@fault("contact-one-edge", "scene.toml:24")
def _(case):
    case.upper = Mesh(0, 0, 1, 1, 1, 6)


@fault("contact-size-ratio", "[contact]")
def _(case):
    case.lower = Mesh(0, -1, 1, 0, 70, 20)


@fault("nonmortar-coarser", "scene.toml:24")
def _(case):
    case.lower = Mesh(0, -1, 1, 0, 32, 16)


@fault("nonmortar-stiffer", "scene.toml:24")
def _(case):
    case.replace("young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1 }\n[[body.boundary]]\nlabel = 4\nux = 0\n[[body.boundary]]\nlabel = 1",
                 "young = 2e9, poisson = 0.3, viscosity = 10, yield_stress = 1 }\n[[body.boundary]]\nlabel = 4\nux = 0\n[[body.boundary]]\nlabel = 1")


@fault("interpolation-unmatched", "[contact]")
def _(case):
    case.replace("label = 3 }\n", "label = 3 }\nvariant = \"interpolation\"\n")
    case.replace("steps = 100", "steps = 101")


@fault("load-on-contact", "scene.toml:10")
def _(case):
    case.replace("label = 4\nux = 0\n", "label = 4\nux = 0\n[[body.boundary]]\nlabel = 1\nty = \"-t\"\n")


@fault("support-on-contact", "scene.toml:10")
def _(case):
    case.replace("label = 4\nux = 0\n", "label = 4\nux = 0\n[[body.boundary]]\nlabel = 1\nux = 0\n")


@fault("contact-meets-support", "scene.toml:8")
def _(case):
    case.replace("ux = 0", "ux = 0\nuy = 0")
    case.replace("label = 3 }\n", "label = 3 }\nvariant = \"interpolation\"\n")


# Materials.
@fault("poisson-limit", "poisson = 0.4999")
def _(case):
    case.replace("poisson = 0.3", "poisson = 0.4999")


@fault("poisson-negative", "poisson = -0.3")
def _(case):
    case.replace("poisson = 0.3", "poisson = -0.3")


@fault("projection-unused", "projection = ", ELASTIC)
def _(case):
    case.replace("poisson = 0.3", "poisson = 0.3, projection = \"elasticity\"")


@fault("large-strain", "young = 70", ELASTIC)
def _(case):
    case.replace("young = 3e11", "young = 70", 2)


@fault("yield-over-young", "yield_stress = 2e11")
def _(case):
    case.replace("yield_stress = 1", "yield_stress = 2e11")


@fault("never-yields", "yield_stress = 1e6")
def _(case):
    case.replace("yield_stress = 1", "yield_stress = 1e6")


@fault("yields-at-once", "steps = ")
def _(case):
    case.replace("-10*t", "-1000*t")


@fault("few-steps-across-yield", "steps = ")
def _(case):
    case.replace("steps = 100", "steps = 5")


@fault("viscosity-large", "viscosity = 1e16")
def _(case):
    case.replace("viscosity = 10", "viscosity = 1e16")


@fault("viscosity-small", "viscosity = 1e-6")
def _(case):
    case.replace("viscosity = 10", "viscosity = 1e-6")


@fault("lands-on-yield", "steps = ")
def _(case):
    case.replace("label = 3 }\n", "label = 3 }\nvariant = \"interpolation\"\n")
    case.lower = Mesh(0, -1, 1, 0, 6, 6)


@fault("scheme-rings", "scheme = ")
def _(case):
    case.scene += 'scheme = "crank-nicolson"\n'


# Loads.
@fault("no-load", "scene.toml:1")
def _(case):
    case.replace("\"-10*t\"", "0")


@fault("large-displacement", "uy = \"0.7*t\"")
def _(case):
    case.replace("uy = 0", "uy = \"0.7*t\"")


@fault("initial-displacement", "uy = 0.01")
def _(case):
    case.replace("uy = 0", "uy = 0.01")


@fault("initial-load", 'ty = "')
def _(case):
    case.replace("-10*t", "-5-5*t")


@fault("load-on-support", "scene.toml:7")
def _(case):
    """Supports on the last edges to the left and right of one that carries a traction."""
    case.replace("[[body.boundary]]\nlabel = 4", "[[body.boundary]]\nlabel = 6\ntx = \"t\"\n"
                 "[[body.boundary]]\nlabel = 7\nux = 0\n[[body.boundary]]\nlabel = 4")
    case.upper.relabel(lambda x, y, label: label if y < 1 or not 0.3 < x < 0.9 else 6 if 0.5 < x < 0.66 else 7)


@fault("kink-between-steps", 'ty = "')
def _(case):
    case.replace("-10*t", "t < 0.123 ? -10*t : -1.23")


@fault("kink-after-end", 'ty = "')
def _(case):
    case.replace("-10*t", "t <= 2 ? -10*t : -20")


@fault("constant-loads", "steps = ", ELASTIC)
def _(case):
    case.replace("steps = 1", "steps = 50")


# Options.
@fault("output-every", "every = ")
def _(case):
    case.scene += "[output]\nevery = 200\n"


@fault("output-large", "every = ")
def _(case):
    case.scene += "[output]\nevery = 1\n"
    case.replace("steps = 100", "steps = 100000")


@fault("tolerance-loose", "tolerance = ")
def _(case):
    case.scene += "[solver]\ntolerance = 1e-3\n"


@fault("tolerance-tight", "tolerance = ")
def _(case):
    case.scene += "[solver]\ntolerance = 1e-16\n"


@fault("iterations-few", "max_iterations = ")
def _(case):
    case.scene += "[solver]\nmax_iterations = 5\n"


def check(scene, *options):
    done = subprocess.run([PROGRAM, "check", str(scene), *options], capture_output=True, text=True, timeout=60)
    return done


def run(case, folder):
    folder = Path(folder)
    case.write(folder)
    getattr(case, "third", Mesh(5, -1, 6, 0, 8, 8)).write(folder / "third.mesh")
    done = check(folder / "scene.toml", "--json")
    return done.returncode, json.loads(done.stdout)


def catalogue():
    return json.loads(subprocess.run([PROGRAM, "check", "--list", "--json"], capture_output=True, text=True,
                                     check=True).stdout)


class Check(unittest.TestCase):
    def test_sound_scenes_are_silent(self):
        for scene in (SCENE, ELASTIC):
            with tempfile.TemporaryDirectory() as folder:
                status, report = run(Case(scene), folder)
                self.assertEqual((status, report["faults"]), (0, []))

    def test_shipped_scenes_are_silent(self):
        scenes = sorted((support.ROOT / "scenes").glob("*.toml"))
        self.assertTrue(scenes)
        for scene in scenes:
            with self.subTest(scene=scene.name):
                done = check(scene, "--json")
                self.assertEqual((done.returncode, json.loads(done.stdout)["faults"]), (0, []))

    def test_each_seeded_fault_is_named(self):
        kinds = {kind["id"]: kind for kind in catalogue()}
        exit_codes = {"warning": 0, "error": 2}
        for identifier, place, scene, seed in FAULTS:
            with self.subTest(fault=identifier), tempfile.TemporaryDirectory() as folder:
                case = Case(scene)
                seed(case)
                status, report = run(case, folder)
                named = [f for f in report["faults"] if f["id"] == identifier]
                self.assertTrue(named, f"{identifier} is not among {json.dumps(report['faults'], indent=1)}")
                literal = place.startswith("scene.toml") or re.match(r"\w*\.mesh", place)
                expected = place if literal else case.line(place)
                self.assertTrue(any(expected in f["place"] for f in named), f"expected {expected}: {named}")
                self.assertEqual(named[0]["remedy"], kinds[identifier]["remedy"])
                self.assertEqual(named[0]["severity"], kinds[identifier]["severity"])
                if identifier == "unheld-body":
                    self.assertEqual(status, 3)
                elif not any(f["severity"] == "error" for f in report["faults"]):
                    self.assertEqual(status, 0)
                else:
                    self.assertEqual(status, 2)
                    self.assertEqual(exit_codes[named[0]["severity"]] == 2, named[0]["severity"] == "error")

    def test_every_kind_is_seeded(self):
        seeded = {identifier for identifier, *_ in FAULTS}
        self.assertEqual(seeded, {kind["id"] for kind in catalogue()})
        self.assertGreaterEqual(len(seeded), 40)

    def test_errors_are_those_of_run(self):
        """What check calls an error a run refuses with the same exit code; what it lets pass, a run begins."""
        severities = {kind["id"]: kind["severity"] for kind in catalogue()}
        for identifier, _, scene, seed in FAULTS:
            with self.subTest(fault=identifier), tempfile.TemporaryDirectory() as folder:
                case = Case(scene)
                seed(case)
                status, _ = run(case, folder)
                if severities[identifier] != "error":
                    continue
                done = subprocess.run([PROGRAM, "run", "scene.toml", "--quiet"], cwd=folder, capture_output=True,
                                      text=True, timeout=60)
                self.assertEqual(done.returncode, status, done.stderr)

    def test_allowed_faults_are_not_named(self):
        case = Case()
        case.replace("steps = 100", "steps = 5")
        case.scene += '[check]\nallow = ["few-steps-across-yield"]\n'
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(run(case, folder)[1]["faults"], [])

    def test_text_has_a_line_per_fault(self):
        case = Case()
        case.replace("steps = 100", "steps = 5")
        with tempfile.TemporaryDirectory() as folder:
            run(case, folder)
            done = check(Path(folder) / "scene.toml")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"scene\.toml:29: warning: body upper: .*; take more steps, or scheme = "
                                      r"\"sdirk2\" \[few-steps-across-yield\]\n")
        self.assertIn("modelled   body upper: ", done.stdout)
        self.assertIn("left out   scene: inertia", done.stdout)
        self.assertRegex(done.stdout, r"0 errors, \d+ warnings?\n$")

    def test_documentation_lists_every_fault(self):
        text = (support.ROOT / "docs" / "check.md").read_text()
        rows = re.findall(r"^\| `([a-z-]+)` \| (\w+) \| (.*?) \| (.*?) \|$", text, re.M)
        self.assertEqual(rows, [(k["id"], k["severity"], k["what"], k["remedy"]) for k in catalogue()])

    def test_plan(self):
        def plan(case, *settings):
            with tempfile.TemporaryDirectory() as folder:
                case.write(Path(folder))
                done = check(Path(folder) / "scene.toml", "--json", *settings)
            return [(item["part"], item["modelled"], item["what"], item["why"]) for item in json.loads(done.stdout)["plan"]]

        viscoplastic = plan(Case(), "--set", "body.upper.material.projection=elasticity")
        self.assertIn(("body upper", True, "LU in every iteration",
                       "projection elasticity makes its tangent unsymmetric where it flows"), viscoplastic)
        self.assertIn(("body lower", True, "Cholesky in every iteration",
                       "projection frobenius makes its tangent symmetric"), viscoplastic)
        strong = plan(Case(), "--set", "body.material.yield_stress=15")
        self.assertTrue(any(part == "body upper" and not modelled and what.startswith("flow")
                            for part, modelled, what, _ in strong))
        elastic = plan(Case(ELASTIC), "--set", "time.steps=50")
        self.assertIn(("body upper", True, "linear: one Cholesky factor for the whole run", "it is elastic"), elastic)


if __name__ == "__main__":
    unittest.main()
