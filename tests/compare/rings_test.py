"""Bodies of revolution under heat, and with flow by the overstress, against exact solutions."""
import math
import unittest

import numpy as np

import heat_test
from scene_parts import body, box, quantity, timed
from rings_support import INNER, OUTER, OfRings, tube
from support import value

# A bar that is pressed along the axis.
BAR = ('plane = "axisymmetric"\n'
       + body("bar", box([0, 0], [1, 1], [2, 2], cut="both"),
              'young = 100, poisson = 0.3, law = "viscoplastic", yield_stress = 1, LAW', "label = 1, uy = 0",
              "label = 3, ty = -3")
       + quantity("shortens", "displacement", "bar", component="y", point=[1, 1])
       + quantity("widens", "displacement", "bar", component="x", point=[1, 1]) + timed()
       + '[check]\nallow = ["initial-load"]\n')


class HotRings(OfRings):
    def test_free_expansion_has_no_stress(self):
        """Whatever the law, also where it remembers more than the stress."""
        growing = ', law = "viscoplastic", yield_stress = 1, reference_stress = 1, reference_rate = 1, ' \
            "exponent = 3, kinematic_hardening = 2, isotropic_hardening = 5"
        laws = ("", ', law = "standard-solid", relaxation_time = 0.1, relaxed_fraction = 0.4',
                ', law = "norton", reference_stress = 1, reference_rate = 1, exponent = 3', growing)
        for plane, part in (("axisymmetric", 1), ("stress", 1), ("strain", 1.3)):
            for law in ("", growing) if plane == "strain" else laws:
                for scheme in ("time.scheme=backward-euler", "time.scheme=sdirk2", "time.tolerance=1e-3"):
                    with self.subTest(plane=plane, law=law, scheme=scheme):
                        text = heat_test.BLOCK.replace("PLANE", plane)
                        # In plane strain it is pressed across the plane: it shall not flow.
                        text = text.replace("poisson = 0.3", "poisson = 0.3" + law.replace(
                            "yield_stress = 1,", "yield_stress = 1e3," if plane == "strain" else
                            "yield_stress = 1,"))
                        summary = self.run_it(text, scheme)
                        self.assertAlmostEqual(value(summary, "grows"), 2e-3 * part, delta=1e-14)
                        if plane != "strain":
                            self.assertLess(summary["peaks"]["von_mises"]["value"], 1e-9)

    def test_a_tube_that_is_hotter_outside(self):
        """T = 100 r between plates: s_rr = (E a/(1 - nu))/r^2 ((r^2 - a^2)/(b^2 - a^2) I(b) - I(r)), I(r) the
        integral of T r from a to r; s_tt = d(r s_rr)/dr (Timoshenko and Goodier, section 151)."""
        young, nu, alpha = 1e5, 0.3, 1e-5
        factor, inside = young * alpha * 100 / (1 - nu), (OUTER**3 - INNER**3) / 3
        part = inside / (OUTER**2 - INNER**2)

        def rr(r, z=0):
            return factor / r**2 * ((r**2 - INNER**2) * part - (r**3 - INNER**3) / 3)

        def tt(r, z=0):
            return factor / r**2 * ((r**2 + INNER**2) * part + (r**3 - INNER**3) / 3 - r**3)

        def zz(r, z=0):
            return nu * (rr(r) + tt(r)) - young * alpha * 100 * r

        def radial(r, z=0):
            return r * ((tt(r) - nu * (rr(r) + zz(r))) / young + alpha * 100 * r)

        body = (f'temperature = "100*x*t"\nmaterial = {{ young = {young}, poisson = {nu}, '
                f"expansion = {alpha} }}")
        for degree, least in ((1, 1.0), (2, 2.0)):
            def run(n, degree=degree):
                self.run_it(tube(n, body, ""), f"degree={degree}")
                moved = self.error("displacement", {}, ux=radial, uy=lambda x, y: 0)
                stressed = self.error("energy", {"tube": (young, nu)}, s11=rr, s22=zz, s33=tt,
                                      s12=lambda x, y: 0)
                self.moved.append(moved)
                return stressed
            self.moved = []
            self.orders([8, 16, 32], run, least - 0.1, 0.05 if degree == 1 else 1e-3)
            order = np.polyfit(np.log([8, 16, 32]), np.log(self.moved), 1)[0]
            self.assertGreaterEqual(-order, least + 0.9, self.moved)


