"""Scenes on which `mortier run --accuracy` is held against far better solutions of the same scenes: the true
error is the difference of the stresses at the end of the run, in the energy norm.
"""
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from scene_parts import body, box, contact, elastic, shape, timed
from support import ROOT
import codes  # behind support: they are in compare/
import results

sys.path.append(str(ROOT / "study"))
from measure import field_error  # noqa: E402

CONTRASTS = (1e-6, 1e-3, 1.0, 1e3, 1e6)


def ring(inner, outer, cells):
    return shape("annulus", inner=inner, outer=outer, cells=cells, span="quarter", cut="rising")


def flowing(young, viscosity=1.0, yield_stress=1.0, more=""):
    return elastic(young, 0.3) + f", viscosity = {viscosity}, yield_stress = {yield_stress}" + more


def either(swapped, one, two, **keys):
    # The equations are linear: displacements have no scale.
    return contact(*((two, one) if swapped else (one, two)), sliding="allow", **keys)


SECOND_ORDER = timed(10, scheme="sdirk2")
HELD = "label = 1, ux = 0, uy = 0"
ROLLERS = "label = 3, uy = 0", "label = 4, ux = 0"


def pressed(young, swapped):
    """Blocks of one width under a pressure that varies."""
    return (body("upper", box([0, 0], [1, 1], [2, 2]), young,
                 'label = 4, ux = 0', 'label = 3, ty = "-1 - 0.8*cos(pi*x)"') +
            body("lower", box([0, -1], [1, 0], [3, 3]), 1.0, HELD) +
            either(swapped, ("upper", 1), ("lower", 3)) + timed())


def shrink(young, swapped):
    """A ring in a ring that is too narrow for it, turned up by a load."""
    return (body("inner", ring(1, 2.002, [4, 2]), young,
                 *ROLLERS, 'label = 1, pressure = "0.001*x"') +
            body("outer", ring(2, 3, [5, 2]), 1.0, *ROLLERS) +
            either(swapped, ("inner", 2), ("outer", 1)) + timed())


def lame(plane, load):
    return (f'plane = "{plane}"\n' +
            body("ring", ring(1, 2, [3, 2]), 1.0, *ROLLERS, load) + timed())


def cylinder(pressure, viscosity):
    return ('plane = "strain"\n' +
            body("ring", ring(1, 2, [3, 2]), flowing(100.0, viscosity),
                 *ROLLERS, f'label = 1, pressure = "{pressure}*t"') + SECOND_ORDER)


def ramp(plane, young, load, more=""):
    return (f'plane = "{plane}"\n' +
            body("square", box([0, 0], [1, 1], [2, 2]), flowing(young, 1.0, 1.0, more),
                 'label = 1, uy = 0', 'label = 4, ux = 0', f'label = 3, ty = "{load}"') +
            SECOND_ORDER)


def flowing_blocks(contrast, swapped, plane="stress"):
    return (f'plane = "{plane}"\n' +
            body("upper", box([0, 0], [1, 1], [2, 2]), flowing(100.0 * contrast),
                 'label = 4, ux = 0', 'label = 3, ty = "-t*(1 + 0.8*cos(pi*x))"') +
            body("lower", box([0, -1], [1, 0], [3, 3]), flowing(100.0),
                 'label = 1, uy = 0', 'label = 4, ux = 0') +
            either(swapped, ("upper", 1), ("lower", 3)) + SECOND_ORDER)


def cases():
    """name -> scene, materials by body (young, poisson), accuracy."""
    found = {}

    def add(name, scene, accuracy, **materials):
        found[name] = scene, {body: (each, 0.3) if isinstance(each, float) else each
                              for body, each in materials.items()}, accuracy
    sides = ((False, ""), (True, ", swapped"))
    for contrast in CONTRASTS:
        for swapped, side in sides:
            add(f"pressed {contrast:g}{side}", pressed(contrast, swapped), 0.01, upper=contrast, lower=1.0)
    for contrast in (1e-3, 1.0, 1e3):
        for swapped, side in sides:
            add(f"shrink fit {contrast:g}{side}", shrink(contrast, swapped), 0.01, inner=contrast, outer=1.0)
    for plane in ("stress", "strain"):
        for name, load in (("pressure", "label = 1, pressure = 1"), ("shear", 'label = 2, tx = "x*y"'),
                           ("pull", 'label = 2, tx = "x"')):
            add(f"ring {plane} {name}", lame(plane, load), 0.01, ring=1.0)
    for pressure, viscosity in ((0.75, 1.0), (1.2, 1.0), (1.2, 0.1)):
        add(f"flow cylinder {pressure} {viscosity}", cylinder(pressure, viscosity), 0.02, ring=100.0)
    for plane in ("stress", "strain"):
        for load in ("-2*t*(1 + 0.5*x)", "-4*t*x*x"):
            add(f"flow square {plane} {load}", ramp(plane, 100.0, load), 0.02, square=100.0)
    for contrast in (1e-3, 1.0, 1e3):
        for swapped, side in sides:
            add(f"flow blocks {contrast:g}{side}", flowing_blocks(contrast, swapped), 0.03,
                upper=100.0 * contrast, lower=100.0)
    return found


