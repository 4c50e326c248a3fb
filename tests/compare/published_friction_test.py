"""Friction in the test suites of other codes, as far as slips are small: their data, meshes of our own, their
values within their tolerances.

- Code_Aster, SSNV128 (V6.04.128, astest/ssnv128a.comm): a plate on a rigid plane, as GRECO proposed it.
- Code_Aster, SSNV503 (V6.04.503, astest/ssnv503b.comm): a pad on an inclined plane.
- Kratos, applications/ContactStructuralMechanicsApplication/tests/ALM_frictional_contact_test_2D:
  pure_friction_test, a punch, and static_evolution_load_test, a block that is dragged.
"""
import math
import unittest

from support import InFolder

# Points of the plate: x [m], displacement along x [m]
SSNV128 = {"A": (0, 2.86e-5), "B": (0.00125, 2.72e-5), "C": (0.005, 2.28e-5), "D": (0.0075, 1.98e-5),
           "E": (0.01125, 1.5e-5)}
ASTER_PRECISION = 0.05

# Nodes of Kratos' punch and base: x, displacement along x, and along y beyond the 5e-5 that part them
PUNCH = ((0.1, 4.2945e-7, -4.2793e-7), (0.075, 3.0674e-7, -5.8411e-7), (0.05, 2.1551e-7, -6.3005e-7),
         (0.025, 1.2210e-7, -6.5827e-7), (0, 0, -6.8509e-7))
BASE = ((0.35, 4.8802e-7, 0), (0.105, 3.0116e-7, -2.9238e-7), (0.0875, 2.9373e-7, -5.3066e-7),
        (0.0525, 2.2403e-7, -6.2651e-7), (0, 3.6213e-8, -6.8509e-7))
# Of the block's lower side: x, and the displacements along x at these times
TIMES = (1.5, 2.0, 2.5, 3.0)
DRAGGED = ((0.2, (9.4930e-7, 1.8988e-6, 1.4419e-3, 3.3993e-3)),
           (0.5, (9.9869e-7, 1.9985e-6, 2.0423e-3, 4.6869e-3)),
           (0.8, (9.4490e-7, 2.0344e-6, 2.4180e-3, 5.6365e-3)))
KRATOS_TOLERANCE = 1e-3  # of from_json_check_result_process, which has no unit: of a displacement [m]


def body(name, lower, upper, cells, material, boundary):
    return f"""[[body]]
name = "{name}"
mesh = {{ shape = "rectangle", lower = {lower}, upper = {upper}, cells = {cells}, cut = "both" }}
material = {{ {material} }}
boundary = [ {boundary} ]
"""


def contact(nonmortar, mortar, friction, more=""):
    return f"""[contact]
nonmortar = {{ body = "{nonmortar[0]}", label = {nonmortar[1]} }}
mortar = {{ body = "{mortar[0]}", label = {mortar[1]} }}
friction = {friction}
{more}
"""


def motion(name, of, place, component="x"):
    return f"""[[quantity]]
name = "{name}"
displacement = {{ body = "{of}", point = {list(place)} }}
component = "{component}"
"""


def steps(end, count):
    return f"[time]\nend = {end}\nsteps = {count}\n"


HELD = ", ".join(f"{{ label = {label}, ux = 0, uy = 0 }}" for label in (1, 2, 3, 4))


