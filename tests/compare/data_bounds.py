#!/usr/bin/env python3
"""Guaranteed bounds of random elastic scenes against solutions on finer meshes, by the shape of the data.

Two blocks, one on the other, on meshes of tens of triangles. `linear` data are linear on sides and constant
on triangles; `natural` ones are waves, parabolas, patches, gaps of those shapes, body forces and initial
stresses that vary; `hostile` ones have narrow peaks, waves shorter than a side, and jumps.

No bound may be below the distance from the finer solution less the bound of that, and the enclosures of both
of every quantity have to meet. Prints the median of bound over distance of each kind.

Usage: data_bounds.py [--linear 100] [--natural 100] [--hostile 20] [--seed 0] [--finer 8] [--jobs 2]
Scene N of a kind is the same on every machine; --show KIND N prints it.
"""
import argparse
import concurrent.futures
import json
import os
import random
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(os.environ.get("MORTIER_ROOT", Path(__file__).resolve().parents[2]))
PROGRAM = str(Path(os.environ.get("MORTIER", ROOT / "build" / "mortier")).resolve())
sys.path.insert(0, str(ROOT / "compare"))
import results  # noqa: E402

KINDS = ("linear", "natural", "hostile")


def shape(rng, kind, at="x"):
    """1 and something beside, on [0, 1]."""
    a = round(rng.uniform(0.3, 0.9), 3)
    b = round(rng.uniform(0, 1), 3)
    if kind == "linear":
        return f"(1 + {a}*{at})"
    if kind == "natural":
        return rng.choice([f"(1 + {a}*sin(pi*{at}))", f"(1 + {a}*cos(2*pi*{at}))", f"(1 + {a}*{at}^2)",
                           f"(1 - {a}*(2*{at} - 1)^2)", f"(1 + {a}*exp(-(({at} - {b})/0.3)^2))",
                           f"(1 + {a}*sin(pi*({at} + {b})))", f"exp({a}*{at})"])
    n = rng.randint(5, 30)
    return rng.choice([f"(1 + {5 * a}*exp(-(({at} - {b})/0.004)^2))", f"(1 + {4 * a}*sin({n}*pi*{at}))",
                       f"({at} < {b} ? 1 : {round(1 + 3 * a, 3)})", f"(1 + {a}*abs({at} - {b})*10)",
                       f"({at} > {b} && {at} < {b} + 0.03 ? 10 : 1)"])


def scene(kind, number, finer=1):
    """The text of a scene, and the elastic constants of its bodies."""
    rng = random.Random(f"{kind} {number}")
    plane = rng.choice(["stress", "strain"])
    young = [1.0, round(10 ** rng.uniform(-1.5, 1.5), 3)]
    poisson = [round(rng.uniform(0, 0.45), 2) for _ in range(2)]
    cells = [rng.randint(2, 5), rng.randint(2, 5)]
    wide = rng.random() < 0.3
    cut = rng.choice(["rising", "both"])
    size = 0.01 * min(young)
    top, held, gap, extra = [], "", "", ["", ""]
    place = rng.choice(["traction", "displacement", "gap", "force", "stress"])
    if kind == "hostile" and place in ("displacement", "gap", "stress"):
        place = "traction"
    if place == "displacement":
        top.append(f'{{ label = 3, uy = "-0.01*t*{shape(rng, kind)}" }}')
    elif place == "gap":
        top.append('{ label = 3, uy = "-0.02*t" }')
        gap = f'gap = "0.005*({shape(rng, kind)} - 1)"\n'
    else:
        ty = shape(rng, kind if place == "traction" else "linear")
        top.append(f'{{ label = 3, ty = "{-size}*t*{ty}" }}')
    if place == "force":
        x, y = (f'"{size}*t*{shape(rng, kind, at)}"' if kind != "linear" else f'"{size}*t"' for at in "xy")
        extra[0] = f"force = {{ x = {x}, y = {y} }}\n"
    if place == "stress":
        value = f'"{-size}*{shape(rng, kind)}"' if kind != "linear" else size
        extra[0] = f"initial_stress = {{ s11 = {value}, s22 = 0, s12 = 0 }}\n"
    top.append("{ label = 4, ux = 0 }")
    bottom = "{ label = 1, ux = 0, uy = 0 }"
    lower = [-0.5, 1.5] if wide else [0, 1]
    text = f'plane = "{plane}"\n'
    for i, (name, box, boundary) in enumerate((("upper", [[0, 0], [1, 1]], ", ".join(top)),
                                               ("lower", [[lower[0], -1], [lower[1], 0]], bottom))):
        across = cells[i] * finer
        along = across * (2 if wide and i == 1 else 1)
        text += (f'[[body]]\nname = "{name}"\nmesh = {{ shape = "rectangle", cut = "{cut}", '
                 f'lower = {box[0]}, upper = {box[1]}, cells = [{along}, {across}] }}\n'
                 f"material = {{ young = {young[i]}, poisson = {poisson[i]} }}\n"
                 f"boundary = [{boundary}]\n{extra[i]}")
    sides = [('body = "upper", label = 1', 'body = "lower", label = 3')]
    one, other = sides[0] if rng.random() < 0.5 else sides[0][::-1]
    text += (f"[contact]\nnonmortar = {{ {one} }}\nmortar = {{ {other} }}\n{gap}"
             f'variant = "{rng.choice(["mortar", "interpolation"])}"\n'
             "[time]\nend = 1\nsteps = 1\n[accuracy]\nbound = true\n"
             '[[quantity]]\nname = "press"\ncontact_force = { body = "lower", label = 3 }\ncomponent = "y"\n'
             '[[quantity]]\nname = "sinks"\ndisplacement = { body = "upper", label = 3 }\ncomponent = "y"\n'
             '[[quantity]]\nname = "holds"\nreaction = { body = "lower", label = 1 }\ncomponent = "y"\n'
             '[[quantity]]\nname = "leans"\nreaction = { body = "upper", label = 4 }\ncomponent = "x"\n')
    return text, {name: (plane, young[i], poisson[i]) for i, name in enumerate(("upper", "lower"))}


