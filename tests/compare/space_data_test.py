"""Data and materials of bodies in space against closed forms: initial stresses, temperatures, elasticity with
axes, hardening, distances that are given, and round bodies."""
import json
import math
import unittest

import meshio
import numpy as np

from support import InFolder, warned

HELD = ('point = [ { at = [0, 0, 0], ux = 0, uy = 0, uz = 0 }, { at = [1, 0, 0], uy = 0, uz = 0 }, '
        '{ at = [0, 1, 0], uz = 0 } ]')
CLAMPED, ROLLERS = ("boundary = [ " + ", ".join(f"{{ label = {k}, {held} }}" for k in range(1, 7)) + " ]"
                    for held in ("ux = 0, uy = 0, uz = 0", "un = 0"))
E, NU = 100, 0.3
ISOTROPIC = f"young = {E}, poisson = {NU}"
MODULI = {"young1": 110, "young2": 30, "young3": 60, "poisson12": 0.3, "poisson13": 0.2, "poisson23": 0.25,
          "shear12": 20, "shear13": 35, "shear23": 15}
ORTHOTROPIC = 'elasticity = "orthotropic", ' + ", ".join(f"{k} = {v}" for k, v in MODULI.items())
AXES = [[1, 2, 2], [2, 1, -2]]


def cube(material, *lines, degree=1):
    return "\n".join(["dimension = 3", f"degree = {degree}", "[[body]]", 'name = "cube"',
                      'mesh = { shape = "cuboid", cells = [2, 3, 2] }', f"material = {{ {material} }}",
                      *lines, "[time]", "end = 1", "steps = 1", ""])


def compliance():
    """(e11, e22, e33, 2 e12, 2 e13, 2 e23) of (s11, s22, s33, s12, s13, s23) in the axes."""
    m = MODULI
    S = np.diag([1/m["young1"], 1/m["young2"], 1/m["young3"], 1/m["shear12"], 1/m["shear13"], 1/m["shear23"]])
    S[0, 1] = S[1, 0] = -m["poisson12"]/m["young1"]
    S[0, 2] = S[2, 0] = -m["poisson13"]/m["young1"]
    S[1, 2] = S[2, 1] = -m["poisson23"]/m["young2"]
    return S


def rotation(axes=AXES):
    """Columns: the axes of the material."""
    first = np.array(axes[0])/np.linalg.norm(axes[0])
    third = np.cross(first, axes[1])
    third /= np.linalg.norm(third)
    return np.column_stack([first, np.cross(third, first), third])


def strain_of(stress, R):
    """The strain tensor of a stress tensor."""
    s = R.T @ stress @ R
    e = compliance() @ [s[0, 0], s[1, 1], s[2, 2], s[0, 1], s[0, 2], s[1, 2]]
    return R @ np.array([[e[0], e[3]/2, e[4]/2], [e[3]/2, e[1], e[5]/2], [e[4]/2, e[5]/2, e[2]]]) @ R.T


class InSpace(InFolder):
    def run_scene(self, text=None, *settings, code=0):
        if text is not None:
            self.write(text)
        done = self.mortier("run", "scene.toml", "--quiet", "--out", "out",
                            *[word for each in settings for word in ("--set", each)], code=code)
        self.warnings = warned(done.stderr)
        self.summary = json.loads(self.read("out/summary.json"))
        return {name: each["value"] for name, each in self.summary.get("quantities", {}).items()}

    def fields(self, body="cube"):
        """Places, displacements, centres of the cells, and stresses: s11, s22, s33, s12, s23, s13."""
        mesh = meshio.read(sorted((self.folder / "out").glob(f"{body}_*.vtu"))[-1])
        stress = mesh.cell_data["stress"][0]
        centres = mesh.points[mesh.cells[0].data[:, :4]].mean(axis=1)
        return mesh.points, mesh.point_data["displacement"], centres, stress

    def expect_homogeneous(self, strain, stress, within=1e-12):
        """u = strain x but for a rotation, which the three supports say."""
        x, u, _, s = self.fields()
        G = np.array(strain, dtype=float)
        W = np.zeros((3, 3))
        W[1, 0], W[2, 0], W[2, 1] = -G[1, 0], -G[2, 0], -G[2, 1]  # u_y, u_z along x and u_z along y are 0
        W -= W.T
        expected = x @ (G + W).T
        np.testing.assert_allclose(u, expected, atol=within*max(np.abs(expected).max(), 1e-4))
        row = [stress[i][j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))]
        np.testing.assert_allclose(s, np.tile(row, (len(s), 1)), atol=within*max(1, np.abs(row).max()))


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
        self.write("""\
[[body]]
name = "plate"
mesh = { shape = "rectangle", cells = 2 }
material = { young = 1, poisson = 0.3 }
initial_stress = { s13 = 1 }
boundary = [ { label = 1, ux = 0, uy = 0 } ]
[time]
end = 1
steps = 1
""")
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
        self.write(f"""\
plane = "strain"
[[body]]
name = "plate"
mesh = {{ shape = "rectangle", cells = 2 }}
material = {{ elasticity = "orthotropic", {keys}, angle = 0.5 }}
boundary = [ {{ label = 1, uy = 0 }}, {{ label = 3, uy = 0.1 }} ]
point = {{ at = [0, 0], ux = 0 }}
[[quantity]]
name = "force"
reaction = {{ body = "plate", label = 3 }}
component = "y"
[[quantity]]
name = "right"
displacement = {{ body = "plate", label = 2 }}
component = "x"
[time]
end = 1
steps = 1
""")
        plane = self.run_scene()
        space = self.run_scene(cube(f"{ORTHOTROPIC}, angle = 0.5", """\
boundary = [ { label = 5, uy = 0 }, { label = 6, uy = 0.1 }, { label = 1, uz = 0 }, { label = 3, uz = 0 } ]
point = { at = [0, 0, 0], ux = 0 }
[[quantity]]
name = "force"
reaction = { body = "cube", label = 6 }
component = "y"
[[quantity]]
name = "right"
displacement = { body = "cube", label = 2 }
component = "x"
"""))
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
                self.write(cube(material, self.LOAD, HELD))
                self.assertIn(message, self.mortier("run", "scene.toml", code=2).stderr)


