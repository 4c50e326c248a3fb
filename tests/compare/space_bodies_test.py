"""Bodies in space against closed forms: columns that flow and harden, given distances, round bodies."""
import math
import unittest

import meshio
import numpy as np

from scene_parts import body, box, contact, quantity, shape, timed
from space_support import E, HELD, ISOTROPIC, NU, InSpace, cube


class Columns(InSpace):
    """Under a stress along the axis: the same in space and about an axis."""
    RING = ('plane = "axisymmetric"\n'
            + body("ring", box([0, 0], [1, 1], 2), "MATERIAL", "label = 1, uy = 0",
                   'label = 3, ty = "-10*t"') + quantity("top", "displacement", "ring", 3, "y")
            + quantity("stored", "stored_energy", "ring") + quantity("lost", "dissipated_energy", "ring")
            + timed(10))
    LOADED = ("boundary = [ { label = 1, uz = 0 }, { label = 4, ux = 0 }, { label = 5, uy = 0 },\n"
              '             { label = 3, tz = "-10*t" } ]\n'
              + quantity("top", "displacement", "cube", 3, "z")
              + quantity("stored", "stored_energy", "cube") + quantity("lost", "dissipated_energy", "cube"))

    def test_are_those_of_revolution(self):
        hardens = "yield_stress = 2, isotropic_hardening = 30"
        # Axis 2 of the ring is along it, its axis 3 the circumference; of the cube axis 3 is along z.
        ring = 'elasticity = "orthotropic", young1 = 50, young2 = 120, young3 = 50, poisson12 = 0.1, ' \
               'poisson13 = 0.2, poisson23 = 0.24, shear12 = 30'
        space = 'elasticity = "orthotropic", young1 = 50, young2 = 50, young3 = 120, poisson12 = 0.2, ' \
                'poisson13 = 0.1, poisson23 = 0.1, shear12 = 20.833333333333332, shear13 = 30, shear23 = 30'
        norton = ', law = "norton", reference_stress = 5, reference_rate = 0.1, exponent = 3'
        perzyna = ", viscosity = 10, yield_stress = 2"
        relaxes = "relaxation_time = 0.5"
        both = [ISOTROPIC + law for law in (norton, f', law = "maxwell", {relaxes}',
                                            f', law = "standard-solid", {relaxes}, relaxed_fraction = 0.4')]
        both += [ISOTROPIC + ', law = "viscoplastic", ' + law
                 for law in (hardens + ", viscosity = 1", hardens + ", viscosity = 0",
                             "yield_stress = 2, viscosity = 1, kinematic_hardening = 20",
                             hardens + ", viscosity = 0, kinematic_hardening = 20",
                             hardens + ", reference_stress = 1, reference_rate = 0.1, exponent = 2")]
        for one, other in [(each, each) for each in both] + [(ring, space), (ring + norton, space + norton),
                                                             (ring + perzyna, space + perzyna)]:
            for degree, scheme in ((1, "backward-euler"), (2, "sdirk2"), (1, "crank-nicolson")):
                if "viscosity = 0" in other and degree == 1 and scheme[0] == "c":
                    continue
                with self.subTest(other, degree=degree):
                    about = self.run_scene(self.RING.replace("MATERIAL", one), f"degree={degree}",
                                           f"time.scheme={scheme}")
                    values = self.run_scene(cube(other, self.LOADED, degree=degree), "time.steps=10",
                                            f"time.scheme={scheme}")
                    self.assertAlmostEqual(values["top"]/about["top"], 1, delta=1e-9)
                    for energy in ("stored", "lost"):
                        self.assertAlmostEqual(values[energy], about[energy]/math.pi,
                                               delta=1e-8*abs(about["stored"]))

    def test_one_that_hardens_is_resumed(self):
        material = ISOTROPIC + ', law = "viscoplastic", yield_stress = 2, viscosity = 1, ' \
                               'isotropic_hardening = 30'
        whole = self.run_scene(cube(material, self.LOADED), "time.steps=10")
        names = [name for name in self.names("out") if name.endswith(".vtu")]
        mesh = meshio.read(self.folder / "out" / names[-1])
        self.assertEqual(mesh.cell_data["stress"][0].shape[1], 6)
        # Uniaxial: the yield stress has grown by K p, and p is the plastic strain along the axis.
        flowed = abs(mesh.cell_data["viscoplastic_strain"][0][:, 2]).max()
        self.assertGreater(flowed, 0.05)
        self.assertLess(abs(whole["top"] + 0.1 + flowed), 1e-9)


