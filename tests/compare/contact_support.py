"""What the harnesses share: parts of scenes, a run and what it gave, a command over scenes."""
import argparse
import contextlib
import csv
import json
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from scene_parts import box, quantity, shape, tool

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "compare"))
from results import read_vtu  # noqa: E402

# The words with which the log names a contact whose mesh is too coarse for its forces or pressures.
UNRESOLVED = re.compile(r"cells on the half width|contact[^\n]*(unresolved|not resolved)")
PLANE = 'plane = "strain"\n'
HELD = "ux = 0, uy = 0"
here = threading.local()  # of a scene of a command: the folder in which its files stay


def rectangle(lower, upper, cells, cut="both"):
    return box(lower, upper, cells, cut=cut)


def quadrilateral(corners, cells, cut="both"):
    return shape("quadrilateral", corners=corners, cells=cells, cut=cut)


def polygon(name, points, motion, labels=None):
    return tool(name, shape="polygon", points=points, labels=labels, more=motion + "\n")


def outline_geo(points, labels, size):
    """A polygon for Gmsh: its sides have these labels; size: of the elements, or one for each point."""
    count = len(points)
    sizes = size if isinstance(size, (list, tuple)) else [size] * count
    text = [f"Point({i + 1}) = {{{float(x)!r}, {float(y)!r}, 0, {sizes[i]!r}}};"
            for i, (x, y) in enumerate(points)]
    text += [f"Line({i + 1}) = {{{i + 1}, {(i + 1) % count + 1}}};" for i in range(count)]
    text += [f"Curve Loop(1) = {{1:{count}}};", "Plane Surface(1) = {1};", "Physical Surface(1) = {1};"]
    for label in sorted(set(labels)):
        sides = ", ".join(str(i + 1) for i in range(count) if labels[i] == label)
        text.append(f"Physical Curve({label}) = {{{sides}}};")
    return "\n".join(text) + "\n"


def forces(kind, name, label=None, prefix=""):
    """The quantities X and Y of a body or tool: of its reaction, or its contact_force."""
    return "".join(quantity(prefix + axis.upper(), kind, name, label, axis) for axis in "xy")


def off(what, value, right, tolerance):
    """A fault where the value is off by more than the tolerance, relative to the right one."""
    if abs(value - right) <= tolerance * abs(right):
        return []
    return [f"{what}: {value:.6g}, right is {right:.6g}"]


def zero(what, value, scale, tolerance):
    return [] if abs(value) <= tolerance * abs(scale) else [f"{what}: {value:.6g}, right is 0"]


def ended(what, run, code=0):
    return [] if run.code == code else [f"{what}: {run.end}"]


@dataclass
class Run:
    code: int  # None: did not end
    told: str  # standard error without warnings
    log: str  # standard output and error
    summary: dict = field(default_factory=dict)
    history: list = field(default_factory=list)  # a table of names and numbers for each step
    contact: list = field(default_factory=list)  # the nodes of the last step
    bodies: dict = field(default_factory=dict)  # name -> results.Body of the last step, where asked for

    def value(self, name):
        """Of a quantity, nan where there is none."""
        return self.summary.get("quantities", {}).get(name, {}).get("value", float("nan"))

    def error(self, name):
        """Its estimated error because of the meshes, infinite where none is known."""
        error = self.summary.get("quantities", {}).get(name, {}).get("estimated_error")
        return float("inf") if error is None else error

    def values(self, *names):
        return np.array([self.value(name) for name in names])

    def course(self, name):
        """A quantity at the end of each step."""
        return np.array([next(float(v) for key, v in row.items() if key.split("[")[0] == name)
                         for row in self.history])

    @property
    def end(self):
        """Exit code and message, for one line."""
        return f"exit {self.code} {re.sub(r'/tmp/[^ :]*/', '', self.told)[:240]}".strip()


def table(path):
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


