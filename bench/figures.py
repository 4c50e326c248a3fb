#!/usr/bin/python3
"""Every figure of docs/benchmarks.md beside its target, in one table.

    bench/figures.py                    # about ten minutes on a quiet machine with 10 GB of memory
    bench/figures.py --no-million       # without 1e6 triangles: about three minutes, 2 GB

--cpu takes processor time, all that is left to trust on a machine that others use. --rounds N changes the
five measurements whose median counts; FreeFEM, where it is installed, is measured once.
"""
import argparse
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "compare"))
import codes  # noqa: E402

# Note's test, N = 100: seconds of the whole process, and how many times faster than the FreeFEM script.
NOTE = [("mortar", "elasticity", 0.08, 70), ("interpolation", "elasticity", 0.25, 25),
        ("mortar", "frobenius", 0.07, 80), ("interpolation", "frobenius", 0.15, 40)]


def row(name, value, target, at_least=False):
    met = value >= target if at_least else value <= target
    print(f"{name:<58} {'':>9} {value:9.3f} {'>=' if at_least else '<=':>4} {target:6.3g}   "
          f"{'met' if met else 'NOT met'}", flush=True)


def children_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def seconds_of(work, cpu):
    clock = children_seconds if cpu else time.perf_counter
    begin = clock()
    work()
    return clock() - begin


def note_test(folder, rounds, cpu):
    for variant, projection, target, times in NOTE:
        settings = ["--set", f"contact.variant={variant}", f"body.material.projection={projection}"]
        run = [codes.MORTIER, "run", codes.COMPRESSION, "--quiet", "--out", folder / "run", *settings]
        seconds = statistics.median(seconds_of(lambda: codes.call(run), cpu) for _ in range(rounds))
        row(f"1  note's test, whole process [s], {variant}, {projection}", seconds, target)
        if shutil.which(codes.FREEFEM):
            freefem = seconds_of(lambda: codes.run_freefem(folder / "freefem", settings[1:]), cpu)
            row(f"1  FreeFEM over it, {variant}, {projection}", freefem / seconds, times, at_least=True)


def output_of_every_step(folder, rounds, cpu):
    steps = 20
    settings = [f"time.steps={steps}", f"time.end={steps * 0.01}"]
    for body, cells, y in (("upper", 91, 0), ("lower", 129, -1)):
        mesh = folder / f"{body}.mesh"
        codes.call([codes.MORTIER, "mesh", "crisscross", "--cells", cells, "--lower", f"0,{y}", "--upper",
                    f"1,{y + 1}", mesh])
        settings.append(f"body.{body}.mesh={mesh}")
    for projection in ("frobenius", "elasticity"):
        seconds = {0: [], 1: []}
        for _ in range(max(1, rounds // 2)):
            for every in seconds:
                run = [codes.MORTIER, "run", codes.COMPRESSION, "--quiet", "--out", folder / "run", "--set",
                       *settings, f"body.material.projection={projection}", f"output.every={every}"]
                seconds[every].append(seconds_of(lambda: codes.call(run), cpu))
        share = statistics.median(seconds[1]) / statistics.median(seconds[0]) - 1
        row(f"10 output of every step over the run, 1e5, {projection}", share, 0.15)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--no-million", action="store_true")
    parser.add_argument("--cpu", action="store_true")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    bench = Path(codes.MORTIER).resolve().parent / "bench"
    common = ["--rounds", str(options.rounds)] + (["--cpu"] if options.cpu else [])
    million = [] if options.no_million else ["--million"]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        note_test(folder, options.rounds, options.cpu)
        subprocess.run([bench / "bench_iteration", *million, *common], check=True)
        subprocess.run([bench / "bench_separation", *common], check=True)
        output_of_every_step(folder, options.rounds, options.cpu)


if __name__ == "__main__":
    main()
