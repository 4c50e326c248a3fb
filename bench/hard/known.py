"""Values that are known: a scene, what is read from its result, and the value that it should have.

`read` of a row takes the runs (results.Run) of its settings, one for each, or the output of its command. It
gives a number, or several, whose differences are over the largest of the reference or over each.
"""
import json
import os
import re
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import results

ROOT = Path(__file__).resolve().parents[2]
MORTIER = Path(os.environ.get("MORTIER", ROOT / "build" / "mortier")).resolve()  # runs are in other folders


@dataclass
class Row:
    case: str
    source: str  # of the value, or of the failure of another code
    value: str  # what is read, in words
    scene: Path = None
    settings: tuple = ()  # KEY=VALUE; of several runs: tuples of them
    read: object = None
    exact: object = 0.0  # of 0 the difference is that from 0; None: there is none, the published value counts
    theirs: object = None  # the published value, of another code or a target
    within: float = 0.0  # the relative difference that is allowed
    named: str = ""  # what the program says where the value is off: id of a warning, or a part of a message
    peers: tuple = ()
    command: tuple = ()
    options: tuple = ()
    at_least: bool = False  # more than the exact value is no fault
    each: bool = False  # differences are over each of several values
    test: str = ""  # of a fast one the verdict that a test expects
    published: bool = False  # in docs/published.md too

    def runs(self):
        several = self.settings and not isinstance(self.settings[0], str)
        return self.settings if several else (self.settings,)

    def reference(self):
        return self.theirs if self.exact is None else self.exact

    def off(self, value):
        """The largest difference of a value; nothing where there is no reference."""
        if self.reference() is None:
            return None
        value, reference = (np.atleast_1d(np.asarray(each, float)) for each in (value, self.reference()))
        if self.at_least and np.all(value >= reference):
            return 0.0
        largest = np.abs(reference).max()
        scale = np.abs(reference) if self.each else largest if largest else 1
        return float((np.abs(value - reference) / scale).max())


def located(folder, rows):
    """Rows whose scenes are files of a folder."""
    for row in rows:
        row.scene = row.scene and folder / row.scene
    return rows


class Ended(Exception):
    """A run that has no result; the message is all that the program said."""


def solve(row, settings, folder):
    """A run, and what the program said of it."""
    words = [MORTIER, "run", row.scene.name, "--quiet", "--out", folder, *row.options]
    words += ["--set", *settings] if settings else []
    done = subprocess.run(words, cwd=row.scene.parent, capture_output=True, text=True)
    if done.returncode != 0:
        raise Ended(done.stderr)
    run = results.read_mortier(folder)
    doubts = (run.summary.get("accuracy") or {}).get("not_reliable", "")
    return run, done.stderr + json.dumps([doubts, run.summary.get("several_solutions", "")])


def call(row):
    """The output of a program of the tree; nothing where it is not built."""
    program = ROOT / row.command[0]
    if row.command[0].startswith("build/"):  # beside the program that is tested
        program = MORTIER.parent / row.command[0].removeprefix("build/")
    if not program.is_file():
        return None
    options = ["--program", MORTIER] if program.suffix == ".py" else []
    done = subprocess.run([program, *row.command[1:], *options], capture_output=True, text=True,
                          cwd=ROOT)
    if not done.stdout:
        raise Ended(done.stderr)
    return done.stdout


def measure(row):
    """(value, difference, verdict) of ours: `within` the tolerance of the row, `named` where the value is off
    and the program said so by itself, `skipped` where what the row needs is not there, or OFF."""
    said = ""
    try:
        if row.command:
            output = call(row)
            if output is None:
                return None, None, f"skipped: {row.command[0]} is not built"
            value = row.read(output)
        else:
            with tempfile.TemporaryDirectory(prefix="mortier-known-") as name:
                solved = [solve(row, settings, Path(name) / str(i)) for i, settings in enumerate(row.runs())]
                value = row.read(*(run for run, _ in solved))
                said = "".join(words for _, words in solved)
    except Ended as ending:
        value, said = None, str(ending)
    off = None if value is None else row.off(value)
    if off is not None and off <= row.within:
        return value, off, "within"
    if row.named and (found := re.search(row.named, said)):
        return value, off, f"named: {found[0]}"
    return value, off, "OFF" if value is not None else "OFF: " + said.strip().splitlines()[-1]
