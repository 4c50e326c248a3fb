#!/usr/bin/env python3
"""Every call to the file system of a study and of its runs fails once,
or its process is killed there (tests/faults).

study_call_sweep.py [--part K/N]    prints what was found, ends with 1 if anything was

After each fault: no file of others is lost or changed, rows that were measured and a page that was there are
still there, whole. After the next study in the same folder: all rows and pictures are in place, and nothing
else is left. Each study is a fork of this process, which has read all modules and draws no pictures, so that
thousands of studies take minutes.
"""
import argparse
import csv
import os
import shutil
import signal
import sys
import tempfile
from pathlib import Path

from call_sweep import CALLS, HOW
from forked_study import ForkedStudy
from scenes import TWO_BLOCKS
from support import mortier

# Of others in the study's folder; the second has the name of a picture.
OTHERS = {"notes.txt": "a", "a-size.svg": "b", "meshes/mine.mesh": "c", "runs/mine": "d",
          "mortier-work-x/deep/e": "e", "new": "f"}
STUDY = """scene = "scene.toml"
[mesh]
upper = {{ kind = "crisscross", cells = [1], lower = [0, 0], upper = [1, 1] }}
[[error]]
name = "{name}"
quantity = "von_mises_max"
exact = 10
[[sweep]]
time.steps = {steps}
"""


class StudySweep:
    def __init__(self, folder):
        self.folder, self.findings = Path(folder), []
        self.study = ForkedStudy(self.folder)
        base = self.folder / "base"
        base.mkdir()
        for name, lower, upper in (("upper", "0,0", "1,1"), ("lower", "0,-1", "1,0")):
            mortier("mesh", "crisscross", "--cells", "1", f"--lower={lower}", f"--upper={upper}",
                    f"{name}.mesh", cwd=base)
        (base / "scene.toml").write_text(TWO_BLOCKS)
        self.copy("base", "old", "c", [1])
        for name, text in OTHERS.items():
            (self.folder / "old/out/s" / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / "old/out/s" / name).write_text(text)
        self.copy("base", "half", "a", [1])
        self.cases = {"fresh": ("base", [1]), "over another study": ("old", [1]),
                      "gone on with": ("half", [1, 2])}

    def copy(self, name, to, *study):
        target = self.folder / to
        shutil.rmtree(target, ignore_errors=True)
        shutil.copytree(self.folder / name, target)
        if study:
            code, errors, _ = self.run(target, *study)
            assert code == 0, errors
        return target

    def run(self, folder, name, steps, **fault):
        """A study, with a fault: its exit code, what it told, the number of calls."""
        (folder / "study.toml").write_text(STUDY.format(name=name, steps=steps))
        code, errors, calls = self.study.run(folder, "study.toml", "out/s", **fault)
        return code, errors.decode(errors="replace"), calls

    def explore(self, part=1, of=1):
        number = tried = 0
        for name, (begin, steps) in self.cases.items():
            calls = self.run(self.copy(begin, "tried"), "a", steps)[2]
            for how in HOW:
                for at in range(1, calls + 1):
                    number += 1
                    if number % of == part % of:
                        tried += 1
                        self.try_one(name, begin, steps, how, at)
        return tried

    def try_one(self, name, begin, steps, how, at):
        folder = self.copy(begin, "tried")
        out = folder / "out/s"
        before = self.rows(out)
        code, told, _ = self.run(folder, "a", steps, at=at, how=how)
        faults = []
        if code not in (0, 1, 2, -signal.SIGKILL) or (code >= 0 and len(told.splitlines()) != (code != 0)):
            faults.append(f"code {code}: {told[:1000]}")
        if begin != "base":
            faults += self.lost(out, begin == "old")
            if begin == "half" and not set(before) <= set(self.rows(out)):
                faults.append("a row that was measured is gone")
            if not (out / "report.html").is_file() or not (out / "report.html").read_text().endswith(
                "</html>\n"):
                faults.append("the page is not whole")
        if code == 0:
            faults += self.not_whole(out, [])
        code, told_next, _ = self.run(folder, "a", steps)
        if code != 0:
            faults.append(f"next study: {code} {told_next}")
        else:
            faults += [f"after the next study: {each}" for each in
                       [*(self.lost(out, True) if begin == "old" else []), *self.not_whole(out, steps),
                        *self.left(folder, begin == "old")]]
        if faults:
            self.findings.append(f"study {name}, call {at}: {how}: {told.strip()}\n  " + "\n  ".join(faults))
            print(self.findings[-1], flush=True)

    @staticmethod
    def rows(out):
        """Of runs that have a result."""
        try:
            with open(out / "study.csv", newline="") as file:
                return {row["key"]: row for row in csv.DictReader(file) if row["status"] == "done"}
        except FileNotFoundError:
            return {}

    @staticmethod
    def lost(out, others):
        return [f"{name} of others is gone or changed" for name, text in OTHERS.items() if others and not any(
            path.is_file() and path.read_text() == text for path in (out / name, out / f"{name}.kept"))]

    def not_whole(self, out, steps):
        faults = [] if len(self.rows(out)) >= len(steps) else ["rows are missing"]
        if not (out / "report.html").is_file() or not (out / "report.html").read_text().endswith("</html>\n"):
            faults.append("no page")
        if not (out / "a-size.svg").is_file() or (out / "a-size.svg").read_bytes() != b"<svg/>":
            faults.append("no picture")
        return faults

    @staticmethod
    def left(folder, others):
        wanted = {"study.csv", "manifest.json", "report.html", "a-size.svg"}
        wanted |= {"a-size.svg.kept", *(name.split("/")[0] for name in OTHERS)} if others else set()
        inside = {path.name for path in (folder / "out/s").iterdir()}
        faults = [f"in the study's folder: {sorted(inside ^ wanted)}"] if inside != wanted else []
        if {path.name for path in folder.iterdir()} != {"out", "lower.mesh", "upper.mesh", "scene.toml",
                                                        "study.toml"}:
            faults.append("left in the current folder")
        return faults + (["left beside the study"] if len(list((folder / "out").iterdir())) != 1 else [])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--part", default="1/1", metavar="K/N", help="of all cases every N-th, from the K-th")
    part, of = map(int, parser.parse_args().part.split("/"))
    if "FAULT_FOLDER" not in os.environ:  # begins again, with calls that can fail
        os.execve(sys.executable, [sys.executable, *sys.argv],
                  {**os.environ, "LD_PRELOAD": CALLS, "FAULT_FOLDER": ""})
    with tempfile.TemporaryDirectory() as folder:
        sweep = StudySweep(folder)
        tried = sweep.explore(part, of)
    print(f"{tried} faults, {len(sweep.findings)} findings")
    return 1 if sweep.findings else 0


if __name__ == "__main__":
    sys.exit(main())
