"""Data and materials of bodies in space against closed forms: initial stresses, temperatures, elasticity with
axes."""
import math
import unittest

import numpy as np

from scene_parts import body, box, quantity, timed
from space_support import (AXES, CLAMPED, E, HELD, ISOTROPIC, MODULI, NU, ORTHOTROPIC, ROLLERS, InSpace,
                           compliance, cube, rotation, strain_of)


class InitialStress(InSpace):
    # Without divergence.
    FIELD = {"s11": "1 + y + 2*z", "s22": "2*x - z", "s33": "3 + 2*x - y", "s12": "z", "s13": "y", "s23": "x"}

    def test_one_in_equilibrium_moves_nothing(self):
        stress = "initial_stress = { " + ", ".join(f'{k} = "{v}"' for k, v in self.FIELD.items()) + " }"
        for degree in (1, 2):
            self.run_scene(cube(ISOTROPIC, stress, CLAMPED, degree=degree))
            self.assertEqual(self.warnings, [])
            _, u, centres, s = self.fields()
            self.assertLess(np.abs(u).max(), 1e-14)
            x, y, z = centres.T
            np.testing.assert_allclose(
                s.T, [1 + y + 2*z, 2*x - z, 3 + 2*x - y, z, x, y], atol=1e-12)

    def test_a_constant_one_is_released(self):
        keys = {"s11": (0, 0), "s22": (1, 1), "s12": (0, 1), "s33": (2, 2), "s13": (0, 2), "s23": (1, 2)}
        for key, (i, j) in keys.items():
            with self.subTest(key):
                self.run_scene(cube(ISOTROPIC, f"initial_stress = {{ {key} = 5 }}", HELD))
                self.assertIn("initial-stress", self.warnings)
                s = np.zeros((3, 3))
                s[i, j] = s[j, i] = -5
                strain = ((1 + NU)*s - NU*np.trace(s)*np.eye(3))/E
                self.expect_homogeneous(strain, np.zeros((3, 3)))

    def test_bodies_that_flow_relax_it(self):
        # Maxwell's deviator under no strain: by backward Euler (1 + dt/tau)^-n of it is left.
        self.run_scene(cube(ISOTROPIC + ', law = "maxwell", relaxation_time = 0.5',
                            "initial_stress = { s11 = 6, s13 = 2 }", CLAMPED), "time.steps=10")
        _, _, _, s = self.fields()
        left = 1.2**-10
        row = [2 + 4*left, 2 - 2*left, 2 - 2*left, 0, 0, 2*left]
        np.testing.assert_allclose(s, np.tile(row, (len(s), 1)), rtol=1e-10, atol=1e-10)

    def test_is_refused_in_the_plane(self):
        self.write(body("plate", box([0, 0], [1, 1], 2), 1, "label = 1, ux = 0, uy = 0",
                        initial_stress={"s13": 1}) + timed())
        said = self.mortier("run", "scene.toml", code=2).stderr
        self.assertIn("s13 = 1, expected it with dimension = 3 only", said)


class Temperature(InSpace):
    HOT = 'temperature = "t*(40 + 30*x - 20*y + 10*z)"'

    def test_free_bodies_expand_without_stress(self):
        self.run_scene(cube(ISOTROPIC + ", expansion = 1e-3", 'temperature = "40*t"', HELD))
        self.expect_homogeneous(0.04*np.eye(3), np.zeros((3, 3)))
        # Linear in space: u is quadratic.
        values = self.run_scene(cube(ISOTROPIC + ", expansion = 1e-3", self.HOT, HELD, """\
[[quantity]]
name = "end"
displacement = { body = "cube", point = [1, 0, 0] }
component = "x"
[[quantity]]
name = "mises"
largest_mises = { body = "cube" }
""", degree=2))
        self.assertAlmostEqual(values["end"], 0.055, delta=1e-14)
        self.assertLess(values["mises"], 1e-12)

    def test_held_bodies_are_stressed(self):
        self.run_scene(cube(ISOTROPIC + ", expansion = 1e-3", self.HOT, ROLLERS, degree=2))
        # All strains but those of the displacements: in the mean -E alpha T/(1 - 2 nu).
        _, _, _, s = self.fields()
        self.assertAlmostEqual(s[:, :3].sum(axis=1).mean()/3/(-E*0.05/(1 - 2*NU)), 1, delta=0.02)
        self.run_scene(cube(ISOTROPIC + ", expansion = 1e-3", 'temperature = "40*t"', ROLLERS))
        self.expect_homogeneous(np.zeros((3, 3)), -E*0.04/(1 - 2*NU)*np.eye(3))
        held = "boundary = [ { label = 1, uz = 0 }, { label = 3, uz = 0 }, { label = 4, ux = 0 }, " \
               "{ label = 5, uy = 0 } ]"
        self.run_scene(cube(ISOTROPIC + ", expansion = 1e-3", 'temperature = "40*t"', held))
        self.expect_homogeneous(np.diag([0.04*(1 + NU), 0.04*(1 + NU), 0]), np.diag([0, 0, -E*0.04]))

    def test_a_file_is_linear_on_tetrahedra(self):
        results = []
        text = cube(ISOTROPIC + ", expansion = 1e-3", self.HOT, ROLLERS, degree=2)
        self.run_scene(text)
        x, *_ = results = self.fields()
        vertices = 3*4*3
        self.write("\n".join(repr(40 + 30*a - 20*b + 10*c) for a, b, c in x[:vertices]) + "\n", "hot.txt")
        self.run_scene(text.replace(self.HOT, 'temperature = { file = "hot.txt", factor = "t" }'))
        for one, other in zip(results, self.fields()):
            np.testing.assert_allclose(one, other, atol=1e-12)
        self.write("1 2 3\n", "hot.txt")
        self.assertIn(f"has 3, expected {vertices} finite numbers",
                      self.mortier("run", "scene.toml", "--out", "no", code=2).stderr)

    def test_without_expansion_is_refused(self):
        self.write(cube(ISOTROPIC, "temperature = 1", HELD))
        self.assertIn("expected expansion in a material", self.mortier("run", "scene.toml", code=2).stderr)

    def test_one_in_time_is_planned_and_its_work_counted(self):
        values = self.run_scene(cube(ISOTROPIC + ", expansion = 1e-3", 'temperature = "40*t"', ROLLERS, """\
[[quantity]]
name = "heat"
thermal_work = { body = "cube" }
[[quantity]]
name = "stored"
stored_energy = { body = "cube" }
"""), "time.steps=4")
        self.assertEqual(self.summary["steps"], 4)
        self.assertAlmostEqual(values["stored"], 1.5*E*0.04**2/(1 - 2*NU), delta=1e-12)
        self.assertAlmostEqual(values["heat"], values["stored"], delta=1e-12)


