"""Friction of bodies of revolution: along the meridian, with the weights of whole rings."""
import math
import unittest

import numpy as np

from scene_parts import body, box, contact, quantity, shape, timed
from support import InFolder, value

import results

# Two cones on each other, the line between them from (0, 1) to (2, 1.5), under a stress of -1 along the axis.
SLOPE = 0.25
CONES = ('plane = "axisymmetric"\n'
         + body("upper", shape("quadrilateral", corners=[[0, 1], [2, 1.5], [2, 3], [0, 3]], cells=[5, 3]),
                100, 'label = 3, ty = "-t"')
         + body("lower", shape("quadrilateral", corners=[[0, 0], [2, 0], [2, 1.5], [0, 1]], cells=[7, 4]),
                100, "label = 1, uy = 0") + contact(("upper", 1), ("lower", 3), friction=0.26) + timed())

# A sleeve that is pressed onto a shaft by a pressure of 1, then pushed along it.
SLEEVE = ('plane = "axisymmetric"\n'
          + body("shaft", box([0, 0], [1, 2], [3, 8], cut="both"), "young = 100, poisson = 0",
                 "label = 1, uy = 0", "label = 3, uy = 0")
          + body("sleeve", box([1, 0], [2, 2], [4, 6], cut="both"), "young = 100, poisson = 0",
                 "label = 2, pressure = { time = [0, 1, 2], value = [0, 1, 1] }",
                 more="force.y = { time = [0, 1, 2], value = [0, 0, PUSH] }\n")
          + contact(("sleeve", 4), ("shaft", 2), friction=0.01)
          + quantity("along", "contact_force", "shaft", 2, "y") + timed(2, 2))

# A block of one body, and cut in two at y = 1: nodes of both meshes are the same.
PART = """\
[[body]]
name = "NAME"
mesh = { shape = "rectangle", lower = [INNER, LOW], upper = [2, HIGH], cells = [4, CELLS], cut = "both" }
material = { young = 100, poisson = 0.3 }
boundary = [ CONDITIONS ]
"""
PRESSED = '{ label = 3, ty = "-t*(3 - x)" }, { label = 2, ty = "-t*y*0.1" }'
HELD = '{ label = 1, ux = 0, uy = 0 }'


def part(name, low, high, cells, conditions, inner):
    return (PART.replace("NAME", name).replace("LOW", str(low)).replace("HIGH", str(high))
            .replace("CELLS", str(cells)).replace("CONDITIONS", conditions).replace("INNER", str(inner)))


class RubbedRings(InFolder):
    def rows(self):
        rows = self.rows_of("out/contact.csv")
        return [row for row in rows if row["step"] != "0"]

    def test_cones_that_stick_have_a_uniform_stress(self):
        """Shear over pressure is the slope: with more friction meshes that do not match pass the patch
        test."""
        normal, shear = 1 / (1 + SLOPE**2), SLOPE / (1 + SLOPE**2)
        for variant in ("mortar", "weighted"):
            for swap in ("false", "true"):
                for law in ("friction=0.26", "shear_limit=0.24"):
                    with self.subTest(variant=variant, swap=swap, law=law):
                        settings = [f"contact.{law}", f"contact.variant={variant}", f"contact.swap={swap}"]
                        if "limit" in law:
                            settings.insert(0, "contact.friction=0")
                        summary = self.run_it(CONES, *settings)
                        run = results.read(self.folder / "out")
                        for body in run.bodies.values():
                            self.assertLess(np.abs(body.stress - [0, -1, 0, 0]).max(), 1e-12)
                        np.testing.assert_allclose(run.contact.pressure, normal, rtol=1e-11)
                        np.testing.assert_allclose(np.abs(run.contact.shear), shear, rtol=2e-11)
                        self.assertFalse(run.contact.slipping.any())
                        self.assertLess(summary["verification"]["friction"], 1e-12)

    def test_cones_slip_below_the_slope(self):
        """All of them: then the shear is its bound everywhere, also that which is the same on all of the
        surface."""
        for law, bound in (("friction=0.2", None), ("shear_limit=0.1", 0.1)):
            for variant in ("mortar", "weighted", "interpolation"):
                with self.subTest(law=law, variant=variant):
                    settings = [f"contact.{law}", f"contact.variant={variant}"]
                    if bound:
                        settings.insert(0, "contact.friction=0")
                    summary = self.run_it(CONES, *settings)
                    rows = self.rows()
                    pressed = [row for row in rows if float(row["force"]) > 0]
                    self.assertTrue(all(int(row["slipping"]) != 0 for row in pressed))
                    for row in pressed:
                        if bound:
                            self.assertAlmostEqual(abs(float(row["shear"])), bound, delta=1e-13)
                        else:
                            self.assertAlmostEqual(abs(float(row["friction"])), 0.2 * float(row["force"]),
                                                   delta=1e-14)
                    self.assertGreater(summary["final"]["friction_work"], 0)
                    # What friction takes of the axial force the pressure gives: both sum to the load.
                    c = 1 / math.hypot(1, SLOPE)
                    along = sum(float(row["force"]) * c + abs(float(row["friction"])) * SLOPE * c
                                for row in rows)
                    self.assertAlmostEqual(along, 4 * math.pi, delta=1e-10)

    def test_a_sleeve_slips_under_friction_times_pressure_times_area(self):
        """The pressure is uniform and the push spoils it by no more than the square of the friction."""
        limit = 0.01 * 1 * 2 * math.pi * 2  # of the force
        volume = math.pi * (4 - 1) * 2
        for variant in ("mortar", "weighted"):
            with self.subTest(variant=variant):
                held = self.run_it(SLEEVE.replace("PUSH", repr(-0.9999 * limit / volume)),
                                   f"contact.variant={variant}")
                self.assertAlmostEqual(value(held, "along") / limit, -0.9999, delta=1e-10)
                self.write(SLEEVE.replace("PUSH", repr(-1.0001 * limit / volume)))
                errors = self.mortier("run", "scene.toml", "--quiet", "--out", "out", "--set",
                                      f"contact.variant={variant}", code=3).stderr
                self.assertRegex(errors, r"hold body sleeve: translation along \(0, -1\)")

    def test_bodies_that_stick_are_one(self):
        for inner in (0, 1):
            head = 'plane = "axisymmetric"\n'
            time = "[time]\nend = 1\nsteps = 2\n"
            self.run_it(head + part("whole", 0, 2, 8, f"{HELD}, {PRESSED}", inner) + time, folder="whole")
            two = (head + part("upper", 1, 2, 4, PRESSED, inner) + part("lower", 0, 1, 4, HELD + ", " +
                   PRESSED.split("}, ")[1], inner)
                   + '[contact]\nnonmortar = { body = "upper", label = 1 }\n'
                   'mortar = { body = "lower", label = 3 }\nfriction = 20\n' + time)
            whole = results.read(self.folder / "whole").bodies["whole"]
            for variant in ("mortar", "interpolation"):
                with self.subTest(inner=inner, variant=variant):
                    self.run_it(two, f"contact.variant={variant}")
                    run = results.read(self.folder / "out")
                    self.assertTrue((run.contact.force > 0).all())
                    self.assertFalse(run.contact.slipping.any())
                    size = np.abs(whole.displacement).max()
                    for body in run.bodies.values():
                        for place, moved in zip(body.points, body.displacement):
                            vertex = np.argmin(((whole.points - place)**2).sum(1))
                            self.assertLess(np.abs(whole.displacement[vertex] - moved).max(), 1e-11 * size)


if __name__ == "__main__":
    unittest.main()
