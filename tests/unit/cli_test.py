"""The built program from outside: usage, exit codes, output that other programs read."""
import os
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import meshio
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))

from scenes import TWO_BLOCKS  # noqa: E402
from support import (HANGS, PROGRAM, OfTwoBlocks, children_of, mortier, processor_time,  # noqa: E402
                     time_to_end, told)

USAGE = [[], ["bla"], ["run"], ["run", "--frobnicate"], ["run", "scene.toml", "--threads", "0"],
         ["run", "none.toml"],
         ["mesh"], ["mesh", "crisscross", "x.mesh"], ["mesh", "info", "none.mesh"], ["freefem"],
         ["mesh", "rectangle", "--cells", "2,a", "x.mesh"],
         ["run", "scene.toml", "--out", "."]]


class Cli(OfTwoBlocks):
    def test_usage(self):
        for arguments in USAGE:
            with self.subTest(arguments=arguments):
                result = mortier(*arguments, cwd=self.folder)
                self.assertEqual(result.returncode, 2)
                if arguments not in ([], ["mesh"]):
                    self.assertTrue(result.stderr.startswith("mortier: "), result.stderr)
                    self.assertEqual(result.stderr.count("\n"), 1, result.stderr)

    def test_help_and_version(self):
        for arguments in [["--help"], ["run", "--help"], ["mesh", "--help"], ["mesh", "crisscross", "--help"],
                          ["mesh", "rectangle", "--help"], ["mesh", "quadrilateral", "--help"],
                          ["mesh", "annulus", "--help"],
                          ["mesh", "halfdisc", "--help"], ["mesh", "info", "--help"], ["freefem", "--help"],
                          ["--version"]]:
            result = self.mortier(*arguments)
            self.assertEqual(result.stderr, "")
            self.assertTrue(result.stdout)

    def test_the_log_has_the_parameters_of_laws(self):
        told = self.mortier("run", "scene.toml", "--set", "units=mm, N, MPa, h").stdout
        self.assertIn("\nmaterial   upper Perzyna (elasticity), young 3e+11 MPa, poisson 0.3, viscosity 10 "
                      "MPa h, yield_stress 1 MPa\n", told)

    def test_a_scene_is_read_once(self):
        text = TWO_BLOCKS.replace('mesh = "', f'mesh = "{self.folder}/')
        for arguments in (["run", "/dev/stdin", "--out", "piped"], ["check", "/dev/stdin"]):
            done = mortier(*arguments, cwd=self.folder, input=text)  # a pipe gives its text once
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.summary_of("piped")["scene_text"], text)

    def test_body_that_nothing_holds(self):
        self.write(TWO_BLOCKS.replace("label = 4\nux = 0", "label = 4\ntx = 0", 1))
        errors = self.mortier("run", "scene.toml", "--quiet", code=3).stderr
        self.assertIn("upper", errors)
        self.assertEqual(errors.count("\n"), 1, errors)
        self.assertEqual([name for name in self.names("out") if ".tmp-" in name], [])

    def test_step_that_cannot_be_solved_leaves_the_old_result(self):
        self.mortier("run", "scene.toml", "--quiet")
        before = self.read("out/scene/summary.json")
        self.mortier("run", "scene.toml", "--quiet", "--set", "solver.max_iterations=1",
                     "solver.tolerance=1e-30", code=1)
        self.assertEqual(self.read("out/scene/summary.json"), before)
        self.assertEqual(self.summary_of("out/scene.failed")["status"], "failed")
        self.assertEqual(self.names("out"), ["scene", "scene.failed"])
        self.mortier("run", "scene.toml", "--quiet")
        self.assertEqual(self.names("out"), ["scene"])

    def test_interrupted_run_can_go_on(self):
        process = subprocess.Popen([PROGRAM, "run", "scene.toml", "--quiet", "--set", "time.steps=1000000"],
                                   cwd=self.folder, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 20
        while not list(self.folder.glob("out/*")) and time.monotonic() < deadline:
            time.sleep(0.01)
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=HANGS)[1]
        self.assertEqual(process.returncode, 1)
        self.assertRegex(errors, r"^mortier: scene.toml: interrupted after step \d+; mortier run --restart "
                                 r"out/scene goes on\n$")
        left, = self.names("out")
        self.assertTrue(left.startswith("scene.tmp-"))
        self.assertIn("checkpoint", self.names("out/" + left))

    def interrupt(self, *arguments):
        """Sends SIGTERM when the run works on its first long step. Returns the seconds until it ended,
        and its message."""
        process = subprocess.Popen([PROGRAM, "run", *arguments], cwd=self.folder, stderr=subprocess.PIPE,
                                   text=True)
        while process.poll() is None and processor_time(process.pid) < 0.5:
            time.sleep(0.01)
        return self.seconds_to_the_end(process)

    def seconds_to_the_end(self, process):
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        seconds = time_to_end(process)
        errors = process.stderr.read()
        process.stderr.close()
        self.assertEqual(process.returncode, 1, errors)
        return seconds, errors

    def test_interrupted_in_the_middle_of_a_step(self):
        endless = ["solver.method=penalty-duality", "solver.max_iterations=1000000000",
                   "solver.tolerance=1e-30", "body.upper.boundary.3.ty=t<=0.5 ? 0 : -1", "time.steps=2"]
        first = ("scene.toml", "--quiet", "--set", *endless)
        again = ("--quiet", "--restart", "out/scene")
        for arguments in (first, again):  # step 1 is done at once, step 2 has no end
            seconds, errors = self.interrupt(*arguments)
            self.assertLess(seconds, 1)
            self.assertRegex(errors, r"scene.toml: interrupted after step 1; mortier run --restart "
                                     r"\S*out/scene goes on\n$")
            left, = self.names("out")
            self.assertIn("checkpoint", self.names("out/" + left))

    def test_interrupted_while_a_library_hears_nothing(self):
        environment = {**os.environ, "LD_PRELOAD": os.environ["DEAF_METIS"],
                       "ASAN_OPTIONS": "verify_asan_link_order=0"}
        self.mortier("mesh", "crisscross", "--cells", "60", "upper.mesh")
        process = subprocess.Popen([PROGRAM, "run", "scene.toml", "--quiet"], cwd=self.folder,
                                   env=environment, stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not (children := children_of(process.pid)):
            time.sleep(0.01)
        time.sleep(0.1)
        seconds, errors = self.seconds_to_the_end(process)
        self.assertLess(seconds, 1)
        self.assertEqual(told(errors), ["mortier: scene.toml: interrupted after step 0; nothing was written"])
        self.assertEqual(self.names("out"), [])
        self.assertFalse(Path(f"/proc/{children[0]}").exists())

    def test_interrupted_while_a_library_traps_the_signal(self):
        environment = {**os.environ, "LD_PRELOAD": os.environ["TRAPPING_METIS"],
                       "ASAN_OPTIONS": "verify_asan_link_order=0"}
        result = subprocess.run([PROGRAM, "run", "scene.toml", "--quiet"], cwd=self.folder, env=environment,
                                stderr=subprocess.PIPE, text=True, timeout=HANGS)
        self.assertEqual(result.returncode, 1)
        self.assertIn("interrupted after step 0; nothing was written", result.stderr)

    def test_steps_chosen_by_their_error_end_at_kinks(self):
        # The table is a ramp but for a pulse that is too short to be found by trying.
        kinks = {0.2001: "body.upper.boundary.3.ty={time=[0, 0.2001, 0.2002, 0.2003, 1], value=[0, -0.4002, "
                         "-3, -0.4006, -2]}",
                 0.2002: None, 0.2003: "body.lower.force={x={time=[0.9, 2], value=[0, 1]}, y='t < 0.7 ? "
                                       "0 : t - 0.7'}",
                 0.7: "time={end=1, tolerance=1e-2, scheme='sdirk2', breaks=[0.35]}", 0.9: None, 0.35: None}
        self.mortier("run", "scene.toml", "--quiet", "--set", *filter(None, kinks.values()))
        times = [float(row["time[s]"])
                 for row in self.rows_of("out/scene/history.csv")]
        self.assertLess(len(times), 100)
        for kink in kinks:
            self.assertIn(kink, times)

    def test_output_that_cannot_be_written(self):
        self.write("", "file")
        self.mortier("run", "scene.toml", "--quiet", "--out", "file/out", code=1)
        self.mortier("mesh", "crisscross", "--cells", "2", "file/x.mesh", code=1)

    def test_output_reads_back(self):
        result = self.mortier("run", "--set", "output.every=2", "body.upper.material.projection=elasticity",
                              "scene.toml", "--out", "result")
        self.assertEqual(result.stderr, "")
        rows = [line for line in result.stdout.splitlines() if line.split()[0].isdigit()]
        self.assertEqual(len(rows), 4)
        self.assertEqual([line.split()[0] for line in result.stdout.splitlines()[-2:]],
                         ["verification", "accuracy"])

        summary = self.summary_of("result")
        self.assertEqual(summary["status"], "converged")
        self.assertEqual(summary["triangles"], 36 + 32)
        self.assertEqual(summary["projection"], "elasticity")
        self.assertLess(summary["verification"]["force_balance"], 1e-9)
        self.assertAlmostEqual(summary["final"]["contact_force"], 10, places=9)
        self.assertGreater(summary["peak_memory_mib"], 1)
        for name in ("mortier", "Eigen", "CHOLMOD", "UMFPACK", "BLAS", "toml++"):
            self.assertRegex(summary["versions"][name], r"\d+\.\d+")
        if {"avx2", "fma"} <= set(Path("/proc/cpuinfo").read_text().split()):
            self.assertNotRegex(summary["versions"]["BLAS"], r"\bPrescott\b")  # kernels without AVX

        self.assertEqual([name for name in self.names("result") if name.endswith(".vtu")],
                         [f"{body}_{step:06}.vtu" for body in ("lower", "upper") for step in (0, 2, 4)])
        for body, triangles, vertices in (("upper", 36, 25), ("lower", 32, 23)):
            mesh = meshio.read(self.folder / f"result/{body}_000004.vtu")
            self.assertEqual(mesh.points.dtype, np.float64)
            self.assertEqual(mesh.points.shape, (vertices, 3))
            self.assertEqual(mesh.cells_dict["triangle"].shape, (triangles, 3))
            original = meshio.read(self.folder / f"{body}.mesh")
            np.testing.assert_array_equal(mesh.points[:, :2], original.points)
            np.testing.assert_array_equal(mesh.cells_dict["triangle"], original.cells_dict["triangle"])
            np.testing.assert_allclose(mesh.cell_data["stress"][0], np.tile([0, -10, 0], (triangles, 1)),
                                       atol=1e-7)
            np.testing.assert_allclose(mesh.cell_data["von_mises"][0], 10, rtol=1e-8)
            self.assertEqual(mesh.point_data["displacement"].shape, (vertices, 3))
            self.assertEqual(set(mesh.cell_data["viscoplastic"][0]), {1 if body == "upper" else 0})
            self.assertEqual(mesh.cell_data["viscoplastic_strain"][0].shape, (triangles, 3))
            self.assertEqual(set(mesh.cell_data["region"][0]),
                             set(original.cell_data_dict["medit:ref"]["triangle"]))

        history = self.rows_of("result/history.csv")
        self.assertEqual([float(row["time[s]"]) for row in history], [0.25, 0.5, 0.75, 1])
        rungs = [row["rung"] for row in history]
        self.assertEqual(summary["rungs"], {rung: rungs.count(rung) for rung in rungs})
        contact = self.rows_of("result/contact.csv")
        self.assertEqual([row["step"] for row in contact], ["0"] * 4 + ["2"] * 4 + ["4"] * 4)
        last = contact[-4:]
        self.assertAlmostEqual(sum(float(row["force"]) for row in last), 10, places=9)
        self.assertEqual({row["active"] for row in last}, {"1"})

    def test_quiet_prints_nothing(self):
        result = self.mortier("run", "scene.toml", "--quiet")
        self.assertEqual((result.stdout, result.stderr), ("", ""))

    def test_thin_triangles_are_told(self):
        self.mortier("mesh", "crisscross", "--cells", "100,1", "upper.mesh")
        errors = self.mortier("run", "scene.toml", "--quiet").stderr
        self.assertIn("warning: upper.mesh: triangle 228: 400 triangles with an aspect ratio above 20",
                      errors)


if __name__ == "__main__":
    unittest.main()
