#!/usr/bin/env python3
"""Random scenes that have a solution, and how the program ends on each.

Two or three stacked rectangles (or one) on meshes of tens of triangles, with everything that a scene may
choose drawn over its whole range: stiffness ratios 1e-9 to 1e9, Poisson's ratio -0.99 to 0.4999, yield
stresses 1e-12 to 1e3 of the load or none, viscosities from almost elastic to almost perfectly plastic,
partial overlap, gaps of either sign, eccentric loads that grow, wave or turn round, both planes, all schemes,
projections and couplings.

Exit code 0 is asked for. 3 is right where contact alone holds a body and the load takes it away. 1 has to be
rare, with a reason; a run that takes longer than the patience counts as a fault whatever it would have ended
with.

Usage: random_scenes.py [--choices | --space] [--count 100] [--seed 0] [--patience 20] [--jobs 1]
                        [--mortier build/mortier]
Scene N is the same on every machine: random_scenes.py --seed N --count 1 --keep FOLDER shows it.
"""
import argparse
import collections
import concurrent.futures
import importlib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

def decades(rng, least, most):
    return 10 ** rng.uniform(least, most)


def decade_class(ratio, limits):
    """The name of the interval between powers of ten in which a ratio lies."""
    for limit in limits:
        if ratio < 10.0 ** limit:
            return f"below 1e{limit}"
    return f"above 1e{limits[-1]}"


class Scene:
    """Scene number `seed`: its text, its meshes (as arguments of `mortier mesh`) and its classes."""

    KINDS = ("yield stress over load", "scheme", "projection", "stiffness ratio", "viscosity",
             "Poisson's ratio", "held by contact alone", "overlap", "gap", "load in time", "plane", "variant",
             "bodies")

    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.classes, self.meshes = {}, {}
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
        self.classes.update({
            "yield stress over load": "elastic" if self.yield_ratio == 0 else decade_class(self.yield_ratio,
                                                                                           (-8, -5, -3, 0)),
            "projection": "elastic" if self.yield_ratio == 0 else "(all one)" if plane == "strain"
            else self.projection,
            "stiffness ratio": "one body" if bodies == 1 else decade_class(self.ratio, (-6, -3, 0, 3, 6)),
            "viscosity": "elastic" if self.yield_ratio == 0 else "theta e " + decade_class(self.stiffness,
                                                                                           (-2, 2, 5, 8)),
            "Poisson's ratio": "below -0.9" if self.poisson < -0.9 else "above 0.49" if self.poisson
            > 0.49 else "between", "plane": plane, "bodies": str(bodies)})
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
        shape, text = self.rng.choice([("ramp", s), ("ramp", s), ("ramp, then hold", f"min(1, 2*{s})"),
                                       ("up and down", f"({s}<0.5 ? 2*{s} : 2-2*{s})"),
                                       ("waves", f"sin(6*pi*{s})"),
                                       ("there at t = 0", "1"), ("power", f"{s}^4")])
        self.classes["load in time"] = shape
        return text

    def make_bodies(self, count):
        rng = self.rng
        names = ("lower", "upper", "top")[:count]
        overlap = rng.choice(["full", "partial", "narrow"]) if count > 1 else "one body"
        sign = rng.choice(["none", "none", "open", "overlapping"]) if count > 1 else "one body"
        contact_alone = count > 1 and rng.random() < 0.4
        self.classes.update({"overlap": overlap, "gap": sign,
                             "held by contact alone": "yes" if contact_alone else "no"})
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
        self.classes["variant"] = "one body"
        for lower, upper in zip(names, names[1:]):
            sides = [f'{{ body = "{upper}", label = 1 }}', f'{{ body = "{lower}", label = 3 }}']
            variant = rng.choice(["mortar", "mortar", "interpolation"])
            self.classes["variant"] = variant
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
        self.classes["scheme"] = scheme
        self.text += ["[time]", f"end = {self.end!r}", f'scheme = "{scheme.split()[0]}"']
        if "error" in scheme:
            self.text.append("tolerance = "
                             f"{decades(rng, -3, -1) if 'euler' in scheme else decades(rng, -5, -1)!r}")
        else:
            self.text.append(f"steps = {rng.choice([1, 2, 5, 10, 20])}")


