#!/usr/bin/python3
"""Random bodies that slide along each other in space with sliding = "finite": blocks, balls, tools that roll
and spin, in any direction, past ends, back and forth. Every run ends certified, or with a reason. Shown of
each are its exit code, the linear solves that its steps took, the message.

    tests/compare/random_slides_space.py [--all] [--count 50] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import random
import sys

from contact_support import command
from random_slides import slid


def path(rng, reach):
    """A motion along one axis from t = 0.2 on."""
    far = rng.uniform(-1, 1) * reach
    return rng.choice([f"{far:.6g}*max(t - 0.2, 0)/0.8", f"{far:.6g}*sin(5*max(t - 0.2, 0))"])


def scene(seed):
    rng = random.Random(seed)
    young = 1e3 * 10 ** rng.uniform(-1, 1)
    other = young * 10 ** rng.uniform(-4, 4)
    length, width = rng.uniform(2, 4), rng.uniform(1, 2)
    along, across = path(rng, 1.2 * length), path(rng, 0.6 * width)
    depth = rng.uniform(2e-3, 2e-2)
    mu = rng.choice([0, rng.uniform(0, 1)])
    variant = rng.choice(["weighted", "weighted", "", "mortar", "interpolation"])
    degree = 2 if variant in ("weighted", "") and rng.random() < 0.25 else 1
    kind = rng.choice(["block", "block", "ball", "tool", "rolling"])
    x, y = length / 2, width / 2
    if kind == "block":
        a, b = rng.uniform(0.3, 0.8), rng.uniform(0.3, 0.8)
        cells = f"[{rng.randint(1, 4)}, {rng.randint(1, 4)}, {rng.randint(1, 3)}]"
        mesh = (f'{{ shape = "cuboid", lower = [{x - a / 2:.6g}, {y - b / 2:.6g}, 0], '
                f'upper = [{x + a / 2:.6g}, {y + b / 2:.6g}, 0.5], cells = {cells} }}')
        near, held = 1, 3
    else:
        radius = rng.uniform(1, 4)
        half = "" if kind == "rolling" else ', keep = ["-z"]'
        mesh = (f'{{ shape = "ball", centre = [{x:.6g}, {y:.6g}, {radius:.6g}], radius = {radius:.6g}, '
                f'cells = {rng.randint(4, 8)}{half} }}')
        near, held = 7, 3
    press = f'"-{depth:.6g}*min(5*t, 1)"'
    sides = [f'{{ body = "upper", label = {near} }}', '{ body = "lower", label = 3 }']
    if kind in ("block", "ball"):
        rng.shuffle(sides)
        upper = (f"[[body]]\nname = \"upper\"\nmesh = {mesh}\n"
                 f"material = {{ young = {other:.6g}, poisson = 0.3 }}\n"
                 f'boundary = [ {{ label = {held}, ux = "{along}", uy = "{across}", uz = {press} }} ]\n')
    else:
        sides.reverse()
        turns = rng.choice(["moment_x = 0\nmoment_y = 0\n", 'rotation_y = "t"\nrotation_z = "-2*t"\n'])
        upper = (f"[[tool]]\nname = \"upper\"\nmesh = {mesh}\nat = [{x:.6g}, {y:.6g}, {radius:.6g}]\n"
                 f'ux = "{along}"\nuy = "{across}"\nuz = {press}\n'
                 + (turns if kind == "rolling" and mu > 0 else ""))
    chosen = f'variant = "{variant}"\n' if variant else ""
    return f"""\
dimension = 3
degree = {degree}
[[body]]
name = "lower"
mesh = {{ shape = "cuboid", lower = [0, 0, -0.6], upper = [{length:.6g}, {width:.6g}, 0], cells = [{
    rng.randint(5, 12)}, {rng.randint(3, 6)}, 2] }}
material = {{ young = {young:.6g}, poisson = 0.3 }}
boundary = [ {{ label = 1, ux = 0, uy = 0, uz = 0 }} ]
{upper}[[contact]]
sides = [ {sides[0]}, {sides[1]} ]
{chosen}friction = {mu:.6g}
sliding = "finite"
[time]
end = 1
steps = {rng.choice([10, 20])}
"""


def examined(program, seed):
    return slid(program, scene(seed))


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 50))
