"""A run that was stopped, however it was, goes on to the same bytes as one that was not."""
import json
import random
import shutil
import signal
import subprocess
import time
import unittest
from pathlib import Path

import accuracies
from mutations import require_whole
from space_friction_test import dragged
from support import HANGS, PROGRAM, ROOT, InFolder, mortier

SCENE = str(ROOT / "scenes/compression.toml")
STEPS = 60
ELASTIC = "body.lower.material={young=3e11, poisson=0.3}"

# Sums over the steps of the run, and ranges.
QUANTITIES = ("quantity=[{name='work', work={body='upper'}}, {name='outside', external_work={body='lower'}}, "
              "{name='heat', dissipated_energy={body='upper'}}, {name='m', largest_mises={body='lower'}}]")

NORTON = ('body.upper.material={young=3e11, poisson=0.3, law="norton", reference_stress=5, '
          'reference_rate=0.05, exponent=4}')

HARDENING = ('body.upper.material={young=3e11, poisson=0.3, law="viscoplastic", yield_stress=3, '
             'reference_stress=5, reference_rate=0.05, exponent=4, kinematic_hardening=20, '
             'isotropic_hardening=30}')

# A standard linear solid as a user-defined law: its state is in the strain.
OWN = ('body.upper.material={young=3e11, poisson=0.3, law="expression", ' +
       "".join(f'rate{c}="(1.3*(s{c}{m})/3e11 - 0.3*(e{c}{d}))/0.3", '
               for c, m, d in (("11", "-m", "-d"), ("22", "-m", "-d"), ("12", "", ""), ("33", "-m", "-d"))) +
       'parameters={m="(s11+s22+s33)/3", d="(e11+e22)/3"}}')

# Settings and threads of the runs that are killed. The upper body is Perzyna in all of them but those with
# NORTON.
CASES = [
    (["contact.variant=mortar"], 1),
    (["contact.variant=interpolation"], 1),
    (["contact.variant=interpolation", "time.scheme=sdirk2"], 1),
    (["contact.variant=mortar", "time.scheme=sdirk2", ELASTIC], 2),
    (["contact.variant=interpolation", "time.scheme=crank-nicolson", "body.material.projection=frobenius"],
     2),
    (["contact.variant=interpolation", "contact.swap=true", "solver.linear=suitesparse", ELASTIC], 1),
    (["contact.variant=mortar", "time.scheme=sdirk2", "time.tolerance=1e-6"], 2),
    (["contact.variant=interpolation", "time.scheme=sdirk2", "time.tolerance=4e-4"], 1),
    (["body.material.yield_stress=100"], 1),  # nothing flows: one factor
    (["body.material.yield_stress=100", "solver.reduce=false"], 1),  # one in every solve
    (["body.material.yield_stress=100", 'body.upper.boundary.ty="-10*min(t,0.2)"'], 2),  # most steps at rest
    (["plane=strain", "contact.variant=interpolation", "time.scheme=sdirk2", ELASTIC], 1),
    (["plane=strain", "contact.variant=mortar", "time.scheme=sdirk2", "time.tolerance=1e-6"], 2),
    (["time.scheme=sdirk2", "time.tolerance=1e-5", QUANTITIES], 1),
    ([NORTON, "contact.variant=mortar", "time.scheme=sdirk2", "time.tolerance=1e-4"], 2),
    (["contact.friction=0.3", "body.lower.boundary=[{label=1, ux=0, uy=0}]",
      "body.upper.boundary=[{label=3, uy='-0.1*t', ux='0.1*sin(9*t)'}]"], 2),
    (["contact.friction=0.3", "body.lower.boundary=[{label=1, ux=0, uy=0}]", "time.tolerance=0.1",
      "body.material={young=100, poisson=0.3}",
      "body.upper.boundary=[{label=3, uy='-0.1*t', ux='0.1*sin(9*t)'}]"], 2),
    ([NORTON, "plane=strain", "contact.variant=mortar", "time.scheme=crank-nicolson"], 1),
    ([HARDENING, "contact.variant=interpolation", "time.scheme=sdirk2"], 1),
    (["plane=strain", "body.volume=averaged", "contact.variant=mortar", "time.scheme=sdirk2", QUANTITIES], 2),
    (["body.upper.boundary.3.ty=-10", "time.scheme=sdirk2", QUANTITIES], 1),  # it acts at once
    (["body.upper.boundary.3.ty='-5-5*t'", "time.scheme=sdirk2", "time.tolerance=1e-5", QUANTITIES], 2),
    ([OWN, "plane=strain", "contact.variant=mortar", "time.scheme=sdirk2", "time.tolerance=1e-4"], 2),
    ([OWN, "plane=strain", "contact.variant=interpolation", "time.scheme=crank-nicolson"], 1),
    (['contact.kind="tied"', "contact.variant=mortar", "time.scheme=sdirk2", QUANTITIES], 2),
]
KILLS = len(CASES)
MEASURED = {"summary.json": [["solve_time_s"], ["wall_time_s"], ["peak_memory_mib"], ["threads"]],
            "manifest.json": [["files", "summary.json"]]}


