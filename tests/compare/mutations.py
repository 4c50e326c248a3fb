#!/usr/bin/env python3
"""Hostile input: sound scenes and meshes with seeded faults, and what the program makes of them.

Whatever it is given, mortier must end by itself with exit code 0, 1, 2 or 3, say why in one line of printable text,
leave a whole result or none, and write no number that is not finite.

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
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import meshio
import numpy as np

TWO_BLOCKS = """\
title = "two blocks"
[[body]]
name = "upper"
mesh = "upper.mesh"
material = { young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1, projection = "elasticity" }
[[body.boundary]]
label = 4
ux = 0
[[body.boundary]]
label = 3
ty = "-10*t"
[[body]]
name = "lower"
mesh = "lower.mesh"
material = { young = 3e11, poisson = 0.3 }
boundary = [ { label = 4, ux = 0 }, { label = 1, uy = 0 } ]
[contact]
nonmortar = { body = "upper", label = 1 }
mortar = { body = "lower", label = 3 }
[time]
end = 1
steps = 4
"""

EVERY_KEY = """\
title = "every key"
[[body]]
name = "upper"
mesh = "upper.mesh"
material = { young = 2e3, poisson = -0.2, viscosity = 50.5, yield_stress = 3 }
force = { x = "sin(pi*x)*t", y = -1 }
[[body.boundary]]
label = 3
ux = "t < 0.5 ? 0 : 1e-4*(t-0.5)"
uy = "-0.01*t"
[[body]]
name = "lower"
mesh = "lower.mesh"
material = { young = 1e4, poisson = 0.49, viscosity = 2, yield_stress = 1, projection = "compliance" }
[[body.boundary]]
label = 1
ux = 0
uy = 0
[[body.boundary]]
label = 2
tx = "exp(-y^2)*min(t, 0.3)"
[[contact]]
nonmortar = { body = "lower", label = 3 }
mortar = { body = "upper", label = 1 }
variant = "interpolation"
swap = true
[time]
end = 2.5
steps = 5
scheme = "sdirk2"
[solver]
tolerance = 1e-9
max_iterations = 200
linear = "suitesparse"
[output]
every = 2
"""

ONE_BODY = """\
[[body]]
name = "block"
mesh = "upper.mesh"
material = { young = 2.1e11, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = 0 }, { label = 3, ty = "-1e6*t" } ]
[time]
end = 1
steps = 2
"""

NUMBERS = ["nan", "inf", "-inf", "1e400", "-1e400", "1e308", "1e-320", "-0", "-0.0", "0", "-1", "0.5", "1e12", "2147483647",
           "2147483648", "-2147483649", "9223372036854775807", "99999999999999999999999", "1e9", "0x7fffffff", "1_000",
           "0.30000000000000004", "--3", "3e", "+", ".", "1979-05-27T07:32:00Z", "true", "\"7\"", "[1]", "{}"]
EXPRESSIONS = ["\"" + "(" * 3000 + "t" + ")" * 3000 + "\"", "\"" + "-" * 20000 + "t\"", "\"1/(t-0.5)\"", "\"sqrt(-t)\"",
               "\"0/0\"", "\"t,t\"", "\"t=1\"", "\"" + "sin(" * 500 + "t" + ")" * 500 + "\"", "\"x^9999\"", "\"\\u0000t\"",
               "\"\\u001b[31mt\"", "\"t ? t : \"", "\"" + "t?t:" * 2000 + "t\"", "\"" + "t+" * 50000 + "t\"", "\"\""]
NUMBER = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def flip_bytes(text, rng):
    data = bytearray(text)
    for _ in range(rng.choice([1, 1, 2, 8, 64])):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(data)


def truncate(text, rng):
    return text[:rng.randrange(len(text))]


def lines(change):
    def mutate(text, rng):
        rows = text.split(b"\n")
        change(rows, rng)
        return b"\n".join(rows)
    return mutate


def delete_line(rows, rng):
    begin = rng.randrange(len(rows))
    del rows[begin:begin + rng.choice([1, 1, 1, 2, 5])]


def repeat_line(rows, rng):
    row = rng.randrange(len(rows))
    rows.insert(rng.randrange(len(rows) + 1), rows[row])


def swap_lines(rows, rng):
    a, b = rng.randrange(len(rows)), rng.randrange(len(rows))
    rows[a], rows[b] = rows[b], rows[a]


def replace_number(text, rng):
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    at = rng.choice(found)
    return text[:at.start()] + rng.choice(NUMBERS).encode() + text[at.end():]


def scale_number(text, rng):
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    at = rng.choice(found)
    value = float(at.group()) * rng.choice([-1, 1e-9, 1e-3, 0.5, 1.1, 2, 1e3, 1e9, 1e150])
    return text[:at.start()] + repr(value).encode() + text[at.end():]


def swap_tokens(text, rng):
    found = list(re.finditer(rb"[^\s=,{}\[\]]+", text))
    if len(found) < 2:
        return text
    a, b = sorted(rng.sample(found, 2), key=lambda token: token.start())
    return text[:a.start()] + b.group() + text[a.end():b.start()] + a.group() + text[b.end():]


def binary(text, rng):
    begin = rng.randrange(len(text))
    return text[:begin] + rng.randbytes(rng.choice([1, 16, 400])) + text[begin + rng.choice([0, 16]):]


def noise(text, rng):
    return rng.randbytes(rng.choice([0, 1, 100, 5000]))


def nest(text, rng):
    depth = rng.choice([50, 1000, 100000])
    return text + rng.choice([b"\na = " + b"[" * depth, b"\na = " + b"{a=" * depth, b"\n[" + b"a." * depth + b"a]\n",
                              b"\na." + b"a." * depth + b"a = 1\n", b"\n" + b"[" * depth + b"\n"])


def replace_expression(text, rng):
    rows = [m for m in re.finditer(rb"(?:[ut][xy]|[xy]) = (\"[^\"\n]*\"|[-0-9.e]+)", text)]
    if not rows:
        return text
    at = rng.choice(rows)
    return text[:at.start(1)] + rng.choice(EXPRESSIONS).encode() + text[at.end(1):]


def endings(text, rng):
    return text.replace(b"\n", rng.choice([b"\r\n", b"\r", b"\x00\n", b" ", b"\n\n"]))


GENERAL = [flip_bytes, truncate, lines(delete_line), lines(repeat_line), lines(swap_lines), replace_number, replace_number,
           scale_number, scale_number, swap_tokens, swap_tokens, binary, noise, endings]
OF_SCENES = GENERAL + [nest, replace_expression, replace_expression]


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
            subprocess.run([self.program, "mesh", kind, "--cells", cells, "--lower", lower, "--upper", upper, "new.mesh"],
                           cwd=folder, check=True, stdout=subprocess.DEVNULL)
            self.meshes[key] = (folder / "new.mesh").read_bytes()
            (folder / "new.mesh").unlink()
        return self.meshes[key]

    def make(self, number, folder):
        """Writes case `number` into the folder. Returns the name of the file that is not sound."""
        rng = random.Random(number)
        files = {"scene.toml": rng.choice([TWO_BLOCKS, TWO_BLOCKS, EVERY_KEY, ONE_BODY]).encode()}
        kind = rng.choice(["rectangle", "crisscross"])
        for name, cells, lower, upper in (("upper.mesh", "2", "0,0", "1,1"), ("lower.mesh", "3,2", "0,-1", "1,0")):
            files[name] = self.mesh(folder, kind, cells, lower, upper)
        target = rng.choice(["scene.toml", "scene.toml", "upper.mesh", "lower.mesh"])
        mutations = OF_SCENES if target == "scene.toml" else GENERAL
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
        process = subprocess.Popen([self.program, *arguments], cwd=folder, env=self.environment, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        command, long = " ".join(arguments), False
        try:
            err = process.communicate(timeout=self.patience)[1]
        except subprocess.TimeoutExpired:
            # A scene may ask for 2^31 steps. It is no hang where each step ends: the first one after Ctrl-C is the last.
            long = True
            process.send_signal(signal.SIGINT)
            try:
                err = process.communicate(timeout=self.seconds)[1]
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
                raise Fault(f"{command} hangs") from None
            if process.returncode != 1:
                raise Fault(f"{command} was interrupted: exit code {process.returncode}")
            for path in folder.glob("out*"):
                shutil.rmtree(path)
        told = [line for line in err.split(b"\n") if line and not line.startswith(b"mortier: warning: ")]
        code = process.returncode
        if code not in (0, 1, 2, 3):
            raise Fault(f"{command}: exit code {code}\n{err.decode(errors='replace')[-4000:]}")
        is_check = arguments[0] == "check"
        if (len(told) != (0 if code == 0 else 1) and not is_check) or any(byte < 32 and byte != 10 for byte in err):
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
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
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
