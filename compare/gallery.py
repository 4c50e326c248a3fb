#!/usr/bin/python3
"""The gallery: scenes with numbers that theory knows, and their pictures (docs/gallery.md).

    compare/gallery.py                runs all its scenes, prints the numbers, draws docs/images/gallery/*.png
    compare/gallery.py punch cook     these only
    compare/gallery.py --out DIR      pictures go elsewhere

Exit code 1 when a number misses its theory. tests/compare/gallery_test.py asserts the same table.
"""
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np

import results
from codes import ROOT, RunError, run_mortier

sys.path.append(str(ROOT / "views"))
import images  # noqa: E402
import pictures  # noqa: E402
import runs  # noqa: E402

PICTURES = ROOT / "docs" / "images" / "gallery"


@dataclass
class Number:
    quantity: str  # what is measured
    measure: Callable  # of a run
    theory: float
    tolerance: float  # relative to theory
    reason: str  # of the tolerance
    told: str = "found {}"  # what docs/gallery.md says of it, {} in place of the measured number


@dataclass
class Entry:
    scene: str
    numbers: list
    scale: float  # of the displacements in the picture
    window: tuple = None  # x and y range of the picture; None: everything
    step: int = None  # of the picture; None: the last one
    course: Callable = None  # a second picture: labels of its axes, and points of both
    balance: float = 1e-12  # force balance, relative
    beside: tuple = ()  # settings of a second run, drawn next to the first


def end_of_contact(run, side):
    """Where the bodies part, on the left (-1) or the right (1). Beyond it the gap grows with the power 3/2 of
    the distance, so its power 2/3 is continued back by a line from the second and third node off contact."""
    x, gap = side * run.contact.position[:, 0], run.contact.gap
    order = np.argsort(x)
    beyond = [i for i in order if x[i] > x[run.contact.force > 0].max()]
    (x1, x2), (d1, d2) = x[beyond[1:3]], gap[beyond[1:3]] ** (2 / 3)
    return side * (x1 - d1 * (x2 - x1) / (d2 - d1))


def worst_stress(run, exact):
    """1 + the largest deviation of a stress component from a homogeneous field, over its size."""
    field = np.concatenate([body.stress for body in run.bodies.values()])
    return 1 + np.abs(field - exact).max() / np.abs(exact).max()


def quantity(run, name):
    return run.summary["quantities"][name]["value"]


def cook_deflection(run):
    """u_y in the middle of the loaded side."""
    panel = run.bodies["panel"]
    tip = np.argmin(np.hypot(*(panel.points - (48, 52)).T))
    return panel.displacement[tip, 1]


def gap_at_three(run):
    """Of the open blocks at t = 3 s, from the rows of contact.csv that the last step does not hold."""
    rows = results.read_csv(run.folder / "contact.csv")
    return np.mean([float(row["gap"]) for row in rows if abs(float(row["time"]) - 3) < 1e-9])


def punch_pressure(run):
    """In the middle, over P/(pi a)."""
    middle = np.argmin(np.abs(run.contact.position[:, 0]))
    return run.contact.pressure[middle] * np.pi / np.sum(run.contact.force)


def receding_pressure(run):
    """Under the load, over the load; half of it is modelled."""
    return run.contact.pressure[np.argmin(run.contact.position[:, 0])] / (2 * np.sum(run.contact.force))


def lift_off(run):
    """Eccentricity e = 0.6 t at which the left edge parts: in full contact all forces are linear in e."""
    rows = [row for row in results.read_csv(run.folder / "contact.csv") if float(row["x"]) == -1]
    times, forces = np.array([[float(row["time"]), float(row["force"])] for row in rows]).T
    full = forces > 0
    slope, constant = np.polyfit(0.6 * times[full], forces[full], 1)
    return -constant / slope


def hertz_peak(run):
    """Largest pressure over sqrt(F E*/(pi R)), E* = 52500 MPa of both bodies in plane stress, R = 50 mm."""
    return run.contact.pressure.max() / np.sqrt(np.sum(run.contact.force) * 52500 / (np.pi * 50))


def sphere_of_hertz(run):
    """Peak pressure and radius of contact by theory for the contact force [MPa, mm]: steel of radius 50 mm on
    aluminium."""
    compliance = (1 - 0.3**2) / 210000 + (1 - 0.33**2) / 70000
    force = np.sum(run.contact.force)
    radius = (0.75 * force * compliance * 50) ** (1 / 3)
    return 1.5 * force / (np.pi * radius**2), radius


def sphere_peak(run):
    return run.contact.pressure.max() / sphere_of_hertz(run)[0]


