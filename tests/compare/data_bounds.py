#!/usr/bin/env python3
"""Guaranteed bounds of random elastic scenes against solutions on finer meshes, by the shape of the data.

Two blocks, one on the other, on meshes of tens of triangles. `linear` data are linear on sides and constant
on triangles; `natural` ones are waves, parabolas, patches, gaps of those shapes, body forces and initial
stresses that vary; `hostile` ones have narrow peaks, waves shorter than a side, and jumps.

No bound may be below the distance from the finer solution less the bound of that, and the enclosures of both
of every quantity have to meet. Prints the median of bound over distance.

    tests/compare/data_bounds.py [--linear | --hostile] [--count 100] [--first SEED] [--jobs N]
                                 [--mortier PROGRAM]
"""
import random
import statistics
import sys

import numpy as np

from contact_support import command, solve

FINER = 8


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


def measured(program, kind, number, finer=FINER):
    """What is wrong, bound over distance or None where the bound is refused, and how many quantities."""
    text, materials = scene(kind, number)
    coarse, fine = (solve(program, each, "--quiet", "--threads", "1", fields=True, patience=600)
                    for each in (text, scene(kind, number, finer)[0]))
    if coarse.code != 0 or fine.code != 0:  # 3: loads pull the bodies apart
        return [run.end for run in (coarse, fine) if run.code not in (0, 3)], None, 0
    bound, own = (run.summary["accuracy"]["bound"] for run in (coarse, fine))
    if "reason" in bound:
        return [], None, 0
    faults, off, enclosed = [], distance(coarse, fine, materials), 0
    if bound["absolute"] < off - own.get("absolute", float("inf")):
        faults.append(f"bound {bound['absolute']:.4g} below {off:.4g} - {own['absolute']:.4g}")
    for name, each in coarse.summary["quantities"].items():
        ours, other = each["bound"], fine.summary["quantities"][name]["bound"]
        if ours["error"] is None or other["error"] is None:
            continue
        enclosed += 1
        if max(ours["lower"] - other["upper"], other["lower"] - ours["upper"]) > 1e-9 * abs(each["value"]):
            faults.append(f"{name}: {ours} and {other} do not meet")
    return faults, bound["absolute"] / off, enclosed


def examined(program, seed, linear=False, hostile=False):
    kind = "linear" if linear else "hostile" if hostile else "natural"
    faults, ratio, enclosed = measured(program, kind, seed)
    return f"{kind}, bound over distance {ratio}, {enclosed} quantities", faults, ratio


def tell(ratios):
    bounded = [each for each in ratios if each is not None]
    print(f"{len(bounded)} of {len(ratios)} bounded, bound over distance: least {min(bounded):.3f}, median "
          f"{statistics.median(bounded):.2f}, largest {max(bounded):.1f}")


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 100, told=tell, linear="linear data", hostile="hostile data"))
