#!/usr/bin/env python3
"""Scenes whose every string is hostile, through run, check, freefem (FreeFEM runs what is written) and study.

hostile_sweep.py [--count N] [--seed N] [--browser PROGRAM]

Prints what was found, ends with 1 if anything was.

Every exit code is a documented one, every message short lines of visible UTF-8; no command in a string is run
and no file is written outside of what was asked for. With a browser (Debian's chromium) each page of a study
is opened in it: it asks for nothing but the page, as it would if anything in the page ran or was loaded.
"""
import argparse
import http.server
import os
import random
import shutil
import subprocess
import sys
import tempfile
import threading
from collections import Counter
from pathlib import Path

from forked_study import ForkedStudy
from scenes import TWO_BLOCKS
from support import PROGRAM

PIECES = ['"', "'", "\\", "\n", "\r", "\t", "\0", "\x1b[2J", "\x7f", "\x0b", "\u0085", "\u2028", "\u202e",
          "\ufeff", "//", "/*", "*/",
          "#", "$", "`touch ran`", "$(touch ran)", ";", '");exec("touch ran");//', "\nexec(\"touch ran\");//",
          "\rexec(\"touch ran\");//",
          'include "ran"', "<script>fetch('/ran')</script>", "<img src=/ran onerror=fetch('/ran')>",
          "\" onerror=fetch('/ran') src=\"/ran",
          "</title><script src=/ran></script>", "<svg onload=fetch('/ran')>",
          "<base href=/ran/><iframe src=javascript:fetch('/ran')>",
          "&lt;script&gt;", "&amp;", "-->", "]]>", "$\\frac{1}$", "$", "%s%n", "{}", "../ran", "/tmp/ran",
          "--out", "-", "=", "a", "é", "日本", "𝄞", "e\u0301", "x" * 300, " ", "0", "macro ran() exec("]
WORDS = {"title": '"two blocks"', "body": '"upper"', "mesh": '"upper.mesh"', "load": '"-10*t"',
         "projection": '"elasticity"', "key": "poisson = 0.3, v"}
STUDY = """title = {}
scene = {}
[[error]]
name = {}
quantity = "von_mises_max"
exact = 10
[[sweep]]
name = {}
{} = [{}]
"""
PAGES = 250  # that a browser opens at once


def toml(text):
    escapes = {'"': '\\"', "\\": "\\\\"}
    return '"' + "".join(escapes.get(c, c if c.isprintable() else f"\\U{ord(c):08x}") for c in text) + '"'


def is_name(text):
    """Whether a file can be called so."""
    return "/" not in text and "\0" not in text and 0 < len(text.encode()) < 240 and text[0] not in "-"


