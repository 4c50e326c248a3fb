"""All commands on scenes of users: some of those of user_walk.py, and what a walk found."""
import csv
import json
import os
import unittest

from scene_parts import body, box, contact, quantity, shape, timed
from support import PROGRAM, OfTwoBlocks
from tutorial import files as tutorial_files
from user_scenes import UserScene, UserSpaceScene
from user_walk import walk

# STEP with a bound and rounds; bodies of files with rounds and a bound that is refused; an aim at a quantity
SEEDS = (1, 11, 17)
IN_SPACE = (38,)  # a stack of two laws, loads at t = 0
RING = ('plane = "axisymmetric"\ndegree = 2\n'
        + body("base", box([0, 0], [1, 1], [5, 3]), 'young = "45 GPa", poisson = 0.3',
               "label = 1, ux = 0, uy = 0")
        + body("middle", box([0, 1], [0.73, 1.5], [4, 3]), 15437, 'label = 3, ux = 0, uy = "-0.004*t"')
        + contact(("middle", 1), ("base", 3), sides=True, variant="interpolation", shear_limit=25) + timed(2))
PUNCH = ('plane = "strain"\n'
         + body("punch", box([-1, 0], [1, 2], 4), 100, 'label = 3, ux = 0, uy = "-0.01*t"')
         + body("ground", box([-4, -4], [4, 0], [8, 4]), 1, "label = 1, ux = 0, uy = 0")
         + contact(("punch", 1), ("ground", 3), sides=True, sliding="allow")
         + quantity("highest", "largest_pressure", "punch", 1)
         + quantity("force", "reaction", "punch", 3, "y") + timed())
STUDY = """\
scene = "scene.toml"
[[error]]
quantity = "energy"
[reference]
steps = 4
[[sweep]]
steps = [1, 2]
"""


class Walks(unittest.TestCase):
    def test_every_command_is_done_or_refused_as_check_said(self):
        for seed, kind in [*((seed, UserScene) for seed in SEEDS),
                           *((seed, UserSpaceScene) for seed in IN_SPACE)]:
            with self.subTest(seed=seed, kind=kind.__name__):
                each = walk(PROGRAM, seed, kind)
                self.assertEqual(each.findings, [])
                done = {"check", "run", "python", "study", "plot", "report", "compare"}
                done -= {"compare"} if each.scene.plane == "space" else set()
                self.assertEqual({each.ways[way] for way in done}, {"done"})


