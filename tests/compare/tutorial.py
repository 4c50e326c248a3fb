#!/usr/bin/python3
"""The tutorial as a reader follows it: its files and its commands (docs/tutorial.md).

    tests/compare/tutorial.py FOLDER     writes them there, the commands as tutorial.sh
"""
import re
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "tutorial.md"
COPIED = ROOT / "shared-meshes" / "pin.step"
MADE = ("out/press/summary.json", "out/press.plots/fields.png", "out/press.html", "pressures.png",
        "press.json", "out/pin.plots/fields.png", "out/pin.html")


def files():
    """Text by name, of those that the reader writes."""
    return dict(re.findall(r"^`([\w.]+)`:\n\n```\w*\n(.*?)^```", PAGE.read_text(), re.M | re.S))


def commands():
    """The lines of blocks without a language that begin with mortier; a line that goes on is one."""
    blocks = re.findall(r"^```\n(mortier .*?)^```", PAGE.read_text(), re.M | re.S)
    return [line for text in blocks for line in re.sub(r"\\\n\s*", "", text).splitlines() if line.strip()]


def main():
    folder = Path(sys.argv[1])
    for name, text in files().items():
        (folder / name).write_text(text)
    shutil.copy(COPIED, folder)
    made = [f"test -s {name}" for name in MADE]
    (folder / "tutorial.sh").write_text("\n".join(["set -ex", *commands(), *made, ""]))


if __name__ == "__main__":
    main()
