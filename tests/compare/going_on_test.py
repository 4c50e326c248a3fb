#!/usr/bin/python3
"""Runs that go on from the state of another one: two runs equal one, supports are released, held, added."""
import json
import unittest

from scene_parts import body, box, contact, quantity, timed, tool
from support import ROOT, InFolder, mortier, value, values

BLOCKS = (body("upper", box([0, 1], [1, 2], [6, 5]), "young = 1000, poisson = 0.3 LAW", "label = 4, ux = 0",
               "label = 3, TOP")
          + body("lower", box([0, 0], [1.5, 1], [7, 4]), "young = 700, poisson = 0.2", "label = 1, uy = 0",
                 "label = 4, ux = 0"))
CONTACT = contact(("upper", 1), ("lower", 3), more="MORE\n")
PLATE = (tool("plate", shape="line", points=[[-1, 2.1], [2, 2.1]], at=[0.5, 2.1], fy="-2*t", moment=0)
         + contact(("upper", 3), ("plate", 1), sides=True))
SOLIDS = ("dimension = 3\n"
          + body("upper", box([0, 0, 1], [1, 1, 2], [3, 3, 2]),
                 "young = 1000, poisson = 0.3, viscosity = 100, yield_stress = 3",
                 'label = "top", tz = "-4*t", tx = "0.6*t"')
          + body("lower", box([-0.2, 0, 0], [1.3, 1, 1], [4, 3, 2]), "young = 700, poisson = 0.2",
                 'label = "bottom", ux = 0, uy = 0, uz = 0')
          + contact(("upper", "bottom"), ("lower", "top"), friction=0.3))
QUANTITIES = (quantity("base", "reaction", "lower", 1, "y") + quantity("top", "displacement", "upper", 3, "y")
              + quantity("work", "work", "upper") + quantity("heat", "dissipated_energy", "upper")
              + quantity("stored", "stored_energy", "upper"))
FLOWS = ", viscosity = 100, yield_stress = 3"


def blocks(law="", top='ty = "-4*t"', more="", contact=CONTACT):
    return BLOCKS.replace("LAW", law).replace("TOP", top) + contact.replace("MORE", more) + QUANTITIES


def until(end, steps, more=""):
    return timed(steps, end, more)


class Case(InFolder):
    def begin(self, text, folder="first"):
        """A run that leaves its state."""
        return self.run_it(text + "[output]\nstate = true\n", folder=folder)

    def go_on(self, text, start="first", folder="out"):
        return self.run_it(f'start = "{start}"\n' + text, folder=folder)

    def assertAgree(self, one, other, within=1e-10):
        self.assertEqual(one.keys(), other.keys())
        size = max(map(abs, one.values()))
        for name, each in one.items():
            self.assertAlmostEqual(each, other[name], delta=within * max(abs(each), 1e-3 * size), msg=name)

    def assertTwoRunsEqualOne(self, text, more="", within=1e-10):
        whole = self.run_it(text + until(2, 10, more), folder="whole")
        self.begin(text + until(1, 5, more))
        again = self.go_on(text + until(2, 5, more))
        numbers = [{**values(each), "pressure": each["final"]["max_pressure"],
                    "energy": each["final"]["elastic_energy"]}
                   for each in (whole, again)]
        self.assertAgree(*numbers, within)
        self.assertEqual(again["start"], {"result": "first", "time": 1})


