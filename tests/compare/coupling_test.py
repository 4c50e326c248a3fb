#!/usr/bin/python3
"""Ties to points: couplings, layers and springs of a stiffness, bolts that are tightened."""
import math
import unittest

from scene_parts import body, box, contact, elastic, quantity, tied, timed, tool
from support import ROOT, InFolder, value, values

YOUNG, POISSON = 1000.0, 0.3


def block(name, mesh, *boundary):
    return body(name, mesh, elastic(YOUNG, POISSON), *boundary)


def point_tool(name, at, motions):
    return tool(name, shape="point", at=at, more=motions + "\n")


def tie(one, other, more=""):
    sides = ((each,) if isinstance(each, str) else each for each in (one, other))
    return tied(*sides, more=more + "\n")


STEP = timed()
SQUARE = box([0, 0], [2, 1], [7, 4])
CUBE = box([0, 0, 0], [2, 1, 1], [4, 3, 3])


class Dimension:
    """A block that is held at its bottom, and what its top does."""

    def __init__(self, dimension, degree, head=""):
        self.space = dimension == 3
        self.head = f"degree = {degree}\n{head}" + ("dimension = 3\n" if self.space else "")
        self.axes = ["x", "y", "z"][:dimension]
        self.up = self.axes[-1]
        self.top = 3
        self.at = [1, 0.5, 1] if self.space else [1, 1]
        self.rotations = ["rotation_x", "rotation_y", "rotation_z"] if self.space else ["rotation"]
        self.moments = ["moment_x", "moment_y", "moment_z"] if self.space else ["moment"]
        self.area = 2.0
        self.fixed = ", ".join(f"u{axis} = 0" for axis in self.axes)

    def body(self, top=""):
        sides = [f"label = 1, {self.fixed}"] + ([f"label = 3, {top}"] if top else [])
        return self.head + block("block", CUBE if self.space else SQUARE, *sides)

    def numbers(self, body="block"):
        text = "".join(quantity(f"base_{axis}", "reaction", body, 1, axis) for axis in self.axes)
        text += "".join(quantity(f"base_{each}", "reaction", body, 1, each, self.at) for each in self.moments)
        return text + quantity("stored", "stored_energy", body)

    def motions(self):
        """Of the point, by keys."""
        keys = [f"u{axis}" for axis in self.axes] + self.rotations
        return dict(zip(keys, [0.01, -0.02, 0.015, 0.03, -0.01, 0.02]))

    def motion_text(self):
        return "\n".join(f'{key} = "{each}*t"' for key, each in self.motions().items())

    def side(self):
        """The same motion, of the side."""
        m = self.motions()
        x, y, z = "(x - 1)", "(y - 0.5)" if self.space else "(y - 1)", "(z - 1)"
        if not self.space:
            return (f'ux = "t*({m["ux"]} - {m["rotation"]}*{y})", '
                    f'uy = "t*({m["uy"]} + {m["rotation"]}*{x})"')
        a, b, c = (m[each] for each in self.rotations)
        return (f'ux = "t*({m["ux"]} + {b}*{z} - {c}*{y})", uy = "t*({m["uy"]} + {c}*{x} - {a}*{z})", '
                f'uz = "t*({m["uz"]} + {a}*{y} - {b}*{x})"')


CASES = [Dimension(2, 1), Dimension(2, 2, 'plane = "strain"\n'), Dimension(3, 1), Dimension(3, 2)]


class Case(InFolder):
    def assertAgree(self, one, other, within=1e-10):
        self.assertEqual(one.keys(), other.keys())
        size = max(map(abs, one.values()))
        for name, each in one.items():
            self.assertAlmostEqual(each, other[name], delta=within * size, msg=name)


