"""Numbers of README.md and docs/ are those that the commands named there print (tests/compare/stated.py).
Those of the gallery, of published tests and of the tutorial are tested with their runs."""
import re
import subprocess
import unittest
from pathlib import Path

import stated
from support import PROGRAM, ROOT, InSharedFolder, mortier
from cases import all_cases, scene_cases
from codes import run_mortier
from compare import compare
import results
import table

THEORY_TESTS = Path(PROGRAM).parent / "tests" / "theory_tests"


def page(name):
    return (ROOT / name).read_text()


class Statements(unittest.TestCase):
    """How a number is read and compared."""

    def test_a_number_has_the_digits_that_are_written(self):
        for number, value in (("0.76899", 0.768994), ("-884.1349", -884.13492), ("4,882", 4882.4),
                              ("7e-5", 7.15e-5), ("1.007", 1.00683), ("10", 9.6)):
            self.assertTrue(stated.agrees(number, value), number)
        for number, value in (("0.76899", 0.768996), ("4,882", 4882.6), ("7e-5", 7.6e-5), ("10", -10)):
            self.assertFalse(stated.agrees(number, value), number)

    def test_a_statement_is_found_across_lines_and_only_once(self):
        text = "the force\n**1.5**, found 1.25. | row with words | 3 |"
        self.assertEqual(stated.written("force **{}**, found {_}.", text), ("1.5",))
        self.assertEqual(stated.written("| row ... | {} |", text), ("3",))
        for missing in ("force {}", "found {} .", "o"):
            with self.assertRaises(AssertionError):
                stated.written(missing, text)

    def test_every_altered_digit_is_another_number(self):
        self.assertEqual(sorted(stated.altered("0.5")), ["0.4", "0.6", "1.5", "9.5"])
        with self.assertRaises(AssertionError):
            stated.check(unittest.TestCase(), "off by 1.26", "off by {}", 1.25)


