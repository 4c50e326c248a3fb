#!/usr/bin/env python3
"""Runs that get SIGINT, SIGTERM or SIGHUP at random moments: while they mesh, order, factorise, refine.

signals.py [--count N] [--seed N] [--case NAME ...] [--restarts SHARE]    ends with 1 if anything was found

Each run ends within one second of processor time after the signal, its own and that of its child processes,
with exit code 1 and one line, or with its result where that was complete. Nothing is left where the line says
so; a run that has a checkpoint goes on to the bytes of a run without signal.
"""
import argparse
import ctypes
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from scene_parts import body, box, contact, timed, written
from support import PROGRAM, ROOT, processor_time

MOST = 1.0  # seconds of processor time after the signal
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
NOTHING = "nothing was written"
MEASURED = ("summary.json", "manifest.json")  # hold times


def blocks(dimension, upper, lower, top, steps, material, more=""):
    """Two blocks of so many cells along an edge, pressed on each other."""
    space = dimension == 3
    base, roof = ("bottom", "top") if space else (1, 3)
    ends = [0] * dimension, [1] * dimension
    below = [*ends[0][1:], -1], [*ends[1][1:], 0]
    rollers = ('label = "left", ux = 0', 'label = "front", uy = 0') if space else ("label = 4, ux = 0",)
    return (("dimension = 3" if space else 'plane = "strain"') + "\ndegree = 2\n"
            + body("upper", box(*ends, upper), material, f"label = {written(roof)}, {top}", *rollers)
            + body("lower", box(*below, lower), material,
                   f"label = {written(base)}, ux = 0, uy = 0" + (", uz = 0" if space else ""))
            + contact(("upper", base), ("lower", roof), sides=True) + timed(steps) + more)


ELASTIC = "young = 100, poisson = 0.3"
FLOWING = "young = 100, poisson = 0.3, viscosity = 10, yield_stress = 0.3"


def shipped(name):
    """The text of a shipped scene, whose meshes are found from any folder."""
    return (ROOT / f"scenes/{name}.toml").read_text().replace("../shared-meshes", str(ROOT / "shared-meshes"))


def cases():
    """name -> scene, settings, seconds of processor time among which the moment of the signal is."""
    plane, space = 'uy = "-0.01*t"', 'uz = "-0.01*t"'
    waves, pushed = 'ty = "-t*(1 + 0.5*cos(3*x))"', 'tz = "-t*(1 + 0.5*cos(3*x))"'
    return {
        "rounds, plane": (shipped("punch"), ["accuracy.energy=0.02"], 3),
        "rounds, larger": (shipped("punch"), ["accuracy.energy=0.001"], 25),
        "rounds, curved": (shipped("hertz"), ["accuracy.energy=0.01"], 5),
        "rounds, flow": (blocks(2, 4, 5, waves, 3, FLOWING), ["accuracy.energy=0.008"], 3),
        "rounds, space": (blocks(3, 3, 4, pushed, 1, ELASTIC), ["accuracy.energy=0.005",
                                                                "accuracy.max_unknowns=300000"], 10),
        "rounds, bound": (blocks(2, 16, 20, waves, 1, ELASTIC), ["degree=1", "accuracy.energy=0.02",
                                                                  "accuracy.bound=true"], 0.2),
        "bound": (blocks(2, 100, 121, waves, 1, ELASTIC), ["degree=1", "accuracy.bound=true"], 1.2),
        "factors, plane": (blocks(2, 200, 221, plane, 2, ELASTIC), [], 5),
        "factors, space": (blocks(3, 14, 16, space, 2, ELASTIC), [], 8),
        "steps, plane": (blocks(2, 40, 51, waves, 20, FLOWING), [], 3),
        "steps, space": (blocks(3, 5, 6, pushed, 4, FLOWING), [], 3),
        "meshing, plane": (shipped("hook"), ["body.hook.mesh.parameters={f=0.01, h=0.02}"], 4),
        "meshing, space": (shipped("ball"), ["body.ball.mesh.parameters={f=0.01, h=0.06}"], 6),
        "two threads": (blocks(3, 12, 14, space, 2, ELASTIC), ["--threads", "2"], 5),
    }


