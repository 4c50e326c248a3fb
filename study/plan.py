"""What a study is: STUDY.toml read and validated (docs/study.md). Nothing is run and nothing written here."""
import difflib
import hashlib
import itertools
import json
import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from expressions import Expression
from problems import StudyError

# axis of a sweep: key of the scene that it sets, and what it takes
AXES = {
    "steps": ("time.steps", "integers >= 1"), "tolerance": ("time.tolerance", "numbers > 0"),
    "scheme": ("time.scheme", "strings"), "variant": ("contact.variant", "strings"),
    "projection": ("body.material.projection", "strings"), "linear": ("solver.linear", "strings"),
    "swap": ("contact.swap", "booleans"),
    "level": (None, "integers >= 0"), "code": (None, "strings"), "threads": (None, "integers >= 1"),
}
CODES = ("mortier", "freefem", "getfem", "calculix")
FIELDS = {"energy": ("s11", "s22", "s12"), "displacement": ("ux", "uy"), "pressure": ("p",)}
SCALARS = ("von_mises_min", "von_mises_max", "interpenetration", "contact_force", "active_nodes", "displacement_min_x",
           "displacement_min_y", "displacement_max_x", "displacement_max_y")
KINDS = ("rectangle", "crisscross")
COSTS = ("wall_time", "processor_time", "memory", "dofs", "iterations")
KEYS = ("title", "scene", "mesh", "let", "error", "reference", "sweep", "compare", "repeat", "timeout")
REQUIRED = object()


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
class ErrorMeasure:
    name: str
    quantity: str
    exact: object = None  # a number; or {body or "": {component: Expression}}; None: the reference run


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


class Lines:
    """Where a key stands in the file: tomllib does not say."""

    def __init__(self, path, source):
        self.path = path
        self.found = {}
        table, counts = "", {}
        for number, line in enumerate(source.splitlines(), 1):
            if header := re.match(r"\s*\[\[\s*([^\]]+?)\s*\]\]", line):
                index = counts[header[1]] = counts.get(header[1], -1) + 1
                self.found.setdefault(header[1], number)
                table = f"{header[1]}.{index}"
            elif header := re.match(r"\s*\[\s*([^\]]+?)\s*\]", line):
                table = header[1]
            elif key := re.match(r"\s*([A-Za-z0-9_\-.\"]+)\s*=", line):
                self.found.setdefault(f"{table}.{key[1]}".strip(".").replace('"', ""), number)
                continue
            else:
                continue
            self.found.setdefault(table, number)

    def place(self, path):
        while path:
            if path in self.found:
                return f"{self.path}:{self.found[path]}"
            path = path.rpartition(".")[0]
        return f"{self.path}:1"


class Table:
    """A table of the file whose keys are taken one by one; what is left over is unknown."""

    def __init__(self, values, lines, path="", words=""):
        self.values, self.lines, self.path, self.words = dict(values), lines, path, words
        self.known = []

    def fault(self, key, value, expected):
        at = self.lines.place(f"{self.path}.{key}".strip("."))
        subject = f"{self.words}: " if self.words else ""
        return StudyError(f"{at}: {subject}{key} = {text(value)}, expected {expected}")

    def take(self, key, expected, test, default=REQUIRED):
        self.known.append(key)
        if key not in self.values:
            if default is REQUIRED:
                place = self.lines.place(self.path)
                raise StudyError(f"{place}: {self.words + ': ' if self.words else ''}{key} is missing, expected {expected}")
            return default
        value = self.values.pop(key)
        if not test(value):
            raise self.fault(key, value, expected)
        return value

    def tables(self, key, required=False):
        """The tables of [[key]]."""
        values = self.take(key, f"tables [[{key}]]", lambda v: isinstance(v, list) and v and
                           all(isinstance(each, dict) for each in v), REQUIRED if required else [])
        return [Table(each, self.lines, f"{self.path}.{key}.{i}".strip("."), f"{key} {i}")
                for i, each in enumerate(values)]

    def table(self, key):
        value = self.take(key, f"a table [{key}]", lambda v: isinstance(v, dict), None)
        return None if value is None else Table(value, self.lines, f"{self.path}.{key}".strip("."), key)

    def finish(self, known=()):
        for key in self.values:
            if key in known:
                continue
            self.known = list(known) or self.known
            near = difflib.get_close_matches(key, self.known, 1)
            place = self.lines.place(f"{self.path}.{key}".strip("."))
            subject = f"{self.words}: " if self.words else ""
            raise StudyError(f"{place}: {subject}unknown key {key}, " + (f"did you mean {near[0]}? Expected" if near
                             else "expected") + f" one of {', '.join(self.known)}")


def text(value):
    """A value as TOML writes it, for messages."""
    return json.dumps(value, default=str) if not isinstance(value, float) else f"{value:g}"


def is_text(value):
    return isinstance(value, str) and value.strip() != ""


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < float("inf")


