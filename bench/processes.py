#!/usr/bin/env python3
"""Time and memory of a run whose bodies are factorised in several processes (docs/scaling.md).

    bench/processes.py BUILD [SCENE [SETTING ...]]      prints a row each for mortier and 1, 2, 4 processes
"""
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SPACE = [str(ROOT / "scenes/cubes.toml"), "body.lower.mesh.cells=24", "body.upper.mesh.cells=22",
         "body.material.yield_stress=1e6", "time.steps=2"]
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OPENBLAS_NUM_THREADS": "1"}


def one(command):
    """Runs a command, and prints its largest memory and its processor time."""
    code = subprocess.run(command, check=False).returncode
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"used {used.ru_maxrss / 1024:.0f} {used.ru_utime + used.ru_stime:.2f}", flush=True)
    return code


def measured(start, program, arguments, folder):
    begin = time.monotonic()
    done = subprocess.run([*start, sys.executable, __file__, "--one", program, "run", *arguments, "--quiet",
                           "--out", folder], capture_output=True, text=True, env=ENVIRONMENT, check=False)
    if done.returncode != 0:
        raise SystemExit(done.stdout + done.stderr)
    used = [line.split()[1:] for line in done.stdout.splitlines() if line.startswith("used")]
    memory = sorted((int(each[0]) for each in used), reverse=True)
    return time.monotonic() - begin, memory


def main():
    if sys.argv[1] == "--one":
        return one(sys.argv[2:])
    build = Path(sys.argv[1]).resolve()
    scene, *settings = sys.argv[2:] or SPACE
    arguments = [scene, *(["--set", *settings] if settings else [])]
    print("| processes | wall time [s] | memory of each [MiB] |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for count in (0, 1, 2, 4):
            start = ["mpirun", "--oversubscribe", "--quiet", "-n", str(count)] if count else []
            program = build / ("mortier-mpi" if count else "mortier")
            seconds, memory = measured(start, program, arguments, f"{folder}/{count}")
            print(f"| {count or '`mortier`'} | {seconds:.1f} | {', '.join(map(str, memory))} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