class Signals:
    def __init__(self, folder, program=PROGRAM, latest=float("inf")):
        """latest: moment of a signal, in seconds of processor time"""
        self.folder, self.program, self.latest = Path(folder), program, latest
        self.findings, self.latencies, self.restarted = [], [], 0
        self.codes = {}  # of runs without a signal
        ctypes.CDLL(None).prctl(36, 1)  # PR_SET_CHILD_SUBREAPER: children of a run that has ended are ours

    def command(self, settings, out):
        options = settings[settings.index("--threads"):] if "--threads" in settings else []
        keys = settings[:len(settings) - len(options)]
        return [self.program, "run", "scene.toml", "--quiet", "--out", out, *options,
                *(["--set", *keys] if keys else [])]

    def start(self, command, folder):
        return subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                text=True, start_new_session=True)

    @staticmethod
    def end(process):
        """Waits for a run and its children: the processor time of all."""
        errors = process.stderr.read()
        process.stderr.close()
        used = 0.0
        while True:
            try:
                pid, status, usage = os.wait4(-1, 0)
            except ChildProcessError:
                return used, errors
            used += usage.ru_utime + usage.ru_stime
            if pid == process.pid:
                process.returncode = os.waitstatus_to_exitcode(status)

    def prepare(self, name):
        folder = self.folder / re.sub(r"\W+", "-", name)
        if not folder.exists():
            folder.mkdir()
            (folder / "scene.toml").write_text(cases()[name][0])
        return folder

    def whole(self, name):
        """The exit code of the run without a signal."""
        if name not in self.codes:
            process = self.start(self.command(cases()[name][1], "whole"), self.prepare(name))
            _, errors = self.end(process)
            self.codes[name] = process.returncode
            if not (self.prepare(name) / "whole/summary.json").exists():
                raise RuntimeError(f"{name}: {process.returncode} {errors}")
        return self.codes[name]

    def try_one(self, name, rng, restarts):
        folder, (_, settings, seconds) = self.prepare(name), cases()[name]
        moment, by = rng.uniform(0.02, min(seconds, self.latest)), rng.choice(SIGNALS)
        goes_on = rng.random() < restarts
        process = self.start(self.command(settings, "out"), folder)
        while (now := processor_time(process.pid)) < moment and not ended(process.pid):
            time.sleep(max(0.003, (moment - now) / 4))  # it has a few threads and children
        os.kill(process.pid, by)  # Popen's own would take what it used, where it has ended
        used, errors = self.end(process)
        place, latency = f"{name}: {by.name} after {now:.2f} s", used - now
        told = [line for line in errors.splitlines() if not line.startswith("mortier: warning: ")]
        faults = [f"ended {latency:.2f} s later"] if latency > MOST else []
        made = sorted(path.name for path in folder.glob("out*"))
        if made == ["out"]:
            if process.returncode not in (0, 1) or "interrupted" in errors:
                faults.append(f"a result, and exit code {process.returncode}: {errors[-500:]}")
        elif process.returncode != 1 or len(told) != 1 or "interrupted" not in told[0]:
            faults.append(f"exit code {process.returncode}: {errors[-500:]}")
        elif NOTHING in told[0]:
            faults += [f"left {made}"] if made else []
        elif not [*folder.glob("out.tmp-*/checkpoint")]:
            faults.append(f"no checkpoint in {made}: {told}")
        elif goes_on:
            code = self.whole(name)
            process = self.start([self.program, "run", "--restart", "out", "--quiet"], folder)
            _, errors = self.end(process)
            if process.returncode != code:
                faults.append(f"restarted: {process.returncode} {errors[-500:]}")
            faults += self.different(folder)
            self.restarted += 1
        for path in folder.glob("out*"):
            shutil.rmtree(path)
        self.latencies.append((latency, place, told[-1] if told else "complete"))
        if faults:
            self.findings.append(f"{place}\n  " + "\n  ".join(faults))
            print(self.findings[-1], flush=True)

    @staticmethod
    def different(folder):
        """What of a result is not as in the run without a signal."""
        names = sorted(path.name for path in (folder / "whole").iterdir())
        if not (folder / "out").is_dir():
            return ["no result"]
        if sorted(path.name for path in (folder / "out").iterdir()) != names:
            return ["not the same files"]
        return [f"{name} is another" for name in names if name not in MEASURED
                and (folder / "out" / name).read_bytes() != (folder / "whole" / name).read_bytes()]


def ended(pid):
    return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--case", action="append", help="only this one")
    parser.add_argument("--restarts", type=float, default=0.2, help="share of the stopped runs that go on")
    given = parser.parse_args()
    names = given.case or list(cases())
    with tempfile.TemporaryDirectory() as folder:
        signals, rng = Signals(folder), random.Random(given.seed)
        for number in range(given.count):
            signals.try_one(names[number % len(names)], rng, given.restarts)
            print("{:6.2f} s  {}  {}".format(*signals.latencies[-1]), flush=True)
    latencies = sorted(signals.latencies, reverse=True)
    print(f"{given.count} signals, {signals.restarted} restarts, {len(signals.findings)} findings: half "
          f"end within {latencies[len(latencies) // 2][0]:.2f} s, all within {latencies[0][0]:.2f} s of "
          "processor time")
    return 1 if signals.findings else 0


if __name__ == "__main__":
    sys.exit(main())
