"""The documentation as a site (docs/site.py): its links, and its pages in headless Chromium, where nothing is
fetched from elsewhere and formulas are formulas."""
import json
import re
import shutil
import subprocess
import sys
import time
import unittest
import urllib.parse
from html.parser import HTMLParser

from browser import Browser
from support import ROOT, InSharedFolder, answered_once

SOURCES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "LICENSE", "docs", "examples", "freefem/README.md",
           "shared-meshes/README.md")
# What a page that is drawn must satisfy: text that is code may hold anything.
WRONG = """
const faults = [], box = e => e.getBoundingClientRect();
const text = document.querySelector('main').cloneNode(true);
text.querySelectorAll('pre, code, annotation').forEach(e => e.remove());
const raw = text.textContent.match(/.*([$]|\\\\[a-z]).*/);
if (raw) faults.push('TeX: ' + raw[0]);
for (const e of document.querySelectorAll('math')) {
  if (box(e).width < 2 || box(e).height < 5) faults.push('no size: ' + e.textContent);
  for (const f of e.querySelectorAll('mfrac'))
    if (!(box(f.children[0]).top < box(f.children[1]).top - 2)) faults.push('no fraction: ' + f.textContent);
  for (const s of e.querySelectorAll('msup'))
    if (!(box(s.children[1]).left > box(s.children[0]).left)) faults.push('no power: ' + s.textContent);
}
for (const e of document.images) if (!(e.complete && e.naturalWidth > 0)) faults.push('no picture: ' + e.src);
return faults"""
# Waits until every picture is decoded. On a loaded machine the browser may drop requests of a page:
# it is asked for such a picture again, a few times; the addresses of those are returned.
PICTURES = """
const again = new Set(), pause = t => new Promise(done => setTimeout(done, t));
await Promise.all([...document.images].map(async image => {
  for (let tries = 0; tries < 4; tries++) {
    try { return await image.decode(); } catch (error) {
      again.add(image.src);
      await pause(200 * 2 ** tries);
      image.src = image.src;
    }
  }
}));
return [...again]"""


def make(root, out, environment):
    """Exit code and what is said."""
    done = subprocess.run([sys.executable, root / "docs" / "site.py", out], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, env=environment)
    return done.returncode, done.stdout


class Page(HTMLParser):
    """targets: (tag, address) of all that it names; names: its anchors."""

    def __init__(self, path):
        super().__init__()
        self.targets, self.names, self.formulas = [], set(), 0
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        self.formulas += tag == "math"
        for key, value in attributes:
            if key == "id":
                self.names.add(value)
            elif key in ("href", "src", "srcset", "data", "action", "poster"):
                self.targets.append((tag, value))


