"""Runs with a guaranteed bound of their error: what they report, and when there is none."""
import cmath
import re
import unittest

from scene_parts import quantity
from scenes import HELD_AND_PRESSED, TWO_BLOCKS
from support import ROOT, OfTwoBlocks

ELASTIC = TWO_BLOCKS.replace(', viscosity = 10, yield_stress = 1, projection = "elasticity"', "")
BOUND = "\n[accuracy]\nbound = true\n"
# The bound is half as large again as the estimate.
SINGLE_CELLS = '''\
plane = "strain"
[[body]]
name = "upper"
mesh = { shape = "rectangle", lower = [0, 0], upper = [1, 1], cells = [1, 1], cut = "both" }
material = { young = 1, poisson = 0.45 }
boundary = [ { label = 4, ux = 0 }, { label = 3, uy = "-0.01*t*1" } ]
[[body]]
name = "lower"
mesh = { shape = "rectangle", lower = [0, -1], upper = [1, 0], cells = [3, 3], cut = "both" }
material = { young = 1.0, poisson = 0.45 }
boundary = [ { label = 1, ux = 0, uy = 0 } ]
[contact]
nonmortar = { body = "upper", label = 1 }
mortar = { body = "lower", label = 3 }
gap = "0.003*2"
sliding = "allow"
[time]
end = 1
steps = 1
'''


def turned_mesh(text, angle, digits):
    """The mesh turned about the origin, with coordinates of so many digits."""
    lines = text.split("\n")
    first = lines.index("Vertices") + 2
    for i in range(first, first + int(lines[first - 1])):
        x, y, *label = lines[i].split()
        z = complex(float(x), float(y)) * cmath.exp(1j * angle)
        lines[i] = " ".join([f"{z.real:.{digits}g}", f"{z.imag:.{digits}g}", *label])
    return "\n".join(lines)


