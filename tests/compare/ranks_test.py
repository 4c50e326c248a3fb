"""Runs of several processes: equal to that of one, refused alike, and gone on with by any number of them."""
import json
import os
import shutil
import signal
import subprocess
import time
import unittest
from pathlib import Path

import numpy as np

from support import PROGRAM, ROOT, InFolder
import results  # behind support: it is in compare/

MPIRUN = ["mpirun", "--oversubscribe", "--quiet", "-n"]
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_mpi_yield_when_idle": "1",
               "OPENBLAS_NUM_THREADS": "1"}
SAME = 1e-10  # of the largest value of its kind
FRICTION = ["contact.friction=0.3", "body.lower.boundary=[{label=1, ux=0, uy=0}]",
            "body.upper.boundary=[{label=3, uy='-0.1*t', ux='0.1*sin(9*t)'}]"]
NOT_FINITE = "body.upper.boundary=[{label=4, ux=0}, {label=3, ty='-10*t + 0*sqrt(abs(t-0.68)-0.03)'}]"
DISTRIBUTED = ["solver.distributed_from=1"]  # by MUMPS, where it is installed
SHEAR = ["contact.friction=0.3", "body.lower.boundary=[{label=1, ux=0, uy=0}]",
         "body.upper.boundary=[{label=3, ty='-10*t', tx='2*t'}]"]
TWO_BLOCKS = str(ROOT / "scenes/compression.toml")


def on_ranks(count, *arguments, cwd):
    return subprocess.run([*MPIRUN, str(count), PROGRAM, "run", *map(str, arguments), "--quiet"], cwd=cwd,
                          capture_output=True, text=True, timeout=300, env=ENVIRONMENT)


def difference(one, other):
    """The largest of two runs, each kind of value over its largest."""
    worst = 0.0
    for kind in ("displacement", "stress"):
        pairs = [(getattr(one.bodies[name], kind), getattr(other.bodies[name], kind)) for name in one.bodies]
        worst = max(worst, largest(pairs))
    return max(worst, largest([(one.contact.force, other.contact.force)]))


def largest(pairs):
    scale = max((np.abs(a).max(initial=0) for a, _ in pairs), default=0)
    return max((np.abs(a - b).max(initial=0) for a, b in pairs), default=0) / scale if scale > 0 else 0.0


class Ranks(InFolder):
    def alone(self, scene, *settings, folder="alone"):
        self.mortier("run", scene, "--quiet", "--out", folder, *self.set(settings), timeout=300)
        return results.read_mortier(self.folder / folder)

    def together(self, count, scene, *settings, folder="together", code=0):
        done = on_ranks(count, scene, "--out", folder, *self.set(settings), cwd=self.folder)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    @staticmethod
    def set(settings):
        return ["--set", *settings] if settings else []

    def expect_same(self, counts, scene, *settings):
        alone = self.alone(scene, *settings)
        for count in counts:
            self.together(count, scene, *settings)
            worst = difference(alone, results.read_mortier(self.folder / "together"))
            self.assertLessEqual(worst, SAME, f"{count} ranks, {scene} {settings}")

    def test_scenes_are_those_of_one_process(self):
        for number, scene in enumerate(sorted((ROOT / "scenes").glob("*.toml"))):
            with self.subTest(scene=scene.name):
                self.expect_same([2 + number % 3], str(scene))

    def test_methods_are_those_of_one_process(self):
        for settings in (["contact.variant=interpolation"], ["solver.linear=suitesparse"], ["degree=2"],
                         ["solver.method=penalty-duality"], ["plane=strain", "accuracy.bound=true"],
                         ["time.scheme=sdirk2", "time.tolerance=1e-3"], FRICTION,
                         ["body.material.expansion=1e-5", "body.upper.temperature='10*t'"],
                         ["body.material.yield_stress=1000", "accuracy.energy=0.05"]):
            with self.subTest(settings=settings):
                self.expect_same([3], TWO_BLOCKS, "time.steps=5", *settings)

    def test_a_distributed_skeleton_changes_nothing(self):
        for ranks, settings in ((2, []), (3, []), (4, []), (3, ["body.material.projection='elasticity'"]),
                                (4, ["solver.linear=suitesparse"]), (3, SHEAR),
                                (3, ["contact.variant=interpolation", "plane=strain"])):
            with self.subTest(ranks=ranks, settings=settings):
                self.expect_same([ranks], TWO_BLOCKS, "time.steps=2", *DISTRIBUTED, *settings)

    def test_the_first_one_tells(self):
        (self.folder / "wrong.toml").write_text("title = 3\n")
        for scene, settings, code in (("wrong.toml", [], 2),
                                      (TWO_BLOCKS, ["time.steps=2", "solver.max_iterations=1",
                                                    "contact.variant=interpolation"], 1),
                                      (TWO_BLOCKS, ["time.steps=9", NOT_FINITE], 1),
                                      (TWO_BLOCKS, ["body.lower.boundary=[]"], 3)):
            with self.subTest(scene=scene, settings=settings):
                alone = self.mortier("run", scene, "--quiet", "--out", "alone", *self.set(settings),
                                     code=code).stderr
                done = self.together(3, scene, *settings, folder="alone", code=code)
                ours = [line for line in done.stderr.splitlines() if line.startswith("mortier: ")]
                self.assertEqual(ours, alone.splitlines())

    def test_a_run_whose_rank_died_goes_on_with_any_number(self):
        self.expect_to_go_on()

    def test_a_run_whose_rank_died_among_those_of_mumps_goes_on(self):
        self.expect_to_go_on(*DISTRIBUTED)

    def expect_to_go_on(self, *settings):
        settings = ["time.steps=60", *settings]
        alone = self.alone(TWO_BLOCKS, *settings)
        process = subprocess.Popen(
            [*MPIRUN, "3", PROGRAM, "run", TWO_BLOCKS, "--quiet", "--checkpoint", "0", "--out", "run",
             *self.set(settings)], cwd=self.folder, env=ENVIRONMENT, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 60
        while not list(self.folder.glob("run.tmp-*/checkpoint")) and time.monotonic() < deadline:
            time.sleep(1e-3)
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        os.kill(int(children[-1]), signal.SIGKILL)
        self.assertNotEqual(process.wait(timeout=60), 0)
        self.assertFalse((self.folder / "run").exists())
        done = on_ranks(2, "--restart", "run", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLessEqual(difference(alone, results.read_mortier(self.folder / "run")), SAME)

    def test_without_its_second_program_it_says_so(self):
        alone = shutil.copy(PROGRAM, self.folder / "mortier")
        done = subprocess.run([alone, "run", TWO_BLOCKS], cwd=self.folder, capture_output=True, text=True,
                              env={**ENVIRONMENT, "OMPI_COMM_WORLD_SIZE": "2"})
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"\Amortier: mpirun: several processes, but no .*mortier-mpi, .*\n\Z")
        self.assertEqual(self.names(), ["mortier"])

    def test_one_folder_one_writer(self):
        self.together(2, TWO_BLOCKS, "time.steps=3")
        self.assertEqual(self.names(), ["together"])
        summary = json.loads(self.read("together/summary.json"))
        self.assertEqual(summary["steps"], 3)


if __name__ == "__main__":
    unittest.main()
