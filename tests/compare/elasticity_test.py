"""Elasticity with axes, as a user meets it, against exact values."""
import math
import unittest

import numpy as np

from scene_parts import body, quantity, shape, timed
from support import InFolder, value

import results

WOOD = ('elasticity = "orthotropic", young1 = 10, young2 = 3, poisson12 = 0.3, shear12 = 1.5')
WOOD_ACROSS = WOOD + ", young3 = 2, poisson13 = 0.2, poisson23 = 0.25"

# A square, turned by TURN with its loads and axes.
SQUARE = ('plane = "PLANE"\ndegree = DEGREE\n'
          + body("block", '{ shape = "quadrilateral", corners = [CORNERS], cells = [3, 4] }',
                 "WOOD, angle = ANGLE", "label = 1, un = 0", "label = 4, un = 0", "label = 3, pressure = -2",
                 "label = 2, pressure = 1") + quantity("energy", "stored_energy", "block")
          + quantity("mises", "largest_mises", "block") + timed() + '[check]\nallow = ["initial-load"]\n')

# A quarter of a large plate with a hole, pulled along x.
HOLE = ("degree = 2\n"
        + body("plate", shape("annulus", inner=1, outer=50, span="quarter", cells=[6, 6], cut="rising"),
               "WOOD", "label = 3, un = 0", "label = 4, un = 0", 'label = 2, tx = "x/sqrt(x^2+y^2)"')
        + "[accuracy]\nenergy = 1e-4\n" + timed()).replace("WOOD", WOOD)


class Axes(InFolder):
    def square(self, turn, angle, plane="stress", degree=1):
        c, s = math.cos(turn), math.sin(turn)
        corners = [[2*x*c - y*s, 2*x*s + y*c] for x, y in [(0, 0), (1, 0), (1, 1), (0, 1)]]
        return (SQUARE.replace("CORNERS", ", ".join(str(corner) for corner in corners))
                .replace("WOOD", WOOD if plane == "stress" else WOOD_ACROSS)
                .replace("ANGLE", angle).replace("PLANE", plane).replace("DEGREE", str(degree)))

    def test_axes_and_mesh_turned_together(self):
        for plane in ("stress", "strain"):
            for degree in (1, 2):
                first = self.run_it(self.square(0, "0.3", plane, degree))
                for turn in (0.7, -2.1):
                    for angle in (str(0.3 + turn), f'"{0.3 + turn} + 0*x"'):
                        with self.subTest(plane=plane, degree=degree, turn=turn, angle=angle):
                            other = self.run_it(self.square(turn, angle, plane, degree))
                            for name in ("energy", "mises"):
                                one = value(first, name)
                                self.assertLessEqual(abs(value(other, name) - one), 1e-12*abs(one))

    def test_uniform_stress_strains_as_the_constants_say(self):
        summary = self.run_it(self.square(0, "0").replace('stored_energy = { body = "block" }',
                              'displacement = { body = "block", point = [2, 1] }\ncomponent = "y"'))
        # s11 = -1, s22 = 2 on the rectangle of 2 by 1
        self.assertAlmostEqual(value(summary, "energy"), 2/3 + 0.3/10, delta=1e-13)

    def test_what_is_not_elliptic_or_not_known_is_refused(self):
        text = self.square(0, "0")
        self.refuse(text, "the smallest eigenvalue of the compliance is ", "body.material.poisson12=2")
        self.refuse(text, "expected young3, poisson13 and poisson23 as well in plane strain", "plane=strain")
        self.refuse(text, 'expected "isotropic" beside accuracy.bound', "accuracy.bound=true")
        self.refuse(text, 'expected "isotropic" beside solver.method = "penalty-duality"',
                    "solver.method=penalty-duality")
        self.refuse(text, "young = 3, expected it beside elasticity = \"isotropic\" only",
                    "body.material.young=3")
        self.refuse(text.replace("angle = 0", 'law = "maxwell", relaxation_time = 1'),
                    'expected "isotropic" beside this law')
        self.refuse(text.replace("angle = 0", 'viscosity = 1, yield_stress = 1, projection = "compliance"'),
                    'expected "frobenius" beside elasticity that is not isotropic')
        self.refuse(text, "the same at all times", "body.material.angle=t")


    def test_a_hole_in_an_orthotropic_plate(self):
        """Lekhnitskii: under a pull along axis 1 the stress at the hole is 1 + n times that across it and
        -(E2/E1)^(1/2) times that ahead of it, n^2 = 2 ((E1/E2)^(1/2) - nu12) + E1/G12."""
        self.run_it(HOLE)
        body = results.read_vtu(next((self.folder / "out").glob("plate_*.vtu")))
        n = math.sqrt(2*(math.sqrt(10/3) - 0.3) + 10/1.5)
        for place, exact, component in (((0, 1), 1 + n, 0), ((1, 0), -math.sqrt(3/10), 1)):
            vertex = np.argmin(np.linalg.norm(body.points - place, axis=1))
            stresses = []
            for corners, stress in zip(body.triangles, body.stress_at_points):
                for k in range(3):
                    if corners[k] == vertex:  # linear, by its values at 2/3, 1/6, 1/6
                        stresses.append(2*stress[k][component] - stress.mean(axis=0)[component])
            self.assertAlmostEqual(np.mean(stresses)/exact, 1, delta=0.01)


if __name__ == "__main__":
    unittest.main()
