#!/usr/bin/env python3
"""Scenes whose every string is hostile, through run, check, freefem (FreeFEM reads what is written) and study.

hostile_sweep.py [--count N] [--seed N] [--studies N]    prints what was found, ends with 1 if anything was

Every exit code is a documented one, every message short lines of visible UTF-8; no command in a string is run and no file
is written outside of what was asked for.
"""
import argparse
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

from scenes import TWO_BLOCKS
from support import PROGRAM

PIECES = ['"', "'", "\\", "\n", "\r", "\t", "\0", "\x1b[2J", "\x7f", "\x0b", "\u0085", "\u2028", "\u202e", "\ufeff", "//", "/*", "*/",
          "#", "$", "`touch ran`", "$(touch ran)", ";", '");exec("touch ran");//', "\nexec(\"touch ran\");//", "\rexec(\"touch ran\");//",
          'include "ran"', "<script>fetch('ran')</script>", "<img src=x onerror=alert(1)>", "&amp;", "]]>", "$\\frac{1}$", "%s%n", "{}",
          "../ran", "/tmp/ran", "--out", "-", "=", "a", "é", "日本", "𝄞", "e\u0301", "x" * 300, " ", "0", "macro ran() exec("]
WORDS = {"title": '"two blocks"', "body": '"upper"', "mesh": '"upper.mesh"', "load": '"-10*t"', "projection": '"elasticity"',
         "key": "poisson = 0.3, v"}


def toml(text):
    escapes = {'"': '\\"', "\\": "\\\\"}
    return '"' + "".join(escapes.get(c, c if c.isprintable() else f"\\U{ord(c):08x}") for c in text) + '"'


class Sweep:
    def __init__(self, folder, program):
        self.folder, self.program = Path(folder) / "in", program
        self.folder.mkdir()
        self.codes, self.findings = Counter(), []
        self.run("mesh", "crisscross", "--cells", "2", "upper.mesh")
        self.run("mesh", "crisscross", "--cells", "3,2", "--lower", "0,-1", "--upper", "1,0", "lower.mesh")
        self.freefem = shutil.which("FreeFem++-nw")
        self.begun = self.listing()

    def run(self, *arguments):
        return subprocess.run([self.program, *arguments], cwd=self.folder, capture_output=True, timeout=300)

    def listing(self):
        return {str(path.relative_to(self.folder.parent)) for path in self.folder.parent.rglob("*")}

    def tell(self, what, seed, scene):
        self.findings.append(what)
        print(f"seed {seed}: {what}\n{scene!r}", flush=True)

    def judge(self, done, command, seed, scene):
        self.codes[command, done.returncode] += 1
        if done.returncode not in (0, 1, 2, 3):
            self.tell(f"{command}: code {done.returncode}", seed, scene)
        try:
            lines = (done.stderr + (done.stdout if command in ("check", "study") else b"")).decode().split("\n")
        except UnicodeDecodeError:
            return self.tell(f"{command}: no UTF-8", seed, scene)
        if any(len(line) > 5000 or not line.isprintable() for line in lines) or b"Traceback" in done.stderr:
            self.tell(f"{command}: {lines}", seed, scene)

    def scene(self, rng):
        text = "".join(rng.choices(PIECES, k=rng.randrange(1, 6)))
        scene = TWO_BLOCKS
        harmless = rng.random() < 0.5  # only what leaves the scene sound, so that a script is written
        for word in ["title"] if harmless else rng.sample(sorted(WORDS), rng.randrange(1, 3)):
            scene = scene.replace(WORDS[word], toml(text) + " = 1, v" if word == "key" else toml(text), 1)
        if not harmless and rng.random() < 0.3 and "/" not in text and "\0" not in text and len(text.encode()) < 250:
            shutil.copy(self.folder / "upper.mesh", self.folder / text)  # a mesh that is there
            scene = scene.replace('"upper.mesh"', toml(text))
        return text, scene

    def try_one(self, seed, study=False):
        rng = random.Random(seed)
        text, scene = self.scene(rng)
        (self.folder / "scene.toml").write_text(scene)
        settings = [f"title={text}"] if rng.random() < 0.3 and "\0" not in text and text else []
        option = ["--set", *settings] if settings else []
        for command in (["check", "scene.toml"], ["run", "scene.toml", "--quiet"], ["freefem", "scene.toml", "scene.edp"]):
            self.judge(self.run(*command, *option), command[0], seed, scene)
        if (self.folder / "scene.edp").exists() and self.freefem:
            script = (self.folder / "scene.edp").read_bytes().split(b"// Boundary conditions")[0]
            (self.folder / "scene.edp").write_bytes(script)
            done = subprocess.run([self.freefem, "-nw", "-ne", "-v", "0", "scene.edp"], cwd=self.folder, capture_output=True)
            self.codes["FreeFEM", done.returncode] += 1
            if done.returncode != 0:
                self.tell(f"FreeFEM does not read it: {done.stdout[-200:]!r}", seed, scene)
        if study:
            (self.folder / "scene.toml").write_text(TWO_BLOCKS)
            (self.folder / "study.toml").write_text(
                f'title = {toml(text)}\nscene = "scene.toml"\n[[error]]\nname = {toml(text if rng.random() < 0.7 else "a")}\n'
                f'quantity = "von_mises_max"\nexact = 10\n[[sweep]]\nname = {toml(text if rng.random() < 0.7 else "b")}\nsteps = [1, 2]\n')
            self.judge(self.run("study", "study.toml", "--quiet"), "study", seed, scene)
            for page in self.folder.glob("out/study/report.html"):
                if b"<script" in page.read_bytes() or b"<img src=x" in page.read_bytes():
                    self.tell("study: the page holds a command", seed, scene)
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        for name in ("scene.toml", "scene.edp", "study.toml", text):
            path = self.folder / name if "\0" not in name and len(name.encode()) < 250 else None
            if path and path.is_file() and str(path.relative_to(self.folder.parent)) not in self.begun:
                path.unlink()
        if more := self.listing() - self.begun:
            self.tell(f"left: {sorted(more)}", seed, scene)
            self.begun |= more
        if os.path.exists("/tmp/ran"):
            self.tell("/tmp/ran was made", seed, scene)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10000)
    parser.add_argument("--studies", type=int, default=200, help="of them, also through mortier study")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        sweep = Sweep(folder, PROGRAM)
        for i in range(given.count):
            sweep.try_one(given.seed + i, study=i < given.studies)
    print(f"{given.count} scenes, {len(sweep.findings)} findings; " + ", ".join(f"{command} {code}: {n}" for (command, code), n in
                                                                              sorted(sweep.codes.items())))
    return 1 if sweep.findings else 0


if __name__ == "__main__":
    sys.exit(main())
