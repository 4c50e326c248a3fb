"""Steps in space chosen by their error: those of the plane on bodies that are extruded, and the tolerance."""
import unittest

from scene_parts import body, box, contact, quantity, timed
from support import InFolder, values

# Two blocks in plane strain and the same blocks in space, held at both ends: the stress is uniform in each.
# y of the plane is z in space.
MATERIALS = {
    "perzyna": ('viscosity = 8, yield_stress = 1', 'viscosity = 5, yield_stress = 2'),
    "maxwell": ('law = "maxwell", relaxation_time = 0.5', 'law = "maxwell", relaxation_time = 0.2'),
    "norton": ('law = "norton", reference_stress = 5, reference_rate = 0.1, exponent = 3', ''),
}
PRESSURE = "8*min(t, 0.4) + (t > 0.7)"


def blocks(space, laws, steps=None, **time):
    ends = ["label = 5, uy = 0", "label = 6, uy = 0"] if space else []
    up = "z" if space else "y"

    def block(name, cells, low, law, held):
        corners = [[0, 0, low], [1, 1, low + 1]] if space else [[0, low], [1, low + 1]]
        material = "young = 100, poisson = 0.3" + (f", {law}" if law else "")
        return body(name, box(*corners, cells), material, *ends, "label = 4, ux = 0", held,
                    volume="pointwise")
    return (("dimension = 3\n" if space else 'plane = "strain"\n')
            + block("upper", 1, 0, laws[0], f'label = 3, pressure = "{PRESSURE}"')
            + block("lower", 2, -1, laws[1], f"label = 1, u{up} = 0")
            + contact(("upper", 1), ("lower", 3), variant="weighted") + timed(steps, **time))


def pressed(degree, law, steps=None, **time):
    """A block that tilts onto another one, and flows: contact closes and opens, the load has kinks."""
    return (f"dimension = 3\ndegree = {degree}\n"
            + body("upper", box([0, 0, 0], [1, 1, 1], 2), f"young = 100, poisson = 0.3, {law}",
                   'label = "top", tz = "-4*(1 + x*y)*(t < 0.3 ? t/0.3 : 1.3 - t)"', 'label = "left", ux = 0',
                   'label = "front", uy = 0')
            + body("lower", box([0, 0, -1], [1.5, 1.5, 0], 2), 100,
                   'label = "bottom", ux = 0, uy = 0, uz = 0')
            + contact(("upper", "bottom"), ("lower", "top"))
            + quantity("corner", "displacement", "upper", component="z", point=[1, 1, 1])
            + quantity("stored", "stored_energy", "upper") + timed(steps, **time))


class SpaceSteps(InFolder):
    def history(self, text, *settings):
        self.summary = self.run_it(text, *settings)
        return [{name: value if name == "rung" else float(value) for name, value in row.items()}
                for row in self.rows_of("out/history.csv")]

    def test_bodies_that_are_extruded_take_the_steps_of_the_plane(self):
        for name, laws in MATERIALS.items():
            for scheme in ("sdirk2", "backward-euler"):
                with self.subTest(name, scheme=scheme):
                    tolerance = 1e-3 if scheme == "sdirk2" else 1e-2
                    time = {"scheme": scheme, "tolerance": tolerance}
                    exact = "solver.tolerance=1e-14"  # what steps are chosen by is not the rounding of steps
                    plane = self.history(blocks(False, laws, **time), exact)
                    space = self.history(blocks(True, laws, **time), exact)
                    self.assertGreater(len(plane), 5)
                    self.assertEqual(len(space), len(plane))
                    for column in ("time[s]", "von_mises_max[Pa]", "displacement_max[m]", "max_pressure[Pa]"):
                        largest = max(abs(row[column]) for row in plane)
                        for mine, other in zip(space, plane):
                            self.assertAlmostEqual(mine[column] / largest, other[column] / largest,
                                                   delta=1e-9, msg=column)
                    # Per depth of 1.
                    self.assertAlmostEqual(space[-1]["contact_force[N]"], plane[-1]["contact_force[N/m]"],
                                           delta=1e-9)

    def test_steps_end_where_data_turn(self):
        text = blocks(True, MATERIALS["maxwell"], scheme="sdirk2", tolerance=1e-2)
        times = {row["time[s]"] for row in self.history(text)}
        self.assertTrue({0.4, 0.7} <= times, times)
        # What happens at one place of the boundary, or of the body, and along z.
        for load in ("8*min(t, 0.45)*(y > 0.9)", "t + (x < 0.1)*(t > 0.45)"):
            times = {row["time[s]"] for row in self.history(text, f"body.upper.boundary.3.pressure={load}")}
            self.assertIn(0.45, times, load)
        times = {row["time[s]"] for row in self.history(
            text, "body.upper.boundary.3.pressure=t", "body.upper.force={z='-min(t, 0.45)*(z > 0.8)'}",
            "body.lower.boundary.1.uz=-0.001*min(t, 0.15)")}
        self.assertTrue({0.15, 0.45} <= times, times)

    def test_what_varies_too_fast_is_refused_with_its_place(self):
        text = blocks(True, MATERIALS["maxwell"], scheme="sdirk2", tolerance=1e-2)
        self.write(text.replace(PRESSURE, "sin(1e7*t*(1 + z))"))
        said = self.mortier("run", "scene.toml", "--quiet", "--out", "out", code=2).stderr
        self.assertRegex(said, r"expected a datum that can be sampled in time: at \(.*, .*, 1\) it varies")

    def test_the_tolerance_is_kept(self):
        """Against equal fine steps. An energy is off by twice what the stress is, the displacement of a
        corner by somewhat more than the mean."""
        for degree, law in ((1, "viscosity = 1, yield_stress = 1.5"),
                            (2, 'law = "norton", reference_stress = 5, reference_rate = 0.1, exponent = 3')):
            fine = pressed(degree, law, 320, scheme="sdirk2")
            self.history(fine)
            exact = values(self.summary)
            for scheme, tolerance in (("sdirk2", 1e-2), ("sdirk2", 1e-3), ("backward-euler", 2e-2)):
                with self.subTest(law, scheme=scheme, tolerance=tolerance):
                    rows = self.history(pressed(degree, law, scheme=scheme, tolerance=tolerance))
                    self.assertLess(len(rows), 320)
                    self.assertIn(0.3, {row["time[s]"] for row in rows})
                    self.assertLessEqual(self.summary["accuracy"]["time"], tolerance)
                    for name, each in self.summary["quantities"].items():
                        within = 2 * tolerance
                        self.assertAlmostEqual(each["value"] / exact[name], 1, delta=within, msg=name)

    def test_rounds_choose_steps_where_bodies_flow(self):
        text = pressed(1, 'law = "maxwell", relaxation_time = 0.5', 3, scheme="sdirk2")
        self.history(text, "accuracy={energy=0.4, max_unknowns=20000}")
        self.assertGreater(self.summary["accuracy"]["time"], 0)
        self.assertLess(self.summary["accuracy"]["time"], 0.2 * 0.4 + 1e-12)

    def test_checks_name_data_that_pass_between_equal_steps(self):
        self.write(blocks(True, MATERIALS["maxwell"], steps=5).replace(
            PRESSURE, "exp(-((t - 0.5)/0.02)^2)*(y > 0.5)"))
        said = self.mortier("check", "scene.toml").stdout
        self.assertIn("load-between-steps", said)


if __name__ == "__main__":
    unittest.main()
