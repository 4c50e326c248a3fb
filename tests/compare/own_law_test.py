"""Laws of one's own, as expressions: runs beside the built-in laws that they repeat; mortier law."""
import math
import unittest

from scene_parts import body, box, contact, timed
from support import InFolder, mortier, told

MISES = "sqrt(s11^2 + s22^2 + s33^2 - s11*s22 - s22*s33 - s33*s11 + 3*s12^2)"
SCENE = """\
plane = "PLANE"
[[body]]
name = "upper"
mesh = {{ shape = "rectangle", cells = [4, 4], lower = [0, 0], upper = [1, 1] }}
[body.material]
young = 2e11
poisson = 0.3
{law}
[[body.boundary]]
label = 3
ty = "-1e8*(1 + 0.5*x)*min(t, 0.3)"
ux = 0
[[body]]
name = "lower"
mesh = {{ shape = "rectangle", cells = [5, 3], lower = [0, -1], upper = [1, 0] }}
material = {{ young = 2e11, poisson = 0.3 }}
[[body.boundary]]
label = 1
ux = 0
uy = 0
[contact]
nonmortar = {{ body = "upper", label = 1 }}
mortar = {{ body = "lower", label = 3 }}
[time]
end = 1
steps = 5
"""


SOFTENING = ('check.allow = ["large-strain"]\n'
             + body("upper", box([0, 0], [1, 1], 2),
                    'young = 1e3, poisson = 0.3, law = "expression", rate11 = "flow*(s11-mean)", '
                    'rate22 = "flow*(s22-mean)", rate12 = "flow*s12", parameters = { mean = "(s11+s22)/3", '
                    'mises = "sqrt(s11^2+s22^2-s11*s22+3*s12^2)", flow = "0.1*tan(mises/20)" }',
                    "label = 4, ux = 0", 'label = 3, ty = "-1e5*t"')
             + body("lower", box([0, -1], [1, 0], 3), 1e3, "label = 4, ux = 0", "label = 1, uy = 0")
             + contact(("upper", 1), ("lower", 3)) + timed(None, scheme="sdirk2", tolerance=1e-2))


def along_deviator(factor, parameters, more="", components=("11", "22", "12", "33")):
    """A law whose rate is a factor times the deviator."""
    lines = [f'rate{c} = "({factor})*(s{c}{" - mean" if c[0] == c[1] else ""}){more.format(c=c)}"'
             for c in components]
    mises = MISES.replace("3*s12^2", "3*(s12^2 + s13^2 + s23^2)") if "13" in components else MISES
    return "\n".join(['law = "expression"', "isotropic = true", *lines,
                      f'parameters = {{ mises = "{mises}", mean = "(s11 + s22 + s33)/3", {parameters} }}'])


NORTON = along_deviator("1.5*r0/s0*(mises/s0)^(n - 1)", "s0 = 1e7, r0 = 1e-4, n = 5")
MAXWELL = along_deviator("1.3/(E*tau)", "E = 2e11, tau = 0.1")
PERZYNA = along_deviator("max(0, 1 - Y/mises)/(2*eta)", "eta = 1e9, Y = 1e7")
# In plane strain, where e33 is 0.
SOLID = along_deviator("1.3/(E*tau)", 'E = 2e11, tau = 0.1, g = 0.3, em11 = "(e11 + e22)/3", em22 = "em11", '
                       'em33 = "em11", em12 = 0', " - g/tau*(e{c} - em{c})")
PAIRS = {
    "norton": ('law = "norton"\nreference_stress = 1e7\nreference_rate = 1e-4\nexponent = 5', NORTON,
               ("stress", "strain")),
    "maxwell": ('law = "maxwell"\nrelaxation_time = 0.1', MAXWELL, ("stress", "strain")),
    "perzyna": ("viscosity = 1e9\nyield_stress = 1e7", PERZYNA, ("strain",)),
    "standard solid": ('law = "standard-solid"\nrelaxation_time = 0.1\nrelaxed_fraction = 0.3', SOLID,
                       ("strain",)),
}
COMPARED = ("max_pressure[Pa]", "von_mises_max[Pa]", "displacement_max[m]", "elastic_energy[J/m]",
            "contact_force[N/m]")