class TwoRuns(Case):
    def test_of_any_law_and_coupling(self):
        for law in ("", FLOWS, ', law = "norton", reference_stress = 10, reference_rate = 0.01, exponent = 3',
                    ', law = "standard-solid", relaxation_time = 1, relaxed_fraction = 0.3',
                    ', law = "viscoplastic", yield_stress = 3, reference_stress = 1, reference_rate = 1, '
                    "exponent = 1, kinematic_hardening = 100"):
            with self.subTest(law=law):
                self.assertTwoRunsEqualOne(blocks(law))
        for more in ("friction = 0.2", "shear_limit = 0.5", 'variant = "interpolation"', 'kind = "tied"',
                     'sliding = "finite"', 'gap = "-0.01*t"'):
            with self.subTest(contact=more):
                self.assertTwoRunsEqualOne(blocks(FLOWS, more=more))

    def test_of_any_plane_degree_and_scheme(self):
        for head in ('plane = "strain"\n', 'plane = "axisymmetric"\n', "degree = 2\n", "dimension = 2\n"):
            for scheme in ("backward-euler", "sdirk2"):
                with self.subTest(head=head, scheme=scheme):
                    self.assertTwoRunsEqualOne(head + blocks(FLOWS), f'scheme = "{scheme}"\n')

    def test_of_tools_and_solids(self):
        self.assertTwoRunsEqualOne(blocks(top="tx = 0") + PLATE)
        self.assertTwoRunsEqualOne(SOLIDS)

    def test_of_a_disc_that_rolls(self):
        """Contact follows it by its own radius; it is locked where it is in the end."""
        text = (ROOT / "scenes" / "ironing.toml").read_text().split("[time]")[0]
        text = text.replace('uy = "-0.05*min(5*t, 1)"', 'fy = "-30*min(5*t, 1)"\nmoment = 0')
        text += quantity("angle", "displacement", "cylinder", component="rotation")
        whole = self.run_it(text + until(1, 25), folder="whole")
        rolled = self.begin(text + until(0.6, 15))
        self.assertAgree(values(whole), values(self.go_on(text + until(1, 10))), 1e-8)
        self.assertLess(value(rolled, "angle"), -0.4)
        locked = text.replace('fy = "-30*min(5*t, 1)"\nmoment = 0', 'uy = "held"\nrotation = "held"')
        locked = locked.replace('ux = "4.7*max(0, t - 0.2)/0.8"', 'ux = "held"')
        held = self.go_on(locked + until(1, 2))
        self.assertAlmostEqual(value(held, "press"), -30, delta=1e-8)
        self.assertAlmostEqual(value(held, "angle"), value(rolled, "angle"), delta=1e-14)

    def test_of_temperature(self):
        hot = blocks(FLOWS + ", expansion = 1e-3").replace(
            'boundary = [ { label = 4, ux = 0 }, { label = 3, ty', 'temperature = "10*t"\n'
            'boundary = [ { label = 4, ux = 0 }, { label = 3, ty')
        self.assertTwoRunsEqualOne(hot)

    def test_with_steps_chosen_by_their_error(self):
        text = blocks(FLOWS)
        plan = "[time]\nend = {}\ntolerance = 1e-4\nscheme = \"sdirk2\"\n"
        whole = self.run_it(text + plan.format(2), folder="whole")
        self.begin(text + plan.format(1))
        self.assertAgree(values(whole), values(self.go_on(text + plan.format(2))), 1e-3)

    def test_killed_and_resumed(self):
        text = blocks(FLOWS, more="friction = 0.2")
        self.begin(text + until(1, 5))
        self.write('start = "first"\n' + text + until(2, 300))
        self.resume([], 20, ["history.csv", "contact.csv", "upper_000300.vtu"])