class Bound(OfTwoBlocks):
    def bound(self, scene, *arguments):
        """Standard output and accuracy of summary.json."""
        self.write(scene + BOUND)
        done = self.mortier("run", "scene.toml", "--out", "out", *arguments)
        return done.stdout, self.summary_of()["accuracy"]

    def test_mortar_is_exact_and_interpolation_is_not(self):
        log, accuracy = self.bound(ELASTIC)
        self.assertIn("guaranteed: below rounding", log)
        self.assertLess(accuracy["bound"]["energy_error"], 1e-12)
        log, accuracy = self.bound(ELASTIC, "--set", "contact.variant=interpolation")
        found = accuracy["bound"]
        self.assertIn(f"guaranteed: at most {100 * found['energy_error']:.2g} %", log)
        self.assertAlmostEqual(found["absolute"] ** 2, found["stress"] ** 2 + found["lift"] ** 2
                               + found["gap"] ** 2, delta=1e-12 * found["absolute"] ** 2)
        self.assertAlmostEqual(found["energy_error"],
                               found["absolute"] / (found["norm"] - found["absolute"]), delta=1e-12)
        self.assertLess(found["data"], 1e-12)
        # The estimate of this state is below its error, the bound above (tests/theory/energy_bound_test.cpp).
        self.assertGreater(found["energy_error"], accuracy["energy_error"])

    def test_turned_meshes_of_eight_digits_are_straight(self):
        # Sides, rollers and contact of turned blocks are straight but for the digits of their files.
        found = {}
        for angle, digits in ((0, 17), (0.3, 8), (0.3, 7)):
            scene = ELASTIC.replace('ty = "-10*t"', 'pressure = "10*t"').replace("3e11", "1e3")
            scene = re.sub("u[xy] = 0", "un = 0", scene) if angle > 0 else scene
            self.setUp()
            for name in ("upper", "lower"):
                self.write(turned_mesh(self.read(f"{name}.mesh"), angle, digits), f"{name}.mesh")
            for variant in ("mortar", "interpolation"):
                _, accuracy = self.bound(scene, "--set", f"contact.variant={variant}")
                found[variant, digits] = accuracy["bound"]["energy_error"]
        for digits in (7, 8):
            self.assertLess(found["mortar", digits], 1e-5)
            self.assertAlmostEqual(found["interpolation", digits], found["interpolation", 17],
                                   delta=0.01 * found["interpolation", 17])

    def test_units_change_nothing(self):
        _, accuracy = self.bound(ELASTIC, "--set", "contact.variant=interpolation")
        soft = ELASTIC.replace("3e11", "3e-4").replace("-10*t", "-1e-9*t")
        _, other = self.bound(soft, "--set", "contact.variant=interpolation")
        ratio = other["bound"]["energy_error"] / accuracy["bound"]["energy_error"]
        self.assertAlmostEqual(ratio, 1, delta=1e-9)

    def test_estimates_are_called_so(self):
        self.write(ELASTIC + BOUND + HELD_AND_PRESSED + quantity("mean", "mean_pressure", "lower", 3)
                   + quantity("peak", "largest_pressure", "lower", 3)
                   + quantity("sinks", "displacement", "upper", component="y", point=[0.3, 0.8]))
        log = self.mortier("run", "scene.toml", "--out", "out", "--set",
                           "contact.variant=interpolation").stdout
        found = {name: each["bound"]
                 for name, each in self.summary_of()["quantities"].items()}
        self.assertRegex(log, r"mean \S+ Pa \+- \S+ \(guaranteed\), peak \S+ Pa at \S+ \S+ \+- \S+ "
                              r"\(an estimate\), sinks \S+ m \+- \S+ \(an estimate\)\n")
        self.assertLessEqual(found["mean"]["lower"], 10 * (1 + 1e-12))
        self.assertGreaterEqual(found["mean"]["upper"], 10 * (1 - 1e-12))
        for name in ("peak", "sinks"):
            self.assertIsNone(found[name]["error"])
            self.assertGreater(found[name]["estimate"], 0)
        summary = self.summary_of()["quantities"]
        self.assertLessEqual(abs(summary["peak"]["value"] - 10), 3 * found["peak"]["estimate"])
        exact = -(1 + 0.8) * 10 / 3e11  # both blocks are pressed alike
        self.assertLessEqual(abs(summary["sinks"]["value"] - exact), found["sinks"]["estimate"])

    def test_memory_grows_by_at_most_half(self):
        for body, y in (("upper", 0), ("lower", -1)):
            self.mortier("mesh", "crisscross", "--cells", "35" if y == 0 else "34", "--lower", f"0,{y}",
                         "--upper", f"1,{y + 1}", f"{body}.mesh")
        peaks = []
        for bound in ("", BOUND):
            peaks.append(self.run_it(ELASTIC + bound, "contact.variant=interpolation")["peak_memory_mib"])
        self.assertLessEqual(peaks[1], 1.5 * peaks[0])

    def test_not_asked_for_is_not_told(self):
        self.write(ELASTIC + HELD_AND_PRESSED)
        log = self.mortier("run", "scene.toml", "--out", "out").stdout
        self.assertNotIn("guaranteed", log)
        summary = self.summary_of()
        self.assertNotIn("bound", summary["accuracy"])
        self.assertNotIn("bound", summary["quantities"]["held"])

    def test_where_no_theorem_holds_the_condition_is_named(self):
        for settings, reason in [(["degree=2"], "displacements are quadratic"),
                                 (["body.upper.material.viscosity=10", "body.upper.material.yield_stress=1"],
                                  "upper is viscoplastic")]:
            log, accuracy = self.bound(ELASTIC, "--set", *settings)
            self.assertIn(f"no guaranteed bound: {reason}\n", log)
            self.assertIsNone(accuracy["bound"]["energy_error"])
            self.assertEqual(accuracy["bound"]["reason"], reason)

    def test_curved_lines_have_none(self):
        done = self.mortier("run", ROOT / "scenes" / "hertz.toml", "--out", "out", "--set",
                            "accuracy.bound=true", "time.steps=1")
        self.assertIn("no guaranteed bound: the contact line of", done.stdout)
        self.assertIn("is not straight", done.stdout)

    def test_supports_along_a_curve_have_none(self):
        done = self.mortier("run", ROOT / "scenes" / "cut-ring.toml", "--out", "out", "--set",
                            "accuracy.bound=true")
        self.assertIn("no guaranteed bound: upper is held along a curve", done.stdout)

    def test_data_that_are_not_linear_are_in_the_bound(self):
        log, accuracy = self.bound(ELASTIC.replace('"-10*t"', '"-10*t*(1 + 0.5*sin(3*x))"'))
        self.assertGreater(accuracy["bound"]["data"], 1e-4)
        self.assertLess(accuracy["bound"]["data"], 0.3 * accuracy["bound"]["energy_error"])
        self.assertIn("% of it for data between the nodes", log)
        # A wave that is zero at all nodes and their quarters.
        _, waves = self.bound(ELASTIC.replace('"-10*t"', '"-10*t*(1 + 5*sin(24*pi*x))"'))
        self.assertGreater(waves["bound"]["absolute"], 3 * accuracy["bound"]["absolute"])

    def test_rounds_end_on_the_bound(self):
        self.write(SINGLE_CELLS.replace("cells = [3, 3]", "cells = [7, 1]")
                   .replace("young = 1.0", "young = 0.02"))
        unknowns = []
        for bound in ("false", "true"):
            self.mortier("run", "scene.toml", "--out", bound, "--accuracy", "0.05", "--set",
                         f"accuracy.bound={bound}")
            summary = self.summary_of(bound)
            self.assertTrue(summary["accuracy"]["reached"])
            unknowns.append(summary["rounds"][-1]["unknowns"])
        self.assertTrue(0.02 < summary["accuracy"]["bound"]["energy_error"] < 0.05)
        # The estimate alone is content with coarser meshes.
        self.assertGreater(unknowns[1], 1.2 * unknowns[0])

    def test_quantities_have_bounds(self):
        asked = (HELD_AND_PRESSED + quantity("sinks", "displacement", "upper", 3, "y")
                 + quantity("at", "displacement", "upper", component="y", point=[0.25, 1]))
        log, _ = self.bound(ELASTIC + asked, "--set", "contact.variant=interpolation")
        found = self.summary_of()["quantities"]
        for name, exact in (("held", 10), ("pressed", -10), ("sinks", -20 / 3e11)):
            value, bound = found[name]["value"], found[name]["bound"]
            self.assertLessEqual(bound["lower"], exact + 1e-12 * abs(exact))
            self.assertGreaterEqual(bound["upper"], exact - 1e-12 * abs(exact))
            self.assertAlmostEqual(bound["error"], max(value - bound["lower"], bound["upper"] - value),
                                   delta=1e-12 * abs(value))
            told = f"{name} {value:.7g} {found[name]['unit']} +- {bound['error']:.2g} (guaranteed)"
            self.assertIn(told, log)
        self.assertGreater(found["sinks"]["bound"]["error"], 1e-6 * 20 / 3e11)
        self.assertIsNone(found["at"]["bound"]["error"])
        self.assertRegex(log, r"at \S+ m \+- \S+ \(an estimate\)")
        self.assertIn("displacements at a point have none", found["at"]["bound"]["reason"])
        # Those of the last round, whose meshes are finer.
        self.bound(ELASTIC + asked, "--accuracy", "0.5")
        found = self.summary_of()["quantities"]["pressed"]
        self.assertLessEqual(abs(found["value"] + 10), found["bound"]["error"] + 1e-10)
        self.assertLess(found["bound"]["error"], 1e-6)
        # Where there is no bound of the energy there is none of quantities.
        log, _ = self.bound(ELASTIC + asked, "--set", "degree=2")
        found = self.summary_of()["quantities"]["held"]["bound"]
        self.assertEqual(found, {"error": None, "reason": "displacements are quadratic"})

    def test_wrong_values_are_refused(self):
        for text, message in [("bound = 1", "bound = 1, expected true or false"),
                              ("bound = true\nmax_unknowns = 5", "max_unknowns = 5"),
                              ("bound = false", "energy")]:
            self.write(ELASTIC + "\n[accuracy]\n" + text + "\n")
            errors = self.mortier("run", "scene.toml", "--out", "out", code=2).stderr
            self.assertIn(message, errors)


if __name__ == "__main__":
    unittest.main()