class Theory(unittest.TestCase):
    """What build/tests/theory_tests print."""

    TESTS = ("Cook.otherDiagonals*:AveragedVolume.cooks*:AveragedVolume.hills*:AveragedVolume.prandtls*:"
             "AveragedVolume.estimate*:ErrorEstimate.estimates*:EnergyBound.isAboveAndNear*:"
             "EnergyBound.sees*:QuantityBound.forceOfATiltedBlock:SlipControl.seesWhat*:"
             "AveragedVolumeInSpace.cooks*:AveragedVolumeInSpace.errors*:Goal.*:Norton.thick*")

    @classmethod
    def setUpClass(cls):
        done = subprocess.run([THEORY_TESTS, f"--gtest_filter={cls.TESTS}"], capture_output=True, text=True)
        assert done.returncode == 0, done.stdout[-2000:]
        cls.output = done.stdout

    def states(self, name, statement, *values):
        stated.check(self, page(f"docs/{name}.md"), statement, *values)

    def read(self, statement):
        found = stated.read(statement, self.output)
        self.assertTrue(found, f"not printed: {statement}")
        return found

    def test_cooks_membrane(self):
        five = "{} {} {} {} {}"
        self.states("gallery", "which is softer, {}, {}, {}, {}, {}; along both {}, {}, {}, {}, {}.",
                    *self.read(f"falling diagonal, 8 to 128 cells: {five}"),
                    *self.read(f"both diagonals, 8 to 128 cells: {five}"))

    def test_averaged_volume(self):
        found = self.read("Cook, nu 0.4999, 16 cells: {} (degree 1), {} (degree 2)")
        self.states("measurements", "deflection (limit 18.515) | {} to {} by the diagonals | {} to {} |",
                    min(found[::2]), max(found[::2]), min(found[1::2]), max(found[1::2]))
        tube = ("{}, degree {}, 32 x 16 cells: mean stress off by {{}} k (without {{}}), "
                "inner displacement by {{}} ({{}})")
        rows = {"tube in plane strain": "mean stress at a point, plane strain | {} k |",
                "tube about the axis": "the same about the axis | {} k (both diagonals 0.021 k) |"}
        for where, row in rows.items():
            one, two = (self.read(tube.format(where, degree)) for degree in (1, 2))
            self.states("measurements", row + " {} k | {} k; {} k |", one[0], two[0], one[1], two[1])
            if where == "tube in plane strain":
                self.states("measurements", "of degree 2 is off by {} (without it {})", two[2], two[3])
        self.states("measurements", "shaken mesh: over the limit load | {} | {} | {}; 1.030 |",
                    *self.read("over the limit load: {} (degree 1), {} (degree 2), {} (pointwise, degree 1)"))
        (one, ratio), (two, other) = (
            self.read(f"degree {degree}, nu 0.4999: error {{}}, estimate over error {{}}")
            for degree in (1, 2))
        self.states("measurements", "without it 5.3e-2, 5.2e-4) | {} | {} |", one, two)
        self.states("measurements", "| estimate over error there | {} | {} |", ratio, other)

    def test_estimate(self):
        found = self.read("mortar, contrast 1, estimated over true error:" + 4 * " {} ({_})")
        self.states("measurements", "any contrast of the bodies | {} with 8 cells, {} with 64 |", found[0],
                    found[-1])

    def test_bounds(self):
        for variant, row in (("mortar", "contact with a known end, mortar, 8 to 32 cells"),
                             ("interpolation", "the same, interpolation")):
            ends = [self.read(f"{variant}, contrast {contrast}, {cells} cells: {{}}")[0]
                    for contrast in ("1", "100", "0.01") for cells in (8, 32)]
            self.states("measurements", f"| {row} | {{}} to {{}} | {{}} to {{}} | {{}} to {{}} |", *ends)
        self.states("measurements", "12 to 10 and 4 to 48 cells | {}, {}, {} |",
                    *self.read("bound over error: {}"))

    def test_bounds_of_quantities(self):
        def blocks(variant, cells):
            """Of two forces, a displacement and mean pressures without and with a margin, value and error."""
            found = self.read(f"{variant}, {cells} cells: {{}}, in {{_}} .. {{_}}, error at most {{}} %")
            return found[::2], found[1::2]
        values, coarse = blocks("mortar", 8)
        _, fine = blocks("mortar", 24)
        _, interpolated = blocks("interpolation", 8)
        self.states("measurements", "the contact force {} with its guaranteed", blocks("mortar", 24)[0][0])
        self.states("measurements", "| mortar | {} % | {} % | | interpolation | {} % | |", coarse[0], fine[0],
                    interpolated[0])
        self.states("measurements", "known to {} % with 8 cells and to {} % with 24; with a margin of 0.1 to "
                    "{} % and {} %", coarse[3], fine[3], coarse[4], fine[4])

    def test_refinement_for_a_quantity(self):
        def rounds(name):
            """Unknowns, true and guaranteed error of the rounds after the first one."""
            return self.read(f"{name}: {{}} unknowns, force {{_}}, off {{}} %, guaranteed {{}} %")[3:]
        aimed, energy, equal = (rounds(name) for name in ("quantity", "energy", "equal"))
        two, last = "{}: {} % ({} %) | {}: {} % ({} %) |", "{} ({} %) |"  # which is taken as exact
        self.states("measurements", f"| aimed at the force | {two} {last}", *aimed[:7], aimed[8])
        self.states("measurements", f"| in the energy norm | {two} {last}", *energy[:7], energy[8])
        self.states("measurements", f"| equal cells | {two}", *equal)
        needed, _, of_equal = self.read("for the last one {}, {}, {} unknowns")
        self.states("measurements", "and {} of those of equal cells", needed / of_equal)

    def test_creep(self):
        solves = [self.read(f"n = {n}: largest error {{_}} of the largest stress, {{}} linear solves")[0]
                  for n in (1, 10)]
        self.states("measurements", "linear solves in all | {} (n = 1) to {} (n = 10) |", *solves)

    def test_slip(self):
        steps, error, estimate = self.read("lifted, tolerance 0.1{_}: {} steps, ... off by {}, estimate {}")
        self.states("measurements", "| pressed, sheared, lifted off | 0.1 | {} | rounding | {} |", steps,
                    error)
        self.assertLess(float(estimate), 1e-12)

    def test_averaged_volume_in_space(self):
        coarse, fine, locked = self.read("Cook, nu 0.4999, 8 and 16 cells: {}, {}, pointwise {}")
        self.states("measurements", "deflection (limit 18.515) | {}, {}, 18.18 | {} with 16 |", coarse, fine,
                    locked)
        compressible, locked, pressure = self.read(
            "nu 0.3, pointwise: error {}; nu 0.4999: {}, of the pressure {}")
        of = self.read("nu 0.4999, averaged, 4 and 8 cells: error {}, {}, of the pressure {}, {}, "
                       "largest {_}, {_}, estimate over error {}, {}")
        self.states("measurements", "(at $\\nu$ 0.3 without it {} with 8) | {}, {}, 0.066 | {} with 8 |",
                    compressible, *of[:2], locked)
        self.states("measurements", "error of the mean stress in $L_2$ | {}, {}, 0.019 | {} with 8 |",
                    *of[2:4], pressure)
        self.states("measurements", "the same: estimate over error | {}, {}, 1.03 |", *of[4:])


