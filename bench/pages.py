#!/usr/bin/python3
"""Size of pages of mortier report, and how long headless Chromium takes from navigation to the first drawing
that answers to mouse and keys.

Usage: bench/pages.py [--repeat 9] [--mortier build/mortier]

Needs Debian's chromium and chromium-driver. Milliseconds: `first` is that time of the first page in a new
browser, `usable` the least and the median of those that follow; `processor` is the median of the processor
time of the page's thread until then, which does not depend on what else the machine does. `report` and
`plot`: the processor time of these commands over that of the run.
"""
import argparse
import os
import statistics
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def note(solve, folder):
    """The test of the note with all of its hundred steps."""
    solve(folder, "note", "output.every=1", "time.steps=100")


def membrane(mortier, folder):
    """1e5 triangles, five steps: Cook's membrane."""
    mortier("mesh", "quadrilateral", "--cells", "224", "--corners", "0,0", "48,44", "48,60", "0,44",
            "fine.mesh", cwd=folder)
    done = mortier("run", ROOT / "scenes/cook.toml", "--quiet", "--out", "membrane", "--set", "time.steps=5",
                   "output.every=1", "body.panel.mesh=fine.mesh", cwd=folder)
    assert done.returncode == 0, done.stderr


def solid(mortier, folder):
    """1e5 unknowns in space, one step."""
    from space_page_test import MANY
    (folder / "solid.toml").write_text(MANY)
    done = mortier("run", "solid.toml", "--quiet", "--out", "solid", cwd=folder)
    assert done.returncode == 0, done.stderr


def processor_time(work):
    """What a call takes of this process and its children [s]."""
    begin = os.times()
    work()
    return sum(os.times()[:4]) - sum(begin[:4])


def opened(browser, path):
    """Milliseconds until the page can be used, and processor time of its thread."""
    milliseconds = browser.open(path)
    metrics = {each["name"]: each["value"] for each in browser.cdp("Performance.getMetrics")["metrics"]}
    return milliseconds, 1e3 * metrics["TaskDuration"]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=9)
    parser.add_argument("--mortier", default=os.environ.get("MORTIER", str(ROOT / "build" / "mortier")))
    options = parser.parse_args()
    os.environ["MORTIER"] = str(Path(options.mortier).resolve())
    sys.path.insert(0, str(ROOT / "tests" / "compare"))
    from browser import Browser
    from support import mortier
    from views_support import solve, view
    with tempfile.TemporaryDirectory(prefix="mortier-pages-") as folder:
        folder = Path(folder)
        runs = {"note": lambda: note(solve, folder), "membrane": lambda: membrane(mortier, folder),
                "solid": lambda: solid(mortier, folder)}

        def made(command, name, *more):
            code, _, errors = view(folder, command, name, *more)
            if code:
                sys.exit(errors)

        print(f"{'page':10}{'MB':>8}{'first':>8}{'usable':>8}{'median':>8}{'processor':>11}{'messages':>10}"
              f"{'report':>8}{'plot':>8}")
        for name, run in runs.items():
            ran = processor_time(run)
            report = processor_time(lambda: made("report", name, "--out", f"{name}.html")) / ran
            plot = processor_time(lambda: made("plot", name)) / ran
            path = folder / f"{name}.html"
            browser = Browser()
            browser.cdp("Performance.enable", timeDomain="threadTicks")
            try:
                found = [opened(browser, path) for _ in range(1 + options.repeat)]
                messages = len(browser.messages())
            finally:
                browser.close()
            first, *times = [each[0] for each in found]
            print(f"{name:10}{path.stat().st_size / 1e6:8.2f}{first:8.0f}{min(times):8.0f}"
                  f"{statistics.median(times):8.0f}{statistics.median(each[1] for each in found):11.0f}"
                  f"{messages:10}{report:8.2f}{plot:8.2f}", flush=True)


if __name__ == "__main__":
    main()
