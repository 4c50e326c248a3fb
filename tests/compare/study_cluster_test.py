"""mortier study --scheduler: the same table as on this machine, each run once, whatever workers do.

MORTIER_LONG_STUDY=1: 200 runs instead of 16.
"""
import json
import os
import signal
import socket
import subprocess
import sys
import time
import unittest

from study_support import SPACE, StudyTest
from support import HANGS, PROGRAM, ROOT

COSTS = ("wall_time[s]", "processor_time[s]", "memory[MiB]", "at_once")
LONG = bool(os.environ.get("MORTIER_LONG_STUDY"))
# Runs are written down when they begin and when they end; they are slow enough to be interrupted.
COUNTING = f"""#!/bin/sh
[ "$1" = study ] && MORTIER=$0 exec {sys.executable} {ROOT}/study/__main__.py "$2"
[ "$1" = run ] || exec {PROGRAM} "$@"
for word; do case $word in *upper.mesh=*) mesh=$word;; *upper.material.young=*) young=$word;; esac; done
echo "begins $young $mesh" >> LOG
sleep 0.3
{PROGRAM} "$@" || exit
echo "ends $young $mesh" >> LOG
"""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Cluster(StudyTest):
    def setUp(self):
        super().setUp()
        # On a busy machine a scheduler takes longer to begin than a study waits for its answer.
        place = self.folder / "scheduler.json"
        self.scheduler = self.start("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0",
                                    "--scheduler-file", str(place))
        while not (text := place.read_text() if place.exists() else "").endswith("}"):
            self.assertIsNone(self.scheduler.poll())
            time.sleep(0.05)
        self.address = json.loads(text)["address"]
        self.workers = 0
        self.log = self.folder / "log"
        self.program = self.folder / "counting"
        self.program.write_text(COUNTING.replace("LOG", str(self.log)))
        self.program.chmod(0o755)
        self.path.write_text(SPACE)

    def start(self, module, *options, environment=None):
        process = subprocess.Popen([sys.executable, "-m", module, *options, "--no-dashboard"],
                                   cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   start_new_session=True, env={**os.environ, **(environment or {})})
        self.addCleanup(self.end, process)
        return process

    def worker(self, program=PROGRAM):
        self.workers += 1
        place = self.folder / f"worker {self.workers}"
        place.mkdir()
        return self.start("distributed.cli.dask_worker", self.address, "--nthreads", "1", "--local-directory",
                          str(place), "--memory-limit", "0", environment={"MORTIER": str(program)})

    def end(self, process):
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()

    def on_workers(self, *options, code=0):
        return self.study("--scheduler", self.address, *options, code=code)

    def begin(self):
        return subprocess.Popen([PROGRAM, "study", self.path, "--out", self.out, "--scheduler", self.address],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=self.folder)

    def wait_until(self, process, count):
        """Until so many runs have begun."""
        until = time.monotonic() + 300
        while len(self.begun()) < count:
            self.assertIsNone(process.poll())
            self.assertLess(time.monotonic(), until)
            time.sleep(0.05)

    def begun(self):
        return [line for line in self.log.read_text().splitlines() if line.startswith("begins")] \
            if self.log.exists() else []

    def many(self, count):
        youngs = ", ".join(f"{200 + i}e9" for i in range(count))
        self.path.write_text(SPACE.replace("level = [0, 1, 2]", "level = 0")
                             .replace('variant = ["mortar", "interpolation"]',
                                      f"body.upper.material.young = [{youngs}]"))

    def test_same_table_without_a_file_of_the_study_on_the_worker(self):
        text = SPACE.replace("[0, 1, 2]", "[0, 1]").replace(
            "[[sweep]]", '[[error]]\nquantity = "displacement_min_y"\n[reference]\nsteps = 40\n[[sweep]]')
        self.path.write_text(text.replace("time.steps = 4", "steps = 4"))
        self.worker(self.program)
        self.on_workers()
        there = self.rows()
        self.out = self.folder / "here"
        self.study()
        here = self.rows()
        self.assertEqual(len(there), 4)
        for a, b in zip(there, here):
            self.assertEqual(a["status"], "done", a["reason"])
            self.assertEqual({**a, **dict.fromkeys(COSTS)}, {**b, **dict.fromkeys(COSTS)})
        self.assertEqual(len(self.begun()), 8)
        for line in self.begun():
            self.assertIn(f"mesh={self.folder}/worker 1/", line)  # none was read where the study has it
        self.assertEqual(list((self.folder / "worker 1").rglob("*.mesh")), [])

    def test_a_worker_that_is_killed_and_one_that_comes_late(self):
        count = 200 if LONG else 16
        self.many(count)
        first = [self.worker(self.program), self.worker(self.program)]
        process = self.begin()
        self.wait_until(process, count // 4)
        os.killpg(first[0].pid, signal.SIGKILL)
        self.worker(self.program)
        self.wait_until(process, count // 2)
        _, errors = process.communicate(timeout=600)
        self.assertEqual(process.returncode, 0, errors)
        rows = self.rows()
        self.assertEqual([row["status"] for row in rows], ["done"] * count)
        self.assertEqual(len({row["key"] for row in rows}), count)
        # Made twice is only what died with its worker, result or not.
        ended = [line.split(maxsplit=2) for line in self.log.read_text().splitlines() if line[:4] == "ends"]
        kept = [young for _, young, mesh in ended if "worker 1/" not in mesh]
        self.assertEqual(len(kept), len(set(kept)))
        self.assertEqual(len({young for _, young, _ in ended}), count)
        self.assertLessEqual(len(self.begun()), count + 4)
        if LONG:
            self.out = self.folder / "here"
            self.study()
            for a, b in zip(rows, self.rows()):
                self.assertEqual({**a, **dict.fromkeys(COSTS)}, {**b, **dict.fromkeys(COSTS)})

    def test_a_run_that_fails_is_a_row_with_its_reason(self):
        self.path.write_text(SPACE.replace("level = [0, 1, 2]",
                                           "level = 0\nbody.upper.material.young = [-1, 3e11]"))
        self.worker()
        self.on_workers()
        reasons = [row["reason"] for row in self.rows() if row["status"] == "failed"]
        self.assertEqual(len(reasons), 2)
        for reason in reasons:
            self.assertIn("body upper: young = -1, expected young > 0", reason)

    def test_a_worker_without_the_program_or_with_another_one(self):
        self.path.write_text(SPACE.replace("level = [0, 1, 2]", "level = 0"))
        worker = self.worker(self.folder / "nothing")
        self.on_workers(code=1)
        for row in self.rows():
            self.assertRegex(row["reason"], r"^worker \S+: .*/nothing: No such file or directory$")
        self.end(worker)
        other = self.folder / "other"
        other.write_text(f'#!/bin/sh\n[ "$1" = --version ] && exec echo other\nexec {PROGRAM} "$@"\n')
        other.chmod(0o755)
        script = self.folder / "study-of-other"
        script.write_text(f"#!/bin/sh\nMORTIER={other} exec {sys.executable} {ROOT}/study/__main__.py -\n")
        script.chmod(0o755)
        worker = self.worker(script)
        self.on_workers(code=1)
        for row in self.rows():
            self.assertRegex(row["reason"],
                             r"^worker \S+: .*mortier here is not the version of the study$")
        self.end(worker)
        self.worker()  # what failed is tried again
        self.assertIn("2 runs, 0 of them done before", self.on_workers().stdout)

    def test_a_study_that_is_stopped_leaves_no_run_on_the_workers(self):
        self.path.write_text(SPACE.replace("steps = 4", "steps = 1000000").replace("[0, 1, 2]", "0"))
        self.worker(self.program)
        process = self.begin()
        self.wait_until(process, 1)
        process.terminate()
        _, errors = process.communicate(timeout=HANGS)
        self.assertEqual(process.returncode, 1)
        self.assertIn("interrupted; finished runs are kept", errors)
        until = time.monotonic() + 20
        while str(self.folder / "worker 1") in (shown := subprocess.run(
                ["ps", "ax", "-o", "args"], capture_output=True, text=True).stdout.replace(
                f"--local-directory {self.folder / 'worker 1'}", "")):
            self.assertLess(time.monotonic(), until, shown)
            time.sleep(0.2)

    def test_a_scheduler_that_is_not_there_or_goes(self):
        done = self.study("--scheduler", f"tcp://127.0.0.1:{free_port()}", code=2)
        self.assertRegex(done.stderr, r"^mortier: --scheduler tcp://\S+: no scheduler answers, expected "
                                      r"tcp://HOST:PORT of one\n$")
        self.assertFalse(self.out.exists())
        done = self.study("--scheduler", "no address", code=2)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.many(8)
        self.worker(self.program)
        process = self.begin()
        while "2/8" not in process.stdout.readline():
            self.assertIsNone(process.poll())
        self.end(self.scheduler)
        _, errors = process.communicate(timeout=HANGS)
        self.assertEqual(process.returncode, 1, errors)
        self.assertRegex(errors, r"^mortier: \S+: the scheduler at \S+ is gone\n$")
        kept = len(self.rows())
        self.assertGreaterEqual(kept, 2)
        self.assertIn(f"8 runs, {kept} of them done before", self.study().stdout)


if __name__ == "__main__":
    unittest.main()