class OwnLaw(InFolder):
    def history(self, law, plane, *settings):
        self.write(SCENE.replace("PLANE", plane).format(law=law))
        self.mortier("run", "scene.toml", "--quiet", "--out", "out", "--set", "body.upper.volume=pointwise",
                     *settings)
        return self.rows_of("out/history.csv")

    def compare(self, name, plane, *settings):
        built_in, own, _ = PAIRS[name]
        with self.subTest(name, plane=plane, settings=settings):
            expected, rows = self.history(built_in, plane, *settings), self.history(own, plane, *settings)
            self.assertEqual(len(rows), len(expected))
            for column in COMPARED:
                values = [float(row[column]) for row in rows]
                others = [float(row[column]) for row in expected]
                off = max(abs(a - b) for a, b in zip(values, others)) / max(map(abs, others))
                self.assertLess(off, 1e-10, column)

    def test_equals_the_built_in_law(self):
        for name, (_, _, planes) in PAIRS.items():
            for plane in planes:
                for scheme in ("backward-euler", "sdirk2", "crank-nicolson"):
                    self.compare(name, plane, f"time.scheme={scheme}")
        self.compare("norton", "strain", "degree=2")
        self.compare("perzyna", "strain", "contact.variant=interpolation")

    def test_steps_chosen_by_their_error_are_the_same(self):
        built_in, own, _ = PAIRS["maxwell"]
        settings = ("time.scheme=sdirk2", "time.tolerance=1e-3")
        expected, rows = self.history(built_in, "strain", *settings), self.history(own, "strain", *settings)
        self.assertEqual([row["step"] for row in rows], [row["step"] for row in expected])
        for row, other in zip(rows, expected):
            self.assertAlmostEqual(float(row["time[s]"]), float(other["time[s]"]), delta=1e-6)

    def test_parameters_can_be_set(self):
        slow = self.history(MAXWELL, "strain", "body.upper.material.parameters.tau=10")
        fast = self.history(MAXWELL, "strain")
        self.assertGreater(float(slow[-1]["von_mises_max[Pa]"]), 1.01 * float(fast[-1]["von_mises_max[Pa]"]))

    def test_threads_change_nothing(self):
        self.write(SCENE.replace("PLANE", "strain").format(law=NORTON))
        for name, threads in (("one", 1), ("two", 2)):
            self.mortier("run", "scene.toml", "--quiet", "--out", name, "--threads", threads)
        results = []
        for name in ("one", "two"):
            rows = self.rows_of(f"{name}/history.csv")
            results.append([[row[column] for column in COMPARED] for row in rows])
        self.assertEqual(*results)