class Axes(InSpace):
    LOAD = 'boundary = [ { label = 3, tx = "2*t", tz = "5*t" }, { label = 2, tz = "2*t" }, ' \
           '{ label = 1, tx = "-2*t", tz = "-5*t" }, { label = 4, tz = "-2*t" } ]'
    STRESS = np.array([[0, 0, 2], [0, 0, 0], [2, 0, 5]])

    def test_a_block_in_any_axes_has_the_closed_form(self):
        for degree in (1, 2):
            self.run_scene(cube(f"{ORTHOTROPIC}, axes = {AXES}", self.LOAD, HELD, degree=degree))
            self.expect_homogeneous(strain_of(self.STRESS, rotation()), self.STRESS)
        self.run_scene(cube(ORTHOTROPIC, self.LOAD, HELD))
        self.expect_homogeneous(strain_of(self.STRESS, np.eye(3)), self.STRESS)

    def test_an_angle_turns_the_axes_about_z(self):
        c, s = math.cos(0.4), math.sin(0.4)
        about = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        for angle in ("0.4", '"0.4 + 0*z"'):  # of the body, or of every point
            self.run_scene(cube(f"{ORTHOTROPIC}, axes = {AXES}, angle = {angle}", self.LOAD, HELD))
            self.expect_homogeneous(strain_of(self.STRESS, about @ rotation()), self.STRESS)

    def test_a_general_stiffness_is_the_same_material(self):
        order = [0, 1, 3, 2, 4, 5]  # s11, s22, s12, s33, s13, s23
        C = np.linalg.inv(compliance())[np.ix_(order, order)]
        C = (C + C.T)/2
        material = f'elasticity = "general", stiffness = {C.tolist()}, axes = {AXES}'
        self.run_scene(cube(material, self.LOAD, HELD))
        self.expect_homogeneous(strain_of(self.STRESS, rotation()), self.STRESS, 1e-11)

    def test_what_expands_differently_along_axes(self):
        c, s = math.cos(0.4), math.sin(0.4)
        R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ rotation()
        for angle in ("0.4", '"0.4 + 0*z"'):
            self.run_scene(cube(f"{ORTHOTROPIC}, axes = {AXES}, angle = {angle}, "
                                "expansion = [1e-3, 2e-3, 5e-3]", 'temperature = "10*t"', HELD))
            self.expect_homogeneous(R @ np.diag([0.01, 0.02, 0.05]) @ R.T, np.zeros((3, 3)), 2e-12)

    def test_is_that_of_plane_strain_extruded(self):
        keys = ", ".join(f"{k} = {v}" for k, v in MODULI.items() if k not in ("shear13", "shear23"))
        self.write('plane = "strain"\n'
                   + body("plate", box([0, 0], [1, 1], 2), f'elasticity = "orthotropic", {keys}, angle = 0.5',
                          "label = 1, uy = 0", "label = 3, uy = 0.1", point={"at": [0, 0], "ux": 0})
                   + quantity("force", "reaction", "plate", 3, "y")
                   + quantity("right", "displacement", "plate", 2, "x") + timed())
        plane = self.run_scene()
        space = self.run_scene(cube(f"{ORTHOTROPIC}, angle = 0.5", ("boundary = [ { label = 5, uy = 0 }, "
                                                                    "{ label = 6, uy = 0.1 }, "
                                                                    "{ label = 1, uz = 0 }, { label = 3, "
                                                                    "uz = 0 } ]\n"
                                                                    "point = { at = [0, 0, 0], ux = 0 }\n"
                                                                    + quantity("force", "reaction", "cube", 6,
                                                                               "y")
                                                                    + quantity("right", "displacement",
                                                                               "cube", 2, "x"))))
        for name in ("force", "right"):
            self.assertAlmostEqual(space[name]/plane[name], 1, delta=1e-12)

    def test_what_is_missing_or_wrong_is_named(self):
        for material, message in (
                (ORTHOTROPIC.replace(", shear23 = 15", ""), "expected shear13 and shear23 as well in space"),
                (ORTHOTROPIC.replace(", young3 = 60", ""), "expected young3, poisson13 and poisson23"),
                (ORTHOTROPIC + ", axes = [[1, 0, 0], [2, 0, 0]]", "expected two vectors that are not"),
                (ORTHOTROPIC + ", axes = [[1, 0], [2, 0]]", "expected two vectors that are not"),
                ('elasticity = "general", stiffness = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]',
                 "expected six rows of six"),
                (ORTHOTROPIC.replace("poisson23 = 0.25", "poisson23 = 2"), "expected > 0 (elliptic)")):
            with self.subTest(message):
                self.refuse(cube(material, self.LOAD, HELD), message)


if __name__ == "__main__":
    unittest.main()
