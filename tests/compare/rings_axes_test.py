"""Bodies of revolution whose elasticity has axes, against exact solutions, and user-defined laws beside
those that they repeat."""
import math
import unittest

import numpy as np

from own_law_test import COMPARED, MAXWELL, NORTON, PAIRS, PERZYNA, SCENE, along_deviator
from rings_support import INNER, OUTER, SPHERE, OfRings, tube
from support import InFolder


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


class AxesOfRings(OfRings):
    YOUNG, POISSON = (10.0, 5.0, 20.0), (0.25, 0.1, 0.15)

    def material(self, young, poisson, angle="0"):
        e, nu = young, poisson
        return (f'elasticity = "orthotropic", young1 = {e[0]}, young2 = {e[1]}, young3 = {e[2]}, '
                f'poisson12 = {nu[0]}, poisson13 = {nu[1]}, poisson23 = {nu[2]}, shear12 = 3, '
                f'angle = "{angle}"')

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


class OwnLawsOfRings(InFolder):
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
                                    f"time.scheme={scheme}", "body.upper.volume=pointwise")
                        rows = self.rows_of("out/history.csv")
                        histories.append([[float(row[column.replace("/m]", "]")]) for column in COMPARED]
                                          for row in rows])
                    np.testing.assert_allclose(*histories, rtol=1e-7)

    def test_the_rate_around_the_axis_is_asked_for(self):
        text = SCENE.replace("PLANE", "axisymmetric").format(law="\n".join(
            line for line in NORTON.splitlines() if not line.startswith("rate33")))
        self.refuse(text, "expected rate33 beside the others around an axis")


if __name__ == "__main__":
    unittest.main()
