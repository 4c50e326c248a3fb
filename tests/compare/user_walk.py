#!/usr/bin/env python3
"""All commands on each of a number of random scenes of users (user_scenes.py): check, law, run, run --restart
of a run that was killed, compare with FreeFEM, the FreeFEM script in FreeFEM, study, plot, report and Python.

Each has to be done, or refused: then in the words that `mortier check` gave before the run. Anything else is
a finding: another exit code, a traceback, a difference, a script that FreeFEM cannot run, a refusal that
comes late.

    tests/compare/user_walk.py [--count 60] [--first SEED] [--space] [--jobs N] [--mortier PROGRAM]
"""
import collections
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

from contact_support import command, meshed, new_folder
from user_scenes import UserScene, UserSpaceScene

FREEFEM = os.environ.get("FREEFEM", "FreeFem++-nw")
PATIENCE = 120  # seconds of a command
STUDY = """\
scene = "scene.toml"
[[error]]
quantity = "displacement"
[reference]
steps = 4
[[sweep]]
steps = [1, 2]
"""
PYTHON = """\
import json, sys
import mortier
assert isinstance(mortier.check("scene.toml"), list)
try:
    run = mortier.load("scene.toml").run()
except mortier.Error as error:
    print(json.dumps({"code": error.exit_code, "told": str(error)}))
    sys.exit()
print(json.dumps({"code": 0, "final": run.summary["final"]}))
for kind in ("fields", "contact", "history"):
    try:
        run.plot(kind)
    except mortier.InputError as error:
        assert "nothing to draw" in str(error), error
repr(run), run._repr_html_(), run.to_meshio()
"""


