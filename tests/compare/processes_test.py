"""Bodies factorised by MUMPS in several processes: results, refusals and restarts are those of one."""
import os
import signal
import subprocess
import time
import unittest
from pathlib import Path

import numpy as np

from support import HANGS, PROGRAM, ROOT, InFolder
import results  # behind support: it is in compare/

SHARED = str(Path(PROGRAM).with_name("mortier-mpi"))
MPIRUN = ["mpirun", "--oversubscribe", "--quiet", "-n"]
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OPENBLAS_NUM_THREADS": "1"}
SAME = 1e-10  # of the largest value of its kind
TWO_BLOCKS = str(ROOT / "scenes/compression.toml")
FRICTION = ["contact.friction=0.3", "body.lower.boundary=[{label=1, ux=0, uy=0}]",
            "body.upper.boundary=[{label=3, uy='-0.1*t', ux='0.1*sin(9*t)'}]"]


def set_(settings):
    return ["--set", *settings] if settings else []


def together(count, *arguments, cwd):
    return subprocess.run([*MPIRUN, str(count), SHARED, "run", *map(str, arguments)], cwd=cwd,
                          capture_output=True, text=True, timeout=300, env=ENVIRONMENT)


def largest(pairs):
    scale = max((np.abs(a).max(initial=0) for a, _ in pairs), default=0)
    return max((np.abs(a - b).max(initial=0) for a, b in pairs), default=0) / scale if scale > 0 else 0.0


def difference(one, other):
    """The largest of two runs, each kind of value over its largest."""
    worst = largest([(one.contact.force, other.contact.force)])
    for kind in ("displacement", "stress"):
        pairs = [(getattr(one.bodies[name], kind), getattr(other.bodies[name], kind)) for name in one.bodies]
        worst = max(worst, largest(pairs))
    return worst


class Processes(InFolder):
    def expect_same(self, count, scene, *settings, options=()):
        self.mortier("run", scene, "--quiet", "--out", "alone", *set_(settings), timeout=300)
        done = together(count, scene, "--quiet", "--out", "shared", *options, *set_(settings),
                        cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        alone, shared = (results.read_mortier(self.folder / name) for name in ("alone", "shared"))
        self.assertLessEqual(difference(alone, shared), SAME, f"{count}, {scene} {settings}")

    def test_scenes(self):
        for name, steps in (("hertz", 1), ("press-fit", 8), ("ironing", 8), ("roller", 8), ("stack", 1),
                            ("sphere", 1), ("cubes", 4), ("cook", 1)):
            with self.subTest(scene=name):
                self.expect_same(2, str(ROOT / f"scenes/{name}.toml"), f"time.steps={steps}")

    def test_methods(self):
        for settings in (["contact.variant='interpolation'"], ["degree=2"], FRICTION,
                         ["body.material.projection='elasticity'"],  # tangents are not symmetric
                         ["solver.method='penalty-duality'"], ["solver.linear='suitesparse'"],
                         ["time.scheme='sdirk2'", "time.tolerance=1e-3"],
                         ["body.material.yield_stress=1000", "accuracy.energy=0.05"]):
            with self.subTest(settings=settings):
                self.expect_same(2, TWO_BLOCKS, "time.steps=3", *settings)

    def test_numbers_of_processes(self):
        for count in (1, 3):
            with self.subTest(count=count):
                self.expect_same(count, TWO_BLOCKS, "time.steps=2")

    def test_factors_on_disk(self):
        (self.folder / "disk").mkdir()
        self.expect_same(2, TWO_BLOCKS, "time.steps=2", options=["--factors", "disk"])
        self.assertEqual(list((self.folder / "disk").iterdir()), [])
        done = self.mortier("run", TWO_BLOCKS, "--factors", "disk", code=2)
        self.assertIn("--factors: expected mortier-mpi", done.stderr)
        done = self.mortier("run", TWO_BLOCKS, "--factors", "nowhere", code=2)
        self.assertIn("nowhere", done.stderr)

    def test_the_first_process_tells(self):
        (self.folder / "wrong.toml").write_text("title = 3\n")
        for scene, settings, code in (("wrong.toml", [], 2),
                                      (TWO_BLOCKS, ["time.steps=2", "solver.max_iterations=1",
                                                    "contact.variant='interpolation'"], 1),
                                      (TWO_BLOCKS, ["body.lower.boundary=[]"], 3)):
            with self.subTest(scene=scene, settings=settings):
                alone = self.mortier("run", scene, "--quiet", "--out", "alone", *set_(settings),
                                     code=code).stderr
                done = together(2, scene, "--quiet", "--out", "alone", *set_(settings), cwd=self.folder)
                self.assertEqual(done.returncode, code)
                ours = [line for line in done.stderr.splitlines() if line.startswith("mortier: ")]
                self.assertEqual(ours, alone.splitlines())

    def test_a_run_of_which_a_process_died_goes_on_in_one(self):
        settings = set_(["time.steps=60"])
        self.mortier("run", TWO_BLOCKS, "--quiet", "--out", "alone", *settings)
        process = subprocess.Popen([*MPIRUN, "2", SHARED, "run", TWO_BLOCKS, "--quiet", "--checkpoint", "0",
                                    "--out", "run", *settings], cwd=self.folder, env=ENVIRONMENT,
                                   stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 60
        while not list(self.folder.glob("run.tmp-*/checkpoint")) and time.monotonic() < deadline:
            time.sleep(1e-3)
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        os.kill(int(children[-1]), signal.SIGKILL)
        self.assertNotEqual(process.wait(timeout=HANGS), 0)
        self.assertFalse((self.folder / "run").exists())
        self.mortier("run", "--restart", "run", "--quiet")
        alone, shared = (results.read_mortier(self.folder / name) for name in ("alone", "run"))
        self.assertLessEqual(difference(alone, shared), SAME)

    def test_summary_and_log(self):
        done = together(2, TWO_BLOCKS, "--out", "shared", "--set", "time.steps=1", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"factors +by MUMPS [\d.]+ in 2 processes")
        summary = self.summary_of("shared")
        self.assertEqual(summary["processes"], 2)
        self.assertIn("MUMPS", summary["versions"])
        self.assertEqual(self.names(), ["shared"])

    def test_mortier_itself_under_mpirun(self):
        done = subprocess.run([*MPIRUN, "2", PROGRAM, "run", TWO_BLOCKS], cwd=self.folder,
                              capture_output=True, text=True, timeout=HANGS, env=ENVIRONMENT)
        self.assertEqual(done.returncode, 2)
        self.assertIn("mortier: mpirun: mortier runs in one process, expected mortier-mpi", done.stderr)
        self.assertEqual(self.names(), [])


if __name__ == "__main__":
    unittest.main()