class Couplings(Case):
    def test_a_kinematic_coupling_is_a_prescribed_side(self):
        for of in CASES:
            with self.subTest(head=of.head):
                point = point_tool("handle", of.at, of.motion_text())
                ties = tie(("block", of.top), "handle")
                coupled = self.run_it(of.body() + point + ties + of.numbers() + STEP)
                held = self.run_it(of.body(of.side()) + of.numbers() + STEP)
                self.assertAgree(values(coupled), values(held))

    def test_forces_and_moments_of_a_point_give_its_motion_back(self):
        for coupling in ("kinematic", "distributing"):
            for of in CASES:
                with self.subTest(coupling=coupling, head=of.head):
                    more = f'coupling = "{coupling}"'
                    loads = dict(zip([f"f{axis}" for axis in of.axes] + of.moments, [3, -5, 2, 1, -2, 1.5]))
                    driven = point_tool("handle", of.at,
                                  "\n".join(f'{key} = "{each}*t"' for key, each in loads.items()))
                    asked = "".join(quantity(f"of_{each}", "displacement", "handle", component=each)
                                    for each in of.axes + of.rotations)
                    ties = tie(("block", of.top), "handle", more)
                    found = values(self.run_it(of.body() + driven + ties + of.numbers() + asked + STEP))
                    balance = {f"base_{key.replace('f', '', 1)}": -each for key, each in loads.items()}
                    self.assertAgree({name: found[name] for name in balance}, balance)
                    names = {key: "of_" + (key[1:] if key[0] == "u" else key) for key in of.motions()}
                    moved = point_tool("handle", of.at, "\n".join(f"{key} = {found[name]!r}"
                                                            for key, name in names.items()))
                    work = quantity("back", "reaction", "handle", component=of.up)
                    back = self.run_it(of.body() + moved + ties + of.numbers() + work + STEP)
                    self.assertAlmostEqual(value(back, "back"), loads[f"f{of.up}"], delta=1e-9)

    def test_a_distributed_force_is_a_uniform_traction(self):
        for of in CASES + [Dimension(2, 1, 'plane = "axisymmetric"\n')]:
            with self.subTest(head=of.head):
                rings = "axisymmetric" in of.head
                up = of.up
                text = of.body()
                if rings:
                    text = text.replace("ux = 0, ", "")
                    of.moments, of.axes = [], ["y"]
                area = 4 * 3.141592653589793 if rings else of.area
                others = [f"f{axis}" for axis in of.axes[:-1]] + of.moments
                free = "\n".join(f"{each} = 0" for each in others)
                point = point_tool("handle", [0, 1] if rings else of.at, f'f{up} = "{3 * area!r}*t"\n{free}')
                ties = tie(("block", of.top), "handle", 'coupling = "distributing"')
                coupled = self.run_it(text + point + ties + of.numbers() + STEP)
                pulled = self.run_it(text.replace(" ]\n", f', {{ label = 3, t{up} = "3*t" }} ]\n')
                                     + of.numbers() + STEP)
                self.assertAgree(values(coupled), values(pulled))

    def test_along_some_axes_alone(self):
        """A plate that presses without friction along the sides is a roller."""
        for of in CASES[:3:2]:
            with self.subTest(head=of.head):
                point = point_tool("plate", of.at, f'u{of.up} = "-0.02*t"')
                ties = tie(("block", of.top), "plate", f'along = ["{of.up}"]')
                coupled = self.run_it(of.body() + point + ties + of.numbers() + STEP)
                self.assertIn("kinematic coupling of", (told := self.mortier("check", "scene.toml").stdout))
                self.assertEqual([axis for axis in "xyz" if f"free along {axis}" in told], of.axes[:-1])
                pressed = self.run_it(of.body(f'u{of.up} = "-0.02*t"') + of.numbers() + STEP)
                self.assertAgree(values(coupled), values(pressed))

    def test_a_support_that_says_something_else_is_refused(self):
        of = CASES[0]
        handle = point_tool("handle", of.at, 'uy = "-0.02*t"') + tie(("block", 3), "handle")
        text = of.body('uy = "-0.01*t"') + handle
        place = next(k for k, line in enumerate(text.splitlines(), 1) if line == "[[contact]]")
        self.refuse(text + STEP, f"scene.toml:{place}: contact: the supports of body block and the motion of "
                                 "tool handle differ by 0.01 at (")
        agreed = text.replace("-0.02*t", "-0.01*t")
        self.assertEqual(self.run_it(agreed + STEP)["status"], "converged")


