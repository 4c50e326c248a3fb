#!/usr/bin/python3
"""Draws docs/images/pictures/: the pictures of docs/pictures.md, from runs of the compression test.

    tests/compare/screenshots.py [--out DIR]
"""
import argparse
import sys
import tempfile
from pathlib import Path

from browser import Browser
from support import ROOT
from views_support import solve, view
import images

PAGES = {"report": (1180, 1010, False, 640), "report-dark": (1180, 1010, True, 640),
         "report-phone": (390, 1000, False, 300)}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "images" / "pictures", metavar="DIR")
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for variant in ("mortar", "interpolation"):
            solve(folder, variant, "time.steps=100", "output.every=10", f"contact.variant={variant}")
        for words in (("plot", "mortar", "interpolation", "--only", "fields", "--out", "fields.png"),
                      ("report", "mortar", "interpolation", "--out", "report.html")):
            code, _, errors = view(folder, *words)
            if code:
                sys.exit(errors)
        save(out / "fields.png", (folder / "fields.png").read_bytes(), 700)
        for name, (width, height, dark, shown) in PAGES.items():
            browser = Browser(width, height, dark)
            try:
                browser.open(folder / "report.html")
                left, top, w, h = browser.run("const c = document.querySelector('#canvas0'); "
                                              "c.scrollIntoView({block: 'center'}); "
                                              "const r = c.getBoundingClientRect(); "
                                              "return [r.left, r.top, r.width, r.height]")
                browser.point(left + 0.4 * w, top + 0.6 * h)
                browser.run("return new Promise(done => requestAnimationFrame(() => "
                            "requestAnimationFrame(done)))")
                save(out / f"{name}.png", browser.picture(), shown)
            finally:
                browser.close()


def save(path, png, width):
    path.write_bytes(images.small(png, width))
    print(path)


if __name__ == "__main__":
    main()