def sphere_radius(run):
    """Where the square of the pressure, linear in that of the radius, would vanish; over theory."""
    exact = sphere_of_hertz(run)[1]
    r = run.contact.position[:, 0]
    inside = r < 0.75 * exact  # beyond it pressures are those of the mesh
    slope, constant = np.polyfit(r[inside] ** 2, run.contact.pressure[inside] ** 2, 1)
    return np.sqrt(-constant / slope) / exact


def cone_pressure(run):
    """At half the radius of contact that Sneddon gives the force, over his E*/20 arcosh(a/r) there."""
    modulus = 1000 / (1 - 0.3**2)
    radius = np.sqrt(20 * run.contact.force.sum() / (np.pi * modulus))
    order = np.argsort(run.contact.position[:, 0])
    found = np.interp(radius / 2, run.contact.position[order, 0], run.contact.pressure[order])
    return found / (modulus / 20 * np.arccosh(2))


def ironed_place(run):
    """Middle of the pressure over the way of the cylinder."""
    return np.average(run.contact.position[:, 0], weights=run.contact.force) / 4.7


def wedge_force(run):
    """Driving force over spreading force, over that of a wedge that slides."""
    ratio = -quantity(run, "drive") / quantity(run, "spread")
    return abs(ratio) / np.tan(np.arctan(0.2) + np.arctan(0.2))


def press_fit_pressure(run):
    """In the middle of the ring, over Lame's."""
    x, p = run.contact.position[:, 1], run.contact.pressure
    order = np.argsort(x)
    return np.interp(-1, x[order], p[order]) / (1000 * 0.005 / (5 / 3 + 0.3))


def hook_at(run, way):
    """Pushing and lifting force where the hook has gone this way."""
    history = results.read_history(run.folder)
    step = np.argmin(np.abs(2.3 * history["time[s]"] - way))
    return history["push[N/mm]"][step], history["lift[N/mm]"][step]


def hook_push(run):
    """Over the lifting force, halfway up the nose, and over what friction of 0.2 on a slope of 30 degrees
    makes of it."""
    push, lift = hook_at(run, 0.5)
    return push / lift / np.tan(np.pi / 6 + np.arctan(0.2))


def hook_lift(run):
    """On top of the nose, at the edge of the lip behind, over that of a beam bent by 0.4 that friction bends
    the other way: its arm is half of the height and the depth of the lip."""
    length = 10 + 0.7 / np.tan(np.radians(80)) + 0.1 * np.tan(np.radians(40))
    stiffness = 3 * 2000 / (1 - 0.3**2) * 0.6**3 / 12 / length**3
    return hook_at(run, 1.4)[1] / (0.4 * stiffness / (1 - 1.5 * 0.2 * (0.3 + 0.7) / length))


def hook_course(run):
    history = results.read_history(run.folder)
    return "way of the hook [mm]", "push [N/mm]", 2.3 * history["time[s]"], history["push[N/mm]"]


def creep_rate(run):
    """Radial velocity on the inner circle in the second half of the run."""
    liner = run.bodies["liner"]
    r = np.hypot(*liner.points.T)
    inner = np.abs(r - 1) < 1e-9
    half = results.read_vtu(run.folder / "liner_000005.vtu")
    moved = np.sum((liner.displacement - half.displacement) * liner.points, axis=1) / r
    return moved[inner].mean() / 2.5


def mean_pressure(run):
    """Over the quarter of a circle of radius 1, or the eighth of a sphere of radius 1."""
    return np.sum(run.contact.force) / (np.pi / 2)


def curvature(run):
    """Of the strip between x = -2 and 2, by the parabola through its lower side."""
    strip = run.bodies["lower"]
    below = (strip.points[:, 1] == -0.5) & (np.abs(strip.points[:, 0]) < 2.01)
    return -2 * np.polyfit(strip.points[below, 0], strip.displacement[below, 1], 2)[0]


def ball_peak(run):
    """Of a quarter of the force, over Hertz's (6 F E*^2/(pi^3 R^2))^(1/3)."""
    force, modulus = -4 * quantity(run, "press"), 1 / (2 * (1 - 0.3**2))
    return quantity(run, "peak") / np.cbrt(6 * force * modulus**2 / np.pi**3)


# Timoshenko, Journal of the Optical Society of America 11 (1925): strips of one thickness, 1 both, with
# moduli as 2 to 1, and the difference of their expansions, 1e-3.
BIMETAL = 24e-3 / (14 + 2 + 1/2)


def constant_stress(exact, tolerance=1e-10):
    return Number("1 + stress error", lambda run: worst_stress(run, np.array(exact)), 1, tolerance,
                  "the patch test holds to rounding", "**{}**")


def contact_force(theory, tolerance, reason):
    return Number("contact force", lambda run: run.scalars["contact_force"], theory, tolerance, reason)


