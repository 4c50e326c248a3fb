#!/usr/bin/python3
"""Random bodies that slide along each other with sliding = "finite": blocks and discs on blocks, stiffnesses
that differ by up to 1e6, friction up to 1, past ends and corners, back and forth. Every run ends certified,
or with a reason. Shown of each are its exit code, the linear solves that its steps took, the message.

    tests/compare/random_slides.py [--all] [--count 50] [--first SEED] [--jobs N] [--mortier PROGRAM]
"""
import random
import statistics
import sys

from contact_support import command, solve

CERTIFIED = ("force_balance", "gap_on_active", "friction", "complementarity")


def variant_of(rng):
    variant = rng.choice(["weighted", "weighted", "mortar", "", "interpolation"])
    return f'variant = "{variant}"' if variant else ""


def scene(seed):
    rng = random.Random(seed)
    young = 1e3 * 10 ** rng.uniform(-1, 1)
    ratio = 10 ** rng.uniform(0, 6)
    lower, upper = rng.choice([(young, young * ratio), (young * ratio, young)])
    degree = rng.choice([1, 1, 2])
    mu = rng.choice([0, rng.uniform(0, 1)])
    length = rng.uniform(3, 8)
    disc = rng.random() < 0.5
    depth = rng.uniform(1e-3, 1e-2)
    if disc:
        radius = rng.uniform(1, 4)
        mesh = (f'{{ shape = "halfdisc", radius = {radius:.6g}, core = {radius / 5:.6g}, '
                f'cells = {rng.randint(3, 6)}, lowest = [{length / 3:.6g}, 0] }}')
        near, held = 1, 2
    else:
        width = rng.uniform(0.5, 2)
        cells = f"[{rng.randint(2, 8)}, {rng.randint(2, 5)}]"
        mesh = (f'{{ shape = "rectangle", lower = [{length / 3:.6g}, 0], '
                f'upper = [{length / 3 + width:.6g}, 1], cells = {cells}, cut = "both" }}')
        near, held = 1, 3
    far = rng.uniform(0.2, 1.2) * length  # may pass the end
    way = rng.choice([f"{far:.6g}*max(t - 0.2, 0)/0.8",
                      f"{far:.6g}*sin(5*max(t - 0.2, 0))",
                      f"-{far:.6g}*max(t - 0.2, 0)/0.8"])
    press = f'uy = "-{depth:.6g}*min(5*t, 1)"'
    if not disc and rng.random() < 0.2:  # held by contact alone: falls where it passes the end
        press = f'ty = "-{depth * young / 10:.6g}*min(5*t, 1)"'
    sides = [f'{{ body = "upper", label = {near} }}', '{ body = "lower", label = 3 }']
    rng.shuffle(sides)
    return f"""\
degree = {degree}
plane = "{rng.choice(['stress', 'strain'])}"
[[body]]
name = "lower"
[body.mesh]
shape = "rectangle"
lower = [0, -1.5]
upper = [{length:.6g}, 0]
cells = [{rng.randint(8, 24)}, 4]
cut = "both"
[body.material]
young = {lower:.6g}
poisson = 0.3
[[body.boundary]]
label = 1
ux = 0
uy = 0
[[body]]
name = "upper"
mesh = {mesh}
material = {{ young = {upper:.6g}, poisson = 0.3 }}
boundary = [ {{ label = {held}, ux = "{way}", {press} }} ]
[contact]
nonmortar = {sides[0]}
mortar = {sides[1]}
{variant_of(rng)}
friction = {mu:.6g}
sliding = "finite"
[time]
end = 1
steps = {rng.choice([10, 20, 40])}
"""


def slid(program, text):
    """What was found of a scene, and the complaints about it."""
    run = solve(program, text, "--quiet", "--threads", "1", patience=300)
    solves = [int(row["iterations"]) for row in run.history if int(row["step"]) > 0]
    shown = f"{run.end}, {len(solves)} steps"
    if solves:
        shown += f", solves of a step: median {statistics.median(solves):g}, most {max(solves)}"
    if run.code not in (0, 1, 3) or not run.summary and run.code != 3:
        return shown, ["no result"]
    verified = run.summary.get("verification", {})
    if run.code == 0 and max(verified[key] for key in CERTIFIED if key in verified) > 1e-8:
        return shown, [f"not certified, {verified}"]
    return shown, []


def examined(program, seed):
    return slid(program, scene(seed))


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 50))
