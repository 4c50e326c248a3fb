"""What the Python tests share. Each is run by ctest, or alone: MORTIER=build/mortier /usr/bin/python3 FILE"""
import csv
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

from scenes import TWO_BLOCKS

ROOT = Path(os.environ.get("MORTIER_ROOT", Path(__file__).resolve().parents[2]))
COMPARE = ROOT / "compare"
PROGRAM = str(Path(os.environ.get("MORTIER", ROOT / "build" / "mortier")).resolve())
sys.path.insert(0, str(COMPARE))
# Limits are of processor time, which other work on the machine does not change. What hangs takes none.
HANGS = 900  # seconds for one process
MOST = float(os.environ.get("MORTIER_TEST_SECONDS", "inf"))  # of processor time for all of a test


def mortier(*arguments, timeout=120, **options):
    """Runs the program; its standard output and errors are text. timeout: of processor time [s]"""
    options.setdefault("stdout", subprocess.PIPE)
    return subprocess.run([PROGRAM, *map(str, arguments)],
                          **{"stderr": subprocess.PIPE, "text": True, "timeout": HANGS,
                             "preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_CPU,
                                                                      (timeout, timeout + 1)), **options})


def set_option(settings):
    return ["--set", *settings] if settings else []


def value(summary, name):
    """Of a quantity."""
    return summary["quantities"][name]["value"]


def values(summary):
    return {name: each["value"] for name, each in summary.get("quantities", {}).items()}


def warned(errors):
    """The kinds of the faults that warnings name, in their order."""
    return re.findall(r"^mortier: warning: .* \[([\w-]+)\]$", errors, re.M)


def told(errors):
    """The lines of standard error that are no warnings."""
    return [line for line in errors.splitlines() if not line.startswith("mortier: warning: ")]


def children_of(pid):
    try:
        return list(map(int, Path(f"/proc/{pid}/task/{pid}/children").read_text().split()))
    except (FileNotFoundError, ProcessLookupError):
        return []


def processor_time(pid):
    """Seconds that a process and its children have taken of the processors, those that have ended included:
    what others do on the machine does not count."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except (FileNotFoundError, ProcessLookupError):
        return 0.0
    return (sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")
            + sum(map(processor_time, children_of(pid))))


def watch():
    while processor_time(os.getpid()) < MOST:
        time.sleep(5)
    print(f"ended: {MOST:g} s of processor time are over", file=sys.stderr, flush=True)
    os._exit(1)


if MOST < float("inf"):
    threading.Thread(target=watch, daemon=True).start()


def time_to_end(process):
    """The same that a process takes from now on until it ends."""
    begin = processor_time(process.pid)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return used.ru_utime + used.ru_stime - begin


def script(name, *arguments):
    """Runs a script of compare/: exit code and output."""
    done = subprocess.run([sys.executable, str(COMPARE / name), *map(str, arguments)], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


def answered_once(program, folder):
    """An environment where `program` is run once for the same words and the same standard input; the file of
    --template is the same wherever it stands."""
    script = folder / program
    script.write_text(f"""#!/bin/sh
asked=$(mktemp "{folder}/asked.XXXXXX")
cat > "$asked"
key="{folder}/$( (printf '%s\\n' "$@" | sed '/^--template$/,+1d'; cat "$asked") | sha256sum | cut -c -64)"
[ -e "$key" ] || {shutil.which(program)} "$@" < "$asked" > "$key.new" || exit
[ -e "$key" ] || mv "$key.new" "$key"
cat "$key"
""")
    script.chmod(0o755)
    return {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}


class InFolder(unittest.TestCase):
    """Each test has a temporary folder of its own."""

    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def write(self, text, name="scene.toml"):
        (self.folder / name).write_text(text)

    def read(self, name):
        return (self.folder / name).read_text()

    def summary_of(self, out="out"):
        return json.loads(self.read(f"{out}/summary.json"))

    def rows_of(self, name):
        """Of a table, dictionaries."""
        return list(csv.DictReader(self.read(name).splitlines()))

    def names(self, folder="."):
        return sorted(path.name for path in (self.folder / folder).iterdir())

    def mortier(self, *arguments, code=0, **options):
        """Runs the program in the folder: it ends with this code, and prints one line where that is not 0."""
        done = mortier(*arguments, cwd=self.folder, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(len(told(done.stderr)), 0 if code == 0 else 1, done.stderr)
        return done

    def reject(self, message, *arguments):
        """The program refuses what it is given with one line, which begins with the message,
        and makes no result."""
        errors = self.mortier(*arguments, code=2).stderr
        self.assertTrue(errors.startswith("mortier: " + message), f"\nexpected {message}\nis       {errors}")
        self.assertEqual(errors.count("\n"), 1, errors)
        self.assertFalse((self.folder / "out").exists())

    def run_it(self, text=None, *settings, folder="out"):
        """Runs a scene, or scene.toml as it is: the summary."""
        if text is not None:
            self.write(text)
        self.mortier("run", "scene.toml", "--quiet", "--out", folder, *set_option(settings))
        return self.summary_of(folder)

    def refuse(self, text, message, *settings):
        self.write(text)
        errors = self.mortier("run", "scene.toml", "--quiet", "--out", "out", *set_option(settings),
                              code=2).stderr
        self.assertEqual(len(errors.splitlines()), 1, errors)
        self.assertIn(message, errors)

    def resume(self, settings, lines, names):
        """A run of scene.toml that is killed once its history has more lines goes on from its checkpoint to
        the same bytes in these files."""
        settings = ("--set", *settings, "--checkpoint", "0") if settings else ("--checkpoint", "0")
        self.mortier("run", "scene.toml", "--out", "whole", *settings)
        process = subprocess.Popen([PROGRAM, "run", "scene.toml", "--out", "killed", *settings],
                                   cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        history = self.folder / f"killed.tmp-{process.pid}/history.csv"
        while process.poll() is None and not (history.exists() and history.read_bytes().count(b"\n") > lines):
            time.sleep(0.001)
        process.kill()
        self.assertNotEqual(process.wait(), 0, "the run ended before it was killed")
        self.mortier("run", "--restart", "killed")
        for name in names:
            self.assertEqual(*((self.folder / out / name).read_bytes() for out in ("whole", "killed")), name)


class OfTwoBlocks(InFolder):
    """Each test has scenes.TWO_BLOCKS as scene.toml, with its meshes."""

    def setUp(self):
        super().setUp()
        self.mortier("mesh", "crisscross", "--cells", "3", "upper.mesh")
        self.mortier("mesh", "crisscross", "--cells", "4,2", "--lower", "0,-1", "--upper", "1,0",
                     "lower.mesh")
        self.write(TWO_BLOCKS)


class InSharedFolder(unittest.TestCase):
    """All tests of the class have one temporary folder."""

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
