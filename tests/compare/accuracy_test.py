"""Runs that refine their meshes and steps until an accuracy is reached."""
import json
import re
import signal
import subprocess
import time
import unittest

from scene_parts import body, box, contact, timed
from scenes import TWO_BLOCKS
from shape_scenes import SHAPE_KEYS
from support import PROGRAM, InFolder

# A stiff punch in the middle of a block, meshes as coarse as they can be.
PUNCH = (body("punch", box([-0.5, 0], [0.5, 1], 1), 1000, 'label = 3, ux = 0, uy = "-0.01*t"')
         + body("block", box([-2, -2], [2, 0], [3, 2]), 1, "label = 1, ux = 0, uy = 0")
         + contact(("punch", 1), ("block", 3)) + timed() + "[accuracy]\nenergy = 0.15\n")

BETWEEN = (body("b0", box([0, 0], [1, 1], 2), 1e3, "label = 1, ux = 0, uy = 0")
           + body("b1", box([0, 1.000001], [1, 2], 3),
                  "young = 1e3, poisson = 0.3, viscosity = 0.02, yield_stress = 0.05", "label = 4, ux = 0")
           + body("b2", box([0, 2.000001], [1, 3], 2), "young = 17, poisson = 0", "label = 3, DRIVE",
                  "label = 4, ux = 0") + contact(("b1", 1), ("b0", 3)) + contact(("b2", 1), ("b1", 3))
           + timed())

FLOWING = (body("block", box([0, 0], [1, 1], 1, cut="both"),
                "young = 100, poisson = 0.3, viscosity = 1, yield_stress = 1", "label = 1, ux = 0, uy = 0",
                'label = 3, ty = "-1.5*t*(1 + 0.5*x)"') + timed(5) + "[accuracy]\nenergy = 0.1\n")