class Layers(Case):
    """One-dimensional states: rollers on both bodies, or POISSON = 0."""

    def column(self, of, more, load):
        rollers = ["label = 4, ux = 0"] + (["label = 5, uy = 0"] if of.space else [])
        cells = ([4, 3, 2], [3, 2, 3]) if of.space else ([5, 3], [7, 4])
        lower, upper = ([0, 0, 0], [2, 1, 1]) if of.space else ([0, 0], [2, 1])
        raised = [*lower[:-1], 1], [*upper[:-1], 2]
        return (of.head + block("lower", box(lower, upper, cells[0]), f"label = 1, u{of.up} = 0", *rollers)
                + block("upper", box(*raised, cells[1]), *rollers, f"label = 3, {load}")
                + tie(("upper", 1), ("lower", 3), more))

    def test_a_layer_gives_way_by_its_traction_over_its_stiffness(self):
        k, p = 200.0, 3.0
        for of in (Dimension(2, 1), Dimension(2, 2), Dimension(2, 1, 'plane = "axisymmetric"\n'),
                   Dimension(3, 1), Dimension(3, 2)):
            for variant in ("mortar", "weighted"):
                if variant == "mortar" and of.space and "degree = 2" in of.head:
                    continue
                with self.subTest(head=of.head, variant=variant):
                    text = self.column(of, f'stiffness = {k}\nvariant = "{variant}"', f't{of.up} = "-{p}*t"')
                    text += quantity("top", "displacement", "upper", 3, of.up)
                    text += quantity("force", "external_work", "upper")
                    text += quantity("stored", "stored_energy", "upper")
                    text += quantity("below", "stored_energy", "lower")
                    found = self.run_it(text + STEP)
                    top = -p * (2 / YOUNG + 1 / k)
                    self.assertAlmostEqual(value(found, "top"), top, delta=1e-12)
                    area = 2.0 if "axisymmetric" not in of.head else 4 * 3.141592653589793
                    self.assertAlmostEqual(value(found, "stored"), p**2 / YOUNG * area / 2, delta=1e-11)
                    self.assertAlmostEqual(value(found, "below"), p**2 / YOUNG * area / 2, delta=1e-11)
                    self.assertAlmostEqual(value(found, "force"), -p * top * area / 2, delta=1e-11)

    def test_a_stiff_layer_is_none(self):
        of = Dimension(2, 1)
        load = 'tx = "t*(1 + x)", ty = "-t*x^2"'
        numbers = quantity("top", "displacement", "upper", 3, "y")
        rigid = values(self.run_it(self.column(of, "", load) + numbers + STEP))
        ratio = []
        for k in (1e6, 1e8):
            soft = values(self.run_it(self.column(of, f"stiffness = {k}", load) + numbers + STEP))
            ratio.append(abs(soft["top"] - rigid["top"]))
        self.assertAlmostEqual(ratio[0] / ratio[1], 100, delta=1)

    def test_the_estimate_of_a_bent_beam_on_a_layer(self):
        """Under a given load the work differs from the exact one by the square of the error; a quarter of it
        is stored in the beam, the rest in the layer."""
        for settings in ([], ["contact.along=['x', 'y']"], ["degree=1", "body.beam.mesh.cells=[200, 8]"]):
            with self.subTest(settings=settings):
                fine = "[800, 32]" if "degree=1" in settings else "[200, 4]"
                runs = []
                for cells in ([], [f"body.beam.mesh.cells={fine}"]):
                    self.mortier("run", ROOT / "scenes/rail.toml", "--quiet", "--out", "out",
                                 *(word for each in settings + cells for word in ("--set", each)))
                    runs.append(self.summary_of())
                coarse, exact = (value(each, "down") for each in runs)
                error = 2*math.sqrt(abs(coarse/exact - 1))
                estimate = runs[0]["accuracy"]["energy_error"]
                self.assertGreater(estimate, 0.8*error)
                self.assertLess(estimate, 2*error)

    def test_a_block_on_springs(self):
        """A bed of springs, and one spring: a point that nothing moves."""
        k, p = 50.0, 3.0
        for of in CASES:
            with self.subTest(head=of.head):
                sides = [f'label = 3, t{axis} = "{load}*t"'
                         for axis, load in zip(of.axes, [1.0, 0.5, -p] if of.space else [1.0, -p])]
                bed = of.head + block("block", CUBE if of.space else SQUARE, *sides)
                ground = point_tool("ground", [1, 0.5, 0] if of.space else [1, 0], "")
                springs = tie(("block", 1), "ground", f'coupling = "distributing"\nstiffness = {k}')
                asked = "".join(quantity(f"u_{axis}", "displacement", "block", 1, axis)
                                for axis in of.axes)
                asked += "".join(quantity(f"f_{axis}", "reaction", "ground", component=axis)
                                 for axis in of.axes)
                found = values(self.run_it(bed + ground + springs + asked + STEP))
                loads = [1.0, 0.5, -p] if of.space else [1.0, -p]
                for axis, load in zip(of.axes, loads):
                    self.assertAlmostEqual(found[f"u_{axis}"], load / k, delta=1e-12)
                    self.assertAlmostEqual(found[f"f_{axis}"], -load * of.area, delta=1e-11)

    def test_flow_beside_a_layer(self):
        """A layer stores what it takes: the work of the loads is stored or dissipated."""
        k = 300.0
        of = Dimension(2, 1)
        text = self.column(of, f"stiffness = {k}", 'ty = "-4*min(t, 1)"')
        text = text.replace(f"poisson = {POISSON} }}",
                            f"poisson = {POISSON}, viscosity = 100, yield_stress = 3 }}")
        text += quantity("jump", "displacement", "upper", 1, "y")
        text += quantity("under", "displacement", "lower", 3, "y")
        found = values(self.run_it(text + timed(12, 3)))
        self.assertAlmostEqual(found["jump"] - found["under"], -4 / k, delta=1e-12)


