"""Random scenes whose quantities have known values: by closed forms, by statics, or by the same scene on
finer meshes with quadratic elements."""
import math
import random
from dataclasses import dataclass, field

import numpy as np
from contact_support import HELD, quadrilateral
from scene_parts import LARGE_CHANGES, body, box, contact, elastic, quantity, shape, stresses, timed



@dataclass
class Scene:
    make: object  # of the factor of its cells
    known: dict = field(default_factory=dict)  # quantity -> value; those of the others come of a fine mesh
    head: str = ""
    finer: int = 4
    degrees: tuple = (1, 2)
    adapts: bool = False  # whether it may be asked for an accuracy
    accuracy: float = 0
    degree: int = 1

    def text(self, degree, factor):
        return f"degree = {degree}\n{self.head}{self.make(factor)}{LARGE_CHANGES}"


def point(name, of, place, component):
    return quantity(name, "displacement", of, None, component, point=place)


def pressures(of, label, size="contact_length", mean=True):
    """mean: not of a label whose length changes with the mesh, as that of the arc of a disc."""
    kinds = ("largest_pressure", size, *(["mean_pressure"] if mean else []))
    return "".join(quantity(kind, kind, of, label) for kind in kinds)


def ring(inner, outer, cells, **keys):
    return shape("annulus", inner=inner, outer=outer, span="quarter", cells=cells, **keys)


def material(text, law):
    """The text with a law in place of elasticity of Poisson's ratio 0.3."""
    return text.replace("poisson = 0.3 }", "poisson = 0.3, " + law + " }")


SYMMETRIC = ["label = 3, uy = 0", "label = 4, ux = 0"]
ENDS = ['label = "start", uz = 0', 'label = "end", uz = 0']
CORNER = ["label = 4, ux = 0", "label = 5, uy = 0"]


class Tube:
    """A tube without strain along its axis, of E and nu, under pressures inside and outside (Lame)."""

    def __init__(self, inner, outer, young, poisson, inside=0.0, outside=0.0):
        a, b = inner, outer
        self.a = (inside * a * a - outside * b * b) / (b * b - a * a)
        self.b = (inside - outside) * a * a * b * b / (b * b - a * a)
        self.young, self.poisson = young, poisson

    def grows(self, r):
        return (1 + self.poisson) / self.young * ((1 - 2 * self.poisson) * self.a * r + self.b / r)

    def mises(self, r):
        s = np.array([self.a - self.b / r**2, self.a + self.b / r**2, 2 * self.poisson * self.a])
        return math.sqrt(sum((s - np.roll(s, 1)) ** 2) / 2)