class FastGrowth(InFolder):
    """Rates that overflow at stresses of an elastic trial: what a step finds is the solution, or a reason."""

    SCENE = """\
plane = "PLANE"
[[body]]
name = "upper"
mesh = {{ shape = "rectangle", lower = [0, 0], upper = [1, 1], cells = {cells} }}
boundary = [ {{ label = 4, ux = 0 }}, {{ label = 3, {drive} }} ]
[body.material]
young = {young!r}
poisson = 0.3
{law}
[[body]]
name = "lower"
mesh = {{ shape = "rectangle", lower = [0, -1], upper = [1, 0], cells = {cells} }}
material = {{ young = {young!r}, poisson = 0.3 }}
boundary = [ {{ label = 4, ux = 0 }}, {{ label = 1, uy = 0 }} ]
[contact]
nonmortar = {{ body = "upper", label = 1 }}
mortar = {{ body = "lower", label = 3 }}
[time]
end = 0.6
steps = 6
"""
    #: flow(mises) of rate = flow(mises)/mises*deviator, in stresses of `unit`
    GROWTHS = {
        "sinh": ("0.075*sinh(mises/(s0*unit))", lambda s, s0: 0.075 * math.sinh(s / s0)),
        "exp": ("0.05*(exp(mises/(s0*unit)) - 1)", lambda s, s0: 0.05 * math.expm1(s / s0)),
        "power": ("0.075*(mises/(s0*unit))^20", lambda s, s0: 0.075 * (s / s0)**20),
    }

    def law(self, growth, s0, unit=1.0):
        return along_deviator(f"{self.GROWTHS[growth][0]}/max(mises, 1e-9*unit)",
                              f"s0 = {s0!r}, unit = {unit!r}")

    def forces(self, growth, s0, steps=6):
        """The contact force of each step in plane stress: uniaxial stress -s, of backward Euler."""
        crept, forces = 0.0, []
        for i in range(1, steps + 1):
            short = 0.03 * (0.5 - 0.5 * math.cos(10 * math.pi * 0.1 * i)) - crept
            flow = self.GROWTHS[growth][1]
            low, high = 0.0, max(short, 0) * 500
            for _ in range(200):
                s = (low + high) / 2
                try:
                    over = 2 * s / 1000 + 0.1 * flow(s, s0) * 2 / 3 > short
                except OverflowError:
                    over = True
                low, high = (low, s) if over else (s, high)
            crept += 0.1 * flow(low, s0) * 2 / 3
            forces.append(low)
        return forces

    def solved(self, growth, s0, plane="stress", unit=1.0, drive=None, cells=1, code=0, settings=()):
        drive = drive or 'uy = "-0.03*(0.5 - 0.5*cos(10*pi*t))"'
        self.write(self.SCENE.replace("PLANE", plane).format(
            law=self.law(growth, s0, unit), young=1e3 * unit, drive=drive, cells=cells))
        changes = ["--set", *settings] if settings else []
        return self.mortier("run", "scene.toml", "--quiet", "--out", "out", *changes, code=code)

    def rows(self):
        rows = self.rows_of("out/history.csv")
        return [{name: value if name == "rung" else float(value) for name, value in row.items()}
                for row in rows]

    def test_uniaxial_stress_is_that_of_the_scalar_law(self):
        for growth in self.GROWTHS:
            for s0, unit in ((4.0, 1.0), (2.0, 1e12), (0.5, 1e-9), (0.1, 1.0), (0.01, 1e12)):
                with self.subTest(growth, s0=s0, unit=unit):
                    self.solved(growth, s0, unit=unit)
                    expected, cut = self.forces(growth, s0), False
                    for row, force in zip(self.rows(), expected, strict=True):
                        found = row["contact_force[N/m]"] / unit
                        cut = cut or row["rung"] == "cut"  # into shorter steps, which creep otherwise
                        self.assertAlmostEqual(found, force, delta=(0.1 if cut else 1e-8) * max(expected))

    def test_stays_below_elasticity_in_all_planes(self):
        """A bar that creeps bears no more than one that does not: E/2 (1 - nu^2) times the strain at most."""
        for plane in ("strain", "axisymmetric"):
            for growth in self.GROWTHS:
                with self.subTest(plane, growth=growth):
                    self.solved(growth, 0.5, plane=plane, cells=2, settings=["time.steps=3"])
                    summary = self.summary_of()
                    self.assertLess(summary["peaks"]["contact_force"]["value"], 1e3 / 2 / (1 - 0.09) * 0.03)
                    self.assertTrue(all(value <= 1e-8 for value in summary["verification"].values()))

    def test_without_a_solution_of_numbers_ends_with_law_stress_and_place(self):
        """A stress that is given, at which the rate is beyond doubles."""
        done = self.solved("exp", 0.01, drive='ty = "-15*t"', code=1,
                           settings=["contact.sliding=allow"])
        self.assertRegex(done.stderr, r"step \d+ at t = .*, at the stress s11 = \S+, s22 = \S+, s12 = \S+; "
                                      r"largest residual of the law, expression: body upper at \(.*\), "
                                      r"triangle")
        stuck = self.summary_of("out.failed")["stuck"]
        self.assertEqual((stuck["body"], stuck["time"] > 0), ("upper", True))


