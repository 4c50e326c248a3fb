"""Random scenes of what random_scenes.py leaves out: every law, axes, temperature, friction, round bodies,
bodies of revolution, degree 2, distances that change, quantities and accuracies; bodies in space. Run by
random_scenes.py."""
import math
import random

from random_scenes import decades

LAWS = ("elastic", "axes", "perzyna", "norton", "maxwell", "standard-solid", "viscoplastic", "expression")
SCHEMES = ("backward-euler", "backward-euler", "sdirk2", "crank-nicolson", "sdirk2 by error",
           "backward-euler by error")


class WideScene:
    """Scene number `seed`: its text and its meshes (as arguments of `mortier mesh`).

    The same problem in other words, for random_equalities.py: with stresses, lengths and times multiplied
    by the factors `units`; with x and y turned by a right angle (the meshes have to be turned, too); with
    the bodies in the reverse order."""

    PLANES = ("stress", "strain", "axisymmetric")
    REFINED = 0.1  # of all scenes

    def __init__(self, seed, units=(1.0, 1.0, 1.0), turned=False, exchanged=False):
        stress, self.length, time = units
        self.turned = turned
        self.rng = rng = random.Random(1000003 * seed + 17)
        self.plane = rng.choice(self.PLANES)
        self.degree = rng.choice([1, 1, 2])
        self.scheme = rng.choice(SCHEMES)
        self.load, self.end = decades(rng, -2, 8) * stress, decades(rng, -1, 2) * time
        self.young = self.load * decades(rng, 1.5, 7)
        self.law = rng.choice(LAWS)
        self.ramp = f"(t/{self.end!r})"
        bodies = rng.choice([1, 2, 2, 2, 3])
        self.rough = bodies > 1 and rng.random() < 0.35 and self.plane != "space"
        self.warm = rng.random() < 0.25
        self.accuracy = rng.random() < self.REFINED and self.scheme != "crank-nicolson"
        self.meshes, self.laws = {}, set()
        self.moves, self.curved = "none", False
        self.text = [f'title = "random choices {seed}"', f"degree = {self.degree}",
                     "dimension = 3" if self.plane == "space" else f'plane = "{self.plane}"']
        self.make_bodies(("lower", "upper", "top")[:bodies])
        if exchanged:
            self.exchange_bodies()
        self.make_time()
        self.contact_alone = bodies > 1

    def along(self, name, value, factor):
        """A datum of the direction y: "factor*value"."""
        sign, axis = (-1, "x") if self.turned else (1, "y")
        return f'{name}{axis} = "{sign * factor!r}*{value}"'

    def held(self, axes):
        """Supports of the directions."""
        turn = {"x": "y", "y": "x"} if self.turned else {"x": "x", "y": "y"}
        return [f"u{turn[axis]} = 0" for axis in axes]

    def exchange_bodies(self):
        begins = [i for i, line in enumerate(self.text) if line == "[[body]]"]
        end = next((i for i, line in enumerate(self.text) if line in ("[[contact]]", "[[quantity]]")),
                   len(self.text))
        blocks = [self.text[a:b] for a, b in zip(begins, [*begins[1:], end])]
        self.text[begins[0]:end] = [line for block in reversed(blocks) for line in block]

    def make_bodies(self, names):
        rng = self.rng
        left = rng.choice([0.0, 0.0, 1.0]) if self.plane == "axisymmetric" else 0.0
        bottom = 0.0
        for i, name in enumerate(names):
            last = i == len(names) - 1
            height = rng.choice([0.2, 1.0, 2.0])
            self.curved = last and i > 0 and left == 0 and rng.random() < 0.3
            if self.curved:
                self.round_mesh(name, bottom)
            else:
                width = 1.0 if i == 0 or rng.random() < 0.6 else rng.uniform(0.4, 1.3)
                self.meshes[f"{name}.mesh"] = [
                    rng.choice(["rectangle", "crisscross"]), "--cells",
                    f"{rng.randint(2, 5)},{rng.randint(1, 4)}",
                    f"--lower={left * self.length!r},{bottom * self.length!r}",
                    f"--upper={(left + width) * self.length!r},{(bottom + height) * self.length!r}"]
            self.text += ["[[body]]", f'name = "{name}"', f'mesh = "{name}.mesh"']
            if rng.random() < 0.15:
                self.text.append(self.along("force.", self.ramp,
                                            -self.load * decades(rng, -3, 0) / self.length))
            self.text.append(self.material(self.young * (1 if i % 2 == 0 else decades(rng, -3, 3))))
            self.support(i)
            if last:
                self.drive()
            bottom += height
        for lower, upper in zip(names, names[1:]):
            self.contact(lower, upper)
        if rng.random() < 0.4:
            self.quantities(names)

    def round_mesh(self, name, bottom):
        rng = self.rng
        radius, cells = rng.choice([1.0, 3.0]), str(rng.randint(2, 4))
        half = self.plane == "axisymmetric"
        self.meshes[f"{name}.mesh"] = [
            "quarterdisc" if half else "halfdisc", "--cells", cells, "--radius",
            str(radius * self.length), "--core", str(0.3 * radius * self.length),
            f"--lowest={0 if half else 0.5 * self.length},{bottom * self.length!r}"]

    def support(self, i):
        """Body 0 rests on its bottom; the others are held along a line, or by friction alone."""
        rng = self.rng
        if i == 0:
            self.text += ["[[body.boundary]]", "label = 1", *self.held("xy")]
        elif self.plane != "axisymmetric" and (not self.rough or rng.random() < 0.7):
            self.text += ["[[body.boundary]]", f"label = {2 if self.curved else 4}", *self.held("x")]

    def drive(self):
        rng, s = self.rng, self.ramp
        shape = rng.choice([s, s, f"min(1, 2*{s})", f"({s}<0.5 ? 2*{s} : 2-2*{s})", f"sin(4*pi*{s})", "1"])
        label = f"label = {2 if self.curved else 3}"
        if label not in self.text[-2:]:
            self.text += ["[[body.boundary]]", label]
        # A round body that touches at one node rolls under a force.
        if rng.random() < 0.5 and not self.curved:
            self.text.append(self.along("t", shape, -self.load))
        else:
            moved = -self.load / self.young * decades(rng, -1, 0.5)
            self.text.append(self.along("u", shape, moved * self.length))

    def material(self, young):
        rng, load, end = self.rng, self.load, self.end
        law = self.law if rng.random() < 0.6 else rng.choice(LAWS)
        self.laws.add(law)
        text = f"young = {young!r}, poisson = {rng.choice([0, 0.3, 0.3, 0.49, rng.uniform(-0.5, 0.49)])!r}"
        rate = load / young / end
        norton = (f"reference_stress = {load * decades(rng, -1, 1)!r}, "
                  f"reference_rate = {rate * decades(rng, -2, 2)!r}, exponent = {rng.choice([1, 3, 5])}")
        if law == "axes":
            text = (f'elasticity = "orthotropic", young1 = {young!r}, young2 = {young * 0.3!r}, '
                    f"poisson12 = 0.2, shear12 = {young * 0.2!r}, young3 = {young!r}, poisson13 = 0.2, "
                    f"poisson23 = 0.05, {self.axes(young)}")
        elif law == "perzyna":
            text += (f", viscosity = {end * young / decades(rng, -2, 6)!r}, "
                     f"yield_stress = {load * decades(rng, -3, 1)!r}")
        elif law == "norton":
            text += f', law = "norton", {norton}'
        elif law in ("maxwell", "standard-solid"):
            text += f', law = "{law}", relaxation_time = {end * decades(rng, -2, 2)!r}'
            text += f", relaxed_fraction = {rng.uniform(0.05, 0.95)!r}" if law != "maxwell" else ""
        elif law == "viscoplastic":
            plastic = rng.random() < 0.4 and "error" not in self.scheme and self.scheme != "crank-nicolson"
            text += f', law = "viscoplastic", yield_stress = {load * decades(rng, -2, 0.7)!r}, '
            text += rng.choice([norton, f"viscosity = {0 if plastic else end * young!r}"])
            text += f", kinematic_hardening = {young * decades(rng, -3, 0)!r}"
        elif law == "expression":
            text += f', law = "expression", {self.rates(rate / load**3 * decades(rng, -2, 1))}'
        if self.warm and rng.random() < 0.7:
            text += f", expansion = {decades(rng, -6, -4)!r}"
            place = ("y" if self.turned else "x") + (f"/{self.length!r}" if self.length != 1 else "")
            self.text.append(f'temperature = "{rng.uniform(-100, 100)!r}*{self.ramp}*(1+0.3*{place})"')
        return f"material = {{ {text} }}"

    def axes(self, _):
        return f"angle = {self.rng.uniform(0, 3) + (math.pi / 2 if self.turned else 0)!r}"

    def rates(self, factor):
        """Creep with the third power of von Mises' stress."""
        out = "0" if self.plane == "stress" else "s33"
        square = f"(0.5*((s11-s22)^2+(s22-{out})^2+({out}-s11)^2)+3*s12*s12)"
        names = {"rate11": f"(s11-(s22+{out})/2)", "rate22": f"(s22-(s11+{out})/2)", "rate12": "1.5*s12"}
        if self.plane != "stress":
            names["rate33"] = "(s33-(s11+s22)/2)"
        parts = [f'{name} = "A*{square}*{value}"' for name, value in names.items()]
        return ", ".join([*parts, f"parameters = {{ A = {factor!r} }}"])

    def contact(self, lower, upper):
        rng = self.rng
        sides = [f'{{ body = "{upper}", label = 1 }}', f'{{ body = "{lower}", label = 3 }}']
        variants = ["weighted"] if self.accuracy else ["mortar", "interpolation", "weighted"]
        self.text += ["[[contact]]", f'variant = "{rng.choice(variants)}"', 'sliding = "allow"']
        # The outer part of a round line faces nothing.
        if self.curved or rng.random() < 0.3:
            self.text.append(f"sides = [ {sides[0]}, {sides[1]} ]")
        else:
            rng.shuffle(sides)
            self.text += [f"nonmortar = {sides[0]}", f"mortar = {sides[1]}"]
        if self.rough:
            self.text.append(rng.choice([f"friction = {rng.uniform(0.05, 1)!r}",
                                         f"shear_limit = {self.load * rng.uniform(0.05, 1)!r}"]))
        if rng.random() < 0.15:
            self.moves = rng.choice(["moves", "stands"])
            amount = rng.choice([-1, 1]) * self.load / self.young * decades(rng, -1, 1) * self.length
            self.text.append(f'gap = "{amount!r}*{self.ramp if self.moves == "moves" else 1}"')

    def quantities(self, names):
        last, choices = names[-1], ["stored_energy", "work", "largest_mises"]
        lines = [f'{kind} = {{ body = "{last}" }}' for kind in choices]
        lines.append('reaction = { body = "lower", label = 1 }\n'
                       f'component = "{"x" if self.turned else "y"}"')
        if len(names) > 1:
            side = '{ body = "lower", label = 3 }'
            lines += [f"{kind} = {side}" for kind in ("mean_pressure", "largest_pressure", "contact_length")]
        for number, line in enumerate(self.rng.sample(lines, 3)):
            self.text += ["[[quantity]]", f'name = "q{number}"', line]

    def make_time(self):
        rng = self.rng
        if self.accuracy:
            self.text += ["[accuracy]", "energy = 0.3", "max_unknowns = 50000"]
        self.text += ["[time]", f"end = {self.end!r}", f'scheme = "{self.scheme.split()[0]}"']
        if "error" in self.scheme:
            self.text.append(f"tolerance = {decades(rng, -2.5, -1)!r}")
        else:
            self.text.append(f"steps = {rng.choice([1, 3, 8])}")


