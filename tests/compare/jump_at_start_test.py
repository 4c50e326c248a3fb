"""What is there at t = 0 acts at once: elastically, then the bodies flow from there. docs/scene.md."""
import itertools
import math
import unittest

from scene_parts import body, box, contact, quantity, timed
from support import InFolder
from results import kept_steps, read_history, read_mortier  # behind support: it is in compare/

def static(data, head=""):
    return (head + body("block", box([0, 0], [1, 1], 4, cut="both"),
                        "young = 2.1e11, poisson = 0.3, expansion = 1e-5", more=data + "\n")
            + quantity("stored", "stored_energy", "block") + quantity("work", "work", "block")
            + quantity("heat", "thermal_work", "block") + timed())


HELD = "boundary = [ {{ label = 1, ux = 0, uy = 0 }}, {{ label = 3, {} }} ]"
DRIVES = {  # what acts; {} is nothing or * t
    "displacement": HELD.format('uy = "-1e-3{}"'),
    "along the normal": HELD.format('un = "-1e-3{}"'),
    "traction": HELD.format('ty = "-1e7{}"'),
    "body force": HELD.format("ux = 0") + '\nforce = { y = "-1e6{}" }',
    "temperature": HELD.format("uy = 0") + '\ntemperature = "100{}"',
}

def pressed(drive, more="", variant="mortar", head=""):
    return (head + body("upper", box([0, 0], [1, 1], 3, cut="both"), 100, "label = 4, ux = 0",
                        f"label = 3, {drive}")
            + body("lower", box([0, -1], [1, 0], 4, cut="both"), "young = 300, poisson = 0.2",
                   "label = 4, ux = 0", "label = 1, uy = 0")
            + contact(("upper", 1), ("lower", 3), variant=variant, more=more + "\n") + timed(2))


def sheared(material, plane, **time):
    """One square of a body that flows, sheared by its supports."""
    return (f'plane = "{plane}"\n'
            + body("a", box([0, 0], [1, 1], 1), material,
                   *(f'label = {k}, ux = "{2*STRAIN}*y", uy = 0' for k in (1, 2, 3, 4)))
            + quantity("stored", "stored_energy", "a") + quantity("lost", "dissipated_energy", "a")
            + quantity("work", "work", "a") + "[output]\nevery = 1\n" + timed(**time))


MAXWELL = 'young = 1000, poisson = 0.25, law = "maxwell", relaxation_time = 0.5'
SOLID = MAXWELL.replace("maxwell", "standard-solid") + ", relaxed_fraction = 0.3"
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
                    text = static(data, f'plane = "{plane}"\ndegree = {degree}\n')
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
        self.write(static(DRIVES["displacement"].replace("{}", "")))
        self.assertEqual(self.mortier("run", "scene.toml", "--quiet", "--out", "out").stderr, "")
        self.assertIn("0 warnings", self.mortier("check", "scene.toml").stdout)

    def test_contact_closes_in_the_jump(self):
        """Also where an interference is all that acts, and with friction."""
        drives = [('uy = "-0.01{}"', ""), ('ty = "-2{}"', ""), ("uy = 0", 'gap = "-0.01{}"'),
                  ('uy = "-0.01{}"', "gap = 0.004"), ('ux = "0.002{}", uy = "-0.01{}"', "friction = 0.3"),
                  ("uy = 0", 'gap = "-0.01{}"\nfriction = 0.3')]
        ways = itertools.cycle((("mortar", "stress", 1), ("interpolation", "strain", 1),
                                ("weighted", "axisymmetric", 2), ("mortar", "strain", 2)))
        for (drive, more), (variant, plane, degree) in zip(drives, ways):
            with self.subTest(drive, more=more, variant=variant):
                text = pressed(drive, more, variant, f'plane = "{plane}"\ndegree = {degree}\n')
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
        summary = self.run_it(sheared(material, plane, scheme=scheme, steps=steps or None,
                                      tolerance=None if steps else 1e-2))
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
        flowing = "young = 1000, poisson = 0.25, viscosity = 1, yield_stress = 3"
        shear, _ = self.shear(flowing, "backward-euler", 0)
        self.assertAlmostEqual(shear[0][1]/8, 1, delta=1e-12)
        self.assertAlmostEqual(math.sqrt(3)*shear[-1][1], 3, delta=1e-2)

    def test_energies_add_up(self):
        """To the order of the scheme, and what is lost never comes back."""
        for material in (MAXWELL, SOLID, 'young = 1000, poisson = 0.25, law = "norton", '
                         'reference_stress = 5, reference_rate = 1e-4, exponent = 3'):
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
        self.write(pressed("ty = 2"))
        errors = self.mortier("run", "scene.toml", "--quiet", "--out", "out", code=3).stderr
        self.assertIn("at t = 0: ", errors)
        self.assertEqual(read_history(self.folder / "out.failed"), {})


if __name__ == "__main__":
    unittest.main()