class Law(InFolder):
    """mortier law."""

    def told(self, law, *arguments, plane="strain", code=0):
        self.write(SCENE.replace("PLANE", plane).format(law=law))
        done = mortier("law", "scene.toml", *arguments, cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr), (code, ""))
        return {line.split()[0]: line for line in done.stdout.splitlines() if line.startswith("  ")}

    def test_constants_of_theory(self):
        # L of Maxwell's body is 1/tau, that of Perzyna's law E/(1 + nu)/(2 eta).
        for law, lipschitz in ((MAXWELL, 10), (PERZYNA, 2e11 / 1.3 / 2e9)):
            told = self.told(law, "--stress", "1e9")
            self.assertAlmostEqual(float(told["Lipschitz"].split()[1]) / lipschitz, 1, delta=1e-2)
            self.assertIn("monotone     yes", told["monotone"])
            self.assertIn("all others", told["steps"])
            self.assertLess(float(told["tangent"].split()[1]), 1e-6)
            self.assertLess(float(told["isotropy"].split()[1]), 1e-12)

    def test_built_in_laws_are_right(self):
        for built_in, _, planes in PAIRS.values():
            for plane in planes:
                told = self.told(built_in, plane=plane)
                self.assertNotIn("WRONG", "".join(told.values()))

    def test_names_what_is_wrong(self):
        turned = NORTON.replace('rate12 = "', 'rate12 = "2*')
        self.assertIn("WRONG", self.told(turned, code=1)["isotropy"])
        unclaimed = self.told(turned.replace("isotropic = true", "isotropic = false"))
        self.assertNotIn("WRONG", unclaimed["isotropy"])
        heating = along_deviator("-1e-12", "k = 1").replace("isotropic = true", "")
        told = self.told(heating, code=1)
        self.assertIn("it makes energy", told["dissipation"])
        self.assertIn("monotone     no", told["monotone"])
        self.assertIn("times as long", self.told(heating.replace("-1e-12", "-1e-9"), code=1)["steps"])
        jump = along_deviator("mises > 1e6 ? 1e-12 : 0*log(1e5 - mises)", "k = 1")
        self.assertIn("WRONG", self.told(jump, code=1)["rate"])

    def test_names_the_stress_at_which_the_rate_overflows(self):
        steep = along_deviator("1e-20*sinh(mises/s0)", "s0 = 1e7")
        told = self.told(steep, "--stress", "1e9")
        self.assertIn("beyond these stresses at s11 = ", told["overflow"])
        self.assertNotIn("overflow", self.told(NORTON, "--stress", "1e9"))
        told = self.told(steep, "--stress", "1e11", code=1)
        self.assertRegex(told["rate"], "WRONG: a number at .* stresses, the least without at s11 = ")

    def test_wants_a_stress(self):
        self.write(SCENE.replace("PLANE", "strain").format(law=NORTON).replace(
            'ty = "-1e8*(1 + 0.5*x)*min(t, 0.3)"', "uy = 0"))
        self.reject("scene.toml: no datum of the scene asks for a stress, expected --stress", "law",
                    "scene.toml")
        self.reject("--stress: ", "law", "scene.toml", "--stress", "-1")