def is_count(least):
    return lambda value: isinstance(value, int) and not isinstance(value, bool) and value >= least


def read(path):
    """The plan of a study. StudyError names what is wrong."""
    path = Path(path)
    try:
        source = path.read_text()
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
    title = top.take("title", "a text", lambda v: isinstance(v, str), path.stem)
    scene = path.parent / top.take("scene", "the file of a scene", is_text)
    bodies = bodies_of(scene, lines)
    meshes, levels = read_meshes(top.table("mesh"), bodies, path.parent)
    timeout = top.take("timeout", "seconds > 0", lambda v: is_number(v) and v > 0, None)
    repeat = top.take("repeat", "an integer >= 1", is_count(1), 1)
    let = read_let(top.table("let"))
    errors = read_errors(top, bodies, [name for name, _ in let])
    reference = top.table("reference")
    if reference is not None:
        reference = read_axes(reference, levels, single=True)
    elif missing := [error for error in errors if error.exact is None]:
        raise StudyError(f"{lines.place('error')}: error {missing[0].name}: exact is missing, expected exact or a table "
                         "[reference]")
    sweeps = [read_sweep(each, i, levels, lines) for i, each in enumerate(top.tables("sweep", required=True))]
    names = [sweep.name for sweep in sweeps]
    for i, name in enumerate(names):
        if name in names[:i]:
            raise StudyError(f"{lines.place(f'sweep.{i}.name')}: sweep {i}: name = {text(name)}, expected a name of its own")
    comparisons = [read_comparison(each, errors, names) for each in top.tables("compare")]
    plan = Plan(path, title, scene, meshes, sweeps, errors, reference, comparisons, let, timeout, repeat)
    decides = {key: document.get(key) for key in ("mesh", "error", "reference", "let", "repeat", "timeout")}
    files = [scene, *(scene.parent / str(body.get("mesh", "")) for body in tomllib.loads(scene.read_text())["body"]),
             *(file for each in meshes.values() for file in each if isinstance(file, Path))]
    digest = hashlib.sha256(json.dumps(decides, sort_keys=True, default=str).encode())
    for file in files:
        digest.update(file.read_bytes() if file.is_file() else b"")
    plan.fingerprint = digest.hexdigest()
    return plan


def bodies_of(scene, lines):
    try:
        document = tomllib.loads(scene.read_text())
        return [body["name"] for body in document["body"]]
    except OSError as error:
        raise StudyError(f"{lines.place('scene')}: scene = \"{scene}\", expected the file of a scene "
                         f"({error.strerror})") from error
    except (ValueError, KeyError, TypeError) as error:
        raise StudyError(f"{lines.place('scene')}: scene = \"{scene}\", expected a scene (docs/scene.md)") from error


def read_meshes(table, bodies, folder):
    """body -> its meshes by level, and the number of levels."""
    if table is None:
        return {}, 0
    meshes = {}
    for name in list(table.values):
        if name not in bodies:
            place = table.lines.place(f"mesh.{name}")
            raise StudyError(f"{place}: mesh: {name}, expected one of the bodies {', '.join(bodies)}")
        value = table.take(name, "{ kind, cells, lower, upper } or a list of files",
                           lambda v: isinstance(v, dict) or (isinstance(v, list) and v and all(map(is_text, v))))
        if isinstance(value, list):
            meshes[name] = [folder / file for file in value]
            for file in meshes[name]:
                if not file.is_file():
                    raise table.fault(name, str(file), "a Medit .mesh file")
        else:
            meshes[name] = generated(Table(value, table.lines, f"mesh.{name}", f"mesh {name}"))
    lengths = {len(each) for each in meshes.values()}
    if len(lengths) > 1:
        raise StudyError(f"{table.lines.place('mesh')}: mesh: {', '.join(f'{k}: {len(v)}' for k, v in meshes.items())} "
                         "levels, expected as many for each body")
    return meshes, lengths.pop()


def generated(table):
    def is_cells(value):
        return is_count(1)(value) or (isinstance(value, list) and len(value) == 2 and all(map(is_count(1), value)))

    def is_point(value):
        return isinstance(value, list) and len(value) == 2 and all(map(is_number, value))
    kind = table.take("kind", "one of " + ", ".join(KINDS), lambda v: v in KINDS, "crisscross")
    cells = table.take("cells", "a list of N or [NX, NY], one a level", lambda v: isinstance(v, list) and v and
                       all(map(is_cells, v)))
    lower = table.take("lower", "[X, Y]", is_point)
    upper = table.take("upper", "[X, Y]", is_point)
    table.finish()
    return [{"kind": kind, "cells": n, "lower": lower, "upper": upper} for n in cells]


def read_let(table):
    """Named expressions for the exact solution, in their order."""
    let = []
    for name, value in list(table.values.items()) if table else []:
        if not name.isidentifier() or name in ("x", "y", "t", "pi"):
            raise table.fault(name, value, "a name of letters, digits and _ that is not x, y, t or pi")
        let.append((name, expression(table, name, value, [known for known, _ in let])))
    return let


