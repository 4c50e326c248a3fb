#!/usr/bin/env python3
"""Random scenes that have a solution, and how the program ends on each.

Two or three stacked rectangles (or one) on meshes of tens of triangles, with everything that a scene may
choose drawn over its whole range: stiffness ratios 1e-9 to 1e9, Poisson's ratio -0.99 to 0.4999, yield
stresses 1e-12 to 1e3 of the load or none, viscosities from almost elastic to almost perfectly plastic,
partial overlap, gaps of either sign, eccentric loads that grow, wave or turn round, both planes, all schemes,
projections and couplings.

Exit code 0 is asked for. 3 is right where contact alone holds a body and the load takes it away, 1 where a
body between two others flows until these overlap, which no contact joins. Any other 1 has to be rare, with a
reason; a run that takes longer than PATIENCE is a fault whatever it would have ended with.

    tests/compare/random_scenes.py [--choices | --space] [--count 100] [--first SEED] [--jobs N]
                                   [--mortier PROGRAM]
"""
import importlib
import random
import sys

from contact_support import command, meshed, solve

OVERLAPS = "no [[contact]] names label"
PATIENCE = 25  # seconds of processor time: seed 216 takes 10 to 15


def decades(rng, least, most):
    return 10 ** rng.uniform(least, most)