class Hostile(InFolder):
    def refuse(self, message, law, plane="strain"):
        self.write(SCENE.replace("PLANE", plane).format(law=law))
        for command in (["run", "scene.toml", "--quiet", "--out", "out"], ["law", "scene.toml"]):
            self.reject("scene.toml:" + message, *command)

    def test_wrong_laws_are_one_line(self):
        at = "10: body upper: "
        names = "s11, s22, s12, s33, e11, e22, e12, e33, "
        for change, message in (
                (("rate11 = \"", "rate11 = \"foo + "),
                 f"{at}rate11 = \"foo + (1.5*r0/s0*(mises/s0)^(n - 1))*(s11 - mean)\", expected an "
                 f"expression in {names}mean, mises, n, r0, s0 (unknown name foo, at character 1)"),
                (("rate22", "rate21"), "11: body upper: unknown key rate21"),
                (("n = 5", "n = \"r0 +\""), "14: body upper: parameters.n = \"r0 +\", expected an expr"),
                (("n = 5", "n = \"2*n\""), "14: body upper: parameters.n = \"2*n\", expected an expression"),
                (("n = 5", "n = inf"), "14: body upper: parameters.n = inf, expected a finite number or"),
                (("n = 5", "n = [1]"), "14: body upper: parameters.n = "),
                (("n = 5", "n = 5, s11 = 1"), "14: body upper: parameters.s11, expected another name"),
                (("n = 5", "n = 5, sin = 1"), "14: body upper: parameters.sin, expected another name"),
                (("n = 5", "n = 5, a-b = 1"), "14: body upper: parameters.a-b, expected a name of letters"),
                (("n = 5", "n = -1"), f"{at}law = \"expression\", expected a rate that is a number without "
                                      "stress and strain"),
                (("rate33 = ", "viscosity = 1 #"), "13: body upper: viscosity = 1, expected it beside"),
                (("isotropic = true", "isotropic = 1"), "9: body upper: isotropic = 1, expected true"),
        ):
            with self.subTest(change=change):
                self.refuse(message, NORTON.replace(*change))
        self.refuse(f"{at}law = \"expression\", expected rate33 beside the others in plane strain",
                    "\n".join(line for line in NORTON.splitlines() if not line.startswith("rate33")))
        self.refuse(f"{at}law = \"expression\", expected a rate that is a number without stress and strain, "
                    "is not one in component 11 (e33 is not known in plane stress)",
                    NORTON.replace("rate11 = \"", "rate11 = \"e33 + "), plane="stress")
        self.refuse("8: body upper: law = \"own\", expected one of elastic, perzyna", 'law = "own"')

    def test_freefem_refuses(self):
        scene = SCENE.replace("PLANE", "strain")
        self.write(scene.format(law=NORTON.replace("s0 = 1e7", 's0 = "1e7 + 0*log2(2)"')))
        self.reject("scene.toml:10: body upper: law = \"expression\": log2 is not known to FreeFEM",
                    "freefem", "scene.toml", "out.edp")
        hot = scene.replace('name = "upper"', 'name = "upper"\ntemperature = 3')
        self.write(hot.format(law="expansion = 1e-6\n" + NORTON))
        self.reject("scene.toml:4: body upper: temperature, expected none beside such a law",
                    "freefem", "scene.toml", "out.edp")

    def test_a_tangent_that_is_singular_ends_a_step(self):
        # Beyond the pole of the tangent function the law softens: LU of the contact nodes may have no pivot.
        self.write(SOFTENING)
        done = self.mortier("run", "scene.toml", "--quiet", "--threads", "1", "--out", "out", code=1)
        self.assertRegex(done.stderr, r"^mortier: scene.toml: step \d+ at t = ")

    def test_steps_that_cannot_be_solved_are_one_line(self):
        pushed = SCENE.replace('ty = "-1e8*(1 + 0.5*x)*min(t, 0.3)"', 'uy = "-1e-4*t"')
        for scene, factor in ((SCENE, "mises > 2e6 ? log(-1) : 1e-12"), (pushed, "mises > 2e6 ? 1e-3 : 0")):
            with self.subTest(factor):
                self.write(scene.replace("PLANE", "strain").format(law=along_deviator(factor, "k = 1")))
                done = self.mortier("run", "scene.toml", "--quiet", "--out", "out", code=1)
                line, = told(done.stderr)
                self.assertRegex(line, r"^mortier: scene.toml: step \d+ at t = ")
                self.assertIn("out.failed", self.names())
                self.assertNotIn("nan", self.read("out.failed/history.csv").lower())


if __name__ == "__main__":
    unittest.main()
