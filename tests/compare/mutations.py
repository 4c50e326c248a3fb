#!/usr/bin/env python3
"""Hostile input: sound scenes and meshes with seeded faults, and what the program makes of them.

Whatever it is given, mortier must end by itself with exit code 0, 1, 2 or 3, say why in one line of printable
text, leave a whole result or none, and write no number that is not finite.

Usage: mutations.py [--count 1000] [--first 0] [--mortier build/mortier] [--seconds 60] [--patience 2]
Case N is the same on every machine: mutations.py --first N --count 1 --keep FOLDER shows it.
"""
import argparse
import collections
import csv
import json
import math
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import meshio
import numpy as np

from mutators import OF_MESHES, OF_SCENES
from scenes import BODY_KEYS, CONTACT_KEYS, TWO_BLOCKS
from shape_scenes import ONE_BODY, SPACE_KEYS


class Fault(Exception):
    """The program did what it must never do."""


class Cases:
    """Makes the cases, and tries them with a program."""

    def __init__(self, program, seconds, patience):
        self.program, self.seconds, self.patience = str(Path(program).resolve()), seconds, patience
        # A sanitizer's report gets an exit code of its own; its address space cannot be limited.
        self.environment = dict(os.environ, ASAN_OPTIONS="exitcode=99:detect_leaks=1",
                                UBSAN_OPTIONS="exitcode=99:print_stacktrace=1")
        self.codes = collections.Counter()
        self.meshes = {}
        self.checks = b"check" in subprocess.run([self.program, "--help"], capture_output=True).stdout.split()

    def mesh(self, folder, kind, cells, lower, upper):
        """The text of a sound mesh."""
        key = kind, cells, lower, upper
        if key not in self.meshes:
            subprocess.run([self.program, "mesh", kind, "--cells", cells, "--lower", lower, "--upper", upper,
                            "new.mesh"],
                           cwd=folder, check=True, stdout=subprocess.DEVNULL)
            self.meshes[key] = (folder / "new.mesh").read_bytes()
            (folder / "new.mesh").unlink()
        return self.meshes[key]

    def make(self, number, folder):
        """Writes case `number` into the folder. Returns the name of the file that is not sound."""
        rng = random.Random(number)
        scenes = [TWO_BLOCKS, CONTACT_KEYS, BODY_KEYS, ONE_BODY, SPACE_KEYS]
        files = {"scene.toml": rng.choice(scenes).encode()}
        kind = rng.choice(["rectangle", "crisscross"])
        for name, cells, lower, upper in (("upper.mesh", "2", "0,0", "1,1"),
                                          ("lower.mesh", "3,2", "0,-1", "1,0")):
            files[name] = self.mesh(folder, kind, cells, lower, upper)
        target = rng.choice(["scene.toml", "scene.toml", "upper.mesh", "lower.mesh"])
        mutations = OF_SCENES if target == "scene.toml" else OF_MESHES
        for _ in range(rng.choice([1, 1, 1, 2, 3])):
            files[target] = rng.choice(mutations)(files[target] or b"\n", rng)
        for name, text in files.items():
            (folder / name).write_bytes(text)
        return target

    def try_case(self, folder, target):
        if target != "scene.toml":
            self.run(folder, "mesh", "info", target)
        if self.checks:
            self.run(folder, "check", "scene.toml")
        code = self.run(folder, "run", "scene.toml", "--quiet", "--out", "out")
        left = sorted(path.name for path in folder.iterdir())
        expected = {0: ["out"], 1: ["out.failed"], 3: ["out.failed"]}.get(code, [])
        sound = [name for name in left if name not in ("scene.toml", "upper.mesh", "lower.mesh")]
        if sound not in ([], expected):
            raise Fault(f"exit code {code} and these files: {sound}")
        if code == 0 and not sound:
            raise Fault("exit code 0 and no result")
        for name in sound:
            require_whole(folder / name)
        self.codes[code] += 1
        return code

    def run(self, folder, *arguments):
        process = subprocess.Popen([self.program, *arguments], cwd=folder, env=self.environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        command, long = " ".join(arguments), False
        try:
            # A check has no steps, after which it could be interrupted.
            patience = self.seconds if arguments[0] == "check" else self.patience
            err = process.communicate(timeout=patience)[1]
        except subprocess.TimeoutExpired:
            # A scene may ask for 2^31 steps. It is no hang where each step ends:
            # the first one after Ctrl-C is the last.
            long = True
            process.send_signal(signal.SIGINT)
            try:
                err = process.communicate(timeout=self.seconds)[1]
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
                raise Fault(f"{command} hangs") from None
            # The last step may have ended before the signal came: then the result is examined below.
            if process.returncode not in (0, 1):
                raise Fault(f"{command} was interrupted: exit code {process.returncode}")
            if process.returncode == 1:
                for path in folder.glob("out*"):
                    shutil.rmtree(path)
        told = [line for line in err.split(b"\n") if line and not line.startswith(b"mortier: warning: ")]
        code = process.returncode
        if code not in (0, 1, 2, 3):
            raise Fault(f"{command}: exit code {code}\n{err.decode(errors='replace')[-4000:]}")
        is_check = arguments[0] == "check"
        if (len(told) != (0 if code == 0 else 1) and not is_check) or any(byte < 32 and byte != 10
                                                                          for byte in err):
            raise Fault(f"{command}: exit code {code}, expected one printable line, got {err!r}")
        if not long and code != 0 and not is_check and not err.endswith(b"\n"):
            raise Fault(f"{command}: a line without end: {err!r}")
        return code


def refuse(word):
    raise Fault(f"summary.json holds {word}")


def require_whole(folder):
    """A complete result, every number finite."""
    summary = json.loads((folder / "summary.json").read_text(), parse_constant=refuse)
    for table in ("history.csv", "contact.csv"):
        header, *rows = csv.reader((folder / table).read_text().splitlines())
        if any(len(row) != len(header) for row in rows):
            raise Fault(f"{table} has a row that is not whole")
        words = {word.lower() for row in rows for word in row}
        if words & {"nan", "-nan", "inf", "-inf"}:
            raise Fault(f"{table} holds a number that is not finite")
        if table == "history.csv" and [row for row in rows if row[0] == "0"]:
            rows = rows[1:]  # what acts at t = 0
        if table == "history.csv" and len(rows) != summary["steps"]:
            raise Fault(f"{len(rows)} rows for {summary['steps']} steps")
    for vtu in folder.glob("*.vtu"):
        mesh = meshio.read(vtu)
        for name, values in [*mesh.point_data.items(), *((name, v[0]) for name, v in mesh.cell_data.items())]:
            if not np.isfinite(np.asarray(values, dtype=float)).all():
                raise Fault(f"{vtu.name}: {name} is not finite")
    if not math.isfinite(summary["final"]["time"]):
        raise Fault("time is not finite")


def explore(program, first, count, seconds=60, patience=2, keep=None):
    """Tries cases; returns the faults as (number, text) and how often each exit code came."""
    cases, faults = Cases(program, seconds, patience), []
    for number in range(first, first + count):
        folder = Path(tempfile.mkdtemp(prefix=f"mutation-{number}-"))
        try:
            cases.try_case(folder, cases.make(number, folder))
        except Fault as fault:
            faults.append((number, str(fault)))
        finally:
            if keep:
                shutil.copytree(folder, Path(keep) / str(number), dirs_exist_ok=True)
            shutil.rmtree(folder)
    return faults, dict(sorted(cases.codes.items()))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mortier", default=os.environ.get("MORTIER", "build/mortier"))
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=60, help="time limit of one step")
    parser.add_argument("--patience", type=float, default=2, help="seconds after which a run is interrupted")
    parser.add_argument("--keep", help="folder to copy the cases to")
    options = parser.parse_args()
    faults, codes = explore(options.mortier, options.first, options.count, options.seconds,
                            options.patience, options.keep)
    for number, text in faults:
        print(f"case {number}: {text}")
    print(f"{options.count} cases, {len(faults)} faults; exit codes " +
          ", ".join(f"{code}: {times}" for code, times in codes.items()))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