class SpaceScene(WideScene):
    """The same of bodies in space, stacked along z: cuboids, the last one a part of a ball or a cylinder."""

    PLANES = ("space",)
    REFINED = 0  # rounds in space take minutes
    SIDES = {"cuboid": (1, 3), "ball": (7, 3), "cylinder": (1, 3)}  # below and above

    def along(self, name, value, factor):
        return f'{name}z = "{factor!r}*{value}"'

    def make_bodies(self, names):
        rng, length, bottom = self.rng, self.length, 0.0
        shape = "cuboid"
        for i, name in enumerate(names):
            last = i == len(names) - 1
            shape = rng.choice(["cuboid", "cuboid", "ball", "cylinder"]) if last and i > 0 else "cuboid"
            self.curved = shape != "cuboid"
            height = rng.choice([0.2, 1.0, 2.0])
            self.text += ["[[body]]", f'name = "{name}"',
                          f"mesh = {{ {self.mesh(shape, i, bottom, height)} }}"]
            if rng.random() < 0.15:
                self.text.append(self.along("force.", self.ramp, -self.load * decades(rng, -3, 0) / length))
            self.text.append(self.material(self.young * (1 if i % 2 == 0 else decades(rng, -3, 3))))
            if i == 0:
                self.text += ["[[body.boundary]]", "label = 1", "ux = 0", "uy = 0", "uz = 0"]
            elif rng.random() < 0.8:
                side = self.SIDES[shape][1] if self.curved else 4
                self.text += ["[[body.boundary]]", f"label = {side}", "ux = 0", "uy = 0"]
            if last:
                self.drive()
            bottom += height
        for i, (lower, upper) in enumerate(zip(names, names[1:])):
            self.contact(lower, upper, self.SIDES[shape if i == len(names) - 2 else "cuboid"][0])
        if rng.random() < 0.4:
            self.quantities(names)

    def mesh(self, shape, i, bottom, height):
        rng, length = self.rng, self.length
        point = lambda *x: "[" + ", ".join(repr(each * length) for each in x) + "]"
        if shape == "ball":
            radius = rng.choice([0.5, 1.0, 3.0])
            return (f'shape = "ball", radius = {radius * length!r}, cells = {rng.randint(1, 3)}, '
                    f'keep = ["-z"], centre = {point(0.5, 0.5, bottom + radius)}')
        if shape == "cylinder":
            return (f'shape = "cylinder", radius = {rng.choice([0.3, 0.5, 0.8]) * length!r}, height = '
                    f"{height * length!r}, cells = {rng.randint(1, 3)}, centre = {point(0.5, 0.5, bottom)}")
        wide = [1.0 if i == 0 or rng.random() < 0.6 else rng.uniform(0.4, 1.3) for _ in range(2)]
        return (f'shape = "cuboid", cells = {[rng.randint(1, 3) for _ in range(3)]}, lower = '
                f"{point(0.0, 0.0, bottom)}, upper = {point(*wide, bottom + height)}")

    def drive(self):
        rng, s = self.rng, self.ramp
        shape = rng.choice([s, s, f"min(1, 2*{s})", f"({s}<0.5 ? 2*{s} : 2-2*{s})", f"sin(4*pi*{s})", "1"])
        shape += rng.choice(["", "", f"*(1+0.5*x/{self.length!r})", f"*cos(2*y/{self.length!r})"])
        if "label = 3" not in self.text[-4:]:
            self.text += ["[[body.boundary]]", "label = 3"]
        if rng.random() < 0.5 and not self.curved:
            self.text.append(self.along("t", shape, -self.load))
        else:
            moved = -self.load / self.young * decades(rng, -1, 0.5)
            self.text.append(self.along("u", shape, moved * self.length))

    def axes(self, young):
        return f"shear13 = {young * 0.3!r}, shear23 = {young * 0.1!r}"

    def rates(self, factor):
        shear = "(s12*s12+s13*s13+s23*s23)"
        square = f"(0.5*((s11-s22)^2+(s22-s33)^2+(s33-s11)^2)+3*{shear})"
        parts = [f'rate{i}{i} = "A*{square}*(1.5*s{i}{i}-(s11+s22+s33)/2)"' for i in (1, 2, 3)]
        parts += [f'rate{ij} = "A*{square}*1.5*s{ij}"' for ij in (12, 13, 23)]
        return ", ".join([*parts, f"parameters = {{ A = {factor!r} }}"])

    def contact(self, lower, upper, below):
        rng = self.rng
        sides = [f'{{ body = "{upper}", label = {below} }}', f'{{ body = "{lower}", label = 3 }}']
        variants = ["weighted"] if self.degree == 2 else ["mortar", "interpolation", "weighted"]
        self.text += ["[[contact]]", f'variant = "{rng.choice(variants)}"', 'sliding = "allow"']
        self.text.append(f"sides = [ {sides[0]}, {sides[1]} ]")
        if rng.random() < 0.15:
            self.moves = rng.choice(["moves", "stands"])
            amount = rng.choice([-1, 1]) * self.load / self.young * decades(rng, -1, 1) * self.length
            self.text.append(f'gap = "{amount!r}*{self.ramp if self.moves == "moves" else 1}"')

    def quantities(self, names):
        choices = ["stored_energy", "work", "largest_mises"]
        lines = [f'{kind} = {{ body = "{names[-1]}" }}' for kind in choices]
        lines.append('reaction = { body = "lower", label = 1 }\ncomponent = "z"')
        if len(names) > 1:
            lines.append('largest_pressure = { body = "lower", label = 3 }')
        for number, line in enumerate(self.rng.sample(lines, 3)):
            self.text += ["[[quantity]]", f'name = "q{number}"', line]
