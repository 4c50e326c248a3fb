"""Quantities of bodies in space: what statics says of forces, moments, mean pressures and areas; their
estimated errors; what is refused."""
import csv
import math
import unittest

import space_quantity_scenes as scenes
from scene_parts import LARGE_CHANGES, body, box, quantity, timed
from scenes import TWO_BLOCKS
from support import InFolder


def moments(kind, body, label, about):
    """All forces and moments of a side."""
    return "".join(quantity(f"{kind}_{body}_{each}", kind, body, label, each, about if "_" in each else None)
                   for each in ("x", "y", "z", "moment_x", "moment_y", "moment_z"))


class SpaceQuantities(InFolder):
    def run_scene(self, text, degree=1):
        self.found = self.run_it(f"dimension = 3\ndegree = {degree}\n{text}{LARGE_CHANGES}")["quantities"]
        return {name: each["value"] for name, each in self.found.items()}

    def ratio(self, make, name, degree, finer=2):
        """The estimated over the true error."""
        estimated = self.found_of(make(1), degree)[name]
        exact = self.found_of(make(finer), 2)[name]["value"]
        return estimated["estimated_error"] / abs(estimated["value"] - exact)

    def found_of(self, text, degree):
        self.run_scene(text, degree)
        return self.found

    def test_forces_and_moments_are_those_of_statics(self):
        """A traction (0.1, -0.2, -1 - y) on the top of a cube on another one, which holds the foot."""
        about = [0.3, -0.2, 0.7]
        text = (body("upper", box([0, 0, 0], [1, 1, 1], [2, 3, 2]), scenes.STEEL, *scenes.CORNER,
                     'label = 3, tx = 0.001, ty = -0.002, tz = "-0.01*(1 + y)"')
                + body("lower", box([-1, -1, -1], [2, 2, 0], [4, 4, 2]), scenes.STEEL, scenes.held(1))
                + scenes.touching("upper", 1, "lower", 3) + moments("contact_force", "upper", 1, about)
                + moments("contact_force", "lower", 3, about) + moments("reaction", "lower", 1, about)
                + quantity("below", "mean_pressure", "lower", 3)
                + "".join(moments("reaction", "upper", label, about).replace("reaction_", f"side{label}_")
                          for label in (4, 5)) + timed())
        for degree in (1, 2):
            with self.subTest(degree=degree):
                values = self.run_scene(text, degree)
                components = ("x", "y", "z", "moment_x", "moment_y", "moment_z")
                load = dict(zip(components, (0.001, -0.002, -0.015)))
                # r x f, and what the part -0.01 y of the traction has about the middle.
                x, y, z = (0.5 - about[0], 0.5 - about[1], 1 - about[2])
                load["moment_x"] = y*load["z"] - z*load["y"] - 0.01/12
                load["moment_y"] = z*load["x"] - x*load["z"]
                load["moment_z"] = x*load["y"] - y*load["x"]
                for c in components:
                    contact = values[f"contact_force_upper_{c}"]
                    self.assertAlmostEqual(contact, -values[f"contact_force_lower_{c}"], delta=1e-12)
                    self.assertAlmostEqual(contact, values[f"reaction_lower_{c}"], delta=1e-12)
                    self.assertAlmostEqual(contact + values[f"side4_upper_{c}"] + values[f"side5_upper_{c}"],
                                           -load[c], delta=1e-12)
                self.assertAlmostEqual(values["mean"], 0.015, delta=1e-12)
                self.assertAlmostEqual(values["below"], 0.015/9, delta=1e-13)
                self.assertEqual(self.found["contact_force_upper_moment_x"]["unit"], "N m")
                self.assertEqual(self.found["contact_force_upper_x"]["unit"], "N")
                self.assertEqual(self.found["area"]["unit"], "m^2")
                self.assertEqual(self.found["mean"]["unit"], "Pa")
                self.assertIn("area[m^2]", next(csv.reader(self.read("out/history.csv").splitlines())))

    def test_of_a_patch_all_errors_are_zero(self):
        for make in (scenes.patch, scenes.patch_coarse):
            for degree in (1, 2):
                with self.subTest(scene=make.__name__, degree=degree):
                    values = self.run_scene(make(1), degree)
                    self.assertAlmostEqual(values["area"], 1, delta=1e-12)
                    for name, each in self.found.items():
                        self.assertLess(each["estimated_error"], 1e-10*abs(each["value"]), name)

    def test_what_equilibrium_alone_decides_has_no_error(self):
        for make, names in ((scenes.leaning, ("mean", "contact", "floor", "area")),
                            (scenes.cantilever, ("held", "held_moment")), (scenes.tube, ("held",))):
            found = self.found_of(make(1), 1)
            for name in names:
                self.assertLess(found[name]["estimated_error"], 1e-10*abs(found[name]["value"]), name)

    def test_estimates_are_about_the_true_errors(self):
        """Of sides that are flat, and of chords of curves, which quadratic tetrahedra have as well."""
        for make, degree, name in (
                (scenes.cantilever, 1, "tip"), (scenes.cantilever, 2, "tip"), (scenes.twisted, 2, "torque"),
                (scenes.leaning, 1, "contact_moment"), (scenes.tube, 2, "bore"), (scenes.tube, 2, "axial"),
                (scenes.tube, 1, "energy_tube"), (scenes.punch, 1, "mean"), (scenes.punch, 1, "press")):
            with self.subTest(scene=make.__name__, degree=degree, quantity=name):
                ratio = self.ratio(make, name, degree)
                self.assertGreater(ratio, 0.8)  # twice the estimated error
                self.assertLess(ratio, 6)

    def test_loads_on_sides_that_end_at_curves_are_in_it(self):
        """A quarter of half a ball is pushed by a traction on its plane side, the area of which is pi/4."""
        for degree in (1, 2):
            found = self.found_of(scenes.pushed_ball(1).replace("-0.02*t", "-0.1*t"), degree)["contact"]
            true = abs(found["value"] - 0.1*math.pi/4)
            self.assertGreater(true, 1e-3*abs(found["value"]))
            self.assertTrue(0.8 < found["estimated_error"]/true < 6, found["estimated_error"]/true)

    def test_edges_and_ends_of_contact_are_reasons(self):
        mises = self.found_of(scenes.cantilever(1), 1)["mises_beam"]
        self.assertIsNone(mises["estimated_error"])
        self.assertIn("unbounded there, at a corner or an end of a support", mises["no_estimate"])
        for name in ("pressure", "mises_punch"):
            self.assertIn("contact ends at a corner", self.found_of(scenes.punch(1), 1)[name]["no_estimate"])

    def test_the_area_is_off_by_half_of_the_rows_at_its_border(self):
        found = self.found_of(scenes.given_gap(1), 1)
        exact = self.found_of(scenes.given_gap(2), 2)["area"]["value"]
        self.assertLess(abs(found["area"]["value"] - exact), 1.2*found["area"]["estimated_error"])
        self.assertLess(found["area"]["estimated_error"], 0.5*found["area"]["value"])

    def test_what_is_not_of_space_is_refused(self):
        self.write(f"dimension = 3\n{scenes.patch(1)}")
        for of, message in (
                ("contact_length={body='upper', label=1}", "expected contact_area with dimension = 3"),
                ("mean_pressure={body='upper', label=1, from=[0, 0]}", "from = an array, expected none with "
                 "dimension = 3"),
                ("mean_pressure={body='upper', label=3}", "label 3 of body upper is no side of a contact"),
                ("reaction={body='lower', label=1}, component='moment'", "expected one of x, y, z, moment_x, "
                 "moment_y, moment_z"),
                ("reaction={body='lower', label=1}, component='moment_x', about=[0, 0]",
                 "expected three numbers"),
                ("reaction={body='lower', label=1}, component='x', about=[0, 0, 0]",
                 'expected it only beside component = "moment_x", "moment_y" or "moment_z"'),
                ("displacement={body='lower', label=1}, component='moment_x'", "expected one of x, y, z")):
            with self.subTest(of):
                self.assertIn(message, self.mortier("run", "scene.toml", "--set",
                                                    f"quantity=[{{name='q', {of}}}]", code=2).stderr)

    def test_what_is_of_space_is_refused_in_the_plane(self):
        self.mortier("mesh", "crisscross", "--cells", "2", "upper.mesh")
        self.mortier("mesh", "crisscross", "--cells", "2", "--lower", "0,-1", "--upper", "1,0", "lower.mesh")
        self.write(TWO_BLOCKS)
        for of, message in (
                ("contact_area={body='upper', label=1}", "expected contact_length without dimension = 3"),
                ("reaction={body='lower', label=1}, component='moment_x'", "expected one of x, y, moment"),
                ("reaction={body='lower', label=1}, component='z'", "expected one of x, y, moment")):
            with self.subTest(of):
                self.assertIn(message, self.mortier("run", "scene.toml", "--set",
                                                    f"quantity=[{{name='q', {of}}}]", code=2).stderr)


if __name__ == "__main__":
    unittest.main()