@contextlib.contextmanager
def new_folder():
    if keep := getattr(here, "keep", None):
        keep.mkdir(parents=True, exist_ok=True)
        yield Path(tempfile.mkdtemp(dir=keep))
    else:
        with tempfile.TemporaryDirectory() as name:
            yield Path(name)


def meshed(program, meshes):
    """Files of meshes, of name -> words after `mortier mesh`."""
    with tempfile.TemporaryDirectory() as folder:
        for name, words in meshes.items():
            subprocess.run([program, "mesh", *words, name], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        return {name: (Path(folder) / name).read_text() for name in meshes}


def solve(program, text, *options, files=None, fields=False, patience=120, command="run"):
    """A run of a scene in a folder of its own; with options of the command line. patience: processor time,
    which does not depend on what else runs."""
    with new_folder() as folder:
        for file, content in {**(files or {}), "scene.toml": text}.items():
            (folder / file).write_text(content)
        out = ["--out", "out"] if command == "run" else []
        limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (patience, patience + 1))
        try:
            done = subprocess.run([program, command, "scene.toml", *out, *options], cwd=folder, text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=10 * patience,
                                  preexec_fn=limit)
        except subprocess.TimeoutExpired:
            return Run(None, f"did not end in {10 * patience} s", "")
        if done.returncode == -signal.SIGXCPU:
            return Run(None, f"took more than {patience} s of processor time", "")
        told = " ".join(line for line in done.stderr.splitlines() if ": warning: " not in line)
        run = Run(done.returncode, told, done.stdout + done.stderr)
        out = folder / ("out" if (folder / "out").exists() else "out.failed")
        if command == "run" and (out / "summary.json").exists():
            run.summary = json.loads((out / "summary.json").read_text())
            run.history = table(out / "history.csv")
            rows = table(out / "contact.csv")
            run.contact = [{key: float(value) for key, value in row.items()} for row in rows
                           if row["step"] == rows[-1]["step"]]
            if fields:
                run.bodies = {b["name"]: read_vtu(sorted(out.glob(f"{b['name']}_*.vtu"))[-1])
                              for b in run.summary["bodies"]}
        return run


def command(text, examined, count, names=None, told=None, **flags):
    """The command of a harness: examined(program, seed) gives what the scene shows, a list of faults, and for
    told(a list of it of all scenes), which prints more, anything else. With names, the scenes are these and
    --only picks one. flags: name -> help, of switches that examined takes as well. Exit code 1 where a scene
    has a fault."""
    parser = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=count)
    parser.add_argument("--first", type=int, default=1, help="the first scene")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--mortier", default=str(ROOT / "build" / "mortier"))
    parser.add_argument("--all", action="store_true", help="a line also for scenes without a fault")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="scenes and results stay there")
    if names:
        parser.add_argument("--only", choices=names)
    for name, words in flags.items():
        parser.add_argument(f"--{name}", action="store_true", help=words)
    arguments = parser.parse_args()
    program = str(Path(arguments.mortier).resolve())
    chosen = {name: getattr(arguments, name) for name in flags}
    if names:
        scenes = [arguments.only] if arguments.only else names[arguments.first - 1:][:arguments.count]
    else:
        scenes = range(arguments.first, arguments.first + arguments.count)

    def examine(scene):
        here.keep = arguments.keep and arguments.keep / str(scene)
        return examined(program, scene, **chosen)
    failed, more = [], []
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for scene, (shown, faults, *rest) in zip(scenes, pool.map(examine, scenes)):
            more += rest
            if faults:
                failed.append(scene)
            if faults or arguments.all:
                left = [f"and {len(faults) - 6} more"] if len(faults) > 6 else []
                print(f"{scene}: {shown}: {'; '.join(faults[:6] + left) or 'right'}", flush=True)
    if told:
        told(more)
    print(f"{len(scenes)} scenes, {len(failed)} with a fault: {', '.join(map(str, failed)) or 'none'}")
    return 1 if failed else 0