def tube(rng, kind):
    a, thick = rng.uniform(0.5, 2), rng.uniform(0.3, 1.5)
    b, young, poisson = a * (1 + thick), 10 ** rng.uniform(0, 5), rng.uniform(0, 0.4)
    p = young * rng.uniform(1e-3, 1e-2)
    exact = Tube(a, b, young, poisson, p)
    around, across, height = rng.randint(4, 10), rng.randint(2, 5), rng.uniform(0.3, 2)
    load = f'pressure = "{p!r}*t"'
    known = {"bore": exact.grows(a), "outside": exact.grows(b), "mises_tube": exact.mises(a)}
    work = p * a * exact.grows(a) / 2
    if kind == "axis":
        def make(f):
            mesh = box([a, 0], [b, height], [across * f, max(1, around // 3) * f])
            held = ["label = 1, uy = 0", "label = 3, uy = 0"]
            return (body("tube", mesh, elastic(young, poisson), *held, f"label = 4, {load}")
                    + quantity("axial", "reaction", "tube", 3, "y") + point("bore", "tube", [a, 0.0], "x")
                    + quantity("outside", "displacement", "tube", 2, "x") + stresses("tube") + timed())
        axial = 2 * poisson * exact.a * math.pi * (b * b - a * a)
        return Scene(make, {**known, "axial": axial, "energy_tube": 2 * math.pi * height * work},
                     'plane = "axisymmetric"\n', adapts=True)

    if kind == "space" and rng.random() < 0.5:
        def make(f):
            mesh = box([a, 0], [b, height], [across * f, f], revolve="pi/2", layers=around * f)
            held = ["label = 1, uy = 0", "label = 3, uy = 0", 'label = "start", uz = 0',
                    'label = "end", ux = 0']
            return (body("tube", mesh, elastic(young, poisson), *held, f"label = 4, {load}")
                    + quantity("held", "reaction", "tube", "start", "z")
                    + point("bore", "tube", [a, 0.0, 0.0], "x") + point("outside", "tube", [b, 0.0, 0.0], "x")
                    + stresses("tube") + timed())
        return Scene(make, {**known, "held": -p * a * height, "energy_tube": math.pi / 2 * height * work},
                     "dimension = 3\n")

    def make(f):
        space = kind == "space"
        layers = {"extrude": height, "layers": max(1, across // 2) * f} if space else {}
        place = [a, 0.0, 0.0][:3 if space else 2]
        held = SYMMETRIC + (ENDS if space else [])
        mesh = ring(a, b, [around * f, across * f], **layers)
        return (body("tube", mesh, elastic(young, poisson), *held, f"label = 1, {load}")
                + quantity("held", "reaction", "tube", 3, "y") + point("bore", "tube", place, "x")
                + point("outside", "tube", [b, *place[1:]], "x") + stresses("tube") + timed())
    depth = height if kind == "space" else 1
    known |= {"held": -p * a * depth, "energy_tube": math.pi / 2 * depth * work}
    return Scene(make, known, "dimension = 3\n" if kind == "space" else 'plane = "strain"\n',
                 adapts=kind == "plane")


def shrink_fit(rng, kind):
    a, thick = rng.uniform(0.5, 2), (rng.uniform(0.3, 1), rng.uniform(0.3, 1))
    c = a * (1 + thick[0])
    b = c * (1 + thick[1])
    young = [10 ** rng.uniform(2, 4) for _ in range(2)]
    poisson, over = rng.uniform(0, 0.4), c * rng.uniform(1e-3, 1e-2)
    grows = [Tube(a, c, young[0], poisson, outside=1).grows(c), Tube(c, b, young[1], poisson, 1).grows(c)]
    p = over / (grows[1] - grows[0])
    hub = Tube(a, c, young[0], poisson, outside=p)
    sleeve = Tube(c, b, young[1], poisson, inside=p)
    cells = [[rng.randint(4, 8), rng.randint(2, 4)] for _ in range(2)]
    height = rng.uniform(0.3, 1)
    first = rng.random() < 0.5
    known = {"bore": hub.grows(a), "outside": sleeve.grows(b), "mises_hub": hub.mises(a),
             "mises_sleeve": sleeve.mises(c), "largest_pressure": p, "mean_pressure": p}
    if kind == "axis":
        def make(f):
            ends = ["label = 1, uy = 0", "label = 3, uy = 0"]
            text = "".join(body(name, box([r, 0], [s, height], [n[1] * f, max(1, n[0] // 3) * f]),
                                elastic(e, poisson), *ends)
                           for name, r, s, n, e in (("hub", a, c, cells[0], young[0]),
                                                    ("sleeve", c, b, cells[1], young[1])))
            sides = [("hub", 2), ("sleeve", 4)]
            return (text + contact(*(sides if first else sides[::-1]), gap=-over)
                    + quantity("bore", "displacement", "hub", 4, "x")
                    + quantity("outside", "displacement", "sleeve", 2, "x")
                    + pressures(*sides[0]) + stresses("hub", "sleeve") + timed())
        return Scene(make, known | {"contact_length": height}, 'plane = "axisymmetric"\n', adapts=True)

    def make(f):
        space = kind == "space"
        ends = SYMMETRIC + (ENDS if space else [])
        layers = {"extrude": height, "layers": f} if space else {}
        zero = [0.0] if space else []
        text = "".join(body(name, ring(r, s, [n[0] * f, n[1] * f], **layers), elastic(e, poisson), *ends)
                       for name, r, s, n, e in (("hub", a, c, cells[0], young[0]),
                                                ("sleeve", c, b, cells[1], young[1])))
        sides = [("hub", 2), ("sleeve", 1)]
        return (text + contact(*(sides if first else sides[::-1]), gap=-over)
                + point("bore", "hub", [a, 0.0, *zero], "x")
                + point("outside", "sleeve", [b, 0.0, *zero], "x")
                + quantity("cut", "reaction", "sleeve", 3, "y") + pressures(*sides[0], "contact_area" if space
                                                                            else "contact_length")
                + stresses("hub", "sleeve") + timed())
    depth = height if kind == "space" else 1
    known |= {"cut": -p * c * depth}
    known["contact_area" if kind == "space" else "contact_length"] = math.pi / 2 * c * depth
    return Scene(make, known, "dimension = 3\n" if kind == "space" else 'plane = "strain"\n',
                 finer=2 if kind == "space" else 4, adapts=kind == "plane")


def beam(rng, space=False, law=None, moved=False, steps=1):
    length, h = rng.uniform(2, 6), 1.0
    n = rng.randint(1, 3) if not space else rng.randint(1, 2)
    along = max(3, round(length * n * rng.uniform(0.7, 1.3)))
    young, q = 1e3, rng.uniform(0.1, 1) * (1 if law else 0.1)
    axis = "z" if space else "y"
    zero = ", uz = 0" if space else ""
    load = f't{axis} = "{-q!r}*min(2*t, 1)"' if not moved else f'u{axis} = "{-0.01 * length!r}*t"'

    def make(f):
        size = [length, h, h] if space else [length, h]
        cells = [along * f] + [n * f] * (len(size) - 1)
        text = body("beam", box([0] * len(size), size, cells, cut=None if space else rng_cut), young,
                    f"label = 4, {HELD}{zero}", f"label = 2, {load}")
        middle = [length / 2, *[h / 2] * (len(size) - 1)]
        return (material(text, law) if law else text) + (
            quantity("held", "reaction", "beam", 4, axis)
            + quantity("moment", "reaction", "beam", 4, "moment_y" if space else "moment")
            + ("" if moved else quantity("tip", "displacement", "beam", 2, axis))
            + point("middle", "beam", middle, axis) + stresses("beam") + timed(steps))
    rng_cut = rng.choice(["rising", "both"])
    known = {} if moved else {"held": q, "moment": q * (length if not space else -length)}
    return Scene(make, known, "dimension = 3\n" if space else "", finer=2 if space else 4,
                 adapts=not law and not space)


def bar(rng):
    """Under its own weight, that grows or falls along it, without contraction across."""
    length, young, g, part = rng.uniform(1, 5), 1e3, rng.uniform(0.1, 1), rng.uniform(-0.9, 2)
    cells = [rng.randint(1, 3), rng.randint(3, 8)]

    def make(f):
        weight = f'force = {{ y = "{-g!r}*(1 + {part / length!r}*y)*t" }}\n'
        return (body("bar", box([0, 0], [1, length], [n * f for n in cells]), elastic(young, 0.0),
                     f"label = 1, {HELD}", more=weight)
                + quantity("held", "reaction", "bar", 1, "y") + quantity("top", "displacement", "bar", 3, "y")
                + point("middle", "bar", [0.5, length / 2], "y") + stresses("bar") + timed())
    force = g * length * (1 + part / 2)
    # s(y) = -g ((L - y) + part (L^2 - y^2)/(2 L))
    sinks = lambda y: -g / young * (length * y - y * y / 2 + part * (length * y / 2 - y**3 / (6 * length)))
    s = lambda y: g * (length - y + part * (length**2 - y**2) / (2 * length))
    y, w = np.polynomial.legendre.leggauss(8)
    energy = sum(w * s((y + 1) * length / 2) ** 2) * length / 2 / (2 * young)
    return Scene(make, {"held": force, "top": sinks(length), "middle": sinks(length / 2), "mises_bar": force,
                        "energy_bar": energy}, adapts=True)


def heated(rng):
    """A tube with a temperature that conduction makes, and a bar between walls that is hot in its middle."""
    cells = [rng.randint(4, 8), rng.randint(2, 4)]
    hot = 10 ** rng.uniform(1, 2)
    expands = "expansion = 1e-5"
    if rng.random() < 0.5:
        b = rng.uniform(1.3, 3)

        def make(f):
            temperature = f'temperature = "{hot!r}*t*log({b!r}/sqrt(x^2 + y^2))"\n'
            return (material(body("tube", ring(1.0, b, [n * f for n in cells]), 1e5, *SYMMETRIC,
                                  more=temperature), expands)
                    + quantity("held", "reaction", "tube", 3, "y") + point("bore", "tube", [1.0, 0.0], "x")
                    + point("outside", "tube", [b, 0.0], "x") + stresses("tube") + timed())
        return Scene(make, {"held": 0}, 'plane = "strain"\n')
    length = rng.uniform(1, 4)

    def make(f):
        temperature = f'temperature = "{hot!r}*t*x*({length!r} - x)"\n'
        return (material(body("bar", box([0, 0], [length, 1], [n * f for n in cells]), 1e5,
                              "label = 1, uy = 0", "label = 2, ux = 0", "label = 4, ux = 0",
                              more=temperature), expands)
                + quantity("wall", "reaction", "bar", 2, "x") + quantity("top", "displacement", "bar", 3, "y")
                + stresses("bar") + timed())
    return Scene(make)


def block(f, width, depth, cells, name="block", young=1e3):
    return body(name, box([-width, -depth], [width, 0], [cells[0] * f, cells[1] * f],
                          cut="both", focus=[0, 0], grading=[cells[2], cells[2]]), young,
                f"label = 1, {HELD}")


def roller(rng):
    """A half disc that is pressed onto a block by a force or a motion."""
    radius, core = 10.0, rng.uniform(1.5, 3)
    young = [10 ** rng.uniform(2.5, 4) for _ in range(2)]
    cells, below = rng.randint(5, 9), [2 * rng.randint(6, 9), rng.randint(5, 8), rng.uniform(5, 10)]
    modulus = 1 / sum(0.91 / e for e in young)
    half = core * rng.uniform(0.4, 0.8)
    force = math.pi * modulus * half**2 / (4 * radius)
    pushed = rng.random() < 0.5
    deep = rng.uniform(0.5, 1) * half**2 / radius
    load = "ux = 0, " + (f'ty = "-{force / (2 * radius)!r}*t"' if pushed else f'uy = "-{deep!r}*t"')
    first = rng.random() < 0.5

    def make(f):
        sides = [("disc", 1), ("block", 3)]
        disc = (f'{{ shape = "halfdisc", radius = {radius}, core = {core!r}, lowest = [0, 0], '
                f"cells = {cells * f} }}")
        return (body("disc", disc, young[0], "label = 2, " + load)
                + block(f, 12.0, 12.0, below, young=young[1])
                + contact(*(sides if first else sides[::-1]))
                + quantity("contact", "contact_force", "block", 3, "y")
                + quantity("floor", "reaction", "block", 1, "y")
                + quantity("sinks", "displacement", "disc", 2, "y") + point("under", "block", [0.0, 0.0], "y")
                + pressures("disc", 1, mean=False) + stresses("disc", "block") + timed())
    return Scene(make, {"contact": -force, "floor": force} if pushed else {}, 'plane = "strain"\n', finer=3,
                 adapts=True)


def ball_about_axis(rng):
    radius, core = 10.0, rng.uniform(1.5, 3)
    young = [10 ** rng.uniform(2.5, 4) for _ in range(2)]
    cells, below = rng.randint(5, 8), [rng.randint(6, 9), rng.randint(5, 8)]
    half = core * rng.uniform(0.4, 0.8)
    pushed = rng.random() < 0.5
    modulus = 1 / sum(0.91 / e for e in young)
    force = 4 / 3 * modulus * half**3 / radius
    deep = rng.uniform(0.5, 1) * half**2 / radius
    load = f'ty = "-{force / (math.pi * radius**2)!r}*t"' if pushed else f'uy = "-{deep!r}*t"'

    def make(f):
        ball = (f'{{ shape = "quarterdisc", radius = {radius}, core = {core!r}, lowest = [0, 0], '
                f"cells = {cells * f} }}")
        under = box([0, -12], [12, 0], [n * f for n in below], cut="both", focus=[0, 0], grading=[8, 8])
        return (body("ball", ball, young[0], "label = 2, " + load)
                + body("block", under, young[1], "label = 1, uy = 0") + contact(("ball", 1), ("block", 3))
                + quantity("contact", "contact_force", "block", 3, "y")
                + quantity("floor", "reaction", "block", 1, "y")
                + quantity("sinks", "displacement", "ball", 2, "y") + point("under", "block", [0.0, 0.0], "y")
                + pressures("ball", 1, mean=False) + stresses("ball", "block") + timed())
    return Scene(make, {"contact": -force, "floor": force} if pushed else {}, 'plane = "axisymmetric"\n',
                 finer=3, adapts=True)


def punch(rng):
    """An elastic or a rigid punch on a block."""
    force, off = rng.uniform(1, 20), rng.uniform(-0.3, 0.3)
    cells, below = [2 * rng.randint(2, 4), rng.randint(2, 4)], [2 * rng.randint(5, 8), rng.randint(5, 8), 6]
    values = (quantity("contact", "contact_force", "block", 3, "y")
              + quantity("floor", "reaction", "block", 1, "y")
              + quantity("floor_moment", "reaction", "block", 1, "moment")
              + point("under", "block", [0.0, 0.0], "y"))
    known = {"contact": -force, "floor": force}
    if rng.random() < 0.5:
        known |= {"turning": 0.0, "floor_moment": 0.0, "mean_pressure": force / 2}

        def make(f):
            return ('[[tool]]\nname = "punch"\nshape = "rectangle"\nlower = [-1, 0]\nupper = [1, 1]\n'
                    f'fy = "-{force!r}*t"\n' + block(f, 5.0, 5.0, below)
                    + contact(("block", 3), ("punch", 1)) + values
                    + quantity("sinks", "displacement", "punch", None, "y")
                    + quantity("turning", "reaction", "punch", None, "moment", [0, 0])
                    + quantity("mean_pressure", "mean_pressure", "punch", 1) + stresses("block") + timed())
    else:
        known |= {"mean_pressure": force / 2, "floor_moment": off * force}
        load = f'ux = 0, ty = "-{force / 2!r}*t*(1 + {3 * off!r}*x)"'

        def make(f):
            return (body("punch", box([-1, 0], [1, 1], [n * f for n in cells]), 1000.0,
                         "label = 3, " + load)
                    + block(f, 5.0, 5.0, below) + contact(("punch", 1), ("block", 3)) + values
                    + quantity("sinks", "displacement", "punch", 3, "y")
                    + pressures("punch", 1) + stresses("punch", "block") + timed())
        known.pop("floor_moment")
    return Scene(make, known, 'plane = "strain"\n', adapts=True)


def groove(rng):
    """A rigid disc pressed into a groove of two flanks, without friction."""
    force, young = rng.uniform(5, 50), 1e3
    turns = [rng.uniform(0.4, 1.1), rng.uniform(0.4, 1.1)]  # of the flanks, from the horizontal
    cells = [2 * rng.randint(5, 9), rng.randint(3, 5)]

    def make(f):
        text = (f'[[tool]]\nname = "disc"\nshape = "disc"\ncentre = [0, 0]\nradius = 1\nfx = 0\n'
                f'fy = "-{force!r}*t"\n')
        for name, sign, turn in (("left", 1, turns[0]), ("right", -1, turns[1])):
            n = np.array([sign * math.sin(turn), math.cos(turn)])  # out of the flank, towards the disc
            along = np.array([n[1], -n[0]])
            foot = -n
            corners = [foot - 0.7 * along - 0.8 * n, foot + 0.7 * along - 0.8 * n, foot + 0.7 * along,
                       foot - 0.7 * along]
            text += (body(name, quadrilateral(corners, [n * f for n in cells]), young,
                          f"label = 1, {HELD}")
                     + contact((name, 3), ("disc", 1)))
            text += (quantity(f"{name}_x", "contact_force", name, 3, "x")
                     + quantity(f"{name}_y", "contact_force", name, 3, "y")
                     + quantity(f"{name}_moment", "contact_force", name, 3, "moment"))
        return (text + quantity("sinks", "displacement", "disc", None, "y")
                + quantity("goes", "displacement", "disc", None, "x")
                + quantity("moment", "reaction", "disc", None, "moment", [0, 0]) + stresses("left", "right")
                + timed())
    a, b = turns
    left, right = force * math.sin(b) / math.sin(a + b), force * math.sin(a) / math.sin(a + b)
    known = {"left_x": -left * math.sin(a), "left_y": -left * math.cos(a), "right_x": right * math.sin(b),
             "right_y": -right * math.cos(b), "left_moment": 0.0, "right_moment": 0.0, "moment": 0.0}
    return Scene(make, known, 'plane = "strain"\n', finer=3)


def dragged(rng):
    """A block that is pressed onto another and dragged over it."""
    mu, p, width = rng.uniform(0.1, 0.6), rng.uniform(1, 5), rng.uniform(1, 2)
    cells, below = [rng.randint(3, 6), rng.randint(3, 5)], [2 * rng.randint(4, 7), rng.randint(4, 6), 4]
    slides = rng.random() < 0.7

    def make(f):
        top = f'ty = "-{p!r}*min(4*t, 1)", ux = "{0.05 if slides else 1e-4}*max(0, t - 0.25)"'
        return (body("upper", box([-width, 0], [width, 1], [n * f for n in cells]), 1000.0,
                     "label = 3, " + top)
                + block(f, 4.0, 3.0, below, "lower") + contact(("upper", 1), ("lower", 3), friction=mu)
                + quantity("press", "contact_force", "lower", 3, "y")
                + quantity("drag", "contact_force", "lower", 3, "x")
                + quantity("push", "reaction", "upper", 3, "x")
                + quantity("sinks", "displacement", "upper", 3, "y") + pressures("upper", 1)
                + stresses("upper", "lower") + timed(4))
    force = 2 * width * p
    known = {"press": -force}
    if slides:
        known |= {"drag": mu * force, "push": mu * force}
    return Scene(make, known, 'plane = "strain"\n', finer=3)


def belt(rng):
    """A belt around a quarter of a pulley that turns it with friction."""
    mu, thick, pull = rng.uniform(0.1, 0.5), rng.uniform(0.03, 0.15), rng.uniform(10, 100)
    cells = [rng.randint(10, 24), rng.randint(1, 3)]

    def make(f):
        return ('[[tool]]\nname = "pulley"\nshape = "disc"\ncentre = [0, 0]\nradius = 1\n'
                'rotation = "-0.05*max(0, t - 0.5)"\n'
                + body("belt", ring(1.0, 1 + thick, [n * f for n in cells]), 1e5,
                       f'label = 3, pressure = "-{pull!r}*min(2*t, 1)"', "label = 4, un = 0")
                + contact(("belt", 1), ("pulley", 1), friction=mu, variant="weighted")
                + quantity("held", "reaction", "belt", 4, "x")
                + quantity("moment", "reaction", "pulley", None, "moment", [0, 0])
                + quantity("side", "reaction", "pulley", None, "y")
                + quantity("mean_pressure", "mean_pressure", "belt", 1) + stresses("belt") + timed(6))
    return Scene(make, {"side": pull * thick}, finer=3)


def rolling(rng):
    """A rigid disc that rolls on a block, or slides on it, by finite sliding."""
    mu, force, radius = rng.uniform(0.2, 0.6), rng.uniform(1, 4), 2.0
    free = rng.random() < 0.5
    cells = [rng.randint(20, 40), rng.randint(4, 6)]
    far = rng.uniform(0.3, 1.5)

    def make(f):
        turn = "moment = 0\n" if free else ""
        return (f'[[tool]]\nname = "disc"\nshape = "disc"\ncentre = [0, {radius}]\nradius = {radius}\n'
                f'ux = "{far!r}*max(0, t - 0.25)"\nfy = "-{force!r}*min(4*t, 1)"\n{turn}'
                + body("block", box([-1.5, -1], [2.5, 0], [n * f for n in cells], cut="both"), 200.0,
                       f"label = 1, {HELD}")
                + contact(("block", 3), ("disc", 1), friction=mu, sliding="finite", variant="weighted")
                + quantity("press", "contact_force", "block", 3, "y")
                + quantity("floor", "reaction", "block", 1, "y")
                + quantity("drag", "reaction", "disc", None, "x")
                + ("" if free else quantity("torque", "reaction", "disc", None, "moment", [0, 0]))
                + stresses("block") + timed(6))
    known = {"press": -force, "floor": force}
    return Scene(make, known, 'plane = "strain"\n', finer=3)


def creep(rng):
    law = rng.choice(['law = "norton", reference_stress = 1, reference_rate = 1e-2, exponent = 4',
                      'law = "maxwell", relaxation_time = 0.7'])
    return beam(rng, law=law, moved=rng.random() < 0.5, steps=6)


def uniform_creep(rng):
    law = rng.choice(['law = "norton", reference_stress = 1, reference_rate = 1e-2, exponent = 3',
                      'law = "maxwell", relaxation_time = 0.7'])
    pull, cells = rng.uniform(0.5, 2), [rng.randint(1, 4), rng.randint(1, 4)]

    def make(f):
        held = ["label = 4, ux = 0", "label = 1, uy = 0"]
        return (material(body("bar", box([0, 0], [2, 1], [n * f for n in cells]), 1000.0, *held,
                              f'label = 2, tx = "{pull!r}*min(2*t, 1)"'), law)
                + quantity("held", "reaction", "bar", 4, "x") + quantity("end", "displacement", "bar", 2, "x")
                + stresses("bar") + timed(6))
    return Scene(make, {"held": -pull, "mises_bar": pull}, finer=2)


def perzyna(rng):
    if rng.random() < 0.5:
        return beam(rng, law="viscosity = 10, yield_stress = 1", moved=True, steps=8)
    cells = [rng.randint(5, 8), rng.randint(2, 4)]
    over = rng.uniform(1, 1.6)
    b = rng.uniform(1.5, 2.5)

    def make(f):
        wider = f'label = 1, ux = "{over * 1e-3!r}*x*t", uy = "{over * 1e-3!r}*y*t"'
        return (material(body("tube", ring(1.0, b, [n * f for n in cells]), 1e3, *SYMMETRIC, wider),
                         "viscosity = 10, yield_stress = 1")
                + quantity("held", "reaction", "tube", 3, "y") + point("outside", "tube", [b, 0.0], "x")
                + stresses("tube") + timed(8))
    return Scene(make, {}, 'plane = "strain"\n')


def cuboids(rng):
    """A cube on another, pressed by a traction that is linear over its top: or a smaller one, or a bar."""
    p, slopes = rng.uniform(1, 10), [rng.uniform(-0.6, 0.6) for _ in range(2)]
    cells = [[rng.randint(2, 3) for _ in range(3)] for _ in range(2)]
    width = rng.choice([1.0, 0.5])

    def make(f):
        sizes = ([0, 0, 0], [width, width, 0.6]), ([0, 0, -1], [1, 1, 0])
        upper = body("upper", box(*sizes[0], [n * f for n in cells[0]]), 1000.0, *CORNER,
                     f'label = 3, tz = "-{p!r}*t*(1 + {slopes[0] / width!r}*x '
                               f'+ {slopes[1] / width!r}*y)"')
        lower = body("lower", box(*sizes[1], [(n + 1) * f for n in cells[1]]), 1000.0, *CORNER,
                     "label = 1, uz = 0")
        return (upper + lower + contact(("upper", 1), ("lower", 3))
                + quantity("contact", "contact_force", "lower", 3, "z")
                + quantity("contact_moment", "contact_force", "lower", 3, "moment_y")
                + quantity("floor", "reaction", "lower", 1, "z")
                + quantity("top", "displacement", "upper", 3, "z") + pressures("upper", 1, "contact_area")
                + stresses("upper", "lower") + timed())
    area = width**2
    force = p * area * (1 + slopes[0] / 2 + slopes[1] / 2)
    return Scene(make, {"contact": -force, "floor": force, "mean_pressure": force / area}, "dimension = 3\n",
                 finer=2)


def ball(rng):
    young = [10 ** rng.uniform(2.5, 4) for _ in range(2)]
    cells, below = rng.randint(3, 5), [rng.randint(4, 5) for _ in range(3)]
    pushed = rng.random() < 0.5
    modulus = 1 / sum(0.91 / e for e in young)
    force = modulus * rng.uniform(0.02, 0.06)  # of a quarter
    load = f'tz = "-{force / (math.pi / 4)!r}*t"' if pushed else f'uz = "-{rng.uniform(.06, .12)!r}*t"'

    def make(f):
        mesh = (f'{{ shape = "ball", centre = [0, 0, 1], radius = 1, cells = {cells * f}, '
                'keep = ["x", "y", "-z"] }')
        return (body("ball", mesh, young[0], *CORNER, "label = 3, " + load)
                + body("block", box([0, 0, -1], [1, 1, 0], [n * f for n in below]), young[1], *CORNER,
                       "label = 1, uz = 0")
                + contact(("ball", 7), ("block", 3)) + quantity("contact", "contact_force", "block", 3, "z")
                + quantity("floor", "reaction", "block", 1, "z")
                + quantity("sinks", "displacement", "ball", 3, "z")
                + pressures("ball", 7, "contact_area") + stresses("ball", "block") + timed())
    return Scene(make, {"contact": -force, "floor": force} if pushed else {}, "dimension = 3\n", finer=2)


KINDS = {
    "tube": lambda rng: tube(rng, "plane"), "tube-axis": lambda rng: tube(rng, "axis"),
    "tube-space": lambda rng: tube(rng, "space"), "shrink": lambda rng: shrink_fit(rng, "plane"),
    "shrink-axis": lambda rng: shrink_fit(rng, "axis"), "shrink-space": lambda rng: shrink_fit(rng, "space"),
    "beam": beam, "beam-moved": lambda rng: beam(rng, moved=True),
    "beam-space": lambda rng: beam(rng, space=True), "bar": bar, "heated": heated, "roller": roller,
    "ball-axis": ball_about_axis, "punch": punch, "groove": groove, "dragged": dragged,
    "belt": belt, "rolling": rolling, "creep": creep, "uniform-creep": uniform_creep,
    "perzyna": perzyna, "cuboids": cuboids, "ball": ball,
}


def scene_of(seed):
    kind = list(KINDS)[seed % len(KINDS)]
    rng = random.Random(seed)
    scene = KINDS[kind](rng)
    scene.degree = rng.choice(scene.degrees)
    scene.accuracy = rng.choice([0.05, 0.1, 0.2]) if scene.adapts and rng.random() < 0.25 else 0
    return kind, scene