class Found(OfTwoBlocks):
    def left_out(self, *words):
        plan = json.loads(self.mortier("check", "scene.toml", "--json", *words).stdout)["plan"]
        return {item["part"]: item["why"] for item in plan if not item["modelled"]}

    def test_tresca_around_an_axis_with_quadratic_interpolation_in_both_codes(self):
        self.write('units = "mm, N, MPa"\n' + RING)
        self.mortier("compare", "scene.toml")

    def test_a_comparison_takes_the_meshes_of_the_scene_and_the_steps_of_the_run(self):
        self.write(self.read("scene.toml") + "[accuracy]\nenergy = 0.1\n")
        self.mortier("compare", "scene.toml")
        self.mortier("compare", "scene.toml", "--set", "time.tolerance=0.05", "accuracy=")

    def test_kept_results_say_what_accuracy_they_have(self):
        plain = self.mortier("compare", "scene.toml", "--accept", "kept").stdout
        self.assertIn("on the meshes of the scene, no accuracy asked for", plain)
        asked = ("--accuracy", "0.2")
        fine = self.mortier("compare", "scene.toml", "--accept", "fine", *asked).stdout
        self.assertIn(", accuracy 0.2\n", fine)
        self.mortier("compare", "scene.toml", "--against", "fine", *asked)

    def test_a_study_takes_shapes_units_and_geometries(self):
        for name, text in tutorial_files().items():
            self.write(text, name)
        press = self.read("press.toml").replace("size = 2", "size = 5")
        for text in ('units = "mm, N, MPa"\n' + RING, press):
            self.write(text)
            self.write(STUDY, "study.toml")
            self.mortier("study", "study.toml", "--quiet", "--jobs", "1", "--out", "studied")
            with (self.folder / "studied" / "study.csv").open() as file:
                rows = list(csv.DictReader(file))
            self.assertEqual([row["status"] for row in rows], ["done", "done"])
            self.assertLess(float(rows[1]["error energy"]), 1e-2)

    def test_check_says_what_others_refuse_in_their_words(self):
        self.assertNotIn("freefem", self.left_out())
        for setting, why in (("time.scheme=sdirk2", "scheme = sdirk2, expected backward-euler"),
                             ("time.tolerance=0.1", "expected equal steps, or those of a run (--steps-of)")):
            self.assertIn(why, self.left_out("--set", setting)["freefem"])
            refused = self.mortier("freefem", "scene.toml", "--set", setting, code=2).stderr
            self.assertIn(self.left_out("--set", setting)["freefem"], refused)
        bound = ("--set", "accuracy.bound=true", "degree=2", "body.upper.material={young=3e11, poisson=0.3}")
        self.assertEqual(self.left_out(*bound)["accuracy"], "displacements are quadratic")
        self.mortier("run", "scene.toml", "--quiet", "--out", "out", *bound)
        told = self.summary_of()["accuracy"]["bound"]
        self.assertEqual(told["reason"], "displacements are quadratic")
        self.assertNotIn("accuracy", self.left_out(*bound, "degree=1"))

    def test_values_without_a_limit_are_named_and_others_say_how_they_change(self):
        self.write(PUNCH)
        told = self.mortier("run", "scene.toml", "--out", "out", "--accuracy", "0.03").stdout
        self.assertRegex(told, r"highest .* \(no limit: stresses are unbounded there, about like r\^-0\.5\), "
                               r"force \S+ N/m \(changed by 0\.\d+ % in the last round\)")
        summary = self.summary_of()
        highest, force = (summary["quantities"][name] for name in ("highest", "force"))
        self.assertAlmostEqual(highest["unbounded_order"], 0.5, delta=0.05)
        self.assertNotIn("unbounded_order", force)
        self.assertLess(force["change_in_last_round"], 0.01 * abs(force["value"]))

    def test_on_one_mesh_errors_of_quantities_are_estimated(self):
        self.write(PUNCH)
        self.assertNotIn("accuracy", self.left_out())
        told = self.mortier("run", "scene.toml", "--out", "out").stdout
        self.assertRegex(told, r"force \S+ N/m \+- \S+")
        self.assertIn("\n           +-: estimated error because of the meshes", told)
        quantities = self.summary_of()["quantities"]
        self.assertEqual([each["change_in_last_round"] for each in quantities.values()], [None, None])
        self.assertGreater(quantities["force"]["estimated_error"], 0)
        self.assertIsNone(quantities["highest"]["estimated_error"])
        self.assertIn("contact ends at a corner", quantities["highest"]["no_estimate"])
        self.assertNotIn("unbounded_order", quantities["highest"])  # too coarse to tell
        told = self.mortier("run", "scene.toml", "--out", "out", "--set", "accuracy.bound=true").stdout
        self.assertIn("(guaranteed)", told)

    def test_orders_of_unbounded_stresses_on_one_mesh(self):
        """Under a stiff punch 1/2 at its corners; none in the middle of a wheel (Hertz), as in a scene whose
        mesh shows a peak of the pressure of a few edges."""
        fine = PUNCH.replace("cells = 4", "cells = 24").replace("cells = [8, 4]", "cells = [128, 64]")
        wheel = fine.replace(box([-1, 0], [1, 2], 24), shape("halfdisc", cells=32, radius=4, core=0.8,
                                                              lowest=[0, 0]))
        wheel = wheel.replace("label = 3, ux = 0, uy", "label = 2, ux = 0, uy")
        wheel = wheel.replace('reaction = { body = "punch", label = 3 }',
                              'reaction = { body = "punch", label = 2 }')
        for text, order in ((fine, 0.5), (wheel, None)):
            highest = self.run_it(text)["quantities"]["highest"]
            if order:
                self.assertAlmostEqual(highest["unbounded_order"], order, delta=0.1)
            else:
                self.assertNotIn("unbounded_order", highest)

    def test_a_contact_that_never_closes_is_said(self):
        self.assertNotIn("never touched", self.mortier("run", "scene.toml").stdout)
        lifted = ("--set", "contact.gap=0.1", 'body.upper.boundary=[{label=4,ux=0},{label=3,uy="1e-3*t"}]')
        told = self.mortier("run", "scene.toml", *lifted).stdout
        self.assertIn("warning    the bodies never touched", told)
        quiet = self.mortier("run", "scene.toml", "--quiet", *lifted)
        self.assertIn("mortier: warning: scene.toml: the bodies never touched", quiet.stderr)
        self.assertEqual(quiet.stdout, "")
        plotted = self.mortier("plot", "out/scene", env={**os.environ, "PYTHONWARNINGS": "always"})
        self.assertNotIn("Warning", plotted.stderr)


if __name__ == "__main__":
    unittest.main()