class PublishedFriction(InFolder):
    def values(self, scene):
        """The quantities of all steps."""
        self.write(scene)
        self.mortier("run", "scene.toml", "--quiet", "--out", "out")
        header, *rows = (line.split(",") for line in self.read("out/history.csv").splitlines())
        names = [name.split("[")[0] for name in header]
        return [dict(zip(names, row)) for row in rows]

    def test_ssnv128_plate_on_a_rigid_plane(self):
        """Its 32 x 32 quadrilaterals; part of the lower side is lifted, part slips, part sticks."""
        scene = 'plane = "strain"\n' + body(
            "plate", [0, 0], [0.04, 0.04], [32, 32], "young = 1.3e11, poisson = 0.2",
            '{ label = 2, ux = 0 }, { label = 3, ty = "-5e7*t" }, { label = 4, tx = "15e7*t" }') + body(
            "plane", [-0.01, -0.01], [0.05, 0], [6, 1], "young = 1e11, poisson = 0.2", HELD) + contact(
            ("plate", 1), ("plane", 3), 1)
        scene += "".join(motion(name, "plate", (x, 0)) for name, (x, _) in SSNV128.items()) + steps(1, 5)
        last = self.values(scene)[-1]
        for name, (_, reference) in SSNV128.items():
            with self.subTest(name):
                print(f"SSNV128 {name}: {float(last[name]):.4e}, {float(last[name]) / reference - 1:+.2%}")
                self.assertAlmostEqual(float(last[name]) / reference, 1, delta=ASTER_PRECISION)

    def test_ssnv503_pad_on_an_inclined_plane(self):
        """A pad of 40 x 20 mm, 2 mm off a plane at 30 degrees, pressed by 300 MPa and pushed along by 0.99
        and by 1.01 of what friction bears. Springs of a few N/mm hold it there; nothing does here."""
        along, across = (math.cos(math.pi / 6), 0.5), (-0.5, math.cos(math.pi / 6))

        def at(x, y):
            return [x * along[0] + y * across[0], x * along[1] + y * across[1]]

        def quadrilateral(name, low, high, cells, young, boundary):
            corners = [at(low[0], low[1]), at(high[0], low[1]), at(high[0], high[1]), at(low[0], high[1])]
            return f"""[[body]]
name = "{name}"
mesh = {{ shape = "quadrilateral", corners = {corners}, cells = {cells}, cut = "both" }}
material = {{ young = {young}, poisson = 0 }}
boundary = [ {boundary} ]
"""

        def scene(push):
            forces = f'{{ label = 3, pressure = "300*t" }}, {{ label = 4, pressure = "{push}*t" }}'
            text = 'units = "mm, N, MPa"\nplane = "strain"\n' + quadrilateral(
                "pad", (-20, 2), (20, 22), [8, 4], 2.1e5, forces) + quadrilateral(
                "plane", (-30, -5), (30, 0), [11, 1], 1e5, "{ label = 1, ux = 0, uy = 0 }")
            text += contact(("pad", 1), ("plane", 3), 0.3) + motion("x", "pad", at(-20, 2))
            text += motion("y", "pad", at(-20, 2), "y")
            for name in "xy":
                text += f'[[quantity]]\nname = "f{name}"\ncontact_force = {{ body = "pad", label = 1 }}\n' \
                        f'component = "{name}"\n'
            return text + steps(1, 2)

        last = self.values(scene(178.2))[-1]
        force = [float(last["fx"]), float(last["fy"])]
        for direction, reference in ((across, 12000), (along, -3564)):
            sum_ = sum(a * b for a, b in zip(force, direction))
            print(f"SSNV503: {sum_:.6g}, {sum_ / reference - 1:+.1e}")
            self.assertAlmostEqual(sum_ / reference, 1, delta=1e-9)  # 0.05 there
        self.assertAlmostEqual(float(last["x"]), 1, delta=0.027)
        self.assertAlmostEqual(float(last["y"]) / -1.732, 1, delta=0.01)

        self.write(scene(181.8))
        errors = self.mortier("run", "scene.toml", "--quiet", "--out", "out", code=3).stderr
        self.assertIn("cannot hold body pad: translation along (0.866, 0.5)", errors)

    def test_kratos_punch(self):
        """A punch on a block, both of steel, coefficient 0.05, under 2.02 MPa."""
        steel = "young = 206.9e9, poisson = 0.29"
        scene = 'plane = "strain"\n' + body(
            "punch", [0, 0.075], [0.1, 0.2005], [16, 20], steel,
            '{ label = 4, ux = 0 }, { label = 3, ty = "-2.02e6*t" }') + body(
            "base", [0, 0], [0.35, 0.075], [80, 17], steel, "{ label = 1, uy = 0 }")
        scene += contact(("punch", 1), ("base", 3), 0.05, "gap = 5e-5")
        for name, nodes in (("punch", PUNCH), ("base", BASE)):
            for i, (x, _, _) in enumerate(nodes):
                scene += motion(f"{name}{i}x", name, (x, 0.075))
                scene += motion(f"{name}{i}y", name, (x, 0.075), "y")
        last = self.values(scene + steps(1, 4))[-1]
        largest = max(abs(y) for _, _, y in PUNCH)
        worst = 0
        for name, nodes in (("punch", PUNCH), ("base", BASE)):
            for i, (_, x, y) in enumerate(nodes):
                parted = 5e-5 if name == "punch" else 0
                off = max(abs(float(last[f"{name}{i}x"]) - x),
                          abs(float(last[f"{name}{i}y"]) + parted - y))
                worst = max(worst, off / largest)
                self.assertLess(off, KRATOS_TOLERANCE)
        print(f"Kratos' punch: off by {worst:.2%} of the largest displacement")
        self.assertLess(worst, 0.05)

    def test_kratos_dragged_block(self):
        """A block pressed on a stiff layer, dragged along at its lower side from t = 1 on: it sticks until
        t = 2, then it slides and is stretched, one corner being held. Cells as large as theirs, two across
        the block, which bends: much depends on them."""
        scene = 'plane = "strain"\n' + body(
            "block", [0, 0], [1, 0.2], [10, 2], "young = 1e3, poisson = 0",
            '{ label = 3, ty = "-min(t, 1)" }, { label = 1, tx = "t < 1 ? 0 : t - 1" }') + \
            "[[body.point]]\nat = [0, 0]\nux = 0\n" + body(
            "layer", [0, -0.1], [4, 0], [40, 1], "young = 1e5, poisson = 0",
            "{ label = 1, ux = 0, uy = 0 }") + contact(("block", 1), ("layer", 3), 1)
        for i, (x, _) in enumerate(DRAGGED):
            scene += motion(f"x{i}", "block", (x, 0))
        rows = self.values(scene + steps(3, 30))
        worst = [0.0] * len(TIMES)
        for i, (x, reference) in enumerate(DRAGGED):
            for k, (time, value) in enumerate(zip(TIMES, reference)):
                off = abs(float(rows[round(10 * time) - 1][f"x{i}"]) - value)
                self.assertLess(off, KRATOS_TOLERANCE)
                worst[k] = max(worst[k], off / value)
        print("Kratos' dragged block: off by", ", ".join(f"{each:.2%}" for each in worst))
        self.assertLess(max(worst[:2]), 0.03)
        self.assertLess(max(worst[2:]), 0.15)


if __name__ == "__main__":
    unittest.main()