def datum(rng, at, jumps=True):
    """A function of `at` in [0, 1] of any shape, between 0 and about 4."""
    a, b = round(rng.uniform(0.3, 0.9), 3), round(rng.uniform(0.1, 0.9), 3)
    return rng.choice(["1", f"(1 + {a}*{at})", f"(1 - {a}*(2*{at} - 1)^2)",
                       f"(1 + {a}*sin(2*pi*({at} + {b})))", f"exp({2 * a:.3f}*{at})",
                       f"({at} < {b} ? 1 : {1 + 3 * a:.3f})" if jumps else "2", f"abs({at} - {b})",
                       f"(1 + {a}*sin({rng.randint(4, 30)}*pi*{at}))",
                       f"(1 + {3 * a:.3f}*exp(-(({at} - {b})/{rng.choice([0.3, 0.05, 0.01])})^2))"])


def random_case(seed):
    """A random problem: its scene, materials, the accuracy and the degree."""
    rng, meshes = random.Random(seed), random.Random(seed)
    degree = rng.choice([1, 2])
    cells = [[meshes.randint(1 + 2 * b, 6), meshes.randint(1, 6)] for b in range(2)]
    young = 10 ** rng.choice([0, rng.uniform(-1, 1), rng.uniform(-4, 4)])
    poisson = [rng.choice([0.0, 0.3, 0.45, 0.49, 0.499]) for _ in range(2)]
    drive = rng.choice(["traction", "traction", "force", "displacement", "gap"])
    wide, start = rng.choice([(1, 0), (1, 0), (3, -1)])
    size = 0.01 * min(1, young)
    top = f'label = 3, ty = "-{size!r}*t*{datum(rng, "x")}"' if drive in ("traction", "force") else \
        f'label = 3, uy = "-0.01*t*{datum(rng, "x", False) if drive == "displacement" else "1"}"'
    weight = {"y": f'-{size!r}*t*{datum(rng, "y")}*{datum(rng, "x")}'}
    gap = f'0.003*{datum(rng, "x", False)}' if drive == "gap" else None
    cut = rng.choice(["rising", "both"])
    scene = (f'plane = "{rng.choice(["stress", "strain"])}"\n' +
             body("upper", box([0, 0], [1, 1], cells[0], cut=cut), elastic(young, poisson[0]),
                  "label = 4, ux = 0", top, force=weight if drive == "force" else None) +
             body("lower", box([start, -1], [start + wide, 0], cells[1], cut=cut),
                  elastic(1.0, poisson[1]), HELD) +
             either(rng.random() < 0.5, ("upper", 1), ("lower", 3), gap=gap) + timed())
    accuracy = 10 ** rng.uniform(-1.3, -0.6) if degree == 1 else 10 ** rng.uniform(-2.3, -1)
    return scene, {"upper": (young, poisson[0]), "lower": (1.0, poisson[1])}, accuracy, degree


def solve(scene, folder, accuracy, degree):
    """The result; where the accuracy is not reached too."""
    path = folder.with_suffix(".toml")
    path.write_text(f"degree = {degree}\n" + scene)
    subprocess.run([codes.MORTIER, "run", path, "--quiet", "--out", folder, "--accuracy", repr(accuracy)],
                   check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return results.read_mortier(folder, failed=True)


def measured(scene, bodies, accuracy, degree, finer):
    """Unknowns, true error, estimate, overhead, whether it was reached."""
    with tempfile.TemporaryDirectory() as place:
        run = solve(scene, Path(place) / "asked", accuracy, degree)
        told, rounds = run.summary["accuracy"], run.summary["rounds"]
        estimate = told["mesh"] + told["time"]
        better = solve(scene, Path(place) / "better", min(accuracy, estimate) / finer, degree)
        error = field_error("energy", run, better, bodies)
    work = [each["steps"] * each["unknowns"]**1.2 for each in rounds]
    reached = told["reached"] and better.summary["accuracy"]["reached"]
    return run.summary["free_dofs"], error, estimate, sum(work) / work[-1], reached


FLOW_STEPS = 20
FLOW_BODIES = {"ring": (100.0, 0.3)}


def flowing_ring(cells, degree):
    """A thick cylinder of which a part flows, on equal cells, with equal steps."""
    return (f'plane = "strain"\ndegree = {degree}\n' +
            body("ring", ring(1, 2, [2 * cells, cells]), flowing(100.0),
                 *ROLLERS, 'label = 1, pressure = "0.75*t"') +
            timed(FLOW_STEPS))


def flow_orders(cells, better):
    """Unknowns and errors by degree on meshes of ever more cells across, against quadratic displacements on
    `better` cells. Steps are the same: the error is that of the meshes.

    cells: degree -> list
    """
    found = {}
    with tempfile.TemporaryDirectory() as place:
        def run(count, degree):
            folder = Path(place) / f"{degree}-{count}"
            folder.with_suffix(".toml").write_text(flowing_ring(count, degree))
            codes.call([codes.MORTIER, "run", folder.with_suffix(".toml"), "--quiet", "--out", folder])
            return results.read_mortier(folder)
        best = run(better, 2)
        for degree, counts in cells.items():
            runs = [run(count, degree) for count in counts]
            found[degree] = (np.array([each.summary["free_dofs"] for each in runs]),
                             np.array([field_error("energy", each, best, FLOW_BODIES) for each in runs]))
    return found


def fitted(unknowns, errors):
    """Order of the errors in the unknowns, and a function that tells how many unknowns an error takes."""
    order, constant = np.polyfit(np.log(unknowns), np.log(errors), 1)
    return order, lambda error: float(np.exp((np.log(error) - constant) / order))
