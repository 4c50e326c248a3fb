"""Friction as a user meets it: columns, quantities, and what does not support it."""
import re
import unittest

from scene_parts import body, box, contact, quantity, shape, timed
from scenes import FRICTION_KEYS, TWO_BLOCKS
from support import ROOT, OfTwoBlocks, values

SPUN = (body("one", shape("annulus", inner=0.3, outer=1, cells=[28, 5]), 100,
             'label = 1, ux = "-y*0.005*max(t - 1, 0)", uy = "x*0.005*max(t - 1, 0)"')
        + body("two", shape("annulus", inner=1, outer=3, cells=[28, 8]), 200, "label = 2, ux = 0, uy = 0")
        + contact(("one", 2), ("two", 1), variant="mortar", friction=0.2, gap="-0.001*min(t, 1)")
        + timed(None, 2)
        + quantity("external1", "external_work", "one") + quantity("stored1", "stored_energy", "one")
        + quantity("external2", "external_work", "two") + quantity("stored2", "stored_energy", "two"))


class FrictionScene(OfTwoBlocks):
    def run_it(self, *settings):
        summary = super().run_it(None, "output.every=1", *settings)
        return self.rows_of("out/contact.csv"), summary

    def test_nodes_stick_or_slip_within_their_bounds(self):
        self.write(FRICTION_KEYS)
        rows, summary = self.run_it()
        states = set()
        for row in rows:
            if row["step"] == "0":
                continue
            p, t, slipping = float(row["force"]), float(row["friction"]), int(row["slipping"])
            if row["interface"] == "0":
                self.assertLessEqual(abs(t), 0.3 * p * (1 + 1e-15))
                if slipping:
                    self.assertEqual(abs(t), 0.3 * p)
            else:
                self.assertLessEqual(abs(float(row["shear"])), 0.5 * (1 + 1e-14))
            if p > 0:
                states.add((row["interface"], slipping))
        self.assertTrue({("0", 0), ("0", 1), ("0", -1)} <= states, states)
        self.assertGreater(summary["final"]["friction_work"], 0)
        self.assertLess(summary["verification"]["friction"], 1e-12)

    def test_its_work_is_told_by_interfaces(self):
        self.write(FRICTION_KEYS)
        _, summary = self.run_it()
        history = self.rows_of("out/history.csv")
        parts = [float(history[-1][f"friction_work_{k}[J/m]"]) for k in range(2)]
        self.assertGreater(min(parts), 0)
        self.assertAlmostEqual(sum(parts) / summary["final"]["friction_work"], 1, places=14)
        self.assertEqual([each["friction_work"] for each in summary["interfaces"]], parts)
        for row in history:
            self.assertEqual(row["rubbed[J/m]"], row["friction_work_0[J/m]"])
            self.assertIn(row["ambiguous"], "01")
        smooth = FRICTION_KEYS.replace("friction = 0.3\n", "")
        self.write(smooth)
        line = 1 + smooth[:smooth.index("friction_work")].count("\n")
        errors = self.mortier("run", "scene.toml", "--quiet", "--out", "out", code=2).stderr
        self.assertIn(f"scene.toml:{line}: quantity rubbed: label 1 of body upper is no side of a contact "
                      "with friction, expected one", errors)

    def test_work_of_slip_is_exact_from_its_onset(self):
        """A shrunk ring is turned until it slips all round: however many steps, friction does its work from
        the place in the step on where slip begins, and the energy of both bodies is kept."""
        self.write(SPUN)
        works = []
        for steps in (16, 50, 333):
            _, summary = self.run_it(f"time.steps={steps}")
            value, works = values(summary), [*works, summary["final"]["friction_work"]]
            external = value["external1"] + value["external2"]
            done = external + summary["final"]["gap_work"]
            self.assertLess(abs(done - works[-1] - value["stored1"] - value["stored2"]) / external, 1e-12)
        self.assertLess(max(abs(work / works[-1] - 1) for work in works), 1e-12)

    def test_a_pin_in_a_hole(self):
        """A closed line: the pin is pressed upwards in its hole and turned at its middle until it slips all
        round where it presses. The moment that friction leaves is reported."""
        turn = 'ux = "-y*{0}", uy = "x*{0} + 0.001*min(t, 1)"'.format("0.005*(t < 1 ? 0 : t - 1)")
        self.write(body("pin", shape("annulus", inner=0.3, outer=1, cells=[28, 5]), 100,
                        f"label = 1, {turn}")
                   + body("plate", shape("annulus", inner=1, outer=3, cells=[40, 8]), 200,
                          "label = 2, ux = 0, uy = 0") + contact(("pin", 2), ("plate", 1), friction=0.2)
                   + quantity("torque", "reaction", "pin", 1, "moment") + timed(6, 3))
        for swap in ("false", "true"):
            with self.subTest(swap=swap):
                rows, summary = self.run_it(f"contact.swap={swap}")
                last = [row for row in rows if row["step"] == "6"]
                pressed = [row for row in last if float(row["force"]) > 0]
                self.assertTrue(5 < len(pressed) < len(last), len(pressed))
                # The pin, turned to the left, drags the hole along; its body is to the left of its line.
                self.assertEqual({row["slipping"] for row in pressed}, {"1"})
                torque = summary["quantities"]["torque"]["value"]
                bound = sum(0.2 * float(row["force"]) for row in pressed)
                self.assertAlmostEqual(torque / bound, 1, places=2)
                [interface] = summary["interfaces"]
                self.assertNotEqual(interface["couple"], 0)
                self.assertLess(abs(interface["couple"]), 0.02 * torque)

    def test_a_strut_jams_or_lets_go(self):
        """A strut that leans on a floor is drawn off it and along: under a large coefficient it hangs free,
        or it is jammed."""
        self.write(body("strut",
                        shape("quadrilateral", corners=[[0, 0], [0.1, 0], [1.1, 1], [1, 1]], cells=[1, 8]),
                        100, 'label = 3, ux = "-0.03*t", uy = "0.01*t"')
                   + body("floor", box([-1, -1], [1, 0], [9, 4]), 1e4, "label = 1, ux = 0, uy = 0")
                   + contact(("strut", 1), ("floor", 3), friction=2) + timed())
        self.mortier("run", "scene.toml", "--quiet", "--out", "out", "--list-solutions")
        summary = self.summary_of()
        [step] = summary["several_solutions"]
        self.assertEqual(step["step"], 1)
        self.assertEqual([each["index"] for each in step["solutions"]].count(-1),
                         len(step["solutions"]) // 2)
        self.assertGreaterEqual(len(step["solutions"]), 3)
        self.assertLess(max(each["residual"] for each in step["solutions"]), 1e-12)
        sets = {each["sets"] for each in step["solutions"]}
        self.assertEqual(len(sets), len(step["solutions"]))
        self.assertIn("oo", sets)
        self.assertTrue(any("s" in each for each in sets), sets)
        self.assertEqual(summary["ambiguous_steps"], 1)
        log = self.mortier("run", "scene.toml", "--out", "out", "--set", "contact.friction=0.1",
                           "solver.list_solutions=true").stdout
        self.assertNotIn("solutions", log)
        self.assertEqual(self.summary_of()["several_solutions"], [])

    def test_a_block_on_a_slope_slides_at_the_angle_of_friction(self):
        """The slope of the scene is 1/2; nothing else holds the upper block."""
        scene = ROOT / "scenes/sloped.toml"
        held = ("body.lower.boundary=[{label=1, ux=0, uy=0}]", 'body.upper.boundary=[{label=3, ty="-10*t"}]')
        for variant in ("mortar", "interpolation", "weighted"):
            for swap in ("false", "true"):
                settings = ["--set", f"contact.variant={variant}", f"contact.swap={swap}", *held]
                self.mortier("run", scene, "--quiet", "--out", "out", *settings, "contact.friction=0.5000005")
                errors = self.mortier("run", scene, "--quiet", "--out", "out", *settings,
                                      "contact.friction=0.4999995", code=3).stderr
                self.assertIn("cannot hold body upper: translation along (-0.8944, -0.4472)", errors)

    def test_no_friction_is_no_friction(self):
        elastic = TWO_BLOCKS.replace(', viscosity = 10, yield_stress = 1, projection = "elasticity"', "")
        self.write(elastic)
        plain, summary = self.run_it()
        self.assertNotIn("friction", plain[0])
        self.assertNotIn("friction_work", summary["final"])
        contact, history = self.read("out/contact.csv"), self.read("out/history.csv")
        self.write(elastic.replace("[contact]\n", "[contact]\nfriction = 0\nshear_limit = 0\n"))
        self.run_it()
        self.assertEqual(self.read("out/contact.csv"), contact)
        self.assertEqual(self.read("out/history.csv"), history)

    def test_meshes_and_steps_are_refined(self):
        self.write(FRICTION_KEYS)
        summary = self.run_it("accuracy.energy=0.15", "contact.1.friction=0.2", "contact.1.shear_limit=0")[1]
        self.assertEqual(summary["status"], "converged")
        self.assertGreater(summary["accuracy"]["round"], 1)
        self.assertLessEqual(summary["accuracy"]["energy_error"] + summary["accuracy"]["time"], 0.15)
        self.assertLessEqual(summary["accuracy"]["time"], 0.2*0.15)
        self.assertGreater(summary["accuracy"]["time"], 0)

    def test_freefem_takes_the_steps_of_a_run(self):
        self.write(FRICTION_KEYS)
        chosen = ("--set", "time.tolerance=0.2", "--set", "contact.1.variant=mortar")
        self.reject("scene.toml: tolerance = 0.2, expected equal steps, or those of a run (--steps-of) "
                    "(all that the FreeFEM method knows)", "freefem", "scene.toml", "scene.edp", *chosen)
        self.mortier("run", "scene.toml", "--quiet", "--out", "out", *chosen)
        times = [float(row["time[s]"]) for row in self.rows_of("out/history.csv")]
        self.mortier("freefem", "scene.toml", "scene.edp", "--steps-of", "out", *chosen)
        script = self.read("scene.edp")
        written = re.search(r"stepEnds = \[([^]]*)\]", script).group(1)
        self.assertEqual([float(time) for time in written.split(",")], times)
        self.assertIn(f"int steps = {len(times)};", script)
        self.mortier("freefem", "scene.toml", "other.edp", "--set", "contact.1.variant=mortar")
        self.assertNotIn("stepEnds", self.read("other.edp"))
        for text, what in {
                "step,time[s]\n1,2\n2,1\n": ":3: time 1, expected a number above the one before",
                "step,time[s]\n1,2\n2,nan\n": ":3: time nan, expected",
                "step,time[s]\n1,2\n2,5\n": ":3: time 5, expected",
                "step\n1\n": ":1: no column time[...], expected the history of a run",
                "step,time[s]\n1,2\n": ": no step to the end of the scene, expected a run that has ended",
                "": ": cannot be read, expected the history of a run"}.items():
            with self.subTest(text):
                self.write(text, "out/history.csv")
                errors = self.mortier("freefem", "scene.toml", "scene.edp", "--steps-of", "out", *chosen,
                                      code=2).stderr
                self.assertTrue(errors.startswith("mortier: out/history.csv" + what), errors)

    def test_what_does_not_support_it_is_refused(self):
        self.write(FRICTION_KEYS)
        line = 1 + FRICTION_KEYS[:FRICTION_KEYS.index("friction = 0.3")].count("\n")
        here = f"scene.toml:{line}: contact: friction = 0.3, expected none: "
        for setting, what in {
                "solver.method=penalty-duality": "solver.method = penalty-duality",
                "accuracy.bound=true": "accuracy.bound"}.items():
            with self.subTest(setting):
                self.reject(f"{here}{what} does not support friction", "run", "scene.toml", "--quiet",
                            "--out", "out", "--set", setting)
        for scene, what in {
                FRICTION_KEYS.replace("friction = 0.3", "friction = 0.3\nshear_limit = 1"):
                    r"contact: shear_limit = 1, expected friction or shear_limit",
                FRICTION_KEYS.replace("friction = 0.3", "friction = -0.3"):
                    r"contact: friction = -0.3, expected friction >= 0"}.items():
            with self.subTest(what):
                self.assertNotEqual(scene, FRICTION_KEYS)
                self.write(scene)
                errors = self.mortier("run", "scene.toml", "--quiet", "--out", "out", code=2).stderr
                self.assertTrue(re.match(r"mortier: scene.toml:\d+: " + what, errors), errors)


if __name__ == "__main__":
    unittest.main()
