#!/usr/bin/python3
"""Draws docs/images/pictures/: the pictures of docs/pictures.md, from runs of the compression test, and that
of the scene of README.md.

    tests/compare/screenshots.py [--out DIR]
"""
import argparse
import re
import sys
import tempfile
from pathlib import Path

from browser import Browser
from support import ROOT, mortier
from views_support import solve, view
import images
import pictures
import runs

# of each page its width and height, whether it is dark, and the width of the picture
PAGES = {"report": ("report", 1180, 1010, False, 640), "report-dark": ("report", 1180, 1010, True, 640),
         "report-phone": ("report", 390, 1000, False, 300), "report-space": ("space", 1180, 760, False, 640)}


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
        solve(folder, "punch", scene="round-punch")
        for words in (("report", "punch", "--out", "space.html"),
                      ("plot", "mortar", "interpolation", "--only", "fields", "--out", "fields.png"),
                      ("report", "mortar", "interpolation", "--out", "report.html")):
            code, _, errors = view(folder, *words)
            if code:
                sys.exit(errors)
        save(out / "fields.png", (folder / "fields.png").read_bytes(), 700)
        save(out / "roller.png", roller(folder), 640)
        for name, (page, width, height, dark, shown) in PAGES.items():
            browser = Browser(width, height, dark)
            try:
                browser.open(folder / f"{page}.html")
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


def roller(folder):
    """The bodies of the scene of README.md."""
    scene = re.search(r"^```toml\n(.*?)^```", (ROOT / "README.md").read_text(), re.M | re.S)[1]
    (folder / "roller.toml").write_text(scene)
    done = mortier("run", "roller.toml", "--accuracy", "0.02", "--quiet", "--out", "roller", cwd=folder)
    assert done.returncode == 0, done.stderr
    with pictures.plt.rc_context(pictures.STYLE):
        seen = [pictures.view(runs.Result(folder / "roller"))]
        figure = pictures.fields(seen, scale=1, window=(-9, 9, -7, 5), strips=False)
        return images.picture(figure, "png", dpi=110)


def save(path, png, width):
    path.write_bytes(images.small(png, width))
    print(path)


if __name__ == "__main__":
    main()
