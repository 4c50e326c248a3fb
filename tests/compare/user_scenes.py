"""Random scenes of what users draw: shapes, geometries for Gmsh, STEP, regions, names of labels, closed
lines, corners, curves of any kind, bodies that start apart, displacements at t = 0, several contacts and
laws, accuracies, bounds and quantities, in the plane and in space. Walked by user_walk.py."""
import random
from pathlib import Path

from random_choices import LAWS, WideScene
from random_scenes import decades
from tutorial import files as tutorial_files

SCHEMES = ("backward-euler",) * 6 + ("sdirk2", "sdirk2 by error", "backward-euler by error", "crank-nicolson")
SPACE_LAWS = ("elastic", "perzyna", "norton", "maxwell", "standard-solid", "viscoplastic")
PLATE = Path(__file__).resolve().parents[1] / "unit" / "plate.step"
BALL = Path(__file__).resolve().parents[2] / "shared-meshes" / "ball.geo"

CORNER = """\
// A block in the corner of an angle; one side of each is a line that turns.
Point(1) = {0, 0, 0};  Point(2) = {3, 0, 0};  Point(3) = {3, 1, 0};  Point(4) = {1, 1, 0};
Point(5) = {1, 3, 0};  Point(6) = {0, 3, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 5};  Line(5) = {5, 6};
Line(6) = {6, 1};  Curve Loop(1) = {1:6};  Plane Surface(1) = {1};
Point(11) = {1, 1, 0};  Point(12) = {2.5, 1, 0};  Point(13) = {2.5, 2.5, 0};  Point(14) = {1, 2.5, 0};
Line(11) = {11, 12};  Line(12) = {12, 13};  Line(13) = {13, 14};  Line(14) = {14, 11};
Curve Loop(2) = {11:14};  Plane Surface(2) = {2};
Physical Surface("below") = {1};  Physical Surface("above") = {2};
Physical Curve("ground") = {1};  Physical Curve("seat") = {3, 4};  Physical Curve("back") = {6};
Physical Curve("foot") = {11, 14};  Physical Curve("head") = {13};
"""
WAVE = """\
// Two blocks that meet along a spline, the upper one lifted by `apart`.
DefineConstant[ apart = 0 ];
For k In {0:4}
  Point(1+k) = {k/2, 0.1*Sin(2*k), 0};
  Point(11+k) = {k/2, 0.1*Sin(2*k) + apart, 0};
EndFor
Point(21) = {0, -1, 0};  Point(22) = {2, -1, 0};  Point(31) = {0, 1, 0};  Point(32) = {2, 1, 0};
Spline(1) = {1:5};  Spline(2) = {11:15};
Line(3) = {21, 22};  Line(4) = {22, 5};  Line(5) = {1, 21};  Curve Loop(1) = {3, 4, -1, 5};
Line(6) = {15, 32};  Line(7) = {32, 31};  Line(8) = {31, 11};  Curve Loop(2) = {2, 6, 7, 8};
Plane Surface(1) = {1};  Plane Surface(2) = {2};
Physical Surface("below") = {1};  Physical Surface("above") = {2};
Physical Curve("ground") = {3};  Physical Curve("seat") = {1};  Physical Curve("back") = {5};
Physical Curve("foot") = {2};  Physical Curve("head") = {7};
"""
GEOMETRIES = ("stack", "stack", "files", "press", "fit", "fit", "disc", "corner", "wave", "step", "alone")