class Continued(Case):
    """What a run of one scene cannot have: other supports, loads, contacts."""

    def test_a_released_support_springs_back(self):
        self.begin(blocks(top="uy = -0.1") + until(1, 1))
        free = self.go_on(blocks(top="ty = 0") + until(2, 1))
        self.assertLess(abs(value(free, "base")), 1e-10)
        self.assertLess(max(map(abs, free["final"]["displacement_max"])), 1e-12)
        self.assertLess(abs(value(free, "work")), 1e-12)

    def test_a_held_label_keeps_its_forces(self):
        for head, component in (("", "uy"), ('plane = "axisymmetric"\n', "un"), ("degree = 2\n", "un")):
            with self.subTest(head=head):
                pressed = self.begin(head + blocks() + until(1, 1))
                held = self.go_on(head + blocks(top=f'{component} = "held"') + until(2, 3))
                self.assertAgree(values(pressed), values(held), 1e-12)
                # Other supports push: what is held stays.
                pushed = self.go_on(head + blocks(top=f'{component} = "held"').replace(
                    "{ label = 1, uy = 0 }", '{ label = 1, uy = "0.02*(t-1)" }') + until(2, 3))
                self.assertAlmostEqual(value(pushed, "top"), value(pressed, "top"), delta=1e-14)
                self.assertGreater(value(pushed, "base"), 1.5 * value(pressed, "base"))

    def test_held_and_given_relax_alike(self):
        """A flat side that a number moves as a whole: held is that number."""
        self.begin(blocks(FLOWS, top='uy = "-0.02*t"') + until(1, 4))
        held = self.go_on(blocks(FLOWS, top='uy = "held"') + until(4, 8), folder="held")
        given = self.go_on(blocks(FLOWS, top="uy = -0.02") + until(4, 8))
        self.assertAgree(values(given), values(held))
        self.assertLess(value(held, "base"), 0.99 * value(self.summary_of("first"), "base"))

    def test_a_tool_driven_by_a_force_is_locked(self):
        pressed = self.begin(blocks(top="tx = 0") + PLATE + until(1, 1))
        locked = PLATE.replace('fy = "-2*t"\nmoment = 0', 'uy = "held"\nrotation = "held"')
        held = self.go_on(blocks(top="tx = 0") + locked + until(2, 1))
        self.assertAgree(values(pressed), values(held), 1e-9)

    def test_a_contact_that_begins_later(self):
        """It is open at the distance at which the bodies are then."""
        apart = BLOCKS.replace("LAW", FLOWS).replace("TOP", 'uy = "-0.03*t"').replace(
            "lower = [0, 1], upper = [1, 2]", "lower = [0, 1.02], upper = [1, 2]") + "CONTACT" + QUANTITIES
        with_contact = apart.replace("CONTACT", CONTACT.replace("MORE", ""))
        whole = self.run_it(with_contact + until(2, 4), folder="whole")
        self.begin(apart.replace("CONTACT", "") + until(0.5, 1))
        later = self.go_on(with_contact + until(2, 3))
        again = self.mortier("run", "scene.toml", "--out", "again").stdout
        self.assertRegex(again, r"(?m)^start +first at t = 0\.5 s; as drawn: lower$")
        self.assertGreater(value(whole, "base"), 5)
        self.assertAgree(values(whole), values(later))

    def test_a_body_that_is_taken_away(self):
        """What it pressed on springs back."""
        self.begin(blocks() + until(1, 1))
        alone = BLOCKS[BLOCKS.index('[[body]]\nname = "lower"'):] + quantity(
            "top", "displacement", "lower", 3, "y")
        self.assertLess(abs(value(self.go_on(alone + until(2, 1)), "top")), 1e-15)

    def test_three_stages_keep_the_energy(self):
        """Pressed by a force, held while it flows, released: work is stored or heat."""
        self.begin(blocks(FLOWS) + until(2, 20))
        self.run_it('start = "first"\n' + blocks(FLOWS, top='uy = "held"') + until(4, 20)
                    + "[output]\nstate = true\n", folder="second")
        last = self.go_on(blocks(FLOWS, top="ty = 0") + until(5, 1), "second")
        self.assertGreater(value(last, "heat"), 0.01)
        # Backward Euler dissipates more than the path does: by a share of the step.
        self.assertAlmostEqual(value(last, "work"), value(last, "stored") + value(last, "heat"),
                               delta=0.05 * value(last, "heat"))

    def test_data_count_from_the_start_on(self):
        """What has no value before is no fault, and steps are those of this run."""
        self.begin(blocks() + until(1, 1))
        late = blocks(top='ty = "-4 - sqrt(t - 1)*max(1, t - 1)"') + until(5, 4)
        self.go_on(late)
        checked = mortier("check", "scene.toml", cwd=self.folder)
        self.assertEqual(checked.returncode, 0, checked.stdout)
        self.assertIn("4 steps of 1 s", checked.stdout)
        self.assertNotIn("kink-between-steps", checked.stdout)

    def test_held_without_a_start_is_zero(self):
        zero = self.run_it(blocks(top="uy = 0").replace("{ label = 1, uy = 0 }", "{ label = 1, uy = 0.01 }")
                           + until(1, 1))
        held = self.run_it(blocks(top='uy = "held"').replace("{ label = 1, uy = 0 }",
                                                             "{ label = 1, uy = 0.01 }") + until(1, 1))
        self.assertEqual(values(zero), values(held))