GALLERY = [
    Entry("cook", [Number("u_y in the middle of the right side", cook_deflection, 23.275, 3e-5,
                          "half of the last digit of the value for 32 cells a side", "**{}**")], 0.3),
    Entry("stack", [constant_stress([0, -10, 0])], 300),
    Entry("bimetal", [Number("curvature [1/m]", curvature, BIMETAL, 1e-6,
                             "the ends are four thicknesses away")], 30),
    Entry("sloped", [constant_stress([-10, -10, 0])], 300),
    Entry("broken-line", [constant_stress([-10, -10, 0])], 3000),
    Entry("turned", [constant_stress([-3.6, -6.4, 4.8])], 0.3),  # -10 along (-3/5, 4/5)
    Entry("cut-ring", [contact_force(0.644067796610, 2e-4, "falls as h^2: 3.1e-4, 6.0e-5, 1.6e-5 with 15, "
                                     "30, 60 edges of the quarter circle")], 10),
    Entry("exact-contact", [contact_force(0.769126488659, 1e-3, "the force converges with order 2 at least; "
                                          "32 cells on 49")], 0.05),
    Entry("edge", [contact_force(2, 1e-2, "two elements of 1/2 under an unbounded pressure")], 0.05),
    Entry("hertz", [Number("peak pressure over sqrt(F E*/(pi R))", hertz_peak, 1, 2e-2,
                           "half-width 0.13 R, where Hertz takes parabolas; the mesh")], 1,
          ((-25, 25), (-25, 18))),
    Entry("sphere", [Number("peak pressure over Hertz's", sphere_peak, 1, 1e-2, "the mesh: 9 elements",
                            "found {} and"),
                     Number("radius of contact over Hertz's", sphere_radius, 1, 1e-2, "the same",
                            "and {} (from a fit")], 1,
          ((0, 25), (-18, 18))),
    Entry("cone", [Number("pressure at half the radius over Sneddon's", cone_pressure, 1, 1e-2,
                          "the mesh: 8 elements")], 1, ((0, 4), (-3, 1))),
    Entry("ironing", [Number("middle of the contact pressure over the way of the cylinder", ironed_place,
                             1, 1e-2, "a third of an edge")], 1, ((2, 7.5), (-2, 2)), balance=1e-9),
    Entry("roller", [Number("angle by which it turns over way / radius",
                            lambda run: quantity(run, "turned") / -1.5, 1, 1e-2,
                            "the block is strained where it presses")], 1, ((-1, 5), (-1, 2)), balance=1e-9),
    Entry("wedge", [Number("driving over spreading force, over tan(alpha + phi)", wedge_force, 1, 1e-9,
                           "all nodes slip")], 1, balance=1e-9),
    Entry("press-fit", [Number("pressure in the middle over Lame's", press_fit_pressure, 1, 2e-2,
                               "friction along the ring, and its ends")], 1, balance=1e-9),
    Entry("hook", [Number("push over lift, over (mu + tan a)/(1 - mu tan a)", hook_push, 1, 1e-3, "statics",
                          "found {}. The lifting"),
                   Number("lifting force over that of a beam", hook_lift, 1, 1e-2, "clamp, lip, shear",
                          "found {}. <img")],
          1, ((-0.5, 14.5), (-1.6, 1.6)), balance=1e-9, step=23, course=hook_course),
    Entry("receding", [Number("half-width of contact", lambda run: end_of_contact(run, 1), 1.324165, 1e-2,
                              "the mesh: an element at the end of contact is 0.08", "found {}; largest"),
                       Number("p(0)/P", receding_pressure, 0.713081, 1e-2,
                              "the mesh, and the width of the load", "**0.713081**, found {}")],
          0.05, ((0, 4), (-2, 1.1))),
    Entry("open-close", [Number("gap at t = 3 s", gap_at_three, 0.04, 1e-6,
                                "the stress that has not yet relaxed at t = 2 s")], 1),
    Entry("bolt", [Number("force of the bolt [N]", lambda run: -quantity(run, "bolt"), 489.219330855, 1e-9,
                          "bars under uniform stresses", "**{}**")], 100),
    Entry("rail", [Number("displacement of the middle", lambda run: quantity(run, "down"), -0.11066819197,
                          1e-2, "the beam of Euler and Bernoulli has no shear strain")], 10,
          ((0, 40), (-3, 3))),
    Entry("ring", [Number("mean contact pressure", mean_pressure, 0.128205128205, 5e-3,
                          "falls as h^2: 8.4e-3, 2.2e-3, 5.4e-4 with 18, 36, 72 edges of the ring")], 5),
    Entry("punch", [Number("pressure in the middle over P/(pi a)", punch_pressure, 1, 3e-2,
                           "the force of the unbounded pressure at the edges takes a fine mesh")], 10,
          ((-3, 3), (-2.5, 1.2))),
    Entry("thick-cylinder", [Number("radial velocity on the inner circle", creep_rate, 0.02664150516, 3e-3,
                                     "falls as h^2: 5.9e-3, 1.5e-3, 3.7e-4 with 18, 36, 72 edges "
                                     "of the liner")], 1),
    Entry("eccentric-punch", [Number("eccentricity over a at lift-off", lift_off, 0.5, 4e-2,
                                     "the edge node has a mean of the pressure beside it: 0.517, 0.508 with "
                                     "26, 52 cells")],
          10, ((-3, 3), (-2.5, 1.2)), balance=5e-12),  # the punch is 1000 times as stiff: its rounding
    Entry("cubes", [Number("displacement of the top by backward Euler", lambda run: quantity(run, "top"),
                           -0.285, 1e-9, "rounding of strains at E = 3e11 yield stresses", "**{}**")], 1,
          beside=("contact.variant=interpolation",)),
    Entry("tilted", [constant_stress([-10, -4, -10, 0, 0, 0], 1e-12)], 5,
          beside=("contact.variant=interpolation",)),
    Entry("shells", [Number("mean contact pressure over Lame's",
                            lambda run: mean_pressure(run) / 0.6089743589743589, 1, 1e-2,
                            "the mesh: flat triangles on spheres")], 20),
    Entry("known-end", [contact_force(0.192281622165, 5e-3, "the mesh: 7 elements in contact")], 0.05),
    Entry("round-punch", [Number("displacement over F (1 - nu^2)/(2 a E)",
                                 lambda run: quantity(run, "down") / -0.00455, 1, 1e-2, "the mesh")], 50),
    Entry("rolling-ball", [Number("angle by which it turns over way / radius",
                                  lambda run: quantity(run, "turned") / 0.4, 1, 1e-2,
                                  "the block is strained where it presses")], 1, balance=1e-8),
    Entry("ball", [Number("peak pressure over Hertz's", ball_peak, 1, 1e-2, "the mesh: 10 elements")], 1,
          balance=1e-11),
]


