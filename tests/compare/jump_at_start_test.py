"""What is there at t = 0 acts at once: elastically, then the bodies flow from there. docs/scene.md."""
import itertools
import math
import unittest

from support import InFolder
from results import kept_steps, read_history, read_mortier  # behind support: it is in compare/

STATIC = """\
{plane}
degree = {degree}
[[body]]
name = "block"
mesh = {{ shape = "rectangle", cells = 4, lower = [0, 0], upper = [1, 1], cut = "both" }}
material = {{ young = 2.1e11, poisson = 0.3, expansion = 1e-5 }}
{data}
[[quantity]]
name = "stored"
stored_energy = {{ body = "block" }}
[[quantity]]
name = "work"
work = {{ body = "block" }}
[[quantity]]
name = "heat"
thermal_work = {{ body = "block" }}
[time]
end = 1
steps = 1
"""
HELD = "boundary = [ {{ label = 1, ux = 0, uy = 0 }}, {{ label = 3, {} }} ]"
DRIVES = {  # what acts; {} is nothing or * t
    "displacement": HELD.format('uy = "-1e-3{}"'),
    "along the normal": HELD.format('un = "-1e-3{}"'),
    "traction": HELD.format('ty = "-1e7{}"'),
    "body force": HELD.format("ux = 0") + '\nforce = { y = "-1e6{}" }',
    "temperature": HELD.format("uy = 0") + '\ntemperature = "100{}"',
}

CONTACT = """\
{plane}
degree = {degree}
[[body]]
name = "upper"
mesh = {{ shape = "rectangle", cells = 3, lower = [0, 0], upper = [1, 1], cut = "both" }}
material = {{ young = 100, poisson = 0.3 }}
boundary = [ {{ label = 4, ux = 0 }}, {{ label = 3, {drive} }} ]
[[body]]
name = "lower"
mesh = {{ shape = "rectangle", cells = 4, lower = [0, -1], upper = [1, 0], cut = "both" }}
material = {{ young = 300, poisson = 0.2 }}
boundary = [ {{ label = 4, ux = 0 }}, {{ label = 1, uy = 0 }} ]
[contact]
nonmortar = {{ body = "upper", label = 1 }}
mortar = {{ body = "lower", label = 3 }}
variant = "{variant}"
{contact}
[time]
end = 1
steps = 2
"""

# One square of a body that flows, sheared or stretched by its supports.
SHEARED = """\
{plane}
[[body]]
name = "a"
mesh = {{ shape = "rectangle", cells = 1, lower = [0, 0], upper = [1, 1] }}
material = {material}
boundary = [ {{ label = 1, ux = "{x}", uy = 0 }}, {{ label = 2, ux = "{x}", uy = 0 }},
             {{ label = 3, ux = "{x}", uy = 0 }}, {{ label = 4, ux = "{x}", uy = 0 }} ]
[[quantity]]
name = "stored"
stored_energy = {{ body = "a" }}
[[quantity]]
name = "lost"
dissipated_energy = {{ body = "a" }}
[[quantity]]
name = "work"
work = {{ body = "a" }}
[output]
every = 1
[time]
end = 1
{time}
"""
MAXWELL = '{ young = 1000, poisson = 0.25, law = "maxwell", relaxation_time = 0.5 }'
SOLID = MAXWELL.replace("maxwell", "standard-solid").replace(" }", ", relaxed_fraction = 0.3 }")
STRAIN = 0.01
GAMMA = 1 - math.sqrt(0.5)
DECAY = {  # by which a step of z = k/tau multiplies what relaxes
    "backward-euler": lambda z: 1/(1 + z),
    "crank-nicolson": lambda z: (1 - z/2)/(1 + z/2),
    "sdirk2": lambda z: (1 - (1 - 2*GAMMA)*z)/(1 + GAMMA*z)**2,
}