def try_scene(kind, seed, program, patience, keep):
    """Runs scene `seed` of a kind: its classes, how it ended, what was said,
    seconds of processor time and linear solves."""
    scene = kind(seed)
    with tempfile.TemporaryDirectory(prefix=f"random-{seed}-") as name:
        folder = Path(name)
        (folder / "scene.toml").write_text("\n".join(scene.text) + "\n")
        for mesh, arguments in scene.meshes.items():
            subprocess.run([program, "mesh", *arguments, mesh], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL)
        limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (patience, patience + 1))
        with (folder / "err").open("w+") as err:
            process = subprocess.Popen([program, "run", "scene.toml", "--quiet", "--threads", "1", "--out",
                                        "out"],
                                       cwd=folder, preexec_fn=limit, stdout=subprocess.DEVNULL, stderr=err)
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            err.seek(0)
            told = [line for line in err.read().splitlines() if not line.startswith("mortier: warning: ")]
        summary = next(folder.glob("out*/summary.json"), None)
        facts = json.loads(summary.read_text()) if summary else {}
        if keep:
            shutil.copytree(folder, Path(keep) / str(seed), dirs_exist_ok=True)
    code = process.returncode
    return {"seed": seed, "code": "long" if code == -signal.SIGXCPU else code,
            "told": " ".join(told), "seconds": used.ru_utime + used.ru_stime,
            "solves": facts.get("newton_iterations", 0), "classes": scene.classes}


def tabulate(results, kinds, out=sys.stdout):
    """Exit codes by class."""
    codes = sorted({result["code"] for result in results}, key=str)
    print(f"{'':44}{'scenes':>8}" + "".join(f"{code!s:>7}" for code in codes) + "   share of 1, long",
          file=out)

    def row(name, part):
        count = collections.Counter(result["code"] for result in part)
        bad = sum(n for code, n in count.items() if code not in (0, 2, 3))
        print(f"{name:44}{len(part):8}" + "".join(f"{count[code]:7}"
                                                  for code in codes) + f"{bad / len(part):12.1%}",
              file=out)

    row("all", results)
    for kind in kinds:
        for value in sorted({result["classes"][kind] for result in results}):
            row(f"{kind}: {value}", [result for result in results if result["classes"][kind] == value])


def explore(program, seed, count, patience=20, jobs=1, keep=None, watch=lambda result: None, kind=Scene):
    """Tries scenes; returns what try_scene() does of each."""
    program, results = str(Path(program).resolve()), []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for result in pool.map(lambda number: try_scene(kind, number, program, patience, keep),
                               range(seed, seed + count)):
            watch(result)
            results.append(result)
    return results


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mortier", default=os.environ.get("MORTIER", "build/mortier"))
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0, help="number of the first scene")
    parser.add_argument("--patience", type=int, default=20,
                        help="seconds of processor time that a run may take")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", help="folder to copy the scenes and results to")
    parser.add_argument("--json", help="file for the results, one a line")
    parser.add_argument("--choices", action="store_true", help="scenes of random_choices.py")
    parser.add_argument("--space", action="store_true", help="those in space")
    options = parser.parse_args()
    choices = importlib.import_module("random_choices")
    kind = choices.SpaceScene if options.space else choices.WideScene if options.choices else Scene

    def watch(result):
        if result["code"] != 0:
            print(f"{result['seed']:6} {result['code']!s:>5} {result['seconds']:7.2f} s  "
                  f"{result['told'][:300]}", flush=True)
        if options.json:
            with open(options.json, "a", encoding="utf-8") as file:
                file.write(json.dumps(result) + "\n")

    results = explore(options.mortier, options.seed, options.count, options.patience, options.jobs,
                      options.keep, watch, kind)
    tabulate(results, kind.KINDS)
    print(f"slowest: {max(result['seconds'] for result in results):.1f} s")
    return 1 if any(result["code"] not in (0, 3) for result in results) else 0


if __name__ == "__main__":
    sys.exit(main())