class Scene:
    """Scene number `seed`: its text and its meshes (as arguments of `mortier mesh`)."""

    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.meshes = {}
        self.load = decades(rng, -3, 9)
        self.end = decades(rng, -2, 2)
        bodies = rng.choices([1, 2, 3], [1, 8, 1])[0]
        plane = rng.choice(["stress", "strain"])
        self.projection = rng.choice(["elasticity", "frobenius", "compliance"])
        self.yield_ratio = 0 if rng.random() < 0.15 else decades(rng, -12, 3)
        self.ratio = 1 if bodies == 1 else decades(rng, -9, 9)
        # Strains of the load between 1e-13 and 1e-1 in the softer body.
        self.young = self.load * decades(rng, 1, 13)
        self.stiffness = decades(rng, -6, 12)  # theta e of the whole run
        self.poisson = rng.choice([-0.99, 0, 0.3, 0.4999, rng.uniform(-0.99, 0.4999),
                                   rng.uniform(-0.5, 0.49)])
        self.text = [f'title = "random scene {seed}"', f'plane = "{plane}"']
        self.make_bodies(bodies)
        self.make_time()

    def material(self, young):
        rng = self.rng
        poisson = rng.choice([self.poisson, 0.3])
        text = f"young = {young!r}, poisson = {poisson!r}"
        if self.yield_ratio == 0 or rng.random() < 0.15:
            return f"material = {{ {text} }}"
        viscosity = self.end * young / self.stiffness * rng.choice([1, 1, decades(rng, -2, 2)])
        threshold = self.yield_ratio * self.load * rng.choice([1, 1, decades(rng, 0, 2)])
        return (f'material = {{ {text}, viscosity = {viscosity!r}, yield_stress = {threshold!r}, '
                f'projection = "{self.projection}" }}')

    def mesh(self, name, left, bottom, width, height):
        rng = self.rng
        kind = rng.choice(["rectangle", "rectangle", "crisscross"])
        most = 4 if kind == "crisscross" else 7
        # Two cells across: the end of one may be held, and the other hang over.
        arguments = [kind, "--cells", f"{rng.randint(2, most)},{rng.randint(1, most)}",
                     f"--lower={left!r},{bottom!r}", f"--upper={left + width!r},{bottom + height!r}"]
        if kind == "rectangle":
            arguments += ["--cut", rng.choice(["rising", "falling", "both"])]
        self.meshes[f"{name}.mesh"] = arguments

    def in_time(self):
        """How the loads vary: between -1 and 1 over the run."""
        s = f"(t/{self.end!r})"
        return self.rng.choice([s, s, f"min(1, 2*{s})", f"({s}<0.5 ? 2*{s} : 2-2*{s})", f"sin(6*pi*{s})", "1",
                                f"{s}^4"])

    def make_bodies(self, count):
        rng = self.rng
        names = ("lower", "upper", "top")[:count]
        overlap = rng.choice(["full", "partial", "narrow"]) if count > 1 else "one body"
        sign = rng.choice(["none", "none", "open", "overlapping"]) if count > 1 else "one body"
        self.contact_alone = contact_alone = count > 1 and rng.random() < 0.4
        amount = {"open": 1, "overlapping": -1}.get(sign, 0) * decades(rng, -12, -2.5)
        left, bottom, width = 0.0, 0.0, 1.0
        for i, name in enumerate(names):
            if i > 0 and overlap != "full":
                # On the middle of the body below, or beyond one of its ends.
                below, width = width, width * rng.uniform(0.3, 0.8)
                left += rng.uniform(0,
                                    below - width) if overlap == "narrow" else rng.choice(
                                        [0, below]) - width / 2
            height = rng.choice([0.2, 1.0, 2.0])
            self.mesh(name, left, bottom, width, height)
            bottom += height + amount
            self.text += ["[[body]]", f'name = "{name}"', f'mesh = "{name}.mesh"',
                          self.material(self.young * (self.ratio if i % 2 else 1))]
            self.support(i, contact_alone)
            if i == count - 1:
                self.loads(width, left, contact_alone, amount)
        self.contacts(names, overlap)

    def contacts(self, names, overlap):
        rng = self.rng
        for lower, upper in zip(names, names[1:]):
            sides = [f'{{ body = "{upper}", label = 1 }}', f'{{ body = "{lower}", label = 3 }}']
            variant = rng.choice(["mortar", "mortar", "interpolation"])
            self.text += ["[[contact]]", f'variant = "{variant}"', 'sliding = "allow"']
            # A nonmortar line with one cell may have no node that the narrow body faces.
            if overlap != "narrow" and rng.random() < 0.3:
                self.text += [f"sides = [ {sides[0]}, {sides[1]} ]"]
                continue
            if overlap != "narrow":
                rng.shuffle(sides)
            self.text += [f"nonmortar = {sides[0]}", f"mortar = {sides[1]}"]

    def support(self, i, contact_alone):
        """Body 0 is held at its bottom. The others are held at their left side, or in x only: at one side,
        where contact must not turn them, or along a line on which they may turn."""
        rng = self.rng
        if i == 0 and rng.random() < 0.7:
            self.text += ["[[body.boundary]]", "label = 1", "ux = 0", "uy = 0"]
            return
        if i == 0:
            self.text += ["[[body.boundary]]", "label = 1", "uy = 0"]
        line = rng.choice([4, 4, 1]) if contact_alone and i > 0 else 4
        self.text += ["[[body.boundary]]", f"label = {line}", "ux = 0"]
        if i > 0 and not contact_alone:
            self.text += ["uy = 0"]

    def loads(self, width, left, contact_alone, amount):
        rng, load = self.rng, self.load
        shape = self.in_time()
        middle, half = left + width / 2, width / 2
        along = rng.choice(["1", "1", f"(1+{rng.uniform(-1, 1)!r}*(x-{middle!r})/{half!r})",
                            f"(x>{middle!r} ? 1 : 0)"])
        if not contact_alone:
            along = rng.choice([along, f"cos(5*(x-{left!r}))", f"(x-{middle!r})/{half!r}"])
        sign = -1 if rng.random() < (0.9 if contact_alone else 0.7) else 1
        self.text += ["[[body.boundary]]", "label = 3"]
        if rng.random() < 0.75:
            self.text += [f'ty = "{sign * load!r}*{along}*{shape}"']
            if rng.random() < 0.3:
                self.text += [f'tx = "{rng.uniform(-1, 1) * load!r}*{shape}"']
        else:
            # The displacement that makes such a stress; none at a side that is held.
            moved = sign * load / (self.young * min(1, self.ratio)) - max(amount, 0)
            held = "1" if contact_alone else f"(x-{left!r})"
            self.text += [f'uy = "{moved!r}*{along}*{held}*{shape}"']
        if rng.random() < 0.2:
            self.text += ["[[body.boundary]]", "label = 2", f'tx = "{-0.3 * load!r}*{shape}"']

    def make_time(self):
        rng = self.rng
        scheme = rng.choice(["backward-euler", "backward-euler", "crank-nicolson", "sdirk2",
                             "sdirk2 by error", "sdirk2 by error", "backward-euler by error"])
        self.text += ["[time]", f"end = {self.end!r}", f'scheme = "{scheme.split()[0]}"']
        if "error" in scheme:
            self.text.append("tolerance = "
                             f"{decades(rng, -3, -1) if 'euler' in scheme else decades(rng, -5, -1)!r}")
        else:
            self.text.append(f"steps = {rng.choice([1, 2, 5, 10, 20])}")


def run_of(program, seed, kind=Scene):
    """The scene, and how the program ends on it."""
    scene = kind(seed)
    return scene, solve(program, "\n".join(scene.text) + "\n", "--quiet", "--threads", "1",
                        files=meshed(program, scene.meshes), patience=PATIENCE)


def examined(program, seed, choices=False, space=False):
    of = importlib.import_module("random_choices")
    _, run = run_of(program, seed, of.SpaceScene if space else of.WideScene if choices else Scene)
    right = run.code in (0, 3) or (run.code == 1 and OVERLAPS in run.told)
    return f"exit {run.code}", [] if right else [run.end]


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 100, choices="scenes of random_choices.py", space="those in space"))