class Gap(InSpace):
    PAIR = ("dimension = 3\ndegree = DEGREE\n"
            + body("upper", box([0, 0, 0], [1, 1, 1], 2), "young = 100, poisson = 0",
                   'label = "left", ux = 0', 'label = "front", uy = 0', 'label = "top", uz = 0')
            + body("lower", box([0, 0, -1], [1, 1, 0], 3), "young = 100, poisson = 0",
                   'label = "left", ux = 0', 'label = "front", uy = 0', 'label = "bottom", uz = 0')
            + contact(("upper", "bottom"), ("lower", "top"), variant="VARIANT", more="gap = GAP\n")
            + quantity("floor", "reaction", "lower", "bottom", "z")
            + quantity("pressure", "largest_pressure", "upper", "bottom") + timed(2))
    KINDS = (("weighted", 1), ("mortar", 1), ("interpolation", 1), ("weighted", 2))

    def press(self, variant, degree, gap, *settings):
        return self.run_scene(self.PAIR.replace("DEGREE", str(degree)).replace("VARIANT", variant)
                              .replace("GAP", gap), *settings)

    def test_an_interference_is_pressed_out(self):
        for variant, degree in self.KINDS:
            for gap in ("-0.02", '"-0.02*t"', "{ time = [0, 1], value = [0.01, -0.02] }"):
                with self.subTest(variant=variant, degree=degree, gap=gap):
                    values = self.press(variant, degree, gap)
                    exact = variant != "interpolation"
                    self.assertAlmostEqual(values["floor"], 1, delta=1e-11 if exact else 0.1)
                    if not exact:
                        continue
                    self.assertAlmostEqual(values["pressure"], 1, delta=1e-11)
                    self.assertLess(self.summary["final"]["interpenetration"], 1e-13)
                    if degree == 1:
                        self.assertLess(self.summary["accuracy"]["energy_error"], 1e-9)

    def test_one_that_varies_has_its_mean_force(self):
        # Uniform compression is a virtual motion: the force is that of the mean distance.
        for variant, degree in self.KINDS[:2] + self.KINDS[3:]:
            with self.subTest(variant=variant, degree=degree):
                values = self.press(variant, degree, '"-0.02 - 0.01*x - 0.004*y"')
                self.assertAlmostEqual(values["floor"], 50*0.027, delta=1e-10)
        values = self.press("weighted", 2, '"-0.02 - 0.01*x*x"')
        self.assertAlmostEqual(values["floor"], 50*(0.02 + 0.01/3), delta=1e-10)

    def test_one_apart_stays_open(self):
        values = self.press("weighted", 1, "0.02", "body.upper.boundary.top.uz=-0.01*t")
        self.assertEqual(values["floor"], 0)


class Round(InSpace):
    def test_round_bodies_under_pressure_all_around(self):
        for shape, rollers in (
                ('shape = "ball", keep = ["x", "y", "-z"], radius = 2, cells = 3', (3, 4, 5)),
                ('shape = "ball", keep = ["-x", "-y", "z"], cells = 2', (1, 2, 6)),
                ('shape = "cylinder", keep = ["x", "-y"], height = 3, cells = [2, 3]', (1, 4, 6))):
            for degree in (1, 2):
                with self.subTest(shape, degree=degree):
                    sides = [f"{{ label = {k}, un = 0 }}" for k in rollers] + [
                        '{ label = "round", pressure = "7*t" }']
                    if "cylinder" in shape:
                        sides.append('{ label = "top", pressure = "7*t" }')
                    text = cube(ISOTROPIC, f"boundary = [ {', '.join(sides)} ]", degree=degree)
                    self.run_scene(text.replace('shape = "cuboid", cells = [2, 3, 2]', shape))
                    self.expect_homogeneous(-7*(1 - 2*NU)/E*np.eye(3), -7*np.eye(3), 1e-11)

    def test_a_ball_on_a_block_is_that_of_hertz(self):
        # Under an approach d the force is 4/3 E* sqrt(R) d^1.5; a quarter of it.
        self.write("dimension = 3\ndegree = 2\n"
                   + body("ball", shape("ball", centre=[0, 0, 1], keep=["x", "y", "-z"], cells=6), 1,
                          'label = "left", ux = 0', 'label = "front", uy = 0',
                          'label = "top", uz = "-0.05*t"')
                   + body("block", box([0, 0, -1], [1, 1, 0], 4), 1e4, 'label = "left", ux = 0',
                          'label = "front", uy = 0', 'label = "bottom", uz = 0')
                   + contact(("ball", "round"), ("block", "top"))
                   + quantity("force", "reaction", "block", "bottom", "z") + timed())
        values = self.run_scene()
        hertz = 4/3/(1 - 0.09)*0.05**1.5/4
        # The flat side of the half ball is rigid: an approach of its middle, stiffer than a half space.
        self.assertAlmostEqual(values["force"]/hertz, 1, delta=0.15)

    def test_what_is_wrong_is_named(self):
        for shape, message in (
                ('shape = "ball", cells = [2, 2]', "expected N along a radius"),
                ('shape = "ball", cells = 2, keep = ["x", "-x"]', "each axis once"),
                ('shape = "cylinder", cells = 2, keep = ["z"]', "of a cylinder x and y only"),
                ('shape = "cylinder", cells = 2, radius = -1', "radius = -1, expected radius > 0"),
                ('shape = "ball", cells = 2, height = 1', "height = 1, expected"),
                ('shape = "disc", cells = 2', "expected cuboid, cylinder, ball")):
            with self.subTest(shape):
                self.refuse(cube(ISOTROPIC, HELD).replace('shape = "cuboid", cells = [2, 3, 2]', shape),
                            message)


if __name__ == "__main__":
    unittest.main()
