#!/usr/bin/python3
"""How long mortier takes to start: processor time of runs of a scene of 100 triangles, without their steps.

    bench/start.py [--rounds 40] [PROGRAM...]     default: build/mortier; several are run in turn

The least of all rounds counts: what a busy machine adds to a process is never negative. The steps are taken
away by runs of 10 and of 110 steps; what is left is the start, reading and checking the scene, and writing
the results.
"""
import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENE = """
[[body]]
name = "upper"
mesh = { shape = "rectangle", cells = [5, 4] }
material = { young = 2e11, poisson = 0.3 }
boundary = [{ label = 4, ux = 0 }, { label = 3, ty = "-1e6*t" }]
[[body]]
name = "lower"
mesh = { shape = "rectangle", cells = [6, 5], lower = [0, -1], upper = [1, 0] }
material = { young = 2e11, poisson = 0.3 }
boundary = [{ label = 4, ux = 0 }, { label = 1, uy = 0 }]
[contact]
sides = [{ body = "upper", label = 1 }, { body = "lower", label = 3 }]
[time]
end = 1
steps = 10
"""
MOST = 10  # [ms]


def milliseconds(command, folder):
    """Processor time of one process."""
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"start: {command}: exit code {process.returncode}")
    return 1e3 * (usage.ru_utime + usage.ru_stime)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("programs", nargs="*", default=[ROOT / "build" / "mortier"], metavar="PROGRAM")
    parser.add_argument("--rounds", type=int, default=40)
    given = parser.parse_args()
    programs = [Path(program).resolve() for program in given.programs]
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "scene.toml").write_text(SCENE)
        commands = {steps: ["run", "scene.toml", "--quiet", "--out", "out", "--set", f"time.steps={steps}"]
                    for steps in (10, 110)} | {"version": ["--version"]}
        least = {}
        for _ in range(given.rounds):
            for program in programs:
                for name, words in commands.items():
                    used = milliseconds([program, *words], folder)
                    least[program, name] = min(used, least.get((program, name), used))
    for program in programs:
        of_step = (least[program, 110] - least[program, 10]) / 100
        start = least[program, 10] - 10 * of_step
        print(f"{program}: run without its steps {start:.1f} ms (at most {MOST}: "
              f"{'met' if start <= MOST else 'NOT met'}), a step {of_step:.3f} ms, "
              f"--version {least[program, 'version']:.1f} ms")


if __name__ == "__main__":
    main()
