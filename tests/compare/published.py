#!/usr/bin/python3
"""Tests that other projects and papers publish: their value, ours, the exact one.

    tests/compare/published.py [WORD ...] [--write]

prints a table in Markdown; with words, only rows that have one of them. --write puts all of it into
docs/published.md. The rows are in tests/compare/published/published_rows.py, and those of bench/hard/rows.py
that are marked. Exit code 1 where a row is beyond its tolerance.
"""
import argparse
import os
import re
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "compare"), str(ROOT / "bench" / "hard"), str(Path(__file__).parent / "published")]

import published_rows  # noqa: E402
import rows as hard_rows  # noqa: E402
from known import measure  # noqa: E402

PAGE = ROOT / "docs" / "published.md"
ROWS = [*published_rows.ROWS, *(row for row in hard_rows.ROWS if row.published)]
HEADER = ["test", "source", "quantity", "exact", "theirs", "ours", "difference", "tolerance", "s"]


def shown(value, which):
    """A number; of several the one at `which`."""
    if value is None:
        return ""
    return f"{np.atleast_1d(np.asarray(value, float))[which]:.6g}"


def values(row):
    """How many a row has."""
    return np.size(row.reference())


def right(row, verdict):
    """A value that is off is wrong though the program said so; where there is none the program has to."""
    return verdict == "within" or row.reference() is None and verdict.startswith("named")


def at_largest(row, value):
    """Of several values the one that is farthest off."""
    if value is None or values(row) == 1:
        return 0
    value, reference = np.asarray(value, float), np.asarray(row.reference(), float)
    return int(np.argmax(np.abs(value - reference) / (np.abs(reference) if row.each else 1)))


def cells(row, value, off, verdict, seconds):
    """The row of the table; of several values the one with the largest difference."""
    which = at_largest(row, value) if off is not None else 0
    ours = shown(value, which) or verdict
    difference = "" if off is None else f"{off:.1e}"
    if not right(row, verdict):
        difference = f"{difference} {verdict}".strip()
    return [*facts(row, which)[:5], ours, difference, facts(row, which)[5], f"{seconds:.2f}"]


def facts(row, which=0):
    """What the table says of a row whatever the run gives."""
    return [row.case, row.source, row.value, shown(row.exact, which), shown(row.theirs, which),
            f"{row.within:g}" if row.reference() is not None else ""]


def statement(row, value, off):
    """What the table states of a value that is more than rounding, as tests/compare/stated.py takes it: the
    row with {} in place of our value and of its difference, and both."""
    rounding = 1e-12
    if value is None or off is None:
        return None
    if off < rounding and (values(row) > 1 or row.reference() == 0):
        return None
    which = at_largest(row, value)
    words = facts(row, which)
    seen = ["{}", "{}"] if off > 1e-7 else ["{}", "{_}"]
    ours = float(np.atleast_1d(np.asarray(value, float))[which])
    return line([*words[:5], *seen, words[5]])[:-1], ours, *([off] if off > 1e-7 else [])


def line(words):
    return "| " + " | ".join(word.replace("|", "\\|") for word in words) + " |"


def seconds():
    """Processor time so far, of programs that were called too."""
    return sum(os.times()[:4])


def table(chosen, report=print):
    """Lines of the table, and how many rows are not as they should be."""
    lines, wrong = [line(HEADER), line(["---"] * len(HEADER)).replace(" ", "")], 0
    for each in lines:
        report(each)
    for row in chosen:
        begin = seconds()
        value, off, verdict = measure(row)
        lines.append(line(cells(row, value, off, verdict, seconds() - begin)))
        wrong += not right(row, verdict)
        report(lines[-1])
    return lines, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", metavar="WORD")
    parser.add_argument("--write", action="store_true", help="all rows, into docs/published.md")
    given = parser.parse_args()
    if given.words and given.write:
        parser.error("--write is for all rows")
    chosen = [row for row in ROWS
              if not given.words or any(word in f"{row.case} {row.value}" for word in given.words)]
    lines, wrong = table(chosen, lambda text: print(text, flush=True))
    tests = len({row.case for row in chosen})
    print(f"\n{tests} tests, {len(chosen)} values, {wrong} beyond their tolerance")
    if given.write:
        text = "\n".join(lines) + "\n"
        PAGE.write_text(re.sub(r"(?m)^\| test \|.*\n(\|.*\n)*", lambda _: text, PAGE.read_text()))
    return 1 if wrong or not chosen else 0


if __name__ == "__main__":
    sys.exit(main())