class Stages(Case):
    """[[stage]]: runs that go on, of one scene."""

    TEXT = blocks(FLOWS) + until(1, 3)
    STAGES = """\
[[stage]]
name = "press"
[[stage]]
name = "hold"
end = 2
set = ["body.upper.boundary.3.ty=", "body.upper.boundary.3.uy=held"]
[[stage]]
name = "lift"
end = 2.5
steps = 2
set = ["body.upper.boundary.3.uy=", "body.upper.boundary.3.ty=-1"]
"""

    def test_equal_runs_by_hand(self):
        self.write(self.TEXT + self.STAGES)
        told = self.mortier("run", "scene.toml").stdout
        self.assertEqual([line.split()[1] for line in told.splitlines() if line.startswith("stage ")],
                         ["press", "hold", "lift"])
        first = self.begin(self.TEXT)
        self.assertEqual(values(self.summary_of("out/scene-press")), values(first))
        held = self.TEXT.replace('ty = "-4*t"', 'uy = "held"').replace("end = 1", "end = 2")
        second = self.run_it('start = "first"\n' + held + "[output]\nstate = true\n", folder="second")
        self.assertEqual(values(self.summary_of("out/scene-hold")), values(second))
        lifted = self.TEXT.replace('ty = "-4*t"', "ty = -1")
        lifted = lifted.replace("end = 1\nsteps = 3", "end = 2.5\nsteps = 2")
        third = self.run_it('start = "second"\n' + lifted, folder="third")
        self.assertEqual(values(self.summary_of("out/scene")), values(third))
        self.assertEqual(self.names("out"), ["scene", "scene-hold", "scene-press"])
        self.write(self.TEXT + self.STAGES)
        alone = self.mortier("run", "scene.toml", "--out", "alone", "--quiet", "--set", "stage=hold",
                             "start=out/scene-press")
        self.assertEqual((alone.stdout, values(self.summary_of("alone"))), ("", values(second)))

    def test_are_changed_from_the_command_line(self):
        self.write(self.TEXT + self.STAGES)
        self.mortier("run", "scene.toml", "--quiet", "--set", "stage.lift.end=2.25", "stage.lift.steps=1")
        self.assertEqual(self.rows_of("out/scene/history.csv")[-1]["time[s]"], "2.25")
        self.refuse(self.TEXT, "expected tables [[stage]]", "stage.end=2.25")

    def test_are_checked_together(self):
        self.write(self.TEXT + self.STAGES)
        told = self.mortier("check", "scene.toml").stdout
        self.assertEqual(told.count("0 errors"), 3)
        report = json.loads(self.mortier("check", "scene.toml", "--json").stdout)
        self.assertEqual({item["stage"] for item in report["plan"]}, {"press", "hold", "lift"})
        self.write(self.TEXT + self.STAGES.replace("ty=-1", "ty=sqrt(t - 2)"))  # from its beginning on
        self.mortier("check", "scene.toml")
        self.write(self.TEXT + self.STAGES.replace("ty=-1", "ty=sqrt(t - 2.2)"))
        found = mortier("check", "scene.toml", cwd=self.folder)
        self.assertEqual(found.returncode, 2)
        self.assertRegex(found.stdout, r"scene.toml:\d+: error: set body.upper.boundary.3.ty=sqrt\(t - 2.2\)")

    def test_a_stage_without_a_solution_ends_the_run(self):
        self.write(self.TEXT + self.STAGES.replace("3.ty=-1", "3.ty=1"))
        self.mortier("run", "scene.toml", "--quiet", code=3)
        self.assertEqual(self.names("out"), ["scene-hold", "scene-press", "scene.failed"])

    def test_what_is_no_stage(self):
        for change, message in (
                (('name = "hold"', 'name = "press"'), 'name = "press", expected a name of its own'),
                (('name = "hold"', 'name = "a b"'), "expected letters, digits, _ and -"),
                (('name = "hold"', ""), "name is missing"),
                (("end = 2\n", "end = 0.5\n"), "expected one after 1, the end of stage press"),
                (("end = 2\n", "begin = 2\n"), "unknown key begin"),
                (("body.upper.boundary.3.ty=-1", "body.upper.bounds=1"),
                 ": set body.upper.bounds=1: no bounds in body")):
            with self.subTest(message):
                self.write(self.TEXT + self.STAGES.replace(*change))
                found = mortier("run", "scene.toml", "--quiet", cwd=self.folder)
                self.assertEqual(found.returncode, 2)
                self.assertIn(message, found.stderr)
                self.assertFalse((self.folder / "out").exists())
        staged = self.TEXT + self.STAGES
        self.refuse(staged, "--set stage=lower: stage: expected --set stage=NAME, one of press",
                    "stage=lower")
        self.refuse(staged, "expected --set start=DIR, the result of stage press", "stage=hold")
        self.refuse(self.TEXT, "--set stage=press: the scene has no [[stage]]", "stage=press")


