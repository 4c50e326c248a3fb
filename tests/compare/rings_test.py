"""Bodies of revolution with every law: temperature, flow by the overstress, axes and laws of one's own,
against exact solutions; the estimate of the error around the axis."""
import csv
import math
import unittest

import numpy as np

from heat_test import BLOCK, Heat
from own_law_test import COMPARED, MAXWELL, NORTON, PAIRS, PERZYNA, SCENE, along_deviator
from support import OfScene

import results
import study_support
import measure

INNER, OUTER = 1.0, 2.0

# A tube between plates.
TUBE = """\
plane = "axisymmetric"
degree = 2
[[body]]
name = "tube"
mesh = { shape = "rectangle", lower = [1, 0], upper = [2, 0.25], cells = [CELLS, 2], cut = "both" }
BODY
boundary = [ { label = 1, uy = 0 }, { label = 3, uy = 0 }, SIDES ]
[time]
end = END
steps = STEPS
[check]
allow = ["constant-loads", "initial-load"]
"""

# A quarter of a hollow sphere: label 4 lies on the axis.
SPHERE = """\
plane = "axisymmetric"
[[body]]
name = "sphere"
mesh = { shape = "annulus", inner = 1, outer = 2, span = "quarter", cells = [CELLS, CELLS], cut = "both" }
material = { MATERIAL }
boundary = [ { label = 3, uy = 0 }, { label = 1, pressure = 1 } ]
[time]
end = 1
steps = 1
[check]
allow = ["constant-loads", "initial-load"]
"""

# A bar that is pressed along the axis.
BAR = """\
plane = "axisymmetric"
[[body]]
name = "bar"
mesh = { shape = "rectangle", lower = [0, 0], upper = [1, 1], cells = [2, 2], cut = "both" }
material = { young = 100, poisson = 0.3, law = "viscoplastic", yield_stress = 1, LAW }
boundary = [ { label = 1, uy = 0 }, { label = 3, ty = -3 } ]
[[quantity]]
name = "shortens"
displacement = { body = "bar", point = [1, 1] }
component = "y"
[[quantity]]
name = "widens"
displacement = { body = "bar", point = [1, 1] }
component = "x"
[time]
end = 1
steps = 1
[check]
allow = ["constant-loads", "initial-load"]
"""


def stiffness(young, poisson):
    """Rows and columns 1, 2, 3 of an orthotropic body."""
    e, (nu12, nu13, nu23) = np.array(young), poisson
    compliance = np.diag(1 / e)
    compliance[0, 1] = compliance[1, 0] = -nu12 / e[0]
    compliance[0, 2] = compliance[2, 0] = -nu13 / e[0]
    compliance[1, 2] = compliance[2, 1] = -nu23 / e[1]
    return np.linalg.inv(compliance)


def powers(n, m, radial, across, inner=INNER, outer=OUTER):
    """Factors of r^n and r^m, for which the stress radial u' + across u/r is -1 inside, 0 outside."""
    rows = [[(radial * k + across) * r**(k - 1) for k in (n, m)] for r in (inner, outer)]
    return np.linalg.solve(rows, [-1, 0])


class OfRings(OfScene):
    def error(self, quantity, materials, **exact):
        """Of the last run, relative, over the whole ring."""
        names = [name for name in ("ux", "uy", "s11", "s22", "s12", "s33") if name in exact]
        truth = measure.Exact({"": {name: lambda x, y, t, f=exact[name]: f(x, y) + 0 * x for name in names}},
                              [], 1.0)
        return measure.field_error(quantity, results.read(self.folder / "out"), truth, materials, ring=True)

    def orders(self, cells, run, least, last):
        errors = [run(n) for n in cells]
        order = np.polyfit(np.log(cells), np.log(errors), 1)[0]
        self.assertGreaterEqual(-order, least, errors)
        self.assertLessEqual(errors[-1], last)