class UserScene(WideScene):
    """Scene number `seed`: its text, its meshes (as arguments of `mortier mesh`) and its files."""

    def __init__(self, seed):
        self.rng = rng = random.Random(7919 * seed + 3)
        self.geometry = rng.choice(GEOMETRIES)
        self.plane = rng.choice(["stress", "strain", "axisymmetric"])
        if self.plane == "axisymmetric" and self.geometry not in ("stack", "files", "disc", "alone"):
            self.plane = "strain"
        self.degree, self.scheme = rng.choice([1, 2]), rng.choice(SCHEMES)
        self.load, self.end = decades(rng, 0, 3), rng.choice([1, 1, 10, 0.5])
        self.young = self.load * decades(rng, 2, 4)
        self.law = rng.choice(["elastic", "elastic", *LAWS])
        self.one_law = rng.random() < 0.5
        self.ramp = f"(t/{self.end!r})" if self.end != 1 else "t"
        self.rough = self.geometry != "alone" and rng.random() < 0.3
        self.warm = rng.random() < 0.15
        self.apart = rng.random() < 0.3 and self.geometry in ("stack", "disc", "wave", "press")
        self.at_start = rng.random() < 0.25
        self.accuracy = rng.choice(["", "", "energy", "bound", "energy, bound", "quantity"])
        if self.scheme == "crank-nicolson":
            self.accuracy = ""
        # Most of those with a bound can have one.
        self.elastic = ("bound" in self.accuracy or self.accuracy == "quantity") and rng.random() < 0.7
        if self.elastic:
            self.warm, self.rough, self.plane = False, False, "strain" if self.plane != "stress" else "stress"
            self.degree = 1 if self.accuracy == "quantity" or rng.random() < 0.8 else 2
        self.length, self.turned, self.curved, self.moves = 1.0, False, False, "none"
        self.meshes, self.files, self.laws, self.names = {}, {}, set(), []
        self.text = [f'title = "a user\'s scene {seed}"', f'plane = "{self.plane}"',
                     f"degree = {self.degree}", *rng.choice([[], ['units = "mm, N, MPa"']])]
        getattr(self, self.geometry)() if self.geometry != "files" else self.stack(files=True)
        if rng.random() < 0.6 or self.accuracy == "quantity":
            self.measured()
        self.asked()
        self.make_time()
        self.text += ["[output]", f"every = {rng.choice([0, 1])}"]

    def body(self, name, mesh, *boundary, point=(), young=1.0):
        self.names.append(name)
        self.text += ["[[body]]", f'name = "{name}"', f"mesh = {mesh}"]
        self.text.append(self.material(self.young * young))
        self.text += [f"boundary = [{', '.join('{ ' + each + ' }' for each in boundary)}]"]
        if point:
            self.text.append(f"point = [{', '.join('{ ' + each + ' }' for each in point)}]")

    def material(self, young):
        if not self.elastic and (not self.one_law or not self.laws):
            return super().material(young)
        self.laws.add("elastic")
        return f"material = {{ young = {young!r}, poisson = {self.rng.choice([0.2, 0.3, 0.4])} }}"

    def moved(self, size):
        """A displacement downwards, by `size` at the end."""
        start = 0.3 * size if self.at_start else 0
        return self.rng.choice([f'"{-start!r} - {size - start!r}*{self.ramp}"',
                                f"{{ time = [0, {self.end!r}], value = [{-start!r}, {-size!r}] }}"]
                               if not self.at_start or self.rng.random() < 0.7 else [repr(-size)])

    def driven(self, label, apart=0.0, held=""):
        """A label pushed downwards: by a displacement, or by a traction where nothing has to be closed."""
        strain = self.load / self.young
        if self.apart or self.rng.random() < 0.6:
            return f"label = {label}, uy = {self.moved(apart + 2 * strain)}{held}"
        start = "0.2+0.8*" if self.at_start else ""
        return f'label = {label}, ty = "-{self.load!r}*({start}{self.ramp})"{held}'

    def pair(self, first, second, *more):
        rng = self.rng
        variant = rng.choice(["", "", "mortar", "weighted", "interpolation", ""])
        if self.accuracy and variant == "interpolation":
            variant = ""
        sides = [f'{{ body = "{name}", label = {label} }}' for name, label in (first, second)]
        self.text += ["[[contact]]", *more, *([f'variant = "{variant}"'] if variant else [])]
        if rng.random() < 0.6:
            self.text.append(f"sides = [{sides[0]}, {sides[1]}]")
        else:
            self.text += [f"nonmortar = {sides[0]}", f"mortar = {sides[1]}"]
        if self.rough:
            self.text.append(rng.choice([f"friction = {rng.uniform(0.05, 0.8)!r}",
                                         f"shear_limit = {self.load * rng.uniform(0.05, 1)!r}"]))
        self.seen = (*first, *second)

    def stack(self, files=False):
        rng, axis = self.rng, self.plane == "axisymmetric"
        gap = 0.3 * self.load / self.young if self.apart else 0.0
        names, low, left = ["base", "middle", "top"][:rng.choice([2, 2, 3])], 0.0, 0.0
        for i, name in enumerate(names):
            width = 1.0 if i == 0 or rng.random() < 0.5 else rng.uniform(0.5, 1.2)
            cells, high = [rng.randint(2, 6), rng.randint(2, 4)], low + rng.choice([0.5, 1.0])
            mesh = f'{{ shape = "rectangle", cells = {cells}, lower = [{left}, {low!r}], ' \
                   f"upper = [{left + width!r}, {high!r}] }}"
            if files:
                mesh = f'"{name}.mesh"'
                self.meshes[f"{name}.mesh"] = [
                    "crisscross", "--cells", f"{cells[0]},{cells[1]}", f"--lower={left},{low!r}",
                    f"--upper={left + width!r},{high!r}"]
            held = [] if axis else ["label = 4, ux = 0"]
            if i == 0:
                held = ["label = 1, uy = 0" + ("" if axis else ", ux = 0")]
            if i == len(names) - 1:
                held.append(self.driven(3, gap))
            self.body(name, mesh, *held, young=1 if i == 0 else decades(rng, -1, 1))
            low = high + (gap if i == len(names) - 2 else 0)
        for lower, upper in zip(names, names[1:]):
            self.pair((upper, 1), (lower, 3))

    def press(self):
        text = tutorial_files()["press.geo"]
        if self.apart:
            text += "Translate {0, 0.01, 0} { Surface{1}; }\n"
        self.files["press.geo"] = text
        mesh = '{{ file = "press.geo", region = "{}", size = 4 }}'
        self.body("punch", mesh.format("punch"), self.driven('"top"', 0.01 if self.apart else 0, ", ux = 0"))
        self.body("block", mesh.format("block"), 'label = "floor", ux = 0, uy = 0')
        self.pair(("punch", '"foot"'), ("block", '"surface"'))

    def fit(self):
        rng = self.rng
        span = rng.choice(["quarter", "half", "full", "full"])
        turns = {"quarter": 1, "half": 2, "full": 4}[span]
        supports = {"quarter": ["label = 3, uy = 0", "label = 4, ux = 0"],
                    "half": ["label = 3, uy = 0", "label = 4, uy = 0"], "full": []}[span]
        for name, inner, outer in (("ring", 1.0, 2.0), ("tube", 2.0, 3.0)):
            cells = [turns * rng.randint(3, 5), 2]
            point = {"quarter": [], "half": [f"at = [{outer}, 0], ux = 0"] if name == "tube" else
                     [f"at = [{inner}, 0], ux = 0"],
                     "full": [f"at = [{inner}, 0], uy = 0", f"at = [{-inner}, 0], uy = 0",
                              f"at = [0, {inner}], ux = 0"]}[span]
            loads = [f'label = 1, pressure = "{self.load!r}*{self.ramp}"'] if name == "ring" else []
            self.body(name, f'{{ shape = "annulus", inner = {inner}, outer = {outer}, span = "{span}", '
                      f"cells = {cells} }}", *supports, *loads, point=point)
        gap = rng.choice([[], [f'gap = "{-self.load / self.young!r}*{self.ramp}"']])
        self.pair(("ring", 2), ("tube", 1), *gap)

    def disc(self):
        axis, gap = self.plane == "axisymmetric", 0.5 * self.load / self.young if self.apart else 0
        left = 0 if axis else -2
        self.body("ground", f'{{ shape = "rectangle", cells = [{4 if axis else 8}, 4], lower = [{left}, -2], '
                  "upper = [2, 0], focus = [0, 0], grading = 8 }", "label = 1, uy = 0" +
                  ("" if axis else ", ux = 0"))
        held = "" if axis else ", ux = 0"
        self.body("wheel", f'{{ shape = "{"quarter" if axis else "half"}disc", cells = 3, radius = 3, '
                  f"core = 0.8, lowest = [0, {gap!r}] }}",
                  f"label = 2, uy = {self.moved(gap + 0.03)}{held}")
        self.pair(("wheel", 1), ("ground", 3))

    def parts(self, name, text, parameters=""):
        self.files[name] = text
        def mesh(region):
            return f'{{ file = "{name}", region = "{region}", size = 0.5{parameters} }}'
        self.body("angle", mesh("below"), 'label = "ground", ux = 0, uy = 0', 'label = "back", ux = 0')
        head = '"head"' + (", ux = 0" if self.geometry == "wave" else f', tx = "-{0.3 * self.load!r}*t"')
        apart = 0.3 * self.load / self.young if self.apart else 0
        self.body("piece", mesh("above"), f"label = {head}, uy = {self.moved(apart + 2e-3)}")
        self.pair(("piece", '"foot"'), ("angle", '"seat"'))

    def corner(self):
        self.parts("corner.geo", CORNER)

    def wave(self):
        apart = 0.3 * self.load / self.young if self.apart else 0
        self.parts("wave.geo", WAVE, f", parameters = {{ apart = {apart!r} }}")

    def step(self):
        self.files["plate.step"] = PLATE.read_text()
        self.body("plate", '{ file = "plate.step", size = 3 }', "label = 1, uy = 0, ux = 0")
        self.body("weight", '{ shape = "rectangle", cells = [4, 2], lower = [5, 10], upper = [15, 14] }',
                  self.driven(3, held=", ux = 0"))
        self.pair(("weight", 1), ("plate", 3))

    def alone(self):
        """One body, with regions of different laws or an initial stress."""
        self.body("beam", '{ shape = "rectangle", cells = [6, 2], lower = [0, 0], upper = [3, 1] }',
                  "label = 1, uy = 0" + ("" if self.plane == "axisymmetric" else ", ux = 0"), self.driven(3))
        if self.rng.random() < 0.4:
            self.text.append(f'initial_stress = {{ s11 = "{-0.1 * self.load!r}*y" }}')

    def measured(self):
        kinds = [f'{kind} = {{ body = "{self.names[-1]}" }}' for kind in
                 ("stored_energy", "work", "largest_mises", "dissipated_energy")]
        if self.geometry != "alone":
            body, label = self.seen[:2]
            side = f'{{ body = "{body}", label = {label} }}'
            kinds += [f"{kind} = {side}" for kind in ("largest_pressure", "contact_length", "mean_pressure")]
            kinds += [f'contact_force = {side}\ncomponent = "{axis}"' for axis in "xy"]
            kinds += [f'displacement = {side}\ncomponent = "y"']
        goal = self.accuracy == "quantity" and self.geometry != "alone"
        picked = self.rng.sample(kinds[-3:] if goal else kinds, 2)
        for number, line in enumerate(picked):
            self.text += ["[[quantity]]", f'name = "q{number}"', line]

    def asked(self):
        lines = {"energy": ["energy = 0.3"], "bound": ["bound = true"], "quantity":
                 ['quantity = "q0"', "tolerance = 0.2"], "energy, bound": ["energy = 0.3", "bound = true"]}
        if self.accuracy:
            self.text += ["[accuracy]", *lines[self.accuracy]]
            self.text += ["max_unknowns = 20000"] if self.accuracy != "bound" else []

    def make_time(self):
        self.text += ["[time]", f"end = {self.end!r}", f'scheme = "{self.scheme.split()[0]}"']
        self.text.append("tolerance = 0.05" if "error" in self.scheme else
                         f"steps = {self.rng.choice([1, 3, 5])}")


