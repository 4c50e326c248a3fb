#!/usr/bin/python3
"""A loop over runs of the note's test with N = 10, each with another load: over the program, a process and a
folder of files each, and in one process with `import mortier`. Both in turns, so that both meet the same
machine; the numbers must be the same.

    PYTHONPATH=build/python bench/python_loop.py [--runs 50]
"""
import argparse
import csv
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SCENE = ROOT / "scenes" / "compression.toml"


def over_the_program(program, load, folder):
    out = Path(folder) / "out"
    subprocess.run([program, "run", SCENE, "--quiet", "--out", out, "--set", "time.steps=10",
                    f"body.upper.boundary.3.ty={load}"], check=True, stderr=subprocess.DEVNULL)
    with open(out / "history.csv", encoding="utf-8") as file:
        return float(list(csv.DictReader(file))[-1]["contact_force[N/m]"])


def in_one_process(load):
    import mortier  # --help does without
    scene = mortier.load(SCENE, set={"time.steps": 10, "body.upper.boundary.3.ty": load})
    return scene.run().history["contact_force"][-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=50)
    parser.add_argument("--program", default=ROOT / "build" / "mortier")
    given = parser.parse_args()
    seconds = {"program": [], "python": []}
    with tempfile.TemporaryDirectory() as folder:
        for i in range(given.runs):
            load, forces = f"-{5 + i / 10}*t", []
            for name, work in (("program", lambda: over_the_program(given.program, load, folder)),
                               ("python", lambda: in_one_process(load))):
                begin = time.perf_counter()
                forces.append(work())
                seconds[name].append(time.perf_counter() - begin)
            if forces[0] != forces[1]:
                sys.exit(f"load {load}: {forces[0]!r} and {forces[1]!r}")
    for name, each in seconds.items():
        print(f"{name:8} {1e3 * sum(each) / len(each):8.2f} ms a run, median "
              f"{1e3 * sorted(each)[len(each) // 2]:.2f} ms")
    means, medians = [[of(seconds[name]) for name in ("program", "python")]
                      for of in (sum, lambda each: sorted(each)[len(each) // 2])]
    print(f"ratio    {means[0] / means[1]:.1f} of the sums, {medians[0] / medians[1]:.1f} of the medians")


if __name__ == "__main__":
    main()
