"""The file of a study: its tables, from which keys are taken one by one,
and the lines on which they stand."""
import difflib
import json
import re

from problems import StudyError

REQUIRED = object()


class Lines:
    """Where a key stands in the file: tomllib does not say."""

    def __init__(self, path, source):
        self.path = path
        self.found = {}
        table, counts = "", {}
        for number, line in enumerate(source.splitlines(), 1):
            line = line[:500]
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

    def wrong(self, what, key=""):
        """The error of the table, or of one of its keys."""
        place = self.lines.place(f"{self.path}.{key}".strip("."))
        return StudyError(f"{place}: {self.words + ': ' if self.words else ''}{what}")

    def fault(self, key, value, expected):
        return self.wrong(f"{key} = {text(value)}, expected {expected}", key)

    def take(self, key, expected, test, default=REQUIRED):
        self.known.append(key)
        if key not in self.values:
            if default is REQUIRED:
                raise self.wrong(f"{key} is missing, expected {expected}")
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
            if key not in known:
                raise self.wrong(unknown("key", key, known or self.known), key)


def unknown(kind, name, known):
    """In words, with the name that may be meant."""
    near = difflib.get_close_matches(name, known, 1)
    expected = f"did you mean {near[0]}? Expected" if near else "expected"
    return f"unknown {kind} {name}, {expected} one of {', '.join(known)}"


def text(value):
    """A value as TOML writes it, for messages."""
    return json.dumps(value, default=str) if not isinstance(value, float) else f"{value:g}"


def is_shown(value):
    """A text that can stand on one line of a page, a plot and a command line."""
    return isinstance(value, str) and value.isprintable() and len(value) <= 300


def is_text(value):
    return is_shown(value) and value.strip() != ""


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e300


def is_count(least):
    return lambda value: isinstance(value, int) and not isinstance(value, bool) and least <= value <= 10**9
