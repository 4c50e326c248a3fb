#!/usr/bin/python3
"""The documentation as a site that needs no network: README.md, docs/ and what they link to, as HTML.

    docs/site.py [OUT]     default: build/site; then open OUT/index.html in a browser

Pandoc makes pages of Markdown and of notebooks, and MathML of formulas. Every link is followed: a folder
becomes its README.md or the list of its files, another text file a page that shows it, a picture is copied. A
link whose file or heading does not exist, a picture from elsewhere and a formula that pandoc cannot read are
named, one line each; then nothing is written, and the exit code is 1.
"""
import argparse
import html
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse
from pathlib import Path, PurePosixPath

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent
PICTURES = {".png", ".svg", ".gif", ".jpg"}
# Of Debian's fonts-dejavu-extra, which browsers set formulas well with;
# where it is not there, they take what the reader has.
FONT = Path("/usr/share/fonts/truetype/dejavu/DejaVuMathTeXGyre.ttf")
# Groups of the navigation; what is linked to but not named here is reached by that link.
NAVIGATION = {
    "Begin": ["README.md", "docs/tutorial.md", "docs/gallery.md"],
    "Use": ["docs/install.md", "docs/scene.md", "docs/limits.md", "docs/check.md", "docs/results.md",
            "docs/pictures.md", "docs/study.md", "docs/compare.md", "docs/python.md", "docs/scaling.md"],
    "Understand": ["docs/theory.md", "docs/sliding.md", "docs/space.md", "docs/bounds.md",
                   "docs/measurements.md", "docs/decisions.md", "docs/glossary.md", "docs/benchmarks.md",
                   "docs/published.md"],
    "Take part": ["CONTRIBUTING.md", "freefem/README.md", "shared-meshes/README.md", "CHANGELOG.md"],
}


class SiteError(Exception):
    pass


def placed(source):
    """Where the page or picture of a file of the repository stands in the site."""
    if (ROOT / source).is_dir():
        return source / "index.html"
    if source.name == "README.md":
        return source.parent / "index.html"
    if source.suffix in (".md", ".ipynb"):
        return source.with_suffix(".html")
    return source if source.suffix in PICTURES else source.with_name(source.name + ".html")


def between(page, target):
    """The address of a target as a page names it, both by their sources."""
    return urllib.parse.quote(os.path.relpath(placed(target), placed(page).parent))


def text_of(source):
    """What pandoc reads of a source: its format and the text."""
    path = ROOT / source
    if path.is_dir():
        names = sorted(each.name + "/" * each.is_dir() for each in path.iterdir() if each.name[0] != ".")
        listed = [f"- [{name}]({urllib.parse.quote(name)})\n" for name in names]
        return "gfm", f"# {source}\n\n{''.join(listed)}"
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise SiteError("neither text nor a picture") from None
    if source.suffix == ".ipynb":
        return "ipynb", text
    if source.suffix == ".md":
        # Pandoc knows no numbers of formulas.
        return "gfm+tex_math_dollars", re.sub(r"\\tag\{(\w+)\}", r"\\qquad\\text{(\1)}", text)
    fence = "`" * (1 + max([2, *map(len, re.findall("`+", text))]))
    return "gfm", f"# {source}\n\n{fence} {source.suffix[1:]}\n{text}\n{fence}\n"


def title_of(form, text):
    if form == "ipynb":
        text = "\n".join("".join(cell["source"]) for cell in json.loads(text)["cells"])
    found = re.search(r"^# (.+)$", text, re.M)
    return found[1] if found else "mortier"


def navigation(page):
    lines = []
    for group, sources in NAVIGATION.items():
        lines.append(f"<p>{group}</p><ul>")
        for source in map(PurePosixPath, sources):
            here = ' aria-current="page"' if source == page else ""
            title = title_of(*text_of(source))
            lines.append(f'<li><a href="{between(page, source)}"{here}>{html.escape(title)}</a></li>')
        lines.append("</ul>")
    return "\n".join(lines)


def sections(source, text):
    """For search: address of the page, anchor of a heading, the title with it and the text below."""
    title = title_of(*text_of(source))
    body = text.partition("<main")[2].partition("</nav>")[2] or text.partition("<main")[2]
    parts = re.split(r'<h[1-4][^>]* id="([^"]*)"[^>]*>(.*?)</h[1-4]>', body, flags=re.S)
    plain = [" ".join(html.unescape(re.sub(r"<annotation\b.*?</annotation>|<[^>]*>", " ", each,
                                           flags=re.S)).split()) for each in parts]
    for anchor, heading, words in zip(parts[1::3], plain[2::3], plain[3::3]):
        above = "" if heading == title else f"{title}: "
        yield [urllib.parse.quote(str(placed(source))), anchor, f"{above}{heading}", words]


