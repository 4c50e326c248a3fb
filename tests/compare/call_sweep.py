#!/usr/bin/env python3
"""Every call to the file system of a run or a restart fails once,
or the process is killed there (tests/faults).

call_sweep.py [--part K/N] [--mortier PROGRAM] [--calls failing_calls.so]

Prints what was found, ends with 1 if anything was.

After each fault: no file of others is lost or changed, and the result is whole, the old one or the new one.
After the next command for the same folder: the new result is in place, with every file of others, and nothing
else is left. That command is run once for all faults that leave the same files.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from scenes import TWO_BLOCKS
from support import PROGRAM, ROOT

CALLS = str(Path(os.environ.get("FAILING_CALLS", ROOT / "build/tests/libfailing-calls.so")).resolve())
HOW = ("kill", "ENOSPC", "EIO", "EACCES", "all-ENOSPC")
RUN = ["run", "scene.toml", "--quiet", "--out", "out/r", "--checkpoint", "0", "--set", "output.every=1"]
FAILS = [*RUN, "solver.max_iterations=1", "solver.tolerance=1e-30"]
RESTART = ["run", "--restart", "out/r", "--quiet", "--checkpoint", "0"]
# Of others; what stands in out/r may move with the result.
INSIDE = {"notes.txt": "a", "mine.vtu": "b", "checkpoint.txt": "c", "other_000001.vtu": "d", "sub/deep": "e"}
BESIDE = {"r.tmp-2024/summary.json": "f", "r.failed.txt": "g", "r.tmp-1": "h", "r.mortier-7/x": "i",
          "rr/history.csv": "j"}


class Sweep:
    def __init__(self, folder, program=PROGRAM, calls=CALLS):
        self.folder, self.program, self.calls = Path(folder), program, calls
        self.findings = []
        self.seen = set()  # what was left, and what comes after it
        self.others = False  # whether there are files of others, and an old result
        base = self.folder / "base"
        base.mkdir()
        self.run(base, ["mesh", "crisscross", "--cells", "3", "upper.mesh"])
        self.run(base, ["mesh", "crisscross", "--cells", "4,2", "--lower", "0,-1", "--upper", "1,0",
                        "lower.mesh"])
        (base / "scene.toml").write_text(TWO_BLOCKS)
        self.copy("base", "whole", RUN)
        self.copy("base", "old", [*RUN, "time.steps=2"])
        for name, text in INSIDE.items():
            self.put(self.folder / "old/out/r" / name, text)
        for name, text in BESIDE.items():
            self.put(self.folder / "old/out" / name, text)
        self.copy("old", "failed", FAILS)
        for name in ("base", "old"):
            middle = self.count(self.copy(name, "counted"), RUN) // 2
            while not list(self.fresh_stopped(name, middle).glob("out/r.tmp-*/checkpoint")):
                middle += 5
        # what is begun, its command, the one after it
        self.cases = {"fresh": ("base", RUN, RUN), "over an old result": ("old", RUN, RUN),
                      "after a failed run": ("failed", RUN, RUN), "that fails": ("old", FAILS, RUN),
                      "restart": ("base-stopped", RESTART, RESTART),
                      "restart over an old result": ("old-stopped", RESTART, RESTART),
                      "anew instead of a restart": ("old-stopped", RUN, RUN)}

    def fresh_stopped(self, name, at):
        stopped = self.copy(name, f"{name}-stopped")
        self.run(stopped, RUN, FAULT_AT=at, FAULT_HOW="kill")
        return stopped

    @staticmethod
    def put(path, text):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def copy(self, name, to, *commands):
        target = self.folder / to
        shutil.rmtree(target, ignore_errors=True)
        shutil.copytree(self.folder / name, target)
        for command in commands:
            self.run(target, command)
        return target

    def run(self, folder, command, **faults):
        environment = {**os.environ, **{key: str(value) for key, value in faults.items()},
                       "ASAN_OPTIONS": "verify_asan_link_order=0:detect_leaks=0"}
        environment["LD_PRELOAD"] = self.calls
        try:
            return subprocess.run([self.program, *command], cwd=folder, env=environment, capture_output=True,
                                  text=True, errors="replace", timeout=120)
        except subprocess.TimeoutExpired:
            return subprocess.CompletedProcess(command, 124, "", "does not end")

    def count(self, folder, command):
        return int(self.run(folder, command, FAULT_COUNT=2).stderr.split()[-1])

    def explore(self, part=1, of=1):
        """Cases part, part + of, ...: how many there were."""
        number = tried = 0
        for name, (begin, command, after) in self.cases.items():
            calls = self.count(self.copy(begin, "counted"), command)
            for how in HOW:
                for at in range(1, calls + 1):
                    number += 1
                    if number % of == part % of:
                        tried += 1
                        self.try_one(name, begin, command, after, how, at)
        return tried

    def try_one(self, name, begin, command, after, how, at):
        folder = self.copy(begin, "tried")
        done = self.run(folder, command, FAULT_AT=at, FAULT_HOW=how)
        place = f"run {name}, call {at}: {how}"
        self.others = not begin.startswith("base")
        faults = [*self.lost(folder), *self.ended(done),
                  *(self.not_whole(folder / "out/r") if self.others else [])]
        if done.returncode == 0:
            faults += self.not_new(folder)
        left = (tuple(after), self.state(folder))
        if not faults and left in self.seen:
            return done
        next_ = self.run(folder, after)
        # A restart finds nothing to go on with where the result is complete already,
        # or where no step had been kept.
        if (next_.returncode == 2 and after == RESTART and "no stopped run" in next_.stderr
                and not self.not_new(folder)):
            pass
        elif next_.returncode != 0:
            faults.append(f"next command: {next_.returncode} {next_.stderr}")
        faults += [f"after the next command: {each}" for each in
                   [*self.lost(folder), *self.not_whole(folder / "out/r"), *self.not_new(folder),
                    *self.left(folder)]]
        if not faults:
            self.seen.add(left)
        else:
            self.findings.append(f"{place}: {done.returncode} {done.stderr.strip()}\n  "
                                 + "\n  ".join(faults))
            print(self.findings[-1], flush=True)
        return done

    def state(self, folder):
        """All files: names without numbers of processes, sizes, contents without what is measured."""
        files = []
        for path in sorted(folder.rglob("*")):
            measured = re.search("summary|manifest|checkpoint", path.name)
            content = None if path.is_dir() else len(path.read_bytes()) if measured else path.read_bytes()
            files.append((re.sub(r"-\d+", "-", str(path.relative_to(folder))), content))
        manifests = tuple(not self.not_whole(path) for path in sorted(folder.glob("out/*")))
        return hash((tuple(files), manifests))

    @staticmethod
    def ended(done):
        if done.returncode == -9:
            return []
        lines = [line for line in done.stderr.splitlines() if "warning" not in line]
        return [] if done.returncode in (0, 1, 2) and len(lines) == (done.returncode != 0) else [
            f"code {done.returncode}, {len(lines)} lines: {done.stderr[:400]}"]

    def lost(self, folder):
        """Files of others that are not where they were, or in the result."""
        if not self.others:
            return []
        faults = [f"{name} of others is gone or changed" for name, text in BESIDE.items()
                  if not (folder / "out" / name).is_file() or (folder / "out" / name).read_text() != text]
        for name, text in INSIDE.items():
            found = [path for path in folder.glob(f"out/*/{name}") if path.read_text() == text]
            if len(found) != 1:
                faults.append(f"{name} of others was found {len(found)} times")
        return faults

    @staticmethod
    def not_whole(result):
        try:
            manifest = json.loads((result / "manifest.json").read_text())
            return [f"{name} is not what the manifest says" for name, entry in manifest["files"].items()
                    if (result / name).stat().st_size != entry["bytes"]
                    or fnv1a((result / name).read_bytes()) != entry["fnv1a"]]
        except (OSError, ValueError, KeyError) as error:
            return [f"no whole result: {error}"]

    def not_new(self, folder):
        for name in ("history.csv", "contact.csv", "upper_000003.vtu", "fields.pvd"):
            path = folder / "out/r" / name
            if not path.is_file() or path.read_bytes() != (self.folder / "whole/out/r" / name).read_bytes():
                return [f"{name} is not that of the whole run"]
        return []

    def left(self, folder):
        allowed = {path.split("/")[0] for path in BESIDE} if self.others else set()
        names = {path.name for path in (folder / "out").iterdir()} - allowed
        faults = [f"left beside the result: {sorted(names - {'r'})}"] if names != {"r"} else []
        inside = {path.name for path in (folder / "out/r").iterdir()}
        more = inside - {path.name for path in (self.folder / "whole/out/r").iterdir()}
        more -= {name.split("/")[0] for name in INSIDE} if self.others else set()
        if more:
            faults.append(f"left in the result: {sorted(more)}")
        if {path.name for path in folder.iterdir()} != {"out", "lower.mesh", "upper.mesh", "scene.toml"}:
            faults.append("left in the current folder")
        return faults


def fnv1a(data):
    hash_ = 14695981039346656037
    for byte in data:
        hash_ = (hash_ ^ byte) * 1099511628211 & 0xffffffffffffffff
    return f"{hash_:016x}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--part", default="1/1", metavar="K/N", help="of all cases every N-th, from the K-th")
    parser.add_argument("--mortier", default=PROGRAM)
    parser.add_argument("--calls", default=CALLS)
    given = parser.parse_args()
    part, of = map(int, given.part.split("/"))
    with tempfile.TemporaryDirectory() as folder:
        sweep = Sweep(folder, given.mortier, given.calls)
        tried = sweep.explore(part, of)
    print(f"{tried} faults, {len(sweep.findings)} findings")
    return 1 if sweep.findings else 0


if __name__ == "__main__":
    sys.exit(main())