class Bolts(Case):
    """A bolt through two plates, in half its section: its shank is cut and tied, its head and nut are tied to
    the plates, which touch."""

    LENGTH = 2.0

    def scene(self, motion, shank="", more="", material=""):
        bolt = material or elastic(YOUNG, 0)
        text = body("low", box([0, -1], [1, 0], [2, 3]), bolt, "label = 4, ux = 0", more=shank)
        text += body("high", box([0, 0], [1, 1], [3, 2]), bolt, "label = 4, ux = 0", more=shank)
        text += block("under", box([1.2, -1], [3, 0], [4, 3]), "label = 1, uy = 0, ux = 0")
        text += block("over", box([1.2, 0], [3, 1], [4, 3]), "label = 2, ux = 0")
        text += point_tool("nut", [0, -1], "fy = 0") + point_tool("head", [0, 1], "fy = 0")
        for plate, side, cap, end in (("under", 1, "nut", ("low", 1)), ("over", 3, "head", ("high", 3))):
            text += tie((plate, side), cap, 'along = ["y"]') + tie(end, cap, 'along = ["y"]')
        text += contact(("over", 1), ("under", 3), sides=True)
        if motion is not None:
            text += point_tool("cut", [0, 0], motion) + tie(("low", 3), ("high", 1), 'offset = "cut"')
            text += quantity("shortening", "displacement", "cut", component="y")
        else:
            text += tie(("low", 3), ("high", 1))
        text += quantity("force", "contact_force", "high", 3, "y")
        text += quantity("clamp", "contact_force", "over", 1, "y")
        return text + quantity("stored", "stored_energy", "over") + more

    def test_tightened_by_a_force_a_length_and_a_temperature(self):
        force = values(self.run_it(self.scene('fy = "5*t"') + STEP))
        self.assertAlmostEqual(force["force"], 5, delta=1e-10)
        self.assertAlmostEqual(force["clamp"], 5, delta=1e-10)
        length = force["shortening"]
        self.assertGreater(length, 5 / YOUNG * self.LENGTH)
        given = values(self.run_it(self.scene(f"uy = {length!r}") + STEP))
        self.assertAgree(given, force, 1e-9)
        # The shank is stressed along its axis alone, so that cooling it is a shortening.
        along = (f'elasticity = "orthotropic", young1 = {YOUNG:g}, young2 = {YOUNG:g}, '
                 f"shear12 = {YOUNG / 2:g}, poisson12 = 0, expansion = [0, 1, 0]")
        cold = values(self.run_it(self.scene(None, shank=f"temperature = {-length / self.LENGTH!r}\n",
                                             material=along) + STEP))
        del force["shortening"]
        self.assertAgree(cold, force, 1e-9)

    def test_a_bolt_that_is_locked_after_it_was_tightened(self):
        """Its length stays, its force does not."""
        loads = 'force = { y = "3*max(0, t - 1)" }\n'

        def loaded(motion):
            return self.scene(motion).replace('name = "over"\n', f'name = "over"\n{loads}', 1)
        self.run_it(loaded('fy = "5*t"') + STEP + "[output]\nstate = true\n", folder="first")
        tight = values(self.run_it(loaded('fy = "5*t"') + STEP))
        going = 'start = "first"\n' + loaded('uy = "held"') + timed(1, 2)
        locked = values(self.run_it(going))
        self.assertAlmostEqual(locked["shortening"], tight["shortening"], delta=1e-15)
        self.assertGreater(locked["force"], 5 + 1e-3)
        whole = values(self.run_it(loaded(f'uy = "{tight["shortening"]!r}*min(t, 1)"')
                                   + timed(2, 2)))
        self.assertAgree(whole, locked, 1e-9)

    def test_a_distance_of_contact_is_an_offset_of_a_tie(self):
        """Where all of a contact without friction is closed."""
        def scene(between):
            return (block("upper", box([0, 1], [1, 2], 5), "label = 3, uy = 0", "label = 4, ux = 0")
                    + block("lower", box([0, 0], [1, 1], [5, 3]), "label = 1, uy = 0, ux = 0") + between
                    + quantity("top", "reaction", "upper", 3, "y")
                    + quantity("stored", "stored_energy", "lower") + STEP)
        sides = ("upper", 1), ("lower", 3)
        near = values(self.run_it(scene(contact(*sides, gap="-0.01*t", variant="mortar"))))
        apart = point_tool("wedge", [0, 1], 'uy = "0.01*t"') + contact(
            *sides, kind="tied", variant="mortar", along=["y"], offset="wedge")
        self.assertAgree(values(self.run_it(scene(apart))), near, 1e-9)