class JumpAtStart(InFolder):
    def ends_of(self, text, *settings):
        self.run_it(text, *settings)
        return read_mortier(self.folder / "out")

    def same(self, one, two):
        for name, body in one.bodies.items():
            for field in ("displacement", "stress"):
                a, b = getattr(body, field), getattr(two.bodies[name], field)
                self.assertLess(abs(a - b).max(), 1e-12*abs(b).max(), field)

    def test_constant_data_are_a_static_analysis(self):
        sections = itertools.cycle((("stress", 1), ("strain", 2), ("axisymmetric", 1), ("stress", 2)))
        for what, data in DRIVES.items():
            for plane, degree in (next(sections), next(sections)):
                with self.subTest(what, plane=plane, degree=degree):
                    text = STATIC.format(plane=f'plane = "{plane}"', degree=degree, data=data)
                    ramp = self.ends_of(text.replace("{}", "*t"))
                    jump = self.ends_of(text.replace("{}", ""))
                    self.assertGreater(abs(jump.bodies["block"].stress).max(), 1e3)
                    self.same(jump, ramp)
                    history = read_history(self.folder / "out")
                    mises = history["von_mises_max[Pa]"]
                    self.assertEqual(list(history["step"]), [0, 1])
                    self.assertAlmostEqual(mises[0]/mises[-1], 1, delta=1e-12)
                    found = jump.summary["quantities"]
                    stored = found["stored"]["value"]
                    for when in ("value", "start"):
                        self.assertAlmostEqual((found["work"][when] + found["heat"][when])/stored, 1,
                                               delta=1e-11)
                        self.assertAlmostEqual(found["stored"][when]/stored, 1, delta=1e-12)

    def test_no_warning_of_it(self):
        self.write(STATIC.format(plane="", degree=1, data=DRIVES["displacement"].replace("{}", "")))
        self.assertEqual(self.mortier("run", "scene.toml", "--quiet", "--out", "out").stderr, "")
        self.assertIn("0 warnings", self.mortier("check", "scene.toml").stdout)

    def test_contact_closes_in_the_jump(self):
        """Also where an interference is all that acts, and with friction."""
        drives = [('uy = "-0.01{}"', ""), ('ty = "-2{}"', ""), ("uy = 0", 'gap = "-0.01{}"'),
                  ('uy = "-0.01{}"', "gap = 0.004"), ('ux = "0.002{}", uy = "-0.01{}"', "friction = 0.3"),
                  ("uy = 0", 'gap = "-0.01{}"\nfriction = 0.3')]
        ways = itertools.cycle((("mortar", "stress", 1), ("interpolation", "strain", 1),
                                ("weighted", "axisymmetric", 2), ("mortar", "strain", 2)))
        for (drive, contact), (variant, plane, degree) in zip(drives, ways):
            with self.subTest(drive, contact=contact, variant=variant):
                text = CONTACT.format(plane=f'plane = "{plane}"', degree=degree, variant=variant,
                                      drive=drive, contact=contact)
                if "ux" in drive:
                    text = text.replace("{ label = 4, ux = 0 }, ", "")
                jump = self.ends_of(text.replace("{}", ""))
                kept = read_history(self.folder / "out")
                ramp = self.ends_of(text.replace("{}", "*t"), "time.steps=1")
                self.same(jump, ramp)
                self.assertGreater(jump.scalars["contact_force"], 0)
                force = next(values for name, values in kept.items() if name.startswith("contact_force"))
                self.assertAlmostEqual(force[0]/force[-1], 1, delta=1e-12)

    def shear(self, material, scheme, steps, plane="stress"):
        """s12 of all steps, and the energies at the end."""
        time = f'steps = {steps}' if steps else "tolerance = 1e-2"
        text = SHEARED.format(plane=f'plane = "{plane}"', material=material, x=f"{2*STRAIN}*y",
                              time=f'scheme = "{scheme}"\n{time}')
        summary = self.run_it(text)
        shear = [(time, read_mortier(self.folder / "out", step).bodies["a"].stress[0, 2])
                 for step, time in kept_steps(self.folder / "out")]
        return shear, summary["quantities"]

    def test_a_held_strain_relaxes(self):
        modulus = 1000/2.5
        for material, left in ((MAXWELL, 0), (SOLID, 0.3)):
            for scheme, decay in DECAY.items():
                plane = "strain" if scheme == "sdirk2" else "stress"
                with self.subTest(material, scheme=scheme, plane=plane):
                    shear, _ = self.shear(material, scheme, 4, plane)
                    for n, (_, value) in enumerate(shear):
                        exact = 2*modulus*STRAIN*(left + (1 - left)*decay(0.25/0.5)**n)
                        self.assertAlmostEqual(value/exact, 1, delta=1e-10)

    def test_with_steps_chosen_by_their_error(self):
        for material, left in ((MAXWELL, 0), (SOLID, 0.3)):
            for scheme in ("backward-euler", "sdirk2"):
                shear, _ = self.shear(material, scheme, 0)
                for time, value in shear:
                    exact = left + (1 - left)*math.exp(-time/0.5)
                    self.assertAlmostEqual(value/8, exact, delta=1.5e-2)

    def test_perzyna_relaxes_to_yield(self):
        flowing = '{ young = 1000, poisson = 0.25, viscosity = 1, yield_stress = 3 }'
        shear, _ = self.shear(flowing, "backward-euler", 0)
        self.assertAlmostEqual(shear[0][1]/8, 1, delta=1e-12)
        self.assertAlmostEqual(math.sqrt(3)*shear[-1][1], 3, delta=1e-2)

    def test_energies_add_up(self):
        """To the order of the scheme, and what is lost never comes back."""
        for material in (MAXWELL, SOLID, '{ young = 1000, poisson = 0.25, law = "norton", '
                         'reference_stress = 5, reference_rate = 1e-4, exponent = 3 }'):
            for scheme, order, plane in (("backward-euler", 1, "stress"), ("crank-nicolson", 2, "strain"),
                                         ("sdirk2", 2, "stress")):
                off = []
                for steps in (16, 32):
                    _, found = self.shear(material, scheme, steps, plane)
                    work, stored, lost = (found[name]["value"] for name in ("work", "stored", "lost"))
                    self.assertAlmostEqual(work, 0.5*8*2*STRAIN, delta=1e-12)  # that of the jump alone
                    self.assertEqual(found["lost"]["largest"]["value"], lost)
                    off.append(abs(work - stored - lost)/work)
                with self.subTest(material, scheme=scheme, plane=plane, off=off):
                    self.assertLess(off[1], 0.03)
                    self.assertGreater(math.log2(off[0]/off[1]), order - 0.1)

    def test_a_load_that_nothing_holds_ends_the_run_before_its_first_step(self):
        text = CONTACT.format(plane="", degree=1, variant="mortar", drive="ty = 2", contact="")
        self.write(text)
        errors = self.mortier("run", "scene.toml", "--quiet", "--out", "out", code=3).stderr
        self.assertIn("at t = 0: ", errors)
        self.assertEqual(read_history(self.folder / "out.failed"), {})


if __name__ == "__main__":
    unittest.main()