def tube(cells, body, sides, end=1, steps=1):
    return (TUBE.replace("CELLS", str(cells)).replace("BODY", body).replace("SIDES", sides)
            .replace("END", str(end)).replace("STEPS", str(steps)))


class HotRings(OfRings):
    def test_free_expansion_has_no_stress(self):
        """Whatever the law, also where it remembers more than the stress."""
        growing = ', law = "viscoplastic", yield_stress = 1, reference_stress = 1, reference_rate = 1, ' \
            "exponent = 3, kinematic_hardening = 2, isotropic_hardening = 5"
        laws = ("", ', law = "standard-solid", relaxation_time = 0.1, relaxed_fraction = 0.4',
                ', law = "norton", reference_stress = 1, reference_rate = 1, exponent = 3', growing)
        for plane, part in (("axisymmetric", 1), ("stress", 1), ("strain", 1.3)):
            for law in laws if plane == "axisymmetric" else (growing,):
                for scheme in ("time.scheme=backward-euler", "time.scheme=sdirk2"):
                    with self.subTest(plane=plane, law=law, scheme=scheme):
                        text = BLOCK.replace("PLANE", plane).replace("BESIDE", "")
                        # In plane strain it is pressed across the plane: it shall not flow.
                        text = text.replace("poisson = 0.3", "poisson = 0.3" + law.replace(
                            "yield_stress = 1,", "yield_stress = 1e3," if plane == "strain" else
                            "yield_stress = 1,"))
                        summary = self.run_it(text, scheme)
                        self.assertAlmostEqual(self.value(summary, "grows"), 2e-3 * part, delta=1e-14)
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

        body = f'temperature = "100*x*t"\nmaterial = {{ young = {young}, poisson = {nu}, expansion = {alpha} }}'
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

    def test_a_fit_heated_and_cooled(self):
        """Rings in each other between plates: the exact pressure of plane strain."""
        for shaft, hub in ((0, 0), (80, 0), (0, -40), (100, 20), (-30, 0)):
            with self.subTest(shaft=shaft, hub=hub):
                def body(name, lower, upper, cells, keys, heat):
                    warm = f'temperature = "{heat}*t"\n' if heat else ""
                    return (f'[[body]]\nname = "{name}"\nmesh = {{ shape = "rectangle", lower = [{lower}, 0], '
                            f'upper = [{upper}, 2], cells = [{cells}, 3] }}\nmaterial = {{ {keys} }}\n{warm}'
                            "boundary = [ { label = 1, uy = 0 }, { label = 3, uy = 0 } ]\n")
                text = ('plane = "axisymmetric"\ndegree = 2\n'
                        + body("shaft", 10, 20, 8, "young = 2e5, poisson = 0.3, expansion = 1.2e-5", shaft)
                        + body("hub", 20, 40, 10, "young = 1e5, poisson = 0.25, expansion = 2.3e-5", hub)
                        + '[contact]\nnonmortar = { body = "shaft", label = 2 }\n'
                        'mortar = { body = "hub", label = 4 }\ngap = -0.01\n[[quantity]]\nname = "pressure"\n'
                        'largest_pressure = { body = "hub", label = 4 }\n[time]\nend = 1\nsteps = 2\n')
                pressure = self.value(self.run_it(text), "pressure")
                self.assertAlmostEqual(pressure / Heat.lame("strain", shaft, hub), 1, delta=1e-4)