class Points(Case):
    def test_forces_at_points_are_borne_by_the_supports(self):
        for of in CASES + [Dimension(2, 1, 'plane = "axisymmetric"\n')]:
            with self.subTest(head=of.head):
                rings = "axisymmetric" in of.head
                forces = dict(zip(of.axes, [1.0, -2.0, 0.5]))
                at = [2, 1, 1] if of.space else [2, 1]
                loads = ", ".join(f'f{axis} = "{each}*t"' for axis, each in forces.items())
                text = of.body().replace("boundary =", f"point = {{ at = {at}, {loads} }}\nboundary =")
                if rings:
                    of.moments = []
                text += of.numbers() + quantity("work", "external_work", "block")
                text += "".join(quantity(f"u_{axis}", "displacement", "block", component=axis, point=at)
                                for axis in of.axes)
                run = self.run_it(text + STEP)
                found = values(run)
                for axis, each in forces.items():
                    if not rings or axis == "y":  # a ring bears what points outwards
                        self.assertAlmostEqual(found[f"base_{axis}"], -each, delta=1e-11)
                work = sum(each * found[f"u_{axis}"] for axis, each in forces.items()) / 2
                self.assertAlmostEqual(found["work"], work, delta=1e-13)
                self.assertAlmostEqual(found["stored"], work, delta=1e-12)
                self.assertIn("where the energy of a force is infinite",
                              " ".join(run["accuracy"]["not_reliable"]))
                self.refuse(text + STEP + "[accuracy]\nenergy = 0.1\n",
                            "a force at a point, expected none beside accuracy")


class Refusals(Case):
    def test_what_does_not_belong_together(self):
        of = CASES[0]
        point = point_tool("handle", of.at, "")
        good = of.body() + point + tie(("block", 3), "handle", "MORE") + STEP
        two = of.body() + block("other", SQUARE, "label = 1, ux = 0")
        for text, expected in (
                (good.replace("MORE", 'variant = "mortar"'), "none beside a tool of shape"),
                (good.replace("MORE", "stiffness = 1"), "it beside coupling"),
                (good.replace("MORE", "stiffness = -1"), "stiffness > 0"),
                (good.replace("MORE", 'along = ["z"]'), "a list of x, y"),
                (good.replace("MORE", "along = []"), "at least"),
                (good.replace("MORE", 'offset = "handle"'), "none beside a tool as a side"),
                (good.replace("MORE", 'coupling = "loose"'), "one of kinematic, distributing"),
                (good.replace("MORE", "").replace('kind = "tied"\n', ""), 'beside a tool of shape "point"'),
                (good.replace("MORE", "").replace("at = [1, 1]\n", ""), "the place of the point"),
                (two + tie(("block", 3), ("other", 1), 'coupling = "kinematic"') + STEP,
                 "it beside a tool of shape"),
                (two + tie(("block", 3), ("other", 1), 'offset = "block"') + STEP,
                 "the name of a tool of shape"),
                (two + tie(("block", 3), ("other", 1), 'stiffness = 1\nvariant = "interpolation"') + STEP,
                 "it beside variant")):
            with self.subTest(expected=expected):
                self.write(text)
                errors = self.mortier("run", "scene.toml", "--out", "out", code=2).stderr
                self.assertIn(expected, errors)


if __name__ == "__main__":
    unittest.main()
