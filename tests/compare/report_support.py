"""Pages of mortier report in headless Chromium, and what one points at there."""
import re

import numpy as np

from browser import Browser
from support import InSharedFolder
from views_support import solve, view
import runs


def hovered(browser, run, count, places=False):
    """Texts and values of the page where there is a triangle under the mouse; with places of the window,
    if asked for."""
    browser.run("document.getElementById(arguments[0]).scrollIntoView({block: 'center'})", f"canvas{run}")
    area = browser.run("const a = document.getElementById(arguments[0]).getBoundingClientRect(); "
                       "return [a.left, a.top, a.width, a.height]", f"canvas{run}")
    found, where = [], []
    for i in range(count * 10):
        x = area[0] + area[2] * (0.5 + 0.45 * np.sin(12.9898 * (i + 1)))
        y = area[1] + area[3] * (0.5 + 0.45 * np.sin(78.233 * (i + 1)))
        browser.point(x, y)
        data, text = browser.run("const r = document.getElementById(arguments[0]); return [{...r.dataset}, "
                                 "r.textContent]",
                                 f"read{run}")
        if "triangle" in data:
            found.append((data["body"], int(data["triangle"]), int(data["vertex"]), float(data["value"]),
                          text))
            where.append((round(x), round(y)))
        if len(found) == count:
            break
    return (where, found) if places else found


def choose(browser, name, value):
    browser.run("const e = document.getElementById(arguments[0]); e.value = arguments[1]; "
                "e.dispatchEvent(new Event('input'))", name, value)
    settled(browser)


def settled(browser):
    """Waits until the page has drawn what was asked for."""
    browser.run("return new Promise(done => { const wait = () => document.querySelector('[aria-busy]') ? "
                "setTimeout(wait, 10) : requestAnimationFrame(() => requestAnimationFrame(() => done(1))); "
                "setTimeout(wait, 50); })")


class Pages(InSharedFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for variant in ("mortar", "interpolation"):
            solve(cls.folder, variant, "output.every=1", f"contact.variant={variant}", "time.steps=100")
        solve(cls.folder, "hertz", "output.every=1", "time.steps=2", scene="hertz")
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def page(self, *names):
        code, shown, errors = view(self.folder, "report", *names)
        self.assertEqual((code, errors), (0, ""))
        path = self.folder / shown.split(":")[0]
        milliseconds = self.browser.open(path)
        print(f"{'+'.join(names)}: {path.stat().st_size / 1e6:.2f} MB, usable after {milliseconds:.0f} ms")
        return path, milliseconds

    def forget_readbacks(self):
        """What the browser says of a test that reads pictures twice."""
        for message in self.browser.messages():
            self.assertIn("willReadFrequently", message)

    def tearDown(self):
        self.assertEqual(self.browser.messages(), [])
        self.assertIsNone(self.browser.run("return window.hacked || null"))

    def check_hover(self, name, run, step, field, count=6):
        result = runs.read(self.folder / name)
        found = result.at(step)
        known = result.fields(found)[field]
        values = result.values(found, known)
        largest = max(np.abs(each).max() for each in values.values())
        seen = hovered(self.browser, run, count)
        self.assertEqual(len(seen), count)
        for body, triangle, vertex, shown, text in seen:
            exact = values[body][vertex if known.by_vertex else triangle]
            digits = 3 if field == "error" else 4 if field == "u" else 5
            leading = np.floor(np.log10(max(np.abs(values[body]).max(), 1e-300)))
            self.assertLessEqual(abs(shown - exact), 0.51 * 10.0 ** (leading - digits + 1) if largest else 0,
                                 f"{field} of {body} {triangle}: {shown}, in the file {exact}")
            self.assertIn(f"{body}, ", text)
            self.assertIn(f"triangle {triangle}:", text)
            corner = found.bodies[body].triangles[triangle]
            self.assertIn(vertex, corner)
            error = found.bodies[body].cells["error"]
            self.assertLessEqual(abs(float(re.search(r"estimated error (\S+)$", text)[1]) - error[triangle]),
                                 0.006 * error.max())
        return seen