class FlowingRings(OfRings):
    def test_bars_harden_with_the_order_of_the_scheme(self):
        """Under a stress s: p = (s - Y)/(H + K) (1 - exp(-(H + K) rate t/s0)); the bar widens by half of it."""
        law = "reference_stress = 2, reference_rate = 0.5, exponent = 1, kinematic_hardening = 4, " \
            "isotropic_hardening = 6"
        p = 2 / 10 * (1 - math.exp(-10 * 0.5 / 2))
        for scheme, order in (("backward-euler", 1), ("sdirk2", 2)):
            errors = []
            for steps in (8, 16, 32, 64):
                summary = self.run_it(BAR.replace("LAW", law), f"time.scheme={scheme}", f"time.steps={steps}")
                short, wide = self.value(summary, "shortens"), self.value(summary, "widens")
                self.assertAlmostEqual(wide + short / 2, (0.3 - 0.5) * 3 / 100, delta=1e-12)
                errors.append(abs(-short - 3 / 100 - p) / p)
            self.assertAlmostEqual(-np.polyfit(np.log([8, 16, 32, 64]), np.log(errors), 1)[0], order, delta=0.1)

    def test_plastic_bars_are_exact(self):
        law = "viscosity = 0, kinematic_hardening = 4, isotropic_hardening = 6"
        summary = self.run_it(BAR.replace("LAW", law))
        self.assertAlmostEqual(-self.value(summary, "shortens"), 3 / 100 + 2 / 10, delta=1e-10)
        self.assertAlmostEqual(self.value(summary, "widens"), 0.3 * 3 / 100 + 1 / 10, delta=1e-10)
        self.assertLessEqual(summary["newton_iterations"], 8)

    def test_a_tube_comes_to_the_stationary_stress(self):
        """p' = 2 C/(sqrt3 r^2) everywhere, so that vM = Y + B r^(-2/m) and, as r s_rr' = 2 vM/sqrt3,
        s_rr = -P + 2/sqrt3 (Y log(r/a) + B m/2 (a^(-2/m) - r^(-2/m))); B from s_rr(b) = 0. With Y much smaller
        it is Norton's (F. K. G. Odqvist, 1966). What flows keeps its volume, which u = C/r does not on a mesh:
        the longer it flows, the more of that is a pressure (docs/theory.md)."""
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


class FreeRings(OfScene):
    def test_a_motion_without_strain_takes_the_same_in_all_units(self):
        iterations = set()
        for units, size in (("m, N, Pa", 1), ("mm, N, MPa", 1000)):
            text = SPIN.replace('force.x = "x"\n', "").replace(", { label = 3, uy = 0 }", "").replace(
                "uy = 0", f'uy = "{0.37e-3 * size}*t"').replace("[1, 1]", f"[{size}, {size}]").replace(
                "CELLS", "7").replace("young = 100", f"young = {2e11 if size == 1 else 2e5}")
            summary = self.run_it(f'units = "{units}"\n' + text)
            iterations.add(summary["newton_iterations"])
            self.assertLess(summary["verification"]["force_balance"], 1e-12)
        self.assertEqual(len(iterations), 1)