class Refused(Case):
    def setUp(self):
        super().setUp()
        self.text = blocks(FLOWS)
        self.begin(self.text + until(1, 1))

    def refuse_start(self, text, message):
        """In run and check."""
        self.refuse('start = "first"\n' + text, message)
        checked = mortier("check", "scene.toml", cwd=self.folder)
        self.assertEqual((checked.returncode, checked.stderr), (2, ""))
        self.assertIn(message, checked.stdout)

    def test_scenes_of_other_bodies(self):
        self.refuse_start(self.text.replace("cells = [6, 5]", "cells = [6, 6]") + until(2, 1),
                          'start = "first": body upper has another mesh')
        self.refuse_start("degree = 2\n" + self.text + until(2, 1), "body upper has another degree")
        self.refuse_start('plane = "strain"\n' + self.text + until(2, 1),
                          "other units or another plane")
        self.refuse_start('units = "mm, N, MPa"\n' + self.text + until(2, 1), "other units or another plane")

    def test_another_law_that_remembers(self):
        """Its back stress is known to it alone."""
        law = ', law = "viscoplastic", yield_stress = 3, reference_stress = 1, reference_rate = 1, '
        first = blocks(law + "exponent = 1, isotropic_hardening = 10")
        self.begin('plane = "strain"\n' + first + until(1, 1))
        other = blocks(', law = "standard-solid", relaxation_time = 1, relaxed_fraction = 0.3')
        self.refuse_start('plane = "strain"\n' + other + until(2, 1), "body upper has")

    def test_what_has_no_place(self):
        self.refuse_start(self.text + until(1, 1),
                          "expected a result that ends before time.end = 1, this one ends at t = 1")
        self.refuse_start(self.text + until(2, 1) + "[accuracy]\nenergy = 0.1\n", "none beside accuracy")
        self.refuse_start(self.text.replace('name = "lower"', 'name = "lower"\ninitial_stress = { s11 = 1 }')
                          + until(2, 1), "none beside initial_stress: body lower")
        self.refuse('start = "none"\n' + self.text + until(2, 1),
                    "expected a result with a state, of a run with output.state = true")

    def test_a_damaged_state(self):
        state = self.folder / "first" / "state"
        whole = state.read_bytes()
        for bytes_ in (b"", whole[:-1], whole[:100] + b"x" + whole[101:], b"mortier state 0\n" + whole[16:]):
            state.write_bytes(bytes_)
            self.refuse_start(self.text + until(2, 1), "expected a state that this program wrote")


if __name__ == "__main__":
    unittest.main()