def run_entry(entry, folder):
    return run_mortier(Path(folder) / entry.scene, [], f"scenes/{entry.scene}.toml")


def draw(entry, folder, out):
    """Deformed bodies, coloured by von Mises stress."""
    folders = [folder]
    if entry.beside:
        name = "-".join([entry.scene, *(setting.split("=")[-1] for setting in entry.beside)])
        scene = f"scenes/{entry.scene}.toml"
        folders.append(run_mortier(folder.with_name(name), list(entry.beside), scene).folder)
    seen = [pictures.view(runs.read(each), entry.step) for each in folders]
    window = entry.window and (*entry.window[0], *entry.window[1])
    with pictures.plt.rc_context(pictures.STYLE):
        figure = pictures.fields(seen, scale=entry.scale, window=window, strips=False)
    save(figure, out / f"{entry.scene}.png")


def save(figure, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(images.small(images.picture(figure, "png", dpi=90)))


def draw_course(entry, run, out):
    along, up, x, y = entry.course(run)
    with pictures.plt.rc_context(pictures.STYLE):
        figure, axes = pictures.plt.subplots(figsize=(6, 2.6), layout="constrained")
        axes.axhline(0, color="0.7", linewidth=0.8)
        axes.plot(np.append(0, x), np.append(0, y))
        axes.set_xlabel(along)
        axes.set_ylabel(up)
    save(figure, out / f"{entry.scene}-course.png")


def error(number, run):
    return abs(number.measure(run) / number.theory - 1)


def main():
    parser = results.argument_parser(__doc__)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="names of scenes (default: all)")
    parser.add_argument("--out", type=Path, default=PICTURES, metavar="DIR", help="folder of the pictures")
    arguments = parser.parse_args()
    names = [entry.scene for entry in GALLERY]
    for scene in arguments.scenes:
        if scene not in names:
            parser.error(f"{scene}: expected one of {', '.join(names)}")
    missed = 0
    print(f"{'scene':16} {'quantity':42} {'measured':>14} {'theory':>14} {'error':>8} {'allowed':>8}")
    with tempfile.TemporaryDirectory(prefix="mortier-gallery-") as folder:
        for entry in GALLERY:
            if arguments.scenes and entry.scene not in arguments.scenes:
                continue
            try:
                run = run_entry(entry, folder)
            except (RunError, results.ResultError) as fault:
                print(f"gallery: {fault}", file=sys.stderr)
                return 1
            draw(entry, run.folder, arguments.out)
            if entry.course:
                draw_course(entry, run, arguments.out)
            for number in entry.numbers:
                miss = not error(number, run) <= number.tolerance
                missed += miss
                print(f"{entry.scene:16} {number.quantity:42} {number.measure(run):14.9g} "
                      f"{number.theory:14.9g} {error(number, run):8.1e} "
                      f"{number.tolerance:8.0e}{'  missed' if miss else ''}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