class AxesOfRings(OfRings):
    YOUNG, POISSON = (10.0, 5.0, 20.0), (0.25, 0.1, 0.15)

    def material(self, young, poisson, angle="0"):
        e, nu = young, poisson
        return (f'elasticity = "orthotropic", young1 = {e[0]}, young2 = {e[1]}, young3 = {e[2]}, '
                f'poisson12 = {nu[0]}, poisson13 = {nu[1]}, poisson23 = {nu[2]}, shear12 = 3, angle = "{angle}"')

    def test_a_tube_with_axes(self):
        """Radial, axial and hoop axes: u = A r^k + B r^-k, k^2 = C33/C11 (Lekhnitskii, 1968); the same with
        axes 1 and 2 exchanged and turned by a right angle."""
        C = stiffness(self.YOUNG, self.POISSON)
        k = math.sqrt(C[2, 2] / C[0, 0])
        A, B = powers(k, -k, C[0, 0], C[0, 2])
        e, (nu12, nu13, nu23) = self.YOUNG, self.POISSON
        swapped = ((e[1], e[0], e[2]), (nu12 * e[1] / e[0], nu23, nu13))
        for young, poisson, angle in ((e, self.POISSON, "0"), (*swapped, "pi/2"), (*swapped, "pi/2 + 0*x")):
            for degree, least, last in ((1, 1.9, 2e-3), (2, 2.9, 2e-5)):
                def run(n, keys=(young, poisson, angle), degree=degree):
                    self.run_it(tube(n, f"material = {{ {self.material(*keys)} }}",
                                     "{ label = 4, pressure = 1 }"), f"degree={degree}")
                    return self.error("displacement", {}, ux=lambda r, z: A * r**k + B * r**-k,
                                      uy=lambda r, z: 0)
                with self.subTest(angle=angle, degree=degree):
                    self.orders([8, 16], run, least, last)

    def test_a_sphere_with_axes(self):
        """Axis 1 along the radius R of the sphere, alike across it: u = A R^n + B R^m,
        n (n + 1) = 2 (C22 + C23 - C12)/C11 (S. G. Lekhnitskii, Theory of Elasticity, 1963, section 69)."""
        young, poisson = (10.0, 20.0, 20.0), (0.1, 0.1, 0.25)
        C = stiffness(young, poisson)
        root = math.sqrt(1 / 4 + 2 * (C[1, 1] + C[1, 2] - C[0, 1]) / C[0, 0])
        n, m = -1 / 2 + root, -1 / 2 - root
        A, B = powers(n, m, C[0, 0], 2 * C[0, 1])
        for degree, least, last in ((1, 1.8, 5e-3), (2, 2.5, 1e-4)):
            def run(cells, degree=degree):
                text = SPHERE.replace("MATERIAL", self.material(young, poisson, "atan2(y, x)"))
                self.run_it(text.replace("CELLS", str(cells)), f"degree={degree}")

                def part(x, y, along):
                    R = np.hypot(x, y)
                    return (A * R**n + B * R**m) * along / R
                return self.error("displacement", {}, ux=lambda x, y: part(x, y, x),
                                  uy=lambda x, y: part(x, y, y))
            with self.subTest(degree=degree):
                self.orders([8, 16], run, least, last)

    def test_what_is_missing_is_asked_for(self):
        text = tube(8, f"material = {{ {self.material(self.YOUNG, self.POISSON)} }}",
                    "{ label = 4, pressure = 1 }")
        self.refuse(text.replace("young3 = 20.0, ", ""), "poisson23 as well around an axis")


# A solid cylinder between plates that spins: a force of r.
SPIN = """\
plane = "axisymmetric"
[[body]]
name = "cylinder"
mesh = { shape = "rectangle", lower = [0, 0], upper = [1, 1], cells = CELLS, cut = "both" }
material = { young = 100, poisson = 0.3 }
force.x = "x"
boundary = [ { label = 1, uy = 0 }, { label = 3, uy = 0 } ]
[time]
end = 1
steps = 1
[check]
allow = ["constant-loads", "initial-load"]
"""


class EstimateAroundTheAxis(OfRings):
    """The estimated error of the stress over the true one."""

    def effectivity(self, text, name, **exact):
        summary = self.run_it(text)
        return summary["accuracy"]["energy_error"] / self.error("energy", {name: (100.0, 0.3)}, **exact)

    def test_of_a_solid_cylinder_that_spins(self):
        """s_rr = c (3 - 2 nu)(1 - r^2), s_tt = c ((3 - 2 nu) - (1 + 2 nu) r^2), c = 1/(8 (1 - nu))."""
        c = 1 / 5.6
        rr, tt = lambda r, z=0: 2.4 * c * (1 - r**2), lambda r, z=0: c * (2.4 - 1.6 * r**2)
        for degree, off in ((1, 0.02), (2, 0.04)):
            self.assertAlmostEqual(self.effectivity(
                SPIN.replace("CELLS", "16").replace("plane", f"degree = {degree}\nplane", 1), "cylinder",
                s11=rr, s33=tt, s12=lambda r, z: 0, s22=lambda r, z: 0.3 * (rr(r) + tt(r))), 1, delta=off)

    def test_of_lames_sphere(self):
        """s_RR = (1 - 8/R^3)/7, s_tt = (1 + 4/R^3)/7."""
        def part(x, y, of):
            R, c, s = np.hypot(x, y), x / np.hypot(x, y), y / np.hypot(x, y)
            return of((1 - 8 / R**3) / 7, (1 + 4 / R**3) / 7, c, s)
        fields = {"s11": lambda r, t, c, s: r * c**2 + t * s**2, "s22": lambda r, t, c, s: r * s**2 + t * c**2,
                  "s12": lambda r, t, c, s: (r - t) * c * s, "s33": lambda r, t, c, s: t}
        text = SPHERE.replace("MATERIAL", "young = 100, poisson = 0.3").replace("CELLS", "16")
        for degree, off in ((1, 0.03), (2, 0.08)):
            self.assertAlmostEqual(self.effectivity(
                text.replace("plane", f"degree = {degree}\nplane", 1), "sphere",
                **{name: lambda x, y, of=of: part(x, y, of) for name, of in fields.items()}), 1, delta=off)