class Walk:
    """One scene through all commands: `ways` is command -> done, refused or failed; `findings` says of what
    failed why."""

    def __init__(self, program, folder, scene):
        self.program, self.folder, self.scene = program, folder, scene
        self.ways, self.findings = {}, []
        (folder / "scene.toml").write_text("\n".join(scene.text) + "\n")
        (folder / "study.toml").write_text(
            STUDY.replace("displacement", "von_mises_max") if scene.plane == "space" else STUDY)
        for name, text in {**scene.files, **meshed(program, scene.meshes)}.items():
            (folder / name).write_text(text)

    def call(self, command, **options):
        environment = {**os.environ, "MORTIER": self.program, "PYTHONPATH": str(
            Path(self.program).parent / "python"), "MPLBACKEND": "agg"}
        try:
            return subprocess.run([str(word) for word in command], cwd=self.folder, env=environment,
                                  text=True, capture_output=True, errors="replace",
                                  timeout=PATIENCE, **options)
        except subprocess.TimeoutExpired:
            return subprocess.CompletedProcess(command, "too long", "", "")

    def mortier(self, *words):
        return self.call([self.program, *words])

    def told(self, done):
        return [line for line in done.stderr.splitlines() if not line.startswith("mortier: warning: ")]

    def fail(self, way, why):
        self.ways[way] = "failed"
        self.findings.append(f"{way}: {why}")

    def judge(self, way, done, codes=(0,)):
        """Done, refused as `check` had said, or failed."""
        told = self.told(done)
        if "Traceback" in done.stderr + done.stdout or "please report" in done.stderr:
            self.fail(way, " ".join(told[-3:]))
        elif done.returncode in codes:
            self.ways[way] = "done"
        elif done.returncode in (1, 2, 3) and len(told) == 1 and self.foretold(told[0]):
            self.ways[way] = "refused"
        else:
            self.fail(way, f"exit code {done.returncode}, {' '.join(told)[:300] or done.stdout[-300:]}")
        return self.ways[way] == "done"

    def foretold(self, line):
        return self.wrong or any(words in line for words in self.before)

    def go(self):
        self.check()
        self.judge("law", self.mortier("law", "scene.toml"), (0,))
        ran = self.mortier("run", "scene.toml", "--quiet", "--out", "out", "--threads", "1")
        # A step that cannot be solved, or an accuracy that is not reached: the run says so, one line.
        reached = self.judge("run", ran, (0,))
        self.python(ran)
        self.judge("study", self.mortier("study", "study.toml", "--quiet", "--jobs", "1", "--out", "studied"))
        self.study_rows(reached)
        self.freefem(reached)
        if not reached:
            return
        self.summary = json.loads((self.folder / "out" / "summary.json").read_text())
        self.bounds()
        self.restart()
        self.judge("plot", self.mortier("plot", "out"))
        self.judge("report", self.mortier("report", "out"))

    def check(self):
        done = self.mortier("check", "scene.toml", "--json")
        self.before = []
        if done.returncode not in (0, 2, 3) or done.stderr:
            return self.fail("check", f"exit code {done.returncode}, {done.stderr[-300:]}")
        self.checked = json.loads(done.stdout)
        self.before = [fault["message"] for fault in self.checked["faults"] if fault["severity"] != "warning"]
        self.wrong = done.returncode == 2  # what goes on without a part of the scene may refuse another one
        self.before += [item["why"] for item in self.checked["plan"] if not item["modelled"]]
        self.ways["check"] = "done"

    def bounds(self):
        """A bound that there is not: `check` has said why."""
        if "bound" not in self.scene.accuracy:
            return
        bound = self.summary["accuracy"].get("bound") or {}
        parts = [bound, *(each for each in bound.values() if isinstance(each, dict))]
        reasons = [part["reason"] for part in parts if part.get("reason")]
        if not reasons:
            self.ways["bound"] = "done"
        elif all(self.foretold(why) for why in reasons):
            self.ways["bound"] = "refused"
        else:
            self.fail("bound", f"not foretold: {reasons}")

    def python(self, ran):
        done = self.call([sys.executable, "-c", PYTHON])
        if done.returncode or "Traceback" in done.stderr or "Warning" in done.stderr:
            return self.fail("python", done.stderr.strip()[-300:])
        told = json.loads(done.stdout.splitlines()[-1])
        if told["code"] != ran.returncode:
            return self.fail("python", f"ends with {told}, the program with {ran.returncode}")
        if told["code"] == 0 and told["final"] != json.loads(
                (self.folder / "out" / "summary.json").read_text())["final"]:
            return self.fail("python", "other numbers than the program's")
        self.ways["python"] = "done"

    def study_rows(self, reached):
        rows = self.folder / "studied" / "study.csv"
        lines = rows.read_text().splitlines() if rows.is_file() else []
        failed = [line for line in lines if ",failed," in line]
        if failed and reached and "error" not in self.scene.scheme:
            self.fail("study", failed[0][-300:])
        elif self.ways["study"] == "failed" and failed and not reached:
            self.findings.pop()  # as the run
            self.ways["study"] = "refused"

    def freefem(self, reached):
        steps = ["--steps-of", "out"] if "error" in self.scene.scheme and reached else []
        done = self.mortier("freefem", "scene.toml", "script.edp", *steps)
        if self.judge("freefem", done):
            ran = self.call([FREEFEM, "-nw", "-nw", "-ne", "-v", "0", "script.edp", "-quiet", "-out",
                             "theirs"])
            if ran.returncode and reached:
                words = [line for line in ran.stdout.splitlines() if line.strip()]
                self.fail("freefem", f"the script ends with {ran.returncode}: {' '.join(words[-4:])[-300:]}")
        done = self.mortier("compare", "scene.toml")
        if done.returncode == 1 and "<-- beyond" in done.stdout:
            worst = [line for line in done.stdout.splitlines() if "beyond" in line]
            self.fail("compare", f"differs: {re.sub(' +', ' ', worst[0])}")
        elif reached or done.returncode == 2:
            self.judge("compare", done)

    def restart(self):
        """A run that was killed goes on to the same numbers."""
        command = [self.program, "run", "scene.toml", "--quiet", "--threads", "1", "--checkpoint", "0",
                   "--out", "again"]
        for _ in range(8):
            process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            deadline = time.perf_counter() + 10
            while process.poll() is None and time.perf_counter() < deadline:
                if list(self.folder.glob("again.tmp-*/checkpoint")):
                    process.send_signal(signal.SIGKILL)
                time.sleep(0.001)
            if process.wait() == -signal.SIGKILL and list(
                    self.folder.glob("again.tmp-*/checkpoint")):
                break
        else:
            return  # faster than it could be killed
        done = self.mortier("run", "--restart", "again", "--quiet", "--threads", "1")
        if self.judge("restart", done):
            finals = [json.loads((self.folder / name / "summary.json").read_text())["final"]
                      for name in ("out", "again")]
            if finals[0] != finals[1]:
                self.fail("restart", "other numbers")


def walk(program, seed, scenes=UserScene):
    with new_folder() as folder:
        each = Walk(program, folder.resolve(), scenes(seed))
        each.go()
        return each


def examined(program, seed, space=False):
    each = walk(program, seed, UserSpaceScene if space else UserScene)
    return each.scene.geometry, each.findings, each.ways


def tabulate(walks):
    count = collections.Counter(each for ways in walks for each in ways.items())
    print(f"{'':10}{'done':>9}{'refused':>9}{'failed':>9}")
    for way in dict.fromkeys(way for way, _ in count):
        print(f"{way:10}" + "".join(f"{count[way, how]:9}" for how in ("done", "refused", "failed")))


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, 60, told=tabulate, space="scenes in space"))