def run(text, folder):
    (folder / "scene.toml").write_text(text)
    done = subprocess.run([PROGRAM, "run", "scene.toml", "--quiet", "--out", "out", "--threads", "1"],
                          cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=600)
    if done.returncode == 3:
        raise RuntimeError("refused: loads pull the bodies apart")
    if done.returncode != 0:
        raise RuntimeError(f"exit {done.returncode}: {done.stdout.strip()[-300:]}")
    return results.read_mortier(folder / "out"), json.loads((folder / "out" / "summary.json").read_text())


def energy(stress, plane, young, poisson):
    """s : E^-1 s by triangles, of the components in the plane."""
    if plane == "strain":
        young, poisson = young / (1 - poisson**2), poisson / (1 - poisson)
    s11, s22, s12 = stress[:, 0], stress[:, 1], stress[:, 2]
    return (s11**2 + s22**2 - 2 * poisson * s11 * s22 + 2 * (1 + poisson) * s12**2) / young


def triangles_at(body, places):
    """The triangle of a body in which each place is."""
    x = body.points[body.triangles]
    first, second = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]
    area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    off = places[:, None] - x[None, :, 0]
    a = (off[..., 0] * second[:, 1] - off[..., 1] * second[:, 0]) / area
    b = (first[:, 0] * off[..., 1] - first[:, 1] * off[..., 0]) / area
    return np.minimum(np.minimum(a, b), 1 - a - b).argmax(1)


def distance(coarse, fine, materials):
    square = 0.0
    for name, body in fine.bodies.items():
        x = body.points[body.triangles]
        (x1, y1), (x2, y2) = (x[:, 1] - x[:, 0]).T, (x[:, 2] - x[:, 0]).T
        areas = np.abs(x1 * y2 - x2 * y1) / 2
        own = coarse.bodies[name].stress[triangles_at(coarse.bodies[name], x.mean(1))]
        square += (areas * energy(body.stress - own, *materials[name])).sum()
    return square**0.5


def measure(kind, number, finer):
    """(kind, number, bound over distance or None, what went wrong, quantities)"""
    text, materials = scene(kind, number)
    try:
        with tempfile.TemporaryDirectory() as folder:
            coarse, summary = run(text, Path(folder))
            bound = summary["accuracy"]["bound"]
            if "reason" in bound:
                return kind, number, None, "refused: " + bound["reason"], 0
            fine, reference = run(scene(kind, number, finer)[0], Path(folder))
        off = distance(coarse, fine, materials)
        own = reference["accuracy"]["bound"]
        faults = []
        if bound["absolute"] < off - own.get("absolute", float("inf")):
            faults.append(f"bound {bound['absolute']:.4g} below {off:.4g} - {own['absolute']:.4g}")
        enclosed = 0
        for name, each in summary["quantities"].items():
            other = reference["quantities"][name]["bound"]
            if each["bound"]["error"] is None or other["error"] is None:
                continue
            enclosed += 1
            rounding = 1e-9 * abs(each["value"])
            ours = each["bound"]
            if max(ours["lower"] - other["upper"], other["lower"] - ours["upper"]) > rounding:
                faults.append(f"{name}: {each['bound']} and {other} do not meet")
        return kind, number, bound["absolute"] / off, "; ".join(faults), enclosed
    except (RuntimeError, subprocess.TimeoutExpired, results.ResultError) as error:
        return kind, number, None, str(error), 0


def survey(counts, seed, finer, jobs):
    """kind -> ratios; faults; refusals; how many quantities."""
    ratios, faults, refused, quantities = {kind: [] for kind in KINDS}, [], [], 0
    work = [(kind, number) for kind in KINDS for number in range(seed, seed + counts[kind])]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for kind, number, ratio, wrong, enclosed in pool.map(lambda each: measure(*each, finer), work):
            quantities += enclosed
            if ratio is not None:
                ratios[kind].append(ratio)
            if wrong.startswith("refused"):
                refused.append(f"{kind} {number}: {wrong}")
            elif wrong:
                faults.append(f"{kind} {number}: {wrong}")
    return ratios, faults, refused, quantities


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    for kind, count in zip(KINDS, (100, 100, 20)):
        parser.add_argument("--" + kind, type=int, default=count)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--finer", type=int, default=8)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--show", nargs=2)
    options = parser.parse_args()
    if options.show:
        print(scene(options.show[0], int(options.show[1]))[0])
        return 0
    counts = {kind: getattr(options, kind) for kind in KINDS}
    ratios, faults, refused, quantities = survey(counts, options.seed, options.finer, options.jobs)
    for kind in KINDS:
        if ratios[kind]:
            print(f"{kind}: {len(ratios[kind])} of {counts[kind]} bounded, bound over distance: least "
                  f"{min(ratios[kind]):.3f}, median {statistics.median(ratios[kind]):.2f}, largest "
                  f"{max(ratios[kind]):.1f}")
    print(f"{quantities} quantities")
    for line in refused + faults:
        print(line)
    print(f"{len(refused)} refused, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
