"""Around the axis: the estimated error over the true one, studies, and forces that are nothing but
rounding."""
import math
import unittest

import numpy as np

from scene_parts import body, timed
from rings_support import SPHERE, OfRings, tube
from support import InFolder
import study_support

# A solid cylinder between plates that spins: a force of r.
SPIN = ('plane = "axisymmetric"\n'
        + body("cylinder",
               '{ shape = "rectangle", lower = [0, 0], upper = [1, 1], cells = CELLS, cut = "both" }', 100,
               "label = 1, uy = 0", "label = 3, uy = 0", more='force.x = "x"\n') + timed()
        + '[check]\nallow = ["initial-load"]\n')


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
        fields = {"s11": lambda r, t, c, s: r * c**2 + t * s**2,
                  "s22": lambda r, t, c, s: r * s**2 + t * c**2,
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
            self.mortier("mesh", "rectangle", "--cells", f"{cells},{cells // 4}", "--lower", "1,0",
                         "--upper", "2,0.25", "--cut", "both", f"tube{cells}.mesh")
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
        rows = self.rows_of("out/study.csv")
        for name, order in (("error energy", 1), ("error displacement", 2)):
            coarse, fine = (float(row[name]) for row in rows)
            self.assertAlmostEqual(math.log2(coarse / fine), order, delta=0.1)


class FreeRings(InFolder):
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


if __name__ == "__main__":
    unittest.main()