class UserSpaceScene(UserScene):
    """The same in space: stacks of cuboids, some apart, a ball on a block, one body."""

    def __init__(self, seed):
        self.rng = rng = random.Random(104729 * seed + 11)
        self.geometry = rng.choice(("stack", "stack", "ball", "alone"))
        self.plane, self.degree = "space", rng.choice([1, 2])
        self.scheme = rng.choice([each for each in SCHEMES if "error" not in each])
        self.load, self.end = decades(rng, 0, 3), rng.choice([1, 1, 10, 0.5])
        self.young = self.load * decades(rng, 2, 4)
        self.law, self.one_law = rng.choice(["elastic", *SPACE_LAWS]), True
        self.ramp = f"(t/{self.end!r})" if self.end != 1 else "t"
        self.rough, self.warm, self.elastic, self.turned, self.length = False, False, False, False, 1.0
        self.apart = rng.random() < 0.3 and self.geometry == "stack"
        self.at_start = rng.random() < 0.25
        self.accuracy = rng.choice(["", "", "energy"]) if self.geometry != "ball" else ""
        self.meshes, self.files, self.laws, self.names = {}, {}, set(), []
        self.text = [f'title = "a user\'s scene in space {seed}"', "dimension = 3", f"degree = {self.degree}",
                     *rng.choice([[], ['units = "mm, N, MPa"']])]
        getattr(self, self.geometry)()
        if rng.random() < 0.6:
            self.measured()
        self.asked()
        self.make_time()
        self.text += ["[output]", f"every = {rng.choice([0, 1])}"]

    def driven(self, label, apart=0.0, held=""):
        return super().driven(label, apart, held).replace("uy = ", "uz = ").replace("ty = ", "tz = ")

    def stack(self, files=False):
        rng, low = self.rng, 0.0
        gap = 0.3 * self.load / self.young if self.apart else 0.0
        names = ["base", "middle", "top"][:rng.choice([2, 2, 3])]
        for i, name in enumerate(names):
            width = 1.0 if i == 0 or rng.random() < 0.5 else rng.uniform(0.5, 1.2)
            high = low + rng.choice([0.5, 1.0])
            mesh = f'{{ shape = "cuboid", cells = {[rng.randint(2, 4) for _ in range(3)]}, ' \
                   f"lower = [0, 0, {low!r}], upper = [{width!r}, 1, {high!r}] }}"
            held = ['label = "left", ux = 0', 'label = "front", uy = 0']
            if i == 0:
                held = ['label = "bottom", ux = 0, uy = 0, uz = 0']
            if i == len(names) - 1:
                held.append(self.driven('"top"', gap))
            self.body(name, mesh, *held, young=1 if i == 0 else decades(rng, -1, 1))
            low = high + (gap if i == len(names) - 2 else 0)
        for lower, upper in zip(names, names[1:]):
            self.pair((upper, '"bottom"'), (lower, '"top"'))

    def ball(self):
        self.files["ball.geo"] = BALL.read_text()
        size = self.rng.choice([0.05, 0.1])
        self.body("ball", f'{{ file = "ball.geo", parameters = {{ f = {size}, h = 0.3 }} }}',
                  'label = "left", ux = 0', 'label = "front", uy = 0',
                  f'label = "top", uz = {self.moved(0.02)}')
        self.body("block", '{ shape = "cuboid", cells = 4, lower = [0, 0, -1], upper = [1, 1, 0] }',
                  'label = "bottom", ux = 0, uy = 0, uz = 0', 'label = "left", ux = 0',
                  'label = "front", uy = 0')
        self.pair(("ball", '"arc"'), ("block", '"top"'))

    def alone(self):
        self.body("beam", '{ shape = "cuboid", cells = [6, 2, 2], lower = [0, 0, 0], upper = [3, 1, 1] }',
                  'label = "bottom", ux = 0, uy = 0, uz = 0', self.driven('"top"'))

    def material(self, young):
        text = super().material(young)
        while any(each not in SPACE_LAWS for each in self.laws):
            self.laws = {each for each in self.laws if each in SPACE_LAWS}
            text = super().material(young)
        return text

    def measured(self):
        kinds = [f'{kind} = {{ body = "{self.names[-1]}" }}' for kind in
                 ("stored_energy", "work", "largest_mises", "dissipated_energy")]
        if self.geometry != "alone":
            side = f'{{ body = "{self.seen[0]}", label = {self.seen[1]} }}'
            kinds += [f"largest_pressure = {side}", f'contact_force = {side}\ncomponent = "z"',
                      f'displacement = {side}\ncomponent = "z"']
        for number, line in enumerate(self.rng.sample(kinds, 2)):
            self.text += ["[[quantity]]", f'name = "q{number}"', line]