class Site(InSharedFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.site = cls.folder / "site"
        (cls.folder / "pandoc-answers").mkdir()
        cls.environment = answered_once("pandoc", cls.folder / "pandoc-answers")
        code, cls.said = make(ROOT, cls.site, cls.environment)
        assert code == 0, cls.said
        cls.pages = {path.resolve(): Page(path) for path in sorted(cls.site.rglob("*.html"))}
        cls.browser = Browser(network=True)
        cls.addClassCleanup(cls.browser.close)

    def test_every_address_is_in_the_site(self):
        checked = 0
        for path, page in self.pages.items():
            for tag, address in page.targets:
                with self.subTest(f"{path.relative_to(self.site)}: {address}"):
                    if re.match(r"[a-z]+:", address):
                        self.assertTrue(tag == "a" or address == "data:,", "fetched from elsewhere")
                        continue
                    name, _, anchor = address.partition("#")
                    target = (path.parent / urllib.parse.unquote(name)).resolve() if name else path
                    self.assertTrue(target.is_relative_to(self.site.resolve()) and target.is_file())
                    if anchor:
                        self.assertIn(urllib.parse.unquote(anchor), self.pages[target].names)
                    checked += 1
        self.assertGreater(checked, 500)

    def test_every_page_and_picture_of_the_docs_is_there(self):
        for source in sorted((ROOT / "docs").glob("*.md")):
            self.assertIn((self.site / "docs" / f"{source.stem}.html").resolve(), self.pages)
        shown = set()
        for source in (ROOT / "README.md", *(ROOT / "docs").glob("*.md")):
            shown |= {source.parent / name for name in re.findall(r'src="([^"]+)"', source.read_text())}
        self.assertGreater(len(shown), 15)
        for picture in shown:
            copy = self.site / picture.relative_to(ROOT)
            self.assertEqual(copy.read_bytes(), picture.read_bytes())
        formulas = sum(page.formulas for page in self.pages.values())
        self.assertGreater(formulas, 300)

    def test_pages_in_a_browser(self):
        browser = self.browser
        folder = self.site.resolve().as_uri()
        for path in self.pages:
            with self.subTest(str(path.relative_to(self.site))):
                browser.send("POST", "/url", {"url": path.as_uri()})
                dropped = browser.run_async(PICTURES)
                if dropped:
                    print(f"{path.name}: loaded again: {dropped}")
                self.assertEqual(browser.run(WRONG), [])
                browser.size(360, 740)
                self.assertLessEqual(browser.run("return document.documentElement.scrollWidth"), 360)
                browser.size(1280, 900)
                asked = browser.requests(path)
                self.assertIn(f"{folder}/site.css", asked)
                if self.pages[path].formulas:
                    self.assertIn(f"{folder}/formulas.ttf", asked)
                elsewhere = [address for address in asked if not address.startswith((f"{folder}/", "data:"))]
                self.assertEqual(elsewhere, [])
                self.assertEqual([message for message in browser.messages()
                                  if not any(address in message for address in dropped)], [])
        # The checks see a formula that is none.
        broken = self.folder / "broken.html"
        broken.write_text("<main>$\\dot x$ <math></math><img src=none.png></main>")
        browser.send("POST", "/url", {"url": broken.as_uri()})
        self.assertEqual(len(browser.run_async(PICTURES)), 1)
        faults = [fault.split(":")[0] for fault in browser.run(WRONG)]
        self.assertEqual(faults, ["TeX", "no size", "no picture"])
        self.assertNotEqual(browser.messages(), [])
        self.assertIn(f"{self.folder.resolve().as_uri()}/none.png", browser.requests(broken))

    def test_search(self):
        """Words are found where they stand, in pages at any depth; the index is loaded when it is needed."""
        browser = self.browser
        index = f"{self.site.resolve().as_uri()}/search-index.js"
        hits = "return [...document.querySelectorAll('#found a')].map(a => [a.href, a.textContent])"
        for page in ("index.html", "docs/scene.html", "docs/notebooks/note.html"):
            path = self.site / page
            browser.send("POST", "/url", {"url": path.as_uri()})
            self.assertNotIn(index, browser.requests(path))
            browser.press("#search", "scheduler address workers")
            self.wait(browser, "return document.querySelectorAll('#found a').length > 0")
            self.assertIn(index, browser.requests(path))
            address, words = browser.run(hits)[0]
            self.assertIn("docs/study.html#", address)
            self.assertIn("scheduler", words)
            self.assertTrue(browser.run("return document.querySelectorAll('#found mark').length > 1"))
            browser.press("#search", "\ue007")  # enter: the first one
            self.wait(browser, "return location.pathname.endsWith('docs/study.html')")
        browser.press("#search", "zqxj")
        self.wait(browser, "return document.getElementById('found').textContent === 'nothing found'")
        browser.size(360, 740)
        self.assertLessEqual(browser.run("return document.documentElement.scrollWidth"), 360)
        browser.size(1280, 900)
        self.assertEqual(browser.messages(), [])

    def wait(self, browser, condition):
        for _ in range(200):
            if browser.run(condition):
                return
            time.sleep(0.05)
        self.fail(condition)

    def test_every_address_of_the_index_is_a_heading(self):
        text = (self.site / "search-index.js").read_text()
        sections = json.loads(text.removeprefix("window.searchIndex = ").rstrip(";\n"))
        self.assertGreater(len(sections), 150)
        self.assertLess(len(text), 1e6)
        for page, anchor, title, words in sections:
            self.assertIn(anchor, self.pages[(self.site / page).resolve()].names, page)
            self.assertTrue(title)
            self.assertNotIn("<", title)
        self.assertTrue(any("mean of the contact pressure" in words for *_, words in sections))

    def test_what_is_wrong_is_named_and_nothing_is_written(self):
        copy = self.folder / "copy"
        for source in SOURCES:
            (copy / source).parent.mkdir(parents=True, exist_ok=True)
            if (ROOT / source).is_dir():
                shutil.copytree(ROOT / source, copy / source, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copyfile(ROOT / source, copy / source)
        page, out = copy / "docs" / "check.md", self.folder / "of-copy"
        faults = {
            "[x](nothing.md)": "docs/check.md: there is no nothing.md",
            "[x](scene.md#nothing)": "docs/check.md: docs/scene.md has no heading #nothing",
            "[x](#nothing)": "docs/check.md: docs/check.md has no heading #nothing",
            "![x](images/nothing.png)": "docs/check.md: there is no images/nothing.png",
            "![x](https://x.org/x.png)": "docs/check.md: https://x.org/x.png is not a file of the repository",
            "[x](../../../etc/passwd)": "docs/check.md: there is no ../../../etc/passwd"}
        page.write_text("\n\n".join([page.read_text(), *faults]))
        for name, formula in (("study", "$\\nothing{x}$"), ("compare", "$a\n- b$")):
            with (copy / "docs" / f"{name}.md").open("a") as other:
                other.write(f"\n{formula}\n")
        code, said = make(copy, out, self.environment)
        self.assertEqual(code, 1)
        self.assertIn("site: docs/study.md: [WARNING] Could not convert TeX math", said)
        self.assertIn("site: docs/compare.md: this formula is not read as one: $a", said)
        of_check = [line for line in said.splitlines() if line.startswith("site: docs/check.md")]
        self.assertEqual(sorted(of_check), sorted(f"site: {fault}" for fault in faults.values()))
        self.assertFalse(out.exists())

    def test_only_a_site_is_replaced(self):
        mine = self.folder / "mine"
        mine.mkdir()
        (mine / "thesis.tex").write_text("kept")
        code, said = make(ROOT, mine, self.environment)
        self.assertEqual((code, said.count("\n")), (2, 1), said)
        self.assertEqual([path.name for path in mine.iterdir()], ["thesis.tex"])
        before = {path: path.read_bytes() for path in self.site.rglob("*") if path.is_file()}
        self.assertEqual(make(ROOT, self.site, self.environment)[0], 0)
        self.assertEqual(set(before), {path for path in self.site.rglob("*") if path.is_file()})
        for path, data in before.items():
            self.assertTrue(path.read_bytes() == data, path)


if __name__ == "__main__":
    unittest.main()