class Site:
    """pages: their HTML by source; pictures: their sources; faults: lines that say what is wrong."""

    def __init__(self):
        self.pages, self.pictures, self.faults, self.anchors = {}, set(), [], []
        waiting = [PurePosixPath(source) for sources in NAVIGATION.values() for source in sources]
        waiting += [PurePosixPath("docs") / path.name for path in sorted(DOCS.glob("*.md"))]
        while waiting:
            source = waiting.pop(0)
            if source.suffix in PICTURES:
                self.pictures.add(source)
            elif source not in self.pages:
                try:
                    self.pages[source], found = self.linked(source, self.converted(source))
                    waiting += found
                except (SiteError, OSError) as error:
                    self.pages[source] = ""
                    self.faults.append(f"{source}: {error}")
        for page, target, anchor in self.anchors:
            if f'id="{html.escape(anchor)}"' not in self.pages[target]:
                self.faults.append(f"{page}: {target} has no heading #{anchor}")

    def converted(self, source):
        form, text = text_of(source)
        root = os.path.relpath(".", placed(source).parent)
        done = subprocess.run(
            ["pandoc", "-f", form, "-t", "html5", "--mathml", "--fail-if-warnings", "--template",
             str(DOCS / "site.html"), "--toc", "--toc-depth=3", "-V", f"root={root}", "-V",
             f"navigation={navigation(source)}", "-M", f"pagetitle={title_of(form, text)}"],
            input=text, capture_output=True, text=True, encoding="utf-8")
        if done.returncode != 0:
            raise SiteError(" ".join(done.stderr.split()))
        words = re.sub(r"<(pre|code|annotation)\b.*?</\1>|<[^>]*>", "", done.stdout, flags=re.S)
        if raw := re.search(r".*\$.*", words):
            raise SiteError(f"this formula is not read as one: {html.unescape(raw[0]).strip()}")
        return done.stdout

    def linked(self, page, text):
        """The page with the addresses that targets have in the site, and the sources of those."""
        found = []
        base = page if (ROOT / page).is_dir() else page.parent

        def address(match):
            kind, given = match[1], html.unescape(match[2])
            if re.match(r"[a-z]+:", given):
                if kind == "src":
                    self.faults.append(f"{page}: {given} is not a file of the repository")
                return match[0]
            path, _, anchor = given.partition("#")
            target = page
            if path:
                target = PurePosixPath(os.path.normpath(base / urllib.parse.unquote(path)))
                if target.parts[:1] == ("..",) or not (ROOT / target).exists():
                    self.faults.append(f"{page}: there is no {path}")
                    return match[0]
                if (ROOT / target / "README.md").is_file():
                    target /= "README.md"
                found.append(target)
            if anchor:
                self.anchors.append((page, target, urllib.parse.unquote(anchor)))
            where = between(page, target) if path else ""
            return f'{kind}="{html.escape(where)}{"#" * bool(anchor)}{html.escape(anchor)}"'

        # Of a page by template, the head and the navigation are right as they stand.
        head, mark, body = text.partition("<main")
        body = re.sub(r'(?<=\s)(href|src)="([^"]*)"(?=[^<>]*>)', address, body)
        return head + mark + body, found

    def write(self, folder):
        for source, text in self.pages.items():
            path = folder / placed(source)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        for source in self.pictures:
            path = folder / source
            path.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / source, path)
        style = (DOCS / "site.css").read_text(encoding="utf-8")
        if FONT.is_file():
            shutil.copyfile(FONT, folder / "formulas.ttf")
            style = '@font-face { font-family: "formulas"; src: url("formulas.ttf"); }\n' + style
        (folder / "site.css").write_text(style, encoding="utf-8")
        shutil.copyfile(DOCS / "search.js", folder / "search.js")
        index = [each for source, text in self.pages.items() if source.suffix in (".md", ".ipynb")
                 for each in sections(source, text)]
        (folder / "search-index.js").write_text(
            f"window.searchIndex = {json.dumps(index, ensure_ascii=False)};\n", encoding="utf-8")


def check_free(out):
    if out.exists() and not (out / "site.css").is_file() and (not out.is_dir() or any(out.iterdir())):
        raise SiteError(f"{out} is there and is no site: expected a new folder, or that of a site")


def replace(site, out):
    """Writes beside the folder first: an old site stays whole until the new one is."""
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{out.name}.", dir=out.parent) as beside:
        new = Path(beside) / "site"
        new.mkdir()
        site.write(new)
        if out.exists():
            out.rename(Path(beside) / "old")
        new.rename(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("out", nargs="?", type=Path, default=ROOT / "build" / "site", metavar="OUT")
    out = parser.parse_args().out.resolve()
    if shutil.which("pandoc") is None:
        print("site: there is no pandoc here; Debian's package has this name", file=sys.stderr)
        return 2
    try:
        check_free(out)
        site = Site()
        for fault in site.faults:
            print(f"site: {fault}", file=sys.stderr)
        if site.faults:
            return 1
        replace(site, out)
    except (SiteError, OSError) as error:
        print(f"site: {error}", file=sys.stderr)
        return 2
    print(f"{out}/index.html: {len(site.pages)} pages, {len(site.pictures)} pictures")
    return 0


if __name__ == "__main__":
    sys.exit(main())
