"""What a study is: STUDY.toml read and validated (docs/study.md). Nothing is run and nothing written here."""
import hashlib
import itertools
import json
import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from axes import flattened, read_axes
from errors import read_errors, read_let
from problems import StudyError, shown
from study_file import Lines, Table, is_count, is_number, is_shown, is_text, text

KINDS = ("rectangle", "crisscross")
KEYS = ("title", "scene", "mesh", "let", "error", "reference", "sweep", "compare", "repeat", "timeout")


@dataclass(frozen=True)
class Case:
    """A point of the sweep: the values of its axes."""
    values: tuple  # of (axis, value), sorted

    def __getitem__(self, axis):
        return dict(self.values).get(axis)

    @property
    def code(self):
        return self["code"] or "mortier"

    def replaced(self, values):
        kept = dict(self.values)
        for axis, other in (("steps", "tolerance"), ("tolerance", "steps")):
            if axis in values:
                kept.pop(other, None)
        return Case(tuple(sorted((kept | values).items())))

    def __str__(self):
        return ", ".join(f"{axis} = {text(value)}" for axis, value in self.values) or "the scene as it stands"


@dataclass
class Comparison:
    """The cost of two series at equal error."""
    error: str
    at: float
    dear: dict
    cheap: dict


@dataclass
class Sweep:
    name: str
    cases: list


@dataclass
class Plan:
    path: Path
    title: str
    scene: Path
    meshes: dict  # body -> list of mesh descriptions or files
    sweeps: list
    errors: list
    reference: dict  # axis -> value; None where every error has an exact value
    comparisons: list
    let: list = field(default_factory=list)  # (name, Expression)
    timeout: float = None
    repeat: int = 1
    fingerprint: str = ""  # of everything but the sweeps that decides what a row holds

    def cases(self):
        """Every case once."""
        return list(dict.fromkeys(case for sweep in self.sweeps for case in sweep.cases))

    def key(self, case):
        """Names a case in study.csv and among the folders."""
        return hashlib.sha256((self.fingerprint + json.dumps(case.values)).encode()).hexdigest()[:16]


def read(path):
    """The plan of a study. StudyError names what is wrong."""
    path = Path(path)
    try:
        source = path.read_text(encoding="utf-8")
        document = tomllib.loads(source)
    except OSError as error:
        raise StudyError(f"{path}: {error.strerror}, expected a study (TOML, docs/study.md)") from error
    except UnicodeDecodeError as error:
        raise StudyError(f"{path}: expected a text file") from error
    except tomllib.TOMLDecodeError as error:
        line = re.search(r"line (\d+)", str(error))
        raise StudyError(f"{path}:{line[1] if line else 1}: not TOML: {error}") from error
    lines = Lines(path, source)
    top = Table(document, lines)
    top.finish(KEYS)
    title = top.take("title", "a text of one line", is_shown, shown(path.stem))
    scene = path.parent / top.take("scene", "the file of a scene", is_text)
    bodies, in_space = bodies_of(scene, lines)
    meshes, levels = read_meshes(top.table("mesh"), bodies, path.parent)
    timeout = top.take("timeout", "seconds > 0, 1e9 at most", lambda v: is_number(v) and 0 < v <= 1e9, None)
    repeat = top.take("repeat", "an integer >= 1", is_count(1), 1)
    let = read_let(top.table("let"))
    errors = read_errors(top, bodies, [name for name, _ in let], in_space)
    reference = top.table("reference")
    if reference is not None:
        reference = read_axes(reference, levels, single=True)
    elif missing := [error for error in errors if error.exact is None]:
        raise StudyError(f"{lines.place('error')}: error {missing[0].name}: exact is missing, expected "
                         "exact or a table [reference]")
    sweeps = {}
    for i, each in enumerate(top.tables("sweep", required=True)):
        name = each.take("name", "a text", is_text, f"sweep {i}")
        if name in sweeps:
            raise each.fault("name", name, "a name of its own")
        sweeps[name] = read_sweep(each, name, levels)
    comparisons = [read_comparison(each, errors, sweeps) for each in top.tables("compare")]
    plan = Plan(path, title, scene, meshes, [*sweeps.values()], errors, reference, comparisons, let, timeout,
                repeat)
    decides = {key: document.get(key) for key in ("mesh", "error", "reference", "let", "repeat", "timeout")}
    files = [scene, *(scene.parent / mesh_file(body)
                      for body in tomllib.loads(scene.read_text(encoding="utf-8"))["body"]),
             *(file for each in meshes.values() for file in each if isinstance(file, Path))]
    digest = hashlib.sha256(json.dumps(decides, sort_keys=True, default=str).encode())
    for file in files:
        digest.update(file.read_bytes() if file.is_file() else b"")
    plan.fingerprint = digest.hexdigest()
    return plan