class StudyOfRings(study_support.StudyTest):
    def test_errors_are_those_of_whole_rings(self):
        """Lame's tube: the study gives what the norm over the ring does, and of order 1."""
        for cells in (8, 16):
            self.mortier("mesh", "rectangle", "--cells", f"{cells},{cells // 4}", "--lower", "1,0", "--upper", "2,0.25",
                         "--cut", "both", f"tube{cells}.mesh")
        scene = tube(8, "material = { young = 100, poisson = 0.3 }", "{ label = 4, pressure = 1 }")
        start, end = scene.index("mesh = "), scene.index("\nmaterial")
        self.write(scene.replace("degree = 2\n", "").replace(scene[start:end], 'mesh = "tube8.mesh"'))
        self.write("""\
scene = "scene.toml"
[mesh]
tube = ["tube8.mesh", "tube16.mesh"]
[[error]]
quantity = "energy"
exact = { s11 = "(1 - 4/x^2)/3", s22 = "0.2", s12 = "0", s33 = "(1 + 4/x^2)/3" }
[[error]]
quantity = "displacement"
exact = { ux = "1.3/300*(0.4*x + 4/x)", uy = "0" }
[[sweep]]
level = [0, 1]
""", "study.toml")
        self.study("--jobs", "1")
        rows = list(csv.DictReader(self.read("out/study.csv").splitlines()))
        for name, order in (("error energy", 1), ("error displacement", 2)):
            coarse, fine = (float(row[name]) for row in rows)
            self.assertAlmostEqual(math.log2(coarse / fine), order, delta=0.1)


class OwnLawsOfRings(OfScene):
    def test_they_repeat_the_laws_of_mortier(self):
        solid = along_deviator("1.3/(E*tau)", 'E = 2e11, tau = 0.1, g = 0.3, em11 = "(e11 + e22 + e33)/3", '
                               'em22 = "em11", em33 = "em11", em12 = 0', " - g/tau*(e{c} - em{c})")
        for name, own in (("norton", NORTON), ("maxwell", MAXWELL), ("perzyna", PERZYNA),
                          ("standard solid", solid)):
            for scheme in ("backward-euler", "sdirk2"):
                with self.subTest(law=name, scheme=scheme):
                    histories = []
                    for law in (PAIRS[name][0], own):
                        self.run_it(SCENE.replace("PLANE", "axisymmetric").format(law=law),
                                    f"time.scheme={scheme}")
                        rows = list(csv.DictReader(self.read("out/history.csv").splitlines()))
                        histories.append([[float(row[column.replace("/m]", "]")]) for column in COMPARED]
                                          for row in rows])
                    np.testing.assert_allclose(*histories, rtol=1e-7)

    def test_the_rate_around_the_axis_is_asked_for(self):
        text = SCENE.replace("PLANE", "axisymmetric").format(law="\n".join(
            line for line in NORTON.splitlines() if not line.startswith("rate33")))
        self.refuse(text, "expected rate33 beside the others around an axis")


if __name__ == "__main__":
    unittest.main()