class Accuracy(InFolder):
    def run_scene(self, scene, *arguments, code=0):
        """Standard output and summary.json."""
        self.write(scene)
        done = self.mortier("run", "scene.toml", "--out", "out", *arguments, code=code)
        return done, self.summary_of()

    def test_an_accuracy_is_reached_and_told(self):
        done, summary = self.run_scene(PUNCH)
        accuracy, rounds = summary["accuracy"], summary["rounds"]
        self.assertTrue(accuracy["reached"])
        self.assertEqual(accuracy["asked"], 0.15)
        self.assertLessEqual(accuracy["mesh"] + accuracy["time"], 0.15)
        self.assertGreater(len(rounds), 1)
        self.assertEqual(accuracy["mesh"], rounds[-1]["mesh"])
        # The pressure is unbounded at the punch's edges: what the estimate does not see there is added.
        self.assertGreater(accuracy["mesh"], accuracy["energy_error"])
        self.assertLess(accuracy["mesh"], 1.1 * accuracy["energy_error"])
        self.assertEqual(rounds[-1]["triangles"], summary["triangles"])
        self.assertEqual(rounds[-1]["unknowns"], summary["free_dofs"])
        self.assertEqual(rounds[0]["triangles"], 2 + 12)
        sizes = [each["unknowns"] for each in rounds]
        self.assertEqual(sizes, sorted(set(sizes)))
        rows = re.findall(r"^ +(\d+) +(\d+) +(\d+) +1 +[\d.]+ %", done.stdout, re.M)
        self.assertEqual([tuple(map(int, row)) for row in rows],
                         [(i + 1, each["triangles"], each["unknowns"]) for i, each in enumerate(rounds)])

    def test_refinement_may_aim_at_a_quantity(self):
        scene = PUNCH.replace("energy = 0.15", 'quantity = "middle"\ntolerance = 0.03') + """\
[[quantity]]
name = "middle"
mean_pressure = { body = "block", label = 3, from = [-0.25, 0], to = [0.25, 0], margin = 0.1 }
"""
        done, summary = self.run_scene(scene)
        accuracy, rounds = summary["accuracy"], summary["rounds"]
        middle = summary["quantities"]["middle"]
        self.assertTrue(accuracy["reached"])
        self.assertEqual((accuracy["asked"], accuracy["quantity"]), (0.03, "middle"))
        self.assertLessEqual(middle["bound"]["error"], 0.03 * middle["value"])
        self.assertAlmostEqual(accuracy["mesh"], middle["bound"]["error"] / middle["value"], delta=1e-12)
        self.assertGreater(rounds[-2]["mesh"], 0.03)
        self.assertIn("(guaranteed)", done.stdout)
        # The pressure is unbounded at the punch's edges, and little of the error is in the stiff punch: its
        # side is refined all the same, as the pressures are those of its nodes.
        _, better = self.run_scene(scene.replace("0.03", "0.01"))
        self.assertTrue(better["accuracy"]["reached"])
        falling = [each["mesh"] for each in better["rounds"][1:]]  # that of the first meshes is over 1
        self.assertEqual(falling, sorted(falling, reverse=True))
        other = better["quantities"]["middle"]["bound"]
        self.assertLessEqual(max(other["lower"], middle["bound"]["lower"]),
                             min(other["upper"], middle["bound"]["upper"]))
        done, limited = self.run_scene(scene, "--max-unknowns", str(rounds[-2]["unknowns"] + 1), code=1)
        self.assertIn("accuracy 0.03 of middle not reached", done.stderr)
        self.assertFalse(limited["accuracy"]["reached"])

    def test_wrong_aims_are_refused(self):
        scene = PUNCH.replace("energy = 0.15", 'quantity = "middle"\ntolerance = 0.03') + """\
[[quantity]]
name = "middle"
mean_pressure = { body = "block", label = 3 }
[[quantity]]
name = "peak"
largest_pressure = { body = "block", label = 3 }
"""
        self.write(scene)
        for settings, message in (
                (["accuracy.quantity=midle"],
                 'accuracy: quantity = "midle", expected one of middle, peak'),
                (["accuracy.quantity=peak"],
                 "expected a reaction of a label, a contact_force, a displacement or a mean_pressure"),
                (["accuracy.tolerance=2"], "tolerance = 2, expected 0 < tolerance < 1"),
                (["accuracy.energy=0.1"], 'quantity = "middle", expected either energy or quantity'),
                (["accuracy.bound=false"], "bound = false, expected true beside quantity"),
                (["degree=2"], "expected degree = 1 beside it"),
                (["body.block.material.viscosity=1", "body.block.material.yield_stress=1"],
                 "expected elastic bodies beside it: body block flows")):
            with self.subTest(settings):
                errors = self.mortier("run", "scene.toml", "--out", "none", "--set", *settings, code=2).stderr
                self.assertIn(message, errors)
                self.assertEqual(len(errors.splitlines()), 1)
                self.assertFalse((self.folder / "none").exists())
        self.write(PUNCH.replace("energy = 0.15", "energy = 0.15\ntolerance = 0.1"))
        self.assertIn("tolerance = 0.1, expected it only beside quantity",
                      self.mortier("run", "scene.toml", code=2).stderr)

    def test_the_refined_meshes_give_the_same_result(self):
        _, summary = self.run_scene(PUNCH)
        self.write(PUNCH[:PUNCH.index("[accuracy]")], "plain.toml")
        self.mortier("run", "plain.toml", "--out", "again", "--set", "body.punch.mesh=out/punch.mesh",
                     "body.block.mesh=out/block.mesh")
        again = self.summary_of("again")
        self.assertEqual(again["dofs"], summary["dofs"])
        for key in ("contact_force", "elastic_energy", "von_mises_max"):
            self.assertAlmostEqual(again["final"][key] / summary["final"][key], 1, delta=1e-9)

    def test_the_option_is_the_key(self):
        _, summary = self.run_scene(PUNCH[:PUNCH.index("[accuracy]")], "--accuracy", "0.15", "--max-unknowns",
                                    "1e5", "--max-seconds", "100")
        self.assertEqual(summary["accuracy"]["asked"], 0.15)
        self.assertEqual(summary["settings"], ["accuracy.energy=0.15", "accuracy.max_unknowns=1e5",
                                               "accuracy.max_seconds=100"])

    def test_what_is_not_reached_is_said(self):
        done, summary = self.run_scene(PUNCH, "--accuracy", "0.001", "--max-unknowns", "2000", code=1)
        self.assertIn("accuracy 0.001 not reached", done.stderr)
        self.assertIn("max_unknowns", done.stderr)
        self.assertFalse(summary["accuracy"]["reached"])
        self.assertLessEqual(summary["free_dofs"], 2000)
        self.assertGreater(summary["free_dofs"], 500)
        self.assertGreater(summary["accuracy"]["mesh"], 0.001)
        self.assertEqual(self.names("."), ["out", "scene.toml"])

    def test_a_round_that_cannot_be_solved_leaves_the_best_result(self):
        # With one iteration a step coarse meshes are solved and finer ones are not.
        self.write(PUNCH + "[output]\nevery = 1\n")
        done = self.mortier("run", "scene.toml", "--out", "out", "--accuracy", "0.01",
                            "--set", "solver.max_iterations=1", code=1)
        summary = self.summary_of()
        accuracy, rounds = summary["accuracy"], summary["rounds"]
        self.assertRegex(done.stderr,
                         f"accuracy 0.01 not reached: round {len(rounds) + 1}: step 1 .* did not converge")
        self.assertGreater(len(rounds), 1)
        self.assertFalse(accuracy["reached"])
        self.assertEqual(accuracy["round"], len(rounds))
        self.assertEqual(accuracy["mesh"], rounds[-1]["mesh"])
        self.assertEqual(summary["free_dofs"], rounds[-1]["unknowns"])
        self.assertEqual(self.names("."), ["out", "scene.toml"])
        self.assertEqual(sorted(json.loads(self.read("out/manifest.json"))["files"]),
                         [name for name in self.names("out") if name not in ("manifest.json", "run.lock")])
        # It is whole: the refined meshes give the same files.
        self.write(PUNCH[:PUNCH.index("[accuracy]")] + "[output]\nevery = 1\n", "plain.toml")
        self.mortier("run", "plain.toml", "--out", "again", "--set", "body.punch.mesh=out/punch.mesh",
                     "body.block.mesh=out/block.mesh", "solver.max_iterations=1")
        for name in ("history.csv", "contact.csv", "fields.pvd"):
            self.assertEqual(self.read(f"out/{name}"), self.read(f"again/{name}"))

    def test_a_round_stops_when_the_time_is_over(self):
        self.write(FLOWING.replace("cells = 1", "cells = 150"))
        # A limit of processor time: without an end of its own the round takes far longer.
        done = self.mortier("run", "scene.toml", "--out", "out", "--set", "accuracy.max_seconds=1",
                            "time.tolerance=1e-7", "time.scheme=sdirk2", code=1, timeout=30)
        self.assertIn("max_seconds are over; the state after step", done.stderr)
        self.assertEqual(self.names("."), ["out.failed", "scene.toml"])
        self.assertFalse(self.summary_of("out.failed")["accuracy"]["reached"])

    def test_bodies_that_flow_get_their_steps_too(self):
        _, summary = self.run_scene(FLOWING)
        accuracy = summary["accuracy"]
        self.assertTrue(accuracy["reached"])
        self.assertLessEqual(accuracy["mesh"] + accuracy["time"], 0.1)
        self.assertGreater(accuracy["time"], 0)
        self.assertAlmostEqual(summary["tolerance"], 0.02, delta=1e-15)

    def test_a_constant_stress_is_exact_after_one_refinement(self):
        scene = TWO_BLOCKS.replace('"upper.mesh"', '{ shape = "rectangle", lower = [0, 0], upper = [1, '
                                                   '1], cells = 3 }')
        scene = scene.replace('"lower.mesh"', '{ shape = "rectangle", lower = [0, -1], upper = [1, '
                                              '0], cells = 4 }')
        _, summary = self.run_scene(scene, "--accuracy", "0.01")
        self.assertEqual(len(summary["rounds"]), 2)
        self.assertEqual(summary["accuracy"]["mesh"], 0)

    def test_circles_of_shapes_are_circles(self):
        self.run_scene(SHAPE_KEYS)
        lines = self.read("out/ring.mesh").splitlines()
        begin = lines.index("Vertices") + 2
        count = int(lines[begin - 1])
        points = [tuple(map(float, line.split()[:2])) for line in lines[begin:begin + count]]
        begin = lines.index("Edges") + 2
        for line in lines[begin:begin + int(lines[begin - 1])]:
            *ends, label = map(int, line.split())
            if label > 2:
                continue
            for vertex in ends:
                x, y = points[vertex - 1]
                self.assertAlmostEqual(((x + 5)**2 + y**2)**0.5, label, delta=1e-13)
        self.assertGreater(count, 12)

    def test_a_polygon_is_named(self):
        self.write(SHAPE_KEYS)
        self.mortier("mesh", "annulus", "--cells", "16,2", "--inner", "1", "--outer", "2", "ring.mesh")
        text = self.read("ring.mesh").split("\n")
        begin = text.index("Vertices") + 2
        for i in range(begin, begin + int(text[begin - 1])):
            x, y, _ = text[i].split()
            text[i] = f"{x} {0.8 * float(y)} 0"
        self.write("\n".join(text), "ring.mesh")
        scene = (body("ring", '"ring.mesh"', 1, "label = 1, ux = 0, uy = 0", "label = 2, pressure = 1")
                 + timed())
        _, summary = self.run_scene(scene, "--accuracy", "0.3")
        self.assertTrue(any("label 1 is a polygon" in each for each in summary["accuracy"]["not_reliable"]))

    def test_what_cannot_be_is_refused(self):
        for setting, message in (("contact.variant=interpolation", "expected mortar beside accuracy"),
                                 ("degree=2 contact.variant=interpolation",
                                  "expected weighted beside accuracy"),
                                 ("degree=2 contact.variant=mortar",
                                  "expected weighted beside accuracy and degree = 2"),
                                 ("time.scheme=crank-nicolson", "expected it only beside time.scheme"),
                                 ("solver.method=penalty-duality", "expected it only beside solver.method"),
                                 ("accuracy.energy=1.5", "0 < energy < 1"),
                                 ("accuracy.max_unknowns=-1", "max_unknowns > 0")):
            with self.subTest(setting):
                self.write(PUNCH)
                errors = self.mortier("run", "scene.toml", "--set", *setting.split(), code=2).stderr
                self.assertIn(message, errors)
                self.assertEqual(self.names("."), ["scene.toml"])

    def test_shapes_that_cannot_be_are_refused(self):
        good = 'shape = "rectangle", lower = [-0.5, 0], upper = [0.5, 1], cells = 1'
        for bad, message in (('shape = "circle", cells = 1', 'shape = "circle", expected'),
                             ('shape = "rectangle"', "cells is missing"),
                             ('shape = "rectangle", cells = 1.5', "expected N or [N, M], integers >= 1"),
                             ('shape = "rectangle", cells = 1, radius = 2',
                              "radius = 2, expected of a mesh of shape rectangle"),
                             ('shape = "rectangle", cells = 1, upper = [-1, 1]',
                              "expected finite numbers with lower < upper"),
                             ('shape = "quadrilateral", cells = 1, corners = [[0, 0], [1, 0]]',
                              "expected four corners"),
                             ('shape = "annulus", cells = 4, span = "most"', "span = \"most\", expected"),
                             ('file = "a.mesh", cells = 1', "cells = 1, expected it beside shape")):
            with self.subTest(bad):
                self.write(PUNCH.replace(good, bad))
                errors = self.mortier("run", "scene.toml", code=2).stderr
                self.assertIn(message, errors)
                self.assertTrue(errors.startswith("mortier: scene.toml:3: body punch: mesh"), errors)

    def test_a_stopped_run_begins_its_rounds_again(self):
        self.write(PUNCH)
        self.mortier("run", "scene.toml", "--out", "whole", "--accuracy", "0.02")
        run = subprocess.Popen([PROGRAM, "run", "scene.toml", "--out", "out", "--accuracy", "0.02"],
                               cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        limit = time.time() + 60
        while not list(
            self.folder.glob("out.tmp-*/checkpoint")) and time.time() < limit and run.poll() is None:
            time.sleep(0.002)
        run.send_signal(signal.SIGKILL)
        run.wait()
        done = subprocess.run([PROGRAM, "run", "--restart", "out"], cwd=self.folder, capture_output=True,
                              text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("the rounds begin again", done.stderr)
        for name in ("history.csv", "contact.csv", "punch.mesh", "block.mesh"):
            self.assertEqual(self.read(f"out/{name}"), self.read(f"whole/{name}"))
        self.assertEqual(self.names("."), ["out", "scene.toml", "whole"])

    def test_a_free_motion_is_named_as_without_an_accuracy(self):
        """A body between two others, next to both: what little it moves makes forces of rounding alone."""
        for drive in ("uy = -1e-4", 'uy = "-1e-4*(1 - 2*t)"', "uy = 0", 'uy = "1e-4*t"'):
            with self.subTest(drive):
                self.write(BETWEEN.replace("DRIVE", drive))
                ends = []
                for options in ([], ["--accuracy", "0.06"], ["--set", "time.tolerance=0.1"]):
                    done = subprocess.run([PROGRAM, "run", "scene.toml", "--quiet", "--out", "out", *options],
                                          cwd=self.folder, capture_output=True, text=True)
                    self.assertIn(done.returncode, (0, 3), done.stderr)
                    ends.append((done.returncode, re.findall("body .*: translation along", done.stderr)))
                self.assertEqual(ends, ends[:1] * 3)


if __name__ == "__main__":
    unittest.main()