class FlowingRings(OfRings):
    def test_bars_harden_with_the_order_of_the_scheme(self):
        """Under a stress s: p = (s - Y)/(H + K) (1 - exp(-(H + K) rate t/s0)); the bar widens by half
        of it."""
        law = "reference_stress = 2, reference_rate = 0.5, exponent = 1, kinematic_hardening = 4, " \
            "isotropic_hardening = 6"
        p = 2 / 10 * (1 - math.exp(-10 * 0.5 / 2))
        for scheme, order in (("backward-euler", 1), ("sdirk2", 2)):
            errors = []
            for steps in (8, 16, 32, 64):
                summary = self.run_it(BAR.replace("LAW", law), f"time.scheme={scheme}", f"time.steps={steps}")
                short, wide = value(summary, "shortens"), value(summary, "widens")
                self.assertAlmostEqual(wide + short / 2, (0.3 - 0.5) * 3 / 100, delta=1e-12)
                errors.append(abs(-short - 3 / 100 - p) / p)
            fitted = -np.polyfit(np.log([8, 16, 32, 64]), np.log(errors), 1)[0]
            self.assertAlmostEqual(fitted, order, delta=0.1)

    def test_plastic_bars_are_exact(self):
        law = "viscosity = 0, kinematic_hardening = 4, isotropic_hardening = 6"
        summary = self.run_it(BAR.replace("LAW", law))
        self.assertAlmostEqual(-value(summary, "shortens"), 3 / 100 + 2 / 10, delta=1e-10)
        self.assertAlmostEqual(value(summary, "widens"), 0.3 * 3 / 100 + 1 / 10, delta=1e-10)
        self.assertLessEqual(summary["newton_iterations"], 8)

    def test_a_tube_comes_to_the_stationary_stress(self):
        """p' = 2 C/(sqrt3 r^2) everywhere, so that vM = Y + B r^(-2/m) and, as r s_rr' = 2 vM/sqrt3,
        s_rr = -P + 2/sqrt3 (Y log(r/a) + B m/2 (a^(-2/m) - r^(-2/m))); B from s_rr(b) = 0. With Y much
        smaller it is Norton's (F. K. G. Odqvist, 1966). What flows keeps its volume, which u = C/r does not
        on a mesh: the longer it flows, the more of that is a pressure (docs/theory.md)."""
        root = 2 / math.sqrt(3)
        for yields, m, pressure in ((1, 3, 1.5), (1e-3, 5, 0.5)):
            size = (pressure / root - yields * math.log(2)) / (m / 2 * (1 - 2**(-2 / m)))

            def rr(r, z=0, yields=yields, m=m, size=size, pressure=pressure):
                return -pressure + root * (yields * np.log(r) + size * m / 2 * (1 - r**(-2 / m)))

            def tt(r, z=0, rr=rr, yields=yields, m=m, size=size):
                return rr(r) + root * (yields + size * r**(-2 / m))

            body = ('material = { young = 100, poisson = 0.3, law = "viscoplastic", reference_stress = 1, '
                    f"reference_rate = 1, yield_stress = {yields}, exponent = {m} }}")
            self.run_it(tube(12, body, f"{{ label = 4, pressure = {pressure} }}", 1, 10))
            error = self.error("energy", {"tube": (100, 0.3)}, s11=rr, s33=tt, s12=lambda x, y: 0,
                               s22=lambda r, z, rr=rr, tt=tt: (rr(r) + tt(r)) / 2)
            self.assertLess(error, 5e-3)

    PLASTIC = ('material = { young = 100, poisson = 0.499, law = "viscoplastic", viscosity = 0, '
               "yield_stress = 1 }")

    def test_a_tube_that_is_plastic_up_to_a_radius(self):
        """Hill's tube, incompressible: plastic up to c = 1.5, P = Y/sqrt3 (2 log(c/a) + 1 - c^2/b^2)."""
        half, c = 1 / math.sqrt(3), 1.5
        pressure = half * (2 * math.log(c) + 1 - c**2 / OUTER**2)

        def rr(r, z=0):
            return np.where(r < c, -pressure + 2 * half * np.log(r), half * c**2 * (1 / OUTER**2 - 1 / r**2))

        def tt(r, z=0):
            return np.where(r < c, rr(r) + 2 * half, half * c**2 * (1 / OUTER**2 + 1 / r**2))

        self.run_it(tube(16, self.PLASTIC, f"{{ label = 4, pressure = {pressure} }}"))
        error = self.error("energy", {"tube": (100, 0.499)}, s11=rr, s33=tt, s12=lambda x, y: 0,
                           s22=lambda r, z: (rr(r) + tt(r)) / 2)
        self.assertLess(error, 5e-3)

    def test_a_tube_bears_its_limit_load(self):
        """2/sqrt3 Y log(b/a)."""
        limit = 2 / math.sqrt(3) * math.log(2)
        text = tube(8, self.PLASTIC.replace("0.499", "0.3"), '{ label = 4, pressure = "LOAD*t" }', 1, 4)
        self.run_it(text.replace("LOAD", str(0.995 * limit)))
        self.write(text.replace("LOAD", str(1.01 * limit)))
        self.mortier("run", "scene.toml", "--quiet", "--out", "beyond", code=1)


if __name__ == "__main__":
    unittest.main()