def bodies_of(scene, lines):
    try:
        document = tomllib.loads(scene.read_text(encoding="utf-8"))
        if not all(is_text(body["name"]) and isinstance(mesh_file(body), str) for body in document["body"]):
            raise ValueError
        return [body["name"] for body in document["body"]], document.get("dimension") == 3
    except OSError as error:
        raise StudyError(f"{lines.place('scene')}: scene = \"{scene}\", expected the file of a scene "
                         f"({error.strerror})") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise StudyError(
            f"{lines.place('scene')}: scene = \"{scene}\", expected a scene (docs/scene.md)") from error


def mesh_file(body):
    """The file of a body's mesh; empty where it is a shape, or the study gives it."""
    mesh = body.get("mesh", "")
    return mesh.get("file", "") if isinstance(mesh, dict) else mesh


def read_meshes(table, bodies, folder):
    """body -> its meshes by level, and the number of levels."""
    if table is None:
        return {}, 0
    meshes = {}
    for name in list(table.values):
        if name not in bodies:
            raise table.wrong(f"{name}, expected one of the bodies {', '.join(bodies)}", name)
        value = table.take(name, "{ kind, cells, lower, upper } or a list of files",
                           lambda v: isinstance(v, dict) or (isinstance(v, list) and v
                                                             and all(map(is_text, v))))
        if isinstance(value, list):
            meshes[name] = [folder / file for file in value]
            for file in meshes[name]:
                if not file.is_file():
                    raise table.fault(name, str(file), "a Medit .mesh file")
        else:
            meshes[name] = generated(Table(value, table.lines, f"mesh.{name}", f"mesh {name}"))
    lengths = {len(each) for each in meshes.values()}
    if len(lengths) > 1:
        levels = ", ".join(f"{name}: {len(each)}" for name, each in meshes.items())
        raise table.wrong(f"{levels} levels, expected as many for each body")
    return meshes, lengths.pop()


def generated(table):
    def is_cells(value):
        return is_count(1)(value) or (isinstance(value, list) and len(value) == 2
                                      and all(map(is_count(1), value)))

    def is_point(value):
        return isinstance(value, list) and len(value) == 2 and all(map(is_number, value))
    kind = table.take("kind", "one of " + ", ".join(KINDS), lambda v: v in KINDS, "crisscross")
    cells = table.take("cells", "a list of N or [NX, NY], one a level",
                       lambda v: isinstance(v, list) and v and
                       all(map(is_cells, v)))
    lower = table.take("lower", "[X, Y]", is_point)
    upper = table.take("upper", "[X, Y]", is_point)
    table.finish()
    return [{"kind": kind, "cells": n, "lower": lower, "upper": upper} for n in cells]


def read_sweep(table, name, levels):
    table.words = f"sweep {name}"
    axes = read_axes(table, levels, single=False)
    if "steps" in axes and "tolerance" in axes:
        raise table.wrong("steps and tolerance, expected one of them (steps are chosen by the tolerance)",
                          "tolerance")
    cases = [Case(tuple(sorted(zip(axes, values)))) for values in itertools.product(*axes.values())]
    return Sweep(name, cases)


def read_comparison(table, errors, sweeps):
    names = [error.name for error in errors]
    error = table.take("error", "the name of an error: " + ", ".join(names), lambda v: v in names)
    at = table.take("at", "a number > 0", lambda v: is_number(v) and v > 0)
    sides = []
    for side in ("dear", "cheap"):
        value = table.take(side, "a sweep, or { sweep, and values of its axes }",
                           lambda v: is_text(v) or isinstance(v, dict))
        value = {"sweep": value} if isinstance(value, str) else dict(flattened(value))
        if value.get("sweep") not in sweeps:
            raise table.fault(side, value.get("sweep", value), "one of the sweeps " + ", ".join(sweeps))
        sides.append(value)
    table.finish()
    return Comparison(error, float(at), *sides)