class Restart(InFolder):
    def run_mortier(self, *arguments, code=0):
        """Runs to the end; the message where that is not the result."""
        return self.mortier("run", *arguments, "--quiet", code=code, timeout=300).stderr

    def stop(self, *arguments, after, pause=0.0, by=signal.SIGKILL):
        """Runs with a checkpoint after every step and stops the run when `after` of them were seen. A run
        that is over before that, on a busy machine, is made again."""
        for attempt in range(20):
            if self.stopped_one(arguments, max(1, after - 5 * attempt), pause, by):
                return self.stopped()
            for made in self.folder.glob("out/" + Path(arguments[arguments.index("--out") + 1]).name + "*"):
                shutil.rmtree(made)
        self.fail("no run could be stopped")

    def stopped_one(self, arguments, after, pause, by):
        process = subprocess.Popen([PROGRAM, "run", *map(str, arguments), "--quiet", "--checkpoint", "0"],
                                   cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        seen, checkpoint, deadline = set(), None, time.monotonic() + 120
        while len(seen) < after and process.poll() is None and time.monotonic() < deadline:
            try:
                checkpoint = checkpoint or next(self.folder.glob(f"out/*.tmp-{process.pid}/checkpoint"), None)
                seen.add(checkpoint.stat().st_mtime_ns)
            except (AttributeError, FileNotFoundError):
                checkpoint = checkpoint or next(self.folder.glob("out/*.tmp-*/checkpoint"), None)
            time.sleep(1e-4)  # shorter than a step; the run needs the processor
        time.sleep(pause)
        process.send_signal(by)
        process.wait(timeout=HANGS)
        process.stderr.close()
        if process.returncode != 0:
            self.assertEqual(process.returncode, -by if by == signal.SIGKILL else 1)
        # It may have been killed with its result complete, or in place.
        return process.returncode != 0 and bool([each for each in self.folder.glob("out/*.tmp-*/checkpoint*")
                                                 if not (each.parent / "manifest.json").exists()])

    def stopped(self):
        """The temporary folder of the stopped run."""
        left, = self.folder.glob("out/*.tmp-*")
        return left

    def settings(self, *more):
        steps = [] if any("time.tolerance" in each for each in more) else [f"time.steps={STEPS}"]
        return ["--set", *steps, "output.every=7", *more]

    def expect_same(self, one, other, whole=True):
        names = sorted(path.name for path in (self.folder / one).iterdir())
        self.assertEqual(sorted(path.name for path in (self.folder / other).iterdir()), names)
        for name in names:
            first, second = (self.folder / one / name).read_bytes(), (self.folder / other / name).read_bytes()
            if name in MEASURED:
                first, second = json.loads(first), json.loads(second)
                for parts in MEASURED[name]:
                    for each in (first, second):
                        for part in parts[:-1]:
                            each = each[part]
                        del each[parts[-1]]
            self.assertEqual(first, second, f"{name} differs")
        if whole:
            require_whole(self.folder / other)

    def test_killed_at_any_moment(self):
        for number in range(KILLS):
            settings, threads = CASES[number % len(CASES)]
            rng = random.Random(number)
            with self.subTest(number=number, settings=settings):
                whole = f"out/whole-{number % len(CASES)}"
                if not (self.folder / whole).exists():
                    self.run_mortier(SCENE, *self.settings(*settings), "--out", whole)
                result = f"out/killed-{number}"
                self.stop(SCENE, *self.settings(*settings), "--out", result,
                          after=rng.randrange(1, STEPS // 3), pause=rng.uniform(0, 5e-3))
                if number % 3 == 0:  # and once more
                    again = self.stopped_one(("--restart", result), rng.randrange(2, STEPS // 4),
                                             rng.uniform(0, 5e-3), signal.SIGKILL)
                else:
                    again = True
                if again:
                    self.run_mortier("--restart", result, "--threads", threads)
                else:  # complete; what the kill left goes with the next command, whatever that finds
                    mortier("run", "--restart", result, cwd=self.folder)
                self.expect_same(whole, result)
                self.assertEqual(list(self.folder.glob("out/*.*")), [])

    def test_a_tool_that_rolls_goes_on_to_the_byte(self):
        """Contact follows the bodies: what its rows were at the start of a step follows from the state."""
        scene = str(ROOT / "scenes" / "roller.toml")
        self.run_mortier(scene, "--out", "out/whole")
        for after in (7, 10, 19, 22, 26):
            self.stop(scene, "--out", f"out/killed-{after}", after=after)
            self.run_mortier("--restart", f"out/killed-{after}")
            self.expect_same("out/whole", f"out/killed-{after}")

    def test_friction_in_space_goes_on_to_the_byte(self):
        for number, steps in enumerate(("steps = 40", "tolerance = 2e-3")):
            (self.folder / "scene.toml").write_text(dragged(30).replace("steps = 10", steps))
            self.run_mortier("scene.toml", "--out", f"out/whole-{number}")
            for after in (5, 12):
                self.stop("scene.toml", "--out", f"out/killed-{number}-{after}", after=after)
                self.run_mortier("--restart", f"out/killed-{number}-{after}")
                self.expect_same(f"out/whole-{number}", f"out/killed-{number}-{after}")

    def test_killed_on_meshes_that_are_worth_threads(self):
        for name, cells, lower, upper in (("upper.mesh", 66, "0,0", "1,1"),
                                          ("lower.mesh", 64, "0,-1", "1,0")):
            self.mortier("mesh", "crisscross", "--cells", cells, "--lower", lower, "--upper", upper, name)
        settings = ["--set", "time.steps=6", "body.upper.mesh=upper.mesh", "body.lower.mesh=lower.mesh"]
        self.run_mortier(SCENE, *settings, "--out", "out/whole", "--threads", 2)
        self.stop(SCENE, *settings, "--out", "out/killed", "--threads", 2, after=3)
        self.run_mortier("--restart", "out/killed", "--threads", 1)
        self.expect_same("out/whole", "out/killed")

    def test_killed_with_quadratic_displacements(self):
        """Equal steps with either cone, a curve that flows, steps chosen by their error."""
        ring = str(ROOT / "scenes/thick-cylinder.toml")
        for number, (scene, settings) in enumerate((
                (SCENE, ["time.steps=20"]),
                (SCENE, ["time.steps=20", "contact.variant=interpolation", "time.scheme=sdirk2"]),
                (ring, []),
                (SCENE, ["time.scheme=sdirk2", "time.tolerance=1e-3", "body.lower.mesh=coarse.mesh"]))):
            with self.subTest(scene=scene, settings=settings):
                self.mortier("mesh", "crisscross", "--cells", 4, "--lower=0,-1", "--upper", "1,0",
                             "coarse.mesh")
                asked = ["--set", "degree=2", "output.every=7", *settings]
                self.run_mortier(scene, *asked, "--out", f"out/whole-{number}")
                self.stop(scene, *asked, "--out", f"out/killed-{number}", after=8)
                self.run_mortier("--restart", f"out/killed-{number}", "--threads", 2)
                self.expect_same(f"out/whole-{number}", f"out/killed-{number}")

    def test_killed_on_meshes_that_are_refined(self):
        scene, _, accuracy = accuracies.cases()["flow blocks 1"]
        (self.folder / "scene.toml").write_text(f"degree = 2\n{scene}[accuracy]\nenergy = {accuracy}\n")
        self.run_mortier("scene.toml", "--out", "out/whole")
        self.stop("scene.toml", "--out", "out/killed", after=30)
        self.run_mortier("--restart", "out/killed")
        for name in ("whole", "killed"):  # what rounds took
            path = self.folder / "out" / name / "summary.json"
            summary = json.loads(path.read_text())
            self.assertGreater(len(summary["rounds"]), 1)
            for each in summary["rounds"]:
                del each["seconds"]
            path.write_text(json.dumps(summary))
        self.expect_same("out/whole", "out/killed", whole=False)

    def test_killed_in_a_run_that_is_begun_again(self):
        settings = ["--set", "output.every=7", "contact.variant=mortar", "time.scheme=sdirk2",
                    "time.tolerance=1e-5"]
        told = self.mortier("run", SCENE, *settings, "--out", "out/whole", timeout=300).stdout
        self.assertIn("restarted with smaller steps", told)
        for after in (2, 9, 14):
            result = f"out/killed-{after}"
            self.stop(SCENE, *settings, "--out", result, after=after)
            self.run_mortier("--restart", result)
            self.expect_same("out/whole", result)

    def test_interrupted(self):
        self.run_mortier(SCENE, *self.settings(), "--out", "out/whole")
        for by in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            self.stop(SCENE, *self.settings(), "--out", "out/stopped", after=5, by=by)
            self.assertFalse((self.folder / "out/stopped").exists())
            # The scene may be named, and must then be the same.
            self.run_mortier(SCENE, *self.settings(), "--restart", "out/stopped")
            self.expect_same("out/whole", "out/stopped")
            shutil.rmtree(self.folder / "out/stopped")

    def test_damaged_checkpoint(self):
        self.run_mortier(SCENE, *self.settings(), "--out", "out/whole")
        rng = random.Random(7)
        for damage in ("cut", "flip", "empty", "none", "older"):
            with self.subTest(damage=damage):
                left = self.stop(SCENE, *self.settings(), "--out", "out/killed", after=9)
                good = (left / "checkpoint.previous").read_bytes()
                (left / "checkpoint").unlink(missing_ok=True)
                if damage == "cut":
                    (left / "checkpoint").write_bytes(good[:rng.randrange(len(good))])
                elif damage == "flip":
                    at = rng.randrange(len(good))
                    (left / "checkpoint").write_bytes(good[:at] + bytes([good[at] ^ 4]) + good[at + 1:])
                elif damage == "empty":
                    (left / "checkpoint").write_bytes(b"")
                elif damage == "older":
                    (left / "checkpoint").write_bytes(good.replace(b"mortier checkpoint ",
                                                                   b"mortier checkpoint 0", 1))
                self.run_mortier("--restart", "out/killed")
                self.expect_same("out/whole", "out/killed")
                shutil.rmtree(self.folder / "out/killed")

    def test_no_sound_checkpoint(self):
        left = self.stop(SCENE, *self.settings(), "--out", "out/killed", after=9)
        good = (left / "checkpoint.previous").read_bytes()
        for name in ("checkpoint", "checkpoint.previous"):
            (left / name).write_bytes(good[:-1])
        self.assertIn("checkpoint: damaged", self.run_mortier("--restart", "out/killed", code=2))
        (left / "checkpoint").write_bytes(good)
        history = (left / "history.csv").read_bytes()
        (left / "history.csv").write_bytes(history.replace(b"newton", b"nEwton", 1))
        self.assertIn("its history.csv is damaged", self.run_mortier("--restart", "out/killed", code=2))
        (left / "history.csv").write_bytes(history)
        kept = (left / "upper_000000.vtu").read_bytes()
        (left / "upper_000000.vtu").write_bytes(b"")
        self.assertIn("its upper_000000.vtu is shorter", self.run_mortier("--restart", "out/killed", code=2))
        (left / "upper_000000.vtu").write_bytes(kept)
        (left / "history.csv").write_bytes(b"step\n")
        self.assertIn("its history.csv is shorter than it was",
                      self.run_mortier("--restart", "out/killed", code=2))
        self.assertTrue(left.exists())

    def test_another_scene(self):
        scene = self.folder / "scene.toml"
        for body in ("upper", "lower"):
            cells = "16" if body == "lower" else "6"
            shutil.copy(ROOT / f"shared-meshes/{body}-crisscross-{cells}.mesh", self.folder / f"{body}.mesh")
        meshes = ["body.upper.mesh=upper.mesh", "body.lower.mesh=lower.mesh"]
        shutil.copy(SCENE, scene)
        left = self.stop(scene, *self.settings(*meshes), "--out", "out/killed", after=5)
        text = scene.read_text()
        scene.write_text(text.replace("viscosity = 10", "viscosity = 11", 1))
        self.assertIn("scene.toml: line 9 has changed, expected",
                      self.run_mortier("--restart", "out/killed", code=2))
        scene.write_text(text)
        other = ["--set", "time.steps=61", *self.settings(*meshes)[2:]]
        self.assertIn("--set time.steps=61 output", self.run_mortier(scene, *other, "--restart", "out/killed",
                                                                     code=2))
        mesh = (self.folder / "upper.mesh").read_text()
        (self.folder / "upper.mesh").write_text(mesh.replace("\n1 1 0\n", "\n1 1.0000000000000002 0\n", 1))
        self.assertNotEqual((self.folder / "upper.mesh").read_text(), mesh)
        self.assertIn("upper.mesh has changed", self.run_mortier("--restart", "out/killed", code=2))
        (self.folder / "upper.mesh").write_text(mesh)
        self.assertTrue(left.exists())
        self.run_mortier("--restart", "out/killed")

    def test_another_temperature(self):
        mesh = "body.upper.mesh={shape='rectangle', cells=4, lower=[0, 0], upper=[1, 1]}"
        heat = ["body.upper.material={young=3e11, poisson=0.3, expansion=1e-12}",
                "body.upper.temperature={file='heat.txt', factor='t'}"]
        self.write("1\n"*25, "heat.txt")
        self.stop(SCENE, *self.settings(mesh, *heat), "--out", "out/killed", after=5)
        self.write("1\n"*24 + "2\n", "heat.txt")
        self.assertIn("the file heat.txt has changed, expected",
                      self.run_mortier("--restart", "out/killed", code=2))
        self.write("1\n"*25, "heat.txt")
        self.run_mortier("--restart", "out/killed")

    def test_nothing_to_go_on_with(self):
        self.assertIn("out/none: no stopped run", self.run_mortier("--restart", "out/none", code=2))
        self.run_mortier(SCENE, "--out", "out/done", "--set", "time.steps=2")
        self.assertIn("out/done: no stopped run", self.run_mortier("--restart", "out/done", code=2))
        self.assertIn("--out excludes --restart", self.run_mortier(SCENE, "--out", "out/a", "--restart",
                                                                   "out/a", code=2))

    def test_a_living_run_is_not_taken_over(self):
        living = subprocess.Popen([PROGRAM, "run", SCENE, "--quiet", "--checkpoint", "0", "--out", "out/a",
                                   "--set", "time.steps=1000000"], cwd=self.folder, stderr=subprocess.DEVNULL)
        self.addCleanup(living.wait)
        self.addCleanup(living.kill)
        while not list(self.folder.glob("out/a.tmp-*/checkpoint")):
            time.sleep(0.01)
        self.assertIn("still goes on", self.run_mortier("--restart", "out/a", code=2))

    def test_begun_anew_instead(self):
        self.stop(SCENE, *self.settings(), "--out", "out/a", after=3)
        self.stopped()
        self.run_mortier(SCENE, *self.settings(), "--out", "out/a")
        self.assertEqual([path.name for path in (self.folder / "out").iterdir()], ["a"])


if __name__ == "__main__":
    unittest.main()