class Sweep:
    def __init__(self, folder, program=PROGRAM):
        self.folder, self.program = Path(folder) / "in", program
        self.folder.mkdir()
        self.codes, self.findings, self.pages = Counter(), [], []
        for name, corners in (("upper", ("0,0", "1,1")), ("lower", ("0,-1", "1,0"))):
            self.run("mesh", "crisscross", "--cells", "1", f"--lower={corners[0]}", f"--upper={corners[1]}",
                     f"{name}.mesh")
        self.freefem = shutil.which("FreeFem++-nw")
        self.study = ForkedStudy(Path(folder))
        self.study.errors.touch()
        self.study.shared.touch()
        self.begun = self.listing()

    def run(self, *arguments):
        return subprocess.run([self.program, *arguments], cwd=self.folder, capture_output=True, timeout=300)

    def listing(self):
        return {str(path.relative_to(self.folder.parent)) for path in self.folder.parent.rglob("*")}

    def report(self, what, seed, scene):
        self.findings.append(what)
        print(f"seed {seed}: {what}\n{scene!r}", flush=True)

    def judge(self, command, code, output, seed, scene):
        self.codes[command, code] += 1
        if code not in (0, 1, 2, 3):
            self.report(f"{command}: code {code}", seed, scene)
        try:
            lines = output.decode().split("\n")
        except UnicodeDecodeError:
            return self.report(f"{command}: no UTF-8", seed, scene)
        if any(len(line) > 5000 or not line.isprintable() or "Traceback" in line for line in lines):
            self.report(f"{command}: {lines}", seed, scene)
        if command != "check" and code != 0 and sum(1 for line in lines if line
                                                    and ": warning: " not in line) != 1:
            self.report(f"{command}: not one line: {lines}", seed, scene)

    @staticmethod
    def text(rng):
        return "".join(rng.choices(PIECES, k=rng.randrange(1, 6)))

    def scene(self, rng):
        """A scene, and a name for its file. Half of them are sound, so that they are solved."""
        scene = TWO_BLOCKS.replace("steps = 4", "steps = 1").replace(WORDS["title"], toml(self.text(rng)))
        if rng.random() < 0.5:
            for word in rng.sample(sorted(WORDS), rng.randrange(1, 3)):
                text = self.text(rng)
                scene = scene.replace(WORDS[word], toml(text) + " = 1, v" if word == "key" else toml(text), 1)
        elif is_name(name := self.text(rng)) and rng.random() < 0.5:
            shutil.copy(self.folder / "upper.mesh", self.folder / name)  # a mesh that is there
            scene = scene.replace(WORDS["mesh"], toml(name))
        name = self.text(rng)
        return scene, name if is_name(name) and rng.random() < 0.5 else "scene.toml"

    def try_one(self, seed, pictures=False):
        rng = random.Random(seed)
        scene, name = self.scene(rng)
        (self.folder / name).write_text(scene)
        setting = self.text(rng)
        option = ["--set", f"title={setting}"] if rng.random() < 0.3 and "\0" not in setting else []
        for command in (["check", name], ["run", name, "--quiet", "--out", "out/r"],
                        ["freefem", name, "scene.edp"]):
            done = self.run(*command, *option)
            self.judge(command[0], done.returncode,
                       done.stderr + (done.stdout if command[0] == "check" else b""), seed, scene)
        if (self.folder / "scene.edp").exists() and self.freefem:
            done = subprocess.run([self.freefem, "-nw", "-ne", "-v", "0", "scene.edp", "-quiet", "-out",
                                   "out/f"], cwd=self.folder,
                                  capture_output=True)
            self.codes["FreeFEM", done.returncode] += 1
            if done.returncode != 0:
                self.report(f"FreeFEM: {done.stdout[-300:]!r}", seed, scene)
        self.try_study(rng, name, seed, pictures)
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        for path in self.folder.iterdir():
            if path.name not in ("upper.mesh", "lower.mesh", "ran") and path.is_file():
                path.unlink()
        if more := self.listing() - self.begun:
            self.report(f"left: {sorted(more)}", seed, scene)
            self.begun |= more
        if os.path.exists("/tmp/ran"):
            self.report("/tmp/ran was made", seed, scene)

    def try_study(self, rng, scene, seed, pictures):
        texts = [self.text(rng) for _ in range(4)]
        visible = ["".join(c for c in each if c.isprintable())[:300].strip() or "a" for each in texts]
        title, error, sweep, value = visible if rng.random() < 0.8 else texts
        if rng.random() < 0.7:  # of a scene that can be solved
            (self.folder / scene).write_text(TWO_BLOCKS.replace("steps = 4", "steps = 1"))
        axis, values = ("title", toml(value)) if rng.random() < 0.5 else ("steps",
                                                                          "1, 2" if pictures else "1")
        (self.folder / "study").write_text(STUDY.format(toml(title), toml(scene), toml(error), toml(sweep),
                                                        axis, values))
        code, told, _ = self.study.run(self.folder, "study", "out/s", pictures)
        self.judge("study", code, told, seed, (self.folder / "study").read_text())
        if (self.folder / "out/s/report.html").exists():
            self.pages.append((seed, (self.folder / "out/s/report.html").read_bytes()))

    def open_pages(self, browser):
        """Each page in a frame, many at once; a page that asks for more than itself is found."""
        pages, asked = dict(self.pages), []

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                asked.append(self.path)
                kind, _, number = self.path[1:].partition("-")
                frames = "".join(f"<iframe src=/page-{seed}></iframe>" for seed in batch)
                answer = {"all": f"{frames}<script>onload = () => fetch('/done-')</script>".encode(),
                          "page": pages.get(int(number) if number.isdigit() else None, b""),
                          "control": b"<script>fetch('/ran')</script>"}.get(kind, b"")
                self.send_response(200)
                self.send_header("Content-Type", "text/html; charset=utf-8")
                self.end_headers()
                self.wfile.write(answer)
                if kind in ("done", "ran"):
                    done.set()

            def log_message(self, *_):
                pass
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        opened = 0
        for begin in range(-PAGES, len(self.pages), PAGES):  # first a page that does what it must not
            batch = [seed for seed, _ in self.pages[max(begin, 0):max(begin + PAGES, 0)]]
            done = threading.Event()
            asked.clear()
            what = "all-" if batch else "control-"
            # The browser may still be writing there when its driver has ended.
            with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
                process = subprocess.Popen([browser, "--headless", "--no-sandbox", "--disable-gpu",
                                            f"--user-data-dir={profile}",
                                            "--remote-debugging-port=0",
                                            f"http://127.0.0.1:{server.server_port}/{what}"],
                                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                done.wait(300)
                process.terminate()
                process.wait()
            loaded = {path for path in asked if path.startswith("/page-")}
            more = set(asked) - loaded - {"/all-", "/done-", "/control-", "/favicon.ico"}
            if not batch and "/ran" not in more:
                self.report("the browser runs nothing: nothing is tested", 0, "")
            elif batch and (more or len(loaded) != len(batch) or not done.is_set()):
                self.report(f"the browser opened {len(loaded)} of {len(batch)} pages and asked for "
                          f"{sorted(more)}", batch[0], "")
            opened += len(loaded)
        server.shutdown()
        return opened


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--browser", help="opens the pages of all studies")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        sweep = Sweep(folder)
        for i in range(given.count):
            sweep.try_one(given.seed + i, pictures=i % 20 == 0)
        opened = sweep.open_pages(given.browser) if given.browser else 0
    print(f"{given.count} scenes, {len(sweep.pages)} pages, {opened} opened, {len(sweep.findings)} findings; "
          + ", ".join(
        f"{command} {code}: {n}" for (command, code), n in sorted(sweep.codes.items())))
    return 1 if sweep.findings else 0


if __name__ == "__main__":
    sys.exit(main())