class Runs(InSharedFolder):
    """What runs of the program print and write."""

    def run_words(self, *words):
        done = mortier("run", *words, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def same(self, text, output, *statements):
        """A page and the output say the same."""
        for statement in statements:
            stated.check(self, text, statement, *stated.read(statement, output))

    def test_compression(self):
        log = self.run_words(ROOT / "scenes" / "compression.toml", "--out", "mortar")
        self.same(page("README.md"), log, "bodies upper {} dofs, Perzyna (elasticity), lower {} dofs",
                  "mortar, {} nonmortar (upper) x {} mortar (lower) nodes, overlap {}",
                  "{} {} 1 7 (+0/-0) {_} {_} 10 100% 10", "newton {} factorisations {}")
        exact = {"mortar": {"interpenetration", "error_backward_euler"}, "interpolation": {}}
        names = ("von_mises_min", "von_mises_max", "interpenetration", "top", "error_exact",
                 "error_backward_euler", "newton_iterations")
        for variant, rounding in exact.items():
            run = run_mortier(self.folder / variant, [f"contact.variant={variant}"],
                              "scenes/compression.toml")
            row = table.row_of(variant, run, run, compare(run, run))
            cells = " | ".join("{_}" if name in rounding else "{}" for name in names)
            values = [abs(row[name]) if "error" in name else row[name] for name in names
                      if name not in rounding]
            stated.check(self, page("docs/measurements.md"), f"| {variant} | mortier | {cells} |", *values)
        stated.check(self, page("README.md"), "it is up to {} times too large", row["von_mises_max"] / 10)

    def test_scene_of_the_readme(self):
        scene = re.search(r"^```toml\n(.*?)^```", page("README.md"), re.M | re.S)[1]
        self.assertEqual(sum(bool(line) for line in scene.splitlines()), 18)
        (self.folder / "roller.toml").write_text(scene)
        log = self.run_words("roller.toml", "--accuracy", "0.02")
        force = stated.read("force {} N/mm (changed", log)
        rounds = stated.read("{} {} {} 1 {} % 0 % {_}", log)
        stated.check(self, page("README.md"), "error of {} % with {} unknowns; the force is {} N per mm.",
                     rounds[-1], rounds[-2], *force)

    def test_rounds(self):
        log = self.run_words(ROOT / "scenes" / "edge.toml", "--accuracy", "0.05", "--out", "edge")
        row = "{} {} {} 1 {} % 0 % {_}"
        rounds = stated.read(row, log)
        for of_row in zip(*[iter(rounds)] * 4):
            stated.check(self, page("docs/scene.md"), f"{of_row[0]:.0f}{row[2:]}", *of_row[1:])
        self.assertEqual(rounds, stated.read(row, page("docs/scene.md")))

    def test_flow_in_plane_stress(self):
        """A bar under a stress, for a time in which it hardly flows: rate over that of the overstress, and
        lateral over axial flow."""
        young, viscosity, time = 1e6, 10, 1e-9
        bar = """
[[body]]
name = "bar"
mesh = {{ shape = "rectangle", cells = 1 }}
material = {{ young = {young}, poisson = 0.3, yield_stress = 1, viscosity = {viscosity}, {law} }}
boundary = [{{ label = 1, uy = 0 }}, {{ label = 4, ux = 0 }}, {{ label = 3, ty = {stress!r} }}]
[time]
end = {time}
steps = 1
"""
        laws = [f'projection = "{norm}"' for norm in ("frobenius", "elasticity", "compliance")]
        for shown, stress in (("1 (limit)", 1 + 1e-6), ("1.2", 1.2), ("2", 2.0), ("5", 5.0)):
            values = []
            for law in (*laws, 'law = "viscoplastic"'):
                (self.folder / "bar.toml").write_text(bar.format(**locals()))
                self.run_words("bar.toml", "--out", "bar")
                body = results.read_vtu(self.folder / "bar" / "bar_000001.vtu")
                strain = body.cells["viscoplastic_strain"]
                axial = strain[:, 1].mean() / time
                values += [axial / ((stress - 1) / (2 * viscosity)), strain[:, 0].mean() / time / axial]
            stated.check(self, page("docs/scene.md"),
                         f"| {shown} | {{}}, {{}} | {{}}, {{}} | {{}}, {{}} | {{}}, {{}} |", *values)


class Counts(unittest.TestCase):
    def test_faults_of_scenes(self):
        kinds = len(mortier("check", "--list").stdout.splitlines())
        stated.check(self, page("README.md"), "detects {} kinds of faults", kinds)

    def test_pairs_of_runs(self):
        scenes = scene_cases()
        text = page("docs/measurements.md")
        stated.check(self, text, "| {} pairs of runs: three mesh pairs", len(all_cases()))
        stated.check(self, text, "| {} pairs of runs of {} scenes:", len(scenes),
                     len({case.name for case in scenes}))

    def test_injected_faults(self):
        import faults_test
        import oracle_test
        of_results = [name for name in dir(faults_test.Faults) if name.startswith("test_")]
        stated.check(self, page("docs/measurements.md"),
                     "all of {} in results and data, all of {} in the FreeFEM method",
                     len(set(of_results) - {"test_without_a_fault_the_codes_agree"}),
                     len(oracle_test.FAULTS))

    def test_hard_problems(self):
        import published
        rows = published.hard_rows.ROWS
        text = page("docs/benchmarks.md")
        stated.check(self, text, "{} rows are tests", sum(bool(row.test) for row in rows))
        stated.check(self, text, "of the {} rows are named and none is OFF", len(rows))
        by_case = {}
        for row in rows:
            by_case[row.case.split(",")[0]] = by_case.get(row.case.split(",")[0], 0) + 1
        for start, cases in HARD.items():
            stated.check(self, text, f"| {start} ... | {{}} |", sum(by_case.pop(case) for case in cases))
        self.assertEqual(by_case, {})


# Of the table of docs/benchmarks.md: how a row begins, its cases.
HARD = {
    "disc on block, cells": ["Disc on block"],
    "rigid cone on a half space": ["Cone"],
    "inf-sup constant": ["Inf-sup constant of nodal pressures"],
    "Prandtl's punch, 8 cells": ["Prandtl's punch"],
    "circular punch, 8 cells": ["Circular punch"],
    "ring that flows": ["A ring that flows by 100 elastic strains"],
    "overlap of the lines": ["Dropped edges"],
    "block that bounces": ["Block on plank with friction"],
    "elastoplastic punch": ["Elastoplastic punch"],
    "shrink fits, cells": ["Shrink fit"],
    "flat punch: nodal": ["Flat punch"],
    "NAFEMS R0094": ["NAFEMS R0094"],
    "sphere on a block (Hertz)": ["Sphere on a block", "Receding contact"],
    "two spheres (SSNV104)": ["Two spheres", "Kratos' hemispheres"],
    "the same in space, the spheres": ["Two spheres in space", "Kratos' hemispheres in space"],
    "spherical shells in space": ["Spherical shells in space"],
    "manufactured solution": ["Manufactured curved contact"],
    "patch on unlike cells": ["Patch on unlike elements"],
    "Cook's membrane,": ["Cook's membrane"],
    "Hill's tube:": ["Hill's tube"],
    "contact that opens while": ["Iterations and the mesh"],
    "shallow ironing": ["Shallow ironing"],
    "rough punch (Spence)": ["Rough punch", "Half planes pushed along"],
    "steps that stall": ["Steps that stall elsewhere"],
}


if __name__ == "__main__":
    unittest.main()