class Columns(InSpace):
    """Under a stress along the axis: the same in space and about an axis."""
    RING = """\
plane = "axisymmetric"
[[body]]
name = "ring"
mesh = { shape = "rectangle", cells = 2 }
material = { MATERIAL }
boundary = [ { label = 1, uy = 0 }, { label = 3, ty = "-10*t" } ]
[[quantity]]
name = "top"
displacement = { body = "ring", label = 3 }
component = "y"
[[quantity]]
name = "stored"
stored_energy = { body = "ring" }
[[quantity]]
name = "lost"
dissipated_energy = { body = "ring" }
[time]
end = 1
steps = 10
"""
    LOADED = """\
boundary = [ { label = 1, uz = 0 }, { label = 4, ux = 0 }, { label = 5, uy = 0 },
             { label = 3, tz = "-10*t" } ]
[[quantity]]
name = "top"
displacement = { body = "cube", label = 3 }
component = "z"
[[quantity]]
name = "stored"
stored_energy = { body = "cube" }
[[quantity]]
name = "lost"
dissipated_energy = { body = "cube" }
"""

    def test_are_those_of_revolution(self):
        hardens = "yield_stress = 2, isotropic_hardening = 30"
        # Axis 2 of the ring is along it, its axis 3 the circumference; of the cube axis 3 is along z.
        ring = 'elasticity = "orthotropic", young1 = 50, young2 = 120, young3 = 50, poisson12 = 0.1, ' \
               'poisson13 = 0.2, poisson23 = 0.24, shear12 = 30'
        space = 'elasticity = "orthotropic", young1 = 50, young2 = 50, young3 = 120, poisson12 = 0.2, ' \
                'poisson13 = 0.1, poisson23 = 0.1, shear12 = 20.833333333333332, shear13 = 30, shear23 = 30'
        norton = ', law = "norton", reference_stress = 5, reference_rate = 0.1, exponent = 3'
        perzyna = ", viscosity = 10, yield_stress = 2"
        both = [ISOTROPIC + ', law = "viscoplastic", ' + law
                for law in (hardens + ", viscosity = 1", hardens + ", viscosity = 0",
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
    PAIR = """\
dimension = 3
degree = DEGREE
[[body]]
name = "upper"
mesh = { shape = "cuboid", upper = [1, 1, 1], cells = 2 }
material = { young = 100, poisson = 0 }
boundary = [ { label = "left", ux = 0 }, { label = "front", uy = 0 }, { label = "top", uz = 0 } ]
[[body]]
name = "lower"
mesh = { shape = "cuboid", lower = [0, 0, -1], upper = [1, 1, 0], cells = 3 }
material = { young = 100, poisson = 0 }
boundary = [ { label = "left", ux = 0 }, { label = "front", uy = 0 }, { label = "bottom", uz = 0 } ]
[contact]
nonmortar = { body = "upper", label = "bottom" }
mortar = { body = "lower", label = "top" }
variant = "VARIANT"
gap = GAP
[[quantity]]
name = "floor"
reaction = { body = "lower", label = "bottom" }
component = "z"
[[quantity]]
name = "pressure"
largest_pressure = { body = "upper", label = "bottom" }
[time]
end = 1
steps = 2
"""
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
        self.write("""\
dimension = 3
degree = 2
[[body]]
name = "ball"
mesh = { shape = "ball", centre = [0, 0, 1], keep = ["x", "y", "-z"], cells = 6 }
material = { young = 1, poisson = 0.3 }
boundary = [ { label = "left", ux = 0 }, { label = "front", uy = 0 }, { label = "top", uz = "-0.05*t" } ]
[[body]]
name = "block"
mesh = { shape = "cuboid", lower = [0, 0, -1], upper = [1, 1, 0], cells = 4 }
material = { young = 1e4, poisson = 0.3 }
boundary = [ { label = "left", ux = 0 }, { label = "front", uy = 0 }, { label = "bottom", uz = 0 } ]
[contact]
nonmortar = { body = "ball", label = "round" }
mortar = { body = "block", label = "top" }
[[quantity]]
name = "force"
reaction = { body = "block", label = "bottom" }
component = "z"
[time]
end = 1
steps = 1
""")
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
                self.write(cube(ISOTROPIC, HELD).replace('shape = "cuboid", cells = [2, 3, 2]', shape))
                self.assertIn(message, self.mortier("run", "scene.toml", code=2).stderr)


if __name__ == "__main__":
    unittest.main()
