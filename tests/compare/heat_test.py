"""Thermal strain and distances in time, as a user meets them, against exact values."""
import unittest

from scene_parts import body, box, contact, quantity, shape, timed
from scenes import ELASTIC_KEYS, lower_heat
from support import InFolder, value

# A block in a corner, or between two walls.
BLOCK = ('plane = "PLANE"\n'
         + body("block", box([0, 0], [2, 1], [4, 2]), "young = 1e5, poisson = 0.3, expansion = 1e-5",
                "label = 1, uy = 0", "label = 4, ux = 0", temperature="100*t")
         + quantity("heat", "thermal_work", "block") + quantity("stored", "stored_energy", "block")
         + quantity("work", "work", "block")
         + quantity("grows", "displacement", "block", component="x", point=[2, 1])
         + quantity("wall", "reaction", "block", 4, "x") + timed(3))
BETWEEN_WALLS = BLOCK.replace("label = 4, ux = 0 }", "label = 4, ux = 0 }, { label = 2, ux = 0 }")

# A quarter of a ring in another, degree 2: inner radius 10, fit 20, outer radius 40.
FIT = ('plane = "PLANE"\ndegree = 2\n'
       + body("shaft", shape("annulus", inner=10, outer=20, span="quarter", cells=[12, 8]),
              "young = 2e5, poisson = 0.3, expansion = 1.2e-5", "label = 3, un = 0", "label = 4, un = 0",
              temperature="SHAFT")
       + body("hub", shape("annulus", inner=20, outer=40, span="quarter", cells=[10, 8]),
              "young = 1e5, poisson = 0.25, expansion = 2.3e-5", "label = 3, un = 0", "label = 4, un = 0",
              temperature="HUB") + contact(("shaft", 2), ("hub", 1), gap=-0.01)
       + quantity("pressure", "largest_pressure", "hub", 1) + quantity("heat", "thermal_work", "hub")
       + timed(2))

# Two blocks, one on the other, with a plate that is pushed in between.
SHIM = (body("upper", box([0, 1], [1, 2], [3, 3]), "young = 10, poisson = 0", "label = 3, ux = 0, uy = 0")
        + body("lower", box([0, 0], [1, 1], [4, 3]), "young = 10, poisson = 0", "label = 1, ux = 0, uy = 0")
        + contact(("upper", 1), ("lower", 3), gap={"time": [0, 1, 2], "value": [0.001, -0.01, 0.001]},
                  variant="mortar") + quantity("pressed", "contact_force", "lower", 3, "y")
        + quantity("above", "work", "upper") + quantity("below", "work", "lower")
        + quantity("stored", "stored_energy", "upper") + timed(22, 2))


class Heat(InFolder):
    def test_a_bar_between_walls(self):
        """s11 = -E alpha T, in plane strain -E alpha T/(1 - nu); heat is the only work."""
        for plane, part in (("stress", 1), ("strain", 1/0.7)):
            for scheme in ("backward-euler", "crank-nicolson", "sdirk2"):
                with self.subTest(plane=plane, scheme=scheme):
                    text = BETWEEN_WALLS.replace("PLANE", plane)
                    summary = self.run_it(text, f"time.scheme={scheme}")
                    self.assertAlmostEqual(value(summary, "wall"), 100*part, delta=1e-10)
                    stored = value(summary, "stored")
                    heat = value(summary, "heat")
                    self.assertAlmostEqual(stored, heat + value(summary, "work"), delta=1e-13)
                    if plane == "stress":
                        self.assertAlmostEqual(stored, 0.5*100*1e-3*2, delta=1e-13)
                    self.assertLess(abs(value(summary, "work")), 1e-13)

    def test_nodal_temperatures_are_linear_between(self):
        """A temperature that is linear in x and y strains as its expression does."""
        text = BETWEEN_WALLS.replace("PLANE", "strain")
        by_datum = self.run_it(text, 'body.temperature=t*(20 + 30*x + 40*y)')
        self.mortier("mesh", "rectangle", "--cells", "4,2", "--upper", "2,1", "block.mesh")
        lines = self.read("block.mesh").splitlines()
        first = lines.index("Vertices") + 2
        count = int(lines[first - 1])
        places = [list(map(float, line.split()[:2])) for line in lines[first:first + count]]
        self.write("".join(f"{20 + 30*x + 40*y}\n" for x, y in places), "heat.txt")
        table = 'temperature = { file = "heat.txt", factor = "t" }'
        of_file = text.replace('temperature = "100*t"', table)
        by_file = self.run_it(of_file)
        for name in ("heat", "stored", "wall", "grows"):
            one = value(by_datum, name)
            self.assertLessEqual(abs(value(by_file, name) - one), 1e-12*abs(one))
        self.write("1\n2\n", "heat.txt")
        self.refuse(of_file, f"has 2, expected {count} finite numbers, one for each vertex of the mesh")
        self.refuse(of_file, "expected a datum beside accuracy", "accuracy.energy=0.1")
        self.refuse(text, "temperature, expected none beside accuracy.bound", "accuracy.bound=true")
        self.refuse(text.replace(", expansion = 1e-5", ""), "expected expansion in a material of the body")

    @staticmethod
    def lame(plane, shaft, hub):
        """Pressure of the fit: the interference that is there plus what the temperatures add, over the
        compliances of both rings."""
        a2, b, b2, c2 = 100, 20, 400, 1600
        rings = []
        for e, nu, alpha, heat in ((2e5, 0.3, 1.2e-5, shaft), (1e5, 0.25, 2.3e-5, hub)):
            if plane == "strain":
                e, nu, alpha = e/(1 - nu**2), nu/(1 - nu), alpha*(1 + nu)
            rings.append((e, nu, alpha*heat))
        (e1, nu1, hot1), (e2, nu2, hot2) = rings
        over = 0.01 + b*(hot1 - hot2)
        return over/b/(((b2 + a2)/(b2 - a2) - nu1)/e1 + ((c2 + b2)/(c2 - b2) + nu2)/e2)

    def test_a_fit_heated_and_cooled(self):
        for plane in ("stress", "strain"):
            for shaft, hub in ((0, 0), (80, 0), (0, -40), (100, 20), (-30, 0)):
                with self.subTest(plane=plane, shaft=shaft, hub=hub):
                    text = FIT.replace("PLANE", plane)
                    text = text.replace("SHAFT", f"{shaft}*t").replace("HUB", f"{hub}*t")
                    if hub == 0:
                        text = text.replace(f'temperature = "{hub}*t"\n', "").replace(
                            'name = "heat"\nthermal_work = { body = "hub" }',
                            'name = "heat"\nstored_energy = { body = "hub" }')
                    if shaft == 0:
                        text = text.replace('temperature = "0*t"\n', "")
                    exact = self.lame(plane, shaft, hub)
                    self.assertGreater(exact, 0)
                    pressure = value(self.run_it(text), "pressure")
                    self.assertAlmostEqual(pressure/exact, 1, delta=2e-3)

    def test_a_fit_that_comes_loose_is_named(self):
        text = FIT.replace("PLANE", "stress").replace('"SHAFT"', "0").replace("HUB", "60*t")
        text = text.replace('temperature = 0\n', "")
        self.assertLess(self.lame("stress", 0, 60), 0)
        self.assertEqual(value(self.run_it(text), "pressure"), 0)
        # Whole rings: nothing but the fit and a point hold the shaft.
        held = "boundary = [ { label = 3, un = 0 }, { label = 4, un = 0 } ]"
        free = text.replace(held, "point = [ { at = [10, 0], uy = 0 } ]", 1)
        free = free.replace(held, "boundary = [ { label = 2, ux = 0, uy = 0 } ]")
        for before, after in (("quarter", "full"), ("degree = 2", "degree = 1"), ("[12, 8]", "[48, 8]"),
                              ("[10, 8]", "[40, 8]")):
            free = free.replace(before, after)
        # The hub is held outside: its hole grows where it cools.
        self.assertGreater(value(self.run_it(free), "pressure"), 0)
        self.write(free.replace("60*t", "-60*t"))
        errors = self.mortier("run", "scene.toml", "--quiet", "--out", "free", code=3).stderr
        self.assertIn("no closed contact holds body shaft: ", errors)