def expression(table, key, value, names):
    try:
        return Expression(value, names)
    except ValueError as error:
        raise table.fault(key, value, f"a number or an expression in {', '.join(['x, y, t', *names])} ({error})") from error


def read_errors(top, bodies, names):
    errors = []
    for table in top.tables("error", required=True):
        quantities = (*FIELDS, *SCALARS)
        quantity = table.take("quantity", "one of " + ", ".join(quantities), lambda v: v in quantities)
        name = table.take("name", "a text", is_text, quantity)
        table.words = f"error {name}"
        if name in [each.name for each in errors]:
            raise table.fault("name", name, "a name of its own")
        exact = None
        if quantity in FIELDS:
            if (value := table.table("exact")) is not None:
                exact = read_exact(value, quantity, bodies, names)
        else:
            exact = table.take("exact", "a number", lambda v: is_number(v) and v != 0, None)
        table.finish()
        errors.append(ErrorMeasure(name, quantity, exact))
    return errors


def read_exact(table, quantity, bodies, names):
    """{"": components} for all bodies alike, or {body: components}."""
    components = FIELDS[quantity]
    each_body = quantity != "pressure" and set(table.values) <= set(bodies) and table.values
    tables = {"": table}
    if each_body:
        if missing := [body for body in bodies if body not in table.values]:
            raise StudyError(f"{table.lines.place(table.path)}: {table.words}: {missing[0]} is missing, expected every body")
        tables = {body: table.table(body) for body in bodies}
    exact = {}
    for body, inner in tables.items():
        exact[body] = {c: expression(inner, c, inner.take(c, "an expression", lambda v: True), names) for c in components}
        inner.finish()
    return exact


def check_axis(table, axis, values, levels):
    expected = AXES.get(axis, (axis, "values"))[1]
    tests = {"integers >= 1": is_count(1), "integers >= 0": is_count(0), "numbers > 0": lambda v: is_number(v) and v > 0,
             "strings": is_text, "booleans": lambda v: isinstance(v, bool),
             "values": lambda v: is_number(v) or isinstance(v, (bool, str))}
    for value in values:
        if not tests[expected](value):
            raise table.fault(axis, value, expected)
        if axis == "level" and value >= levels:
            raise table.fault(axis, value, f"a level below {levels} (the levels of [mesh])" if levels else "a table [mesh]")
        if axis == "code" and value not in CODES:
            raise table.fault(axis, value, "one of " + ", ".join(CODES))


def flattened(values, prefix=""):
    """TOML reads `time.end = 1` as a table in a table."""
    for key, value in values.items():
        if isinstance(value, dict):
            yield from flattened(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


def read_axes(table, levels, single):
    """axis -> value (single) or list of values."""
    axes = {}
    for axis, value in flattened(table.values):
        if axis not in AXES and "." not in axis:
            near = difflib.get_close_matches(axis, AXES, 1)
            raise StudyError(f"{table.lines.place(f'{table.path}.{axis}')}: {table.words}: unknown axis {axis}, "
                             + (f"did you mean {near[0]}? Expected" if near else "expected")
                             + f" one of {', '.join(AXES)}, or a dotted key of the scene")
        values = value if isinstance(value, list) else [value]
        if not values or (single and isinstance(value, list)):
            raise table.fault(axis, value, "one value" if single else "one value or more")
        check_axis(table, axis, values, levels)
        axes[axis] = value if single else list(dict.fromkeys(values))
    return axes


def read_sweep(table, index, levels, lines):
    name = table.take("name", "a text", is_text, f"sweep {index}")
    table.words = f"sweep {name}"
    axes = read_axes(table, levels, single=False)
    if "steps" in axes and "tolerance" in axes:
        raise StudyError(f"{lines.place(f'sweep.{index}.tolerance')}: {table.words}: steps and tolerance, expected one of "
                         "them (steps are chosen by the tolerance)")
    cases = [Case(tuple(sorted(zip(axes, values)))) for values in itertools.product(*axes.values())]
    return Sweep(name, cases)


def read_comparison(table, errors, sweeps):
    names = [error.name for error in errors]
    error = table.take("error", "the name of an error: " + ", ".join(names), lambda v: v in names)
    at = table.take("at", "a number > 0", lambda v: is_number(v) and v > 0)
    sides = []
    for side in ("dear", "cheap"):
        value = table.take(side, "a sweep, or { sweep, and values of its axes }", lambda v: is_text(v) or isinstance(v, dict))
        value = {"sweep": value} if isinstance(value, str) else dict(flattened(value))
        if value.get("sweep") not in sweeps:
            raise table.fault(side, value.get("sweep", value), "one of the sweeps " + ", ".join(sweeps))
        sides.append(value)
    table.finish()
    return Comparison(error, float(at), *sides)