class Distance(InFolder):
    def test_a_plate_between_two_blocks(self):
        """Each block takes half of what the plate is thicker than the gap; the plate does the work."""
        for variant in ("mortar", "interpolation", "weighted"):
            for degree in (1, 2):
                with self.subTest(variant=variant, degree=degree):
                    # Interpolation is exact where the meshes match.
                    settings = [f"contact.variant={variant}", f"degree={degree}"] + (
                        ["body.lower.mesh.cells=[3, 3]"] if variant == "interpolation" else [])
                    summary = self.run_it(SHIM, *settings, "output.every=1")
                    rows = self.rows_of("out/history.csv")
                    for row in rows:
                        t = float(row["time[s]"])
                        gap = 0.001 - 0.011*t if t <= 1 else -0.01 + 0.011*(t - 1)
                        self.assertAlmostEqual(float(row["pressed[N/m]"]), -10*max(0, -gap)/2, delta=1e-13)
                    half = [row for row in rows if abs(float(row["time[s]"]) - 1) < 1e-9][0]
                    stored = 0.5*10*0.005**2
                    self.assertAlmostEqual(float(half["stored[J/m]"]), stored, delta=1e-15)
                    self.assertAlmostEqual(float(half["above[J/m]"]), stored, delta=1e-15)
                    self.assertAlmostEqual(float(half["below[J/m]"]), stored, delta=1e-15)
                    self.assertLess(abs(summary["final"]["gap_work"]), 1e-15)
                    at_one = self.run_it(SHIM, *settings, "time.end=1", "time.steps=11")
                    self.assertAlmostEqual(at_one["final"]["gap_work"], 2*stored, delta=1e-15)
                    contact = self.rows_of("out/contact.csv")
                    self.assertTrue(all(abs(float(row["gap"])) < 1e-14 for row in contact))

    def test_steps_chosen_by_their_error_end_at_its_kinks(self):
        self.run_it(SHIM, "time.tolerance=1e-3", "time.scheme=sdirk2")
        rows = self.rows_of("out/history.csv")
        self.assertTrue(any(float(row["time[s]"]) == 1 for row in rows))

    def test_a_bound_of_the_error_is_refused(self):
        self.refuse(SHIM, "expected a distance that does not change in time beside accuracy.bound",
                    "accuracy.bound=true")


class AllKeys(InFolder):
    def test_threads_change_nothing(self):
        self.write(lower_heat(18), "lower.heat")
        self.run_it(ELASTIC_KEYS, folder="one")
        self.mortier("run", "scene.toml", "--quiet", "--out", "two", "--threads", "2")
        self.assertEqual(self.read("one/contact.csv"), self.read("two/contact.csv"))


if __name__ == "__main__":
    unittest.main()
