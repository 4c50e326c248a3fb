"""mortier report in headless Chromium: what one points at is what the files hold, by mouse and by keyboard,
on a desk and on a phone, in the light and in the dark; and text of others is shown, never run."""
import json
import re
import shutil
import unittest

import numpy as np

from browser import Browser
from support import ROOT, InSharedFolder, mortier
from views_support import solve, view
import coding
import recovery
import results
import runs

RING = """
title = "A ring in a ring, closed"
[[body]]
name = "inner"
mesh = "inner.mesh"
material = {{ young = 100, poisson = 0.3 }}
boundary = [ {{ label = 1, pressure = "1*t", ut = 0 }} ]
[[body]]
name = "outer"
mesh = "outer.mesh"
material = {{ young = 50, poisson = 0.2 }}
boundary = [ {{ label = 2, un = 0, ut = 0 }} ]
[[contact]]
nonmortar = {{ body = "inner", label = 2 }}
mortar = {{ body = "outer", label = 1 }}
initial = "close"
[time]
end = 1
steps = {steps}
[output]
every = 1
"""
COARSE = """
degree = 2
[[body]]
name = "ring"
mesh = { shape = "annulus", inner = 1, outer = 2, cells = [8, 1], span = "full" }
material = { young = 100, poisson = 0.3 }
boundary = [ { label = 1, pressure = 1 }, { label = 2, un = 0, ut = 0 } ]
[time]
end = 1
steps = 1
"""
HOSTILE = ["</script><script>window.hacked=1</script>", "<img src=x onerror=window.hacked=1>",
           "\"'`${window.hacked=1}\\",
           "a\u2028b\u2029c\u0000\u001b[31m\u202e", "]]><!--<script>", "&lt;script&gt;&amp;"]


CONTRASTS = """
const found = [];
const behind = element => {
  for (let e = element; e; e = e.parentElement) {
    const colour = getComputedStyle(e).backgroundColor;
    if (!/, 0\\)$/.test(colour)) return colour;
  }
  return 'rgb(255, 255, 255)';
};
document.querySelectorAll('details').forEach(each => { each.open = true; });
const walker = document.createTreeWalker(document.querySelector('main'), NodeFilter.SHOW_TEXT);
while (walker.nextNode()) {
  const e = walker.currentNode.parentElement, style = getComputedStyle(e), words = walker.currentNode.data;
  if (words.trim() && e.tagName !== 'OPTION')
    found.push([e.closest('svg') ? style.fill : style.color, behind(e), words.slice(0, 40), true]);
}
for (const e of document.querySelectorAll('svg path[class^=c], .key i')) {
  const style = getComputedStyle(e);
  found.push([e.tagName === 'I' ? style.backgroundColor : style.stroke, behind(e.parentElement), '', false]);
}
return found;
"""


def contrast(*colours):
    """Of two colours `rgb(r, g, b)`, as WCAG 2 defines it."""
    light = []
    for colour in colours:
        parts = [int(part) / 255 for part in re.findall(r"\d+", colour)[:3]]
        linear = [c / 12.92 if c <= 0.03928 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
        light.append(np.dot([0.2126, 0.7152, 0.0722], linear) + 0.05)
    return max(light) / min(light)


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
        result = runs.Result(self.folder / name)
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

    def test_hovered_values_are_those_of_the_files(self):
        path, milliseconds = self.page("mortar", "interpolation")
        self.assertLess(path.stat().st_size, 2e6)  # of two runs
        for run in json.loads(re.search(r'id="data">(.*)</script>', path.read_text())[1])["runs"]:
            last = {how for _, how, _ in run["steps"][-1]["f"]}
            self.assertLessEqual(last, {coding.BEFORE, coding.GIVEN},
                                 "what is seen first needs no other step")
        self.assertLess(milliseconds, 10000)
        for step in (100, 37, 0):
            choose(self.browser, "step", step)
            for field in ("von_mises", "s12", "uy", "u", "e22", "error"):
                choose(self.browser, "field", field)
                with self.subTest(step=step, field=field):
                    self.check_hover("interpolation", 1, step, field, 3)
        choose(self.browser, "step", 100)
        choose(self.browser, "field", "s22")
        for _, _, _, value, text in self.check_hover("mortar", 0, 100, "s22"):
            self.assertEqual(value, -10)
            self.assertIn("stress s22 -10 Pa", text)

    def test_the_triangle_under_the_pointer_is_the_one_that_is_there(self):
        """The geometry of the page against that of the files, zoomed and moved,
        at several scales of the displacements."""
        self.page("interpolation")
        run = results.read_mortier(self.folder / "interpolation")
        for index in (0, 5, 8):  # of the slider
            choose(self.browser, "scale", index)
            scale = float(self.browser.run("return document.querySelector('output[for=scale]').textContent"))
            self.browser.press("#canvas0", "0")
            settled(self.browser)
            view = self.browser.run("return document.getElementById('canvas0').dataset.view")
            whole = float(view.split(",")[2])
            self.browser.press("#canvas0", "++\ue014")  # closer by 0.8 twice, then a step to the right
            settled(self.browser)
            shapes = {name: body.points + scale * body.displacement for name, body in run.bodies.items()}
            seen = list(zip(*hovered(self.browser, 0, 8, places=True)))
            shown = self.browser.run("return document.getElementById('canvas0').dataset.view")
            middle_x, middle_y, half = map(float, shown.split(","))
            left, top, width, height = self.browser.run(
                "const r = document.getElementById('canvas0').getBoundingClientRect(); "
                "return [r.left, r.top, r.width, r.height]")
            self.assertNotEqual(half, whole)
            pixel = 2 * half / width
            for (x, y), (body, triangle, *_) in seen:
                place = np.array([middle_x + (x - left - width / 2) * pixel,
                                  middle_y - (y - top - height / 2) * pixel])
                corners = shapes[body][run.bodies[body].triangles[triangle]]
                # how far to the left of each side, counterclockwise
                for a, b in zip(corners, np.roll(corners, -1, axis=0)):
                    side = b - a
                    self.assertGreater((side[0] * (place - a)[1]
                                        - side[1] * (place - a)[0]) / np.hypot(*side), -2 * pixel)

    def test_keyboard(self):
        self.page("interpolation")
        value = "return document.getElementById(arguments[0]).value"
        output = "return document.querySelector(`output[for=${arguments[0]}]`).textContent"
        self.assertEqual(self.browser.run(value, "step"), "100")
        self.browser.press("#step", "\ue012\ue012")  # left, twice
        settled(self.browser)
        self.assertEqual(self.browser.run(output, "step"), "t = 0.98 s")
        self.check_hover("interpolation", 0, 98, "von_mises", 2)
        self.browser.press("#step", "\ue011")  # home
        settled(self.browser)
        self.assertEqual(self.browser.run(output, "step"), "t = 0 s")
        self.browser.press("#step", "\ue010")  # end
        before = self.browser.run(output, "scale")
        self.browser.press("#scale", "\ue014")
        settled(self.browser)
        self.assertGreater(float(self.browser.run(output, "scale")), float(before))
        self.browser.press("#canvas0", "0")
        settled(self.browser)
        picture = "return document.getElementById('canvas0').toDataURL()"
        seen = [self.browser.run(picture)]
        for key in ("+", "\ue014", "-", "0"):
            self.browser.press("#canvas0", key)
            settled(self.browser)
            seen.append(self.browser.run(picture))
        self.assertEqual(len(set(seen[:4])), 4)
        self.assertEqual(seen[4], seen[0])

    def test_charts_are_those_of_the_files(self):
        self.page("mortar", "interpolation")
        for name, r in (("mortar", 0), ("interpolation", 1)):
            run = results.read_mortier(self.folder / name)
            marks = self.browser.run("return [...document.querySelectorAll(`#pressure0-0 "
                                     "circle.c${arguments[0]}`)].map(c => [Number(c.getAttribute('cx')), "
                                     "Number(c.getAttribute('cy'))])", r)
            x, y = np.array(marks).T
            self.assertEqual(len(x), len(run.contact.pressure))
            pressure = run.contact.pressure
            if np.ptp(pressure) > 1e-6:
                slope, constant = np.polyfit(pressure, y, 1)
                np.testing.assert_allclose(slope * pressure + constant, y, atol=0.11)
                self.assertLess(slope, 0)
            slope, constant = np.polyfit(run.contact.position[:, 0], x, 1)
            np.testing.assert_allclose(slope * run.contact.position[:, 0] + constant, x, atol=0.11)
        titles = self.browser.run("return [...document.querySelectorAll('#histories "
                                  "text:first-child')].map(t => t.textContent)")
        self.assertIn("contact force [N/m]", titles)
        self.browser.run("document.querySelectorAll('details').forEach(d => d.open = true)")
        text = self.browser.run("return document.body.innerText")
        for words in ("forces that are not balanced", "von Mises stress", "left out",
                      "inertia, friction, finite strains and slips"):
            self.assertIn(words, text)
        scene = self.browser.run("return document.querySelector('.scene').textContent")
        self.assertIn('projection = "elasticity"', scene)

    def test_hertz_and_a_closed_ring(self):
        self.page("hertz")
        choose(self.browser, "step", 1)
        self.check_hover("hertz", 0, 1, "von_mises")
        for name, cells, inner, outer in (("inner", "40,4", 1, 1.5), ("outer", "56,4", 1.5, 2)):
            mortier("mesh", "annulus", "--cells", cells, "--inner", inner, "--outer", outer, "--span", "full",
                    f"{name}.mesh", cwd=self.folder)
        (self.folder / "ring.toml").write_text(RING.format(steps=2))
        done = mortier("run", "ring.toml", "--quiet", "--out", "ring", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.page("ring")
        choose(self.browser, "field", "s11")
        self.check_hover("ring", 0, 2, "s11")
        self.assertEqual(self.browser.run("return document.querySelectorAll('#pressure0-0 circle').length"),
                         40)

    def test_what_the_scene_asks_for_stands_first(self):
        (self.folder / "asked.toml").write_text((ROOT / "scenes/compression.toml").read_text().replace(
            "../shared-meshes", str(ROOT / "shared-meshes")) +
            '\n[[quantity]]\nname = "ground"\nreaction = { body = "lower", label = 1 }\ncomponent = "y"\n')
        done = mortier("run", "asked.toml", "--quiet", "--out", "asked", "--set", "time.steps=5",
                       cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.page("asked")
        table = self.browser.run("return [...document.querySelectorAll('#quantities td')]"
                                 ".map(cell => cell.textContent)")
        self.assertEqual([table[0], float(table[1]), table[2]], ["ground", 10, "N/m"])
        titles = self.browser.run("return [...document.querySelectorAll('#asked text:first-child')]"
                                  ".map(title => title.textContent)")
        self.assertEqual(titles, ["ground [N/m]", "contact force [N/m] over displacement"])
        order = self.browser.run("return [...document.querySelectorAll('#quantities, #asked, #contact, "
                                 "#canvas0, #histories')].map(each => each.id)")
        self.assertEqual(order, ["quantities", "asked", "contact", "canvas0", "histories"])

    def test_the_legend_has_name_unit_and_ticks_where_their_colours_are(self):
        self.page("hertz")
        for field, words in (("von_mises", "von Mises stress [Pa]"), ("s12", "stress s12 [Pa]")):
            choose(self.browser, "field", field)
            self.assertEqual(self.browser.run("return document.querySelector('.bar div').textContent"),
                             words + ", recovered at the vertices")
            marks = self.browser.run("return [...document.querySelectorAll('.scale span')].map(s => "
                                     "[parseFloat(s.textContent.replace(/[^-0-9.e]/g, '')), "
                                     "parseFloat(s.style.left)])")
            self.assertGreaterEqual(len(marks), 3)
            value, part = np.array(marks).T
            slope, constant = np.polyfit(value, part, 1)
            np.testing.assert_allclose(slope * value + constant, part, atol=0.01)
            self.assertGreater(slope, 0)

    def test_values_are_recovered_or_raw_in_smooth_colours_or_bands(self):
        self.page("hertz")
        picture = "return document.getElementById('canvas0').toDataURL()"
        legend = "return document.querySelector('.bar div').textContent"
        seen = {}
        for values, colours in (("recovered", "smooth"), ("raw", "smooth"), ("raw", "bands"),
                                ("recovered", "bands")):
            choose(self.browser, "values", values)
            choose(self.browser, "colours", colours)
            seen[values, colours] = self.browser.run(picture)
            self.assertEqual("recovered" in self.browser.run(legend), values == "recovered")
        self.assertEqual(len(set(seen.values())), 4)
        bar = ("const c = document.querySelector('.bar canvas'), d = c.getContext('2d').getImageData(0, 0, "
               "c.width, 1).data, s = new Set(); for (let i = 0; i < d.length; i += 4) "
               "s.add([d[i], d[i + 1], d[i + 2]].join()); return s.size")
        self.assertEqual(self.browser.run(bar), 10)
        choose(self.browser, "colours", "smooth")
        self.assertGreater(self.browser.run(bar), 100)
        self.forget_readbacks()
        # Where it is marked as largest, it is: of the triangles, and of their means at the vertices.
        run = results.read_mortier(self.folder / "hertz")
        raw = max(body.cells["von_mises"].max() for body in run.bodies.values())
        smooth = max(recovery.von_mises(*(recovery.averaged(body, s) for s in body.stress.T)).max()
                     for body in run.bodies.values())
        self.assertNotEqual(raw, smooth)
        for values, largest in (("raw", raw), ("recovered", smooth)):
            choose(self.browser, "values", values)
            told = self.browser.run("return document.getElementById('most0').textContent")
            self.assertRegex(told, r"^largest \S+ Pa in (\w+) at \(\S+, \S+\)$")
            self.assertAlmostEqual(float(told.split()[1]) / largest, 1, delta=1e-3)

    def test_a_range_that_is_set_stays(self):
        self.page("hertz")
        marks = ("return [...document.querySelectorAll('.scale span')].map(s => "
                 "[parseFloat(s.textContent.replace(/[^-0-9.e]/g, '')), parseFloat(s.style.left)])")

        def ends():
            value, part = np.array(self.browser.run(marks)).T
            slope, constant = np.polyfit(part, value, 1)
            return constant, constant + 100 * slope

        automatic = ends()
        high = automatic[1] / 2
        choose(self.browser, "high", str(high))
        self.assertAlmostEqual(ends()[1] / high, 1, delta=1e-3)
        self.assertIn("\u2192", self.browser.run("return document.querySelector('.scale').textContent"))
        choose(self.browser, "step", 0)
        choose(self.browser, "field", "uy")
        self.assertEqual(self.browser.run("return document.getElementById('high').value"), "")
        choose(self.browser, "field", "von_mises")
        self.assertAlmostEqual(ends()[1] / high, 1, delta=1e-3)
        choose(self.browser, "high", "")
        choose(self.browser, "step", 2)
        np.testing.assert_allclose(ends(), automatic, atol=1e-3 * automatic[1])

    def test_letters_have_one_size(self):
        """On a desk and on a phone, in charts, tables and text."""
        self.page("mortar", "interpolation")
        sizes = ("const found = []; for (const e of document.querySelectorAll('svg text, td, p, label, h3')) "
                 "{ const box = e.closest('svg'), scale = box ? box.getBoundingClientRect().width / "
                 "box.viewBox.baseVal.width : 1; found.push(parseFloat(getComputedStyle(e).fontSize) * "
                 "scale); } return [Math.min(...found), Math.max(...found)]")
        for width in (1280, 800, 360):
            self.browser.size(width, 900)
            settled(self.browser)
            settled(self.browser)
            low, high = self.browser.run(sizes)
            self.assertGreater(low, 11.9)
            self.assertLess(high, 16.1)
        self.browser.size(1280, 900)

    def test_curves_of_quadratic_triangles(self):
        """A ring of a few of them has the area of a ring, not of a polygon."""
        (self.folder / "coarse.toml").write_text(COARSE)
        done = mortier("run", "coarse.toml", "--quiet", "--out", "coarse", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.page("coarse")
        choose(self.browser, "scale", 0)
        choose(self.browser, "field", "region")
        for name in ("mesh", "ghost"):
            self.browser.run(f"document.getElementById('{name}').click()")
        settled(self.browser)
        pixels, half, width = self.browser.run(
            "const c = document.getElementById('canvas0'), d = c.getContext('2d').getImageData(0, 0, c.width,"
            " c.height).data; let n = 0; for (let i = 3; i < d.length; i += 4) n += d[i] === 255; "
            "return [n, Number(c.dataset.view.split(',')[2]), c.width]")
        self.forget_readbacks()
        area = pixels * (2 * half / width) ** 2
        polygon = 0.5 * 8 * np.sin(2 * np.pi / 8) * (2**2 - 1)
        self.assertLess(polygon, 0.91 * np.pi * (2**2 - 1))
        self.assertAlmostEqual(area / (np.pi * (2**2 - 1)), 1, delta=0.02)

    def test_the_band_of_the_pressure_is_wide_where_pressures_alternate(self):
        """Interpolation on meshes that do not match alternates, mortar is exact."""
        widths = {}
        for name in ("mortar", "interpolation"):
            result = runs.Result(self.folder / name)
            run = result.at(100)
            line = result.lines(run)[0]
            body = run.bodies[line.nonmortar]
            widths[name] = np.abs(recovery.NormalStress(body, line)(body) - line.pressure).max()
        self.assertLess(widths["mortar"], 1e-9)
        self.assertGreater(widths["interpolation"], 1)
        self.page("interpolation")
        self.assertEqual(self.browser.run("return document.querySelectorAll('#pressure0-0 .under').length"),
                         1)

    def test_contrast(self):
        """WCAG 2, AA: every letter 4.5 to what is behind it, every line of a run 3 to the paper."""
        self.page("mortar", "interpolation")
        self.browser.run("for (const kind of ['soft', 'bad']) {const p = document.createElement('p'); "
                         "p.className = kind; p.textContent = kind; "
                         "document.querySelector('main').append(p);}")
        for scheme in ("light", "dark"):
            self.browser.cdp("Emulation.setEmulatedMedia",
                             features=[{"name": "prefers-color-scheme", "value": scheme}])
            pairs = self.browser.run(CONTRASTS)
            self.assertGreater(len(pairs), 100)
            worst = min((contrast(ink, paper), words) for ink, paper, words, letters in pairs if letters)
            self.assertGreater(worst[0], 4.5, f"{scheme}: {worst[1]}")
            line = min(contrast(ink, paper) for ink, paper, _, letters in pairs if not letters)
            print(f"contrast, {scheme}: letters {worst[0]:.2f} ({worst[1]}), lines {line:.2f}")
            self.assertGreater(line, 3, scheme)
        self.browser.cdp("Emulation.setEmulatedMedia",
                         features=[{"name": "prefers-color-scheme", "value": "light"}])

    def test_a_hundred_thousand_triangles(self):
        """Five steps of Cook's membrane: smooth fields and a corner."""
        mortier("mesh", "quadrilateral", "--cells", "224", "--corners", "0,0", "48,44", "48,60", "0,44",
                "fine.mesh", cwd=self.folder)
        done = mortier("run", ROOT / "scenes/cook.toml", "--quiet", "--out", "fine", "--set", "time.steps=5",
                       "output.every=1", "body.panel.mesh=fine.mesh", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        path, milliseconds = self.page("fine")
        self.assertLess(path.stat().st_size, 2e6)
        self.assertLess(milliseconds, 20000)
        for step, field in ((5, "s12"), (2, "von_mises"), (2, "ux")):
            choose(self.browser, "step", step)
            choose(self.browser, "field", field)
            self.check_hover("fine", 0, step, field, 3)

    def test_phone_and_dark(self):
        self.page("mortar", "interpolation")
        for width in (360, 412, 800):
            self.browser.size(width, 740)
            settled(self.browser)
            self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth"), width)
            shown = self.browser.run("return [...document.querySelectorAll('canvas[id]')]"
                                     ".map(c => c.getBoundingClientRect().width)")
            self.assertGreater(min(shown), 300)
            if width < 600:  # a finger on the middle of the picture says what is there
                x, y = self.browser.run("const c = document.getElementById('canvas0'); "
                                        "c.scrollIntoView({block: 'center'}); const r = "
                                        "c.getBoundingClientRect(); return [r.left + r.width/2, r.top + "
                                        "0.7*r.height]")
                self.browser.cdp("Input.dispatchTouchEvent", type="touchStart",
                                 touchPoints=[{"x": x, "y": y}])
                self.browser.cdp("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
                settled(self.browser)
                self.assertEqual(self.browser.run("return document.getElementById('read0').dataset.value"),
                                 "10")
        self.browser.size(1280, 900)
        looks = "const s = getComputedStyle(document.body); return [s.color, s.backgroundColor]"
        light = self.browser.run(looks)
        self.browser.cdp("Emulation.setEmulatedMedia",
                         features=[{"name": "prefers-color-scheme", "value": "dark"}])
        dark = self.browser.run(looks)
        self.browser.cdp("Emulation.setEmulatedMedia",
                         features=[{"name": "prefers-color-scheme", "value": "light"}])
        bright = [[sum(map(int, re.findall(r"\d+", colour)[:3])) for colour in pair]
                  for pair in (light, dark)]
        self.assertGreater(bright[0][1] - bright[0][0], 500)
        self.assertGreater(bright[1][0] - bright[1][1], 500)

    def test_text_of_others_is_shown_and_never_run(self):
        shutil.copytree(self.folder / "hertz", self.folder / "hostile")
        path = self.folder / "hostile" / "summary.json"
        summary = json.loads(path.read_text())
        for text in HOSTILE:
            path.write_text(json.dumps({**summary, "title": text, "scene": text, "scene_text": text,
                                        "settings": [text],
                                        "plane": text, "status": "failed", "reason": text,
                                        "accuracy": {text: text}, "final": {**summary["final"], text: 1}}))
            page, _ = self.page("hostile")
            self.assertEqual(self.browser.messages(), [], text)
            self.assertIsNone(self.browser.run("return window.hacked || null"), text)
            self.assertEqual(self.browser.run("return document.querySelector('.scene').textContent"), text)
            self.assertEqual(self.browser.run("return document.querySelectorAll('script,img').length"), 2,
                             text)
            self.assertIn("default-src 'none'", page.read_text())
        # The policy holds by itself: what gets into the page all the same does not run.
        broken = page.read_text().replace("<main", "<script>window.hacked=1</script><main")
        (self.folder / "broken.html").write_text(broken)
        self.browser.open(self.folder / "broken.html")
        self.assertIsNone(self.browser.run("return window.hacked || null"))
        self.assertIn("Content Security Policy", self.browser.messages()[0])

    def test_a_page_that_cannot_be_drawn_says_so(self):
        page, _ = self.page("hertz")
        (self.folder / "cut.html").write_text(re.sub(r'"d":"[^"]+"', '"d":"AAAA"', page.read_text(), count=1))
        self.browser.send("POST", "/url", {"url": (self.folder / "cut.html").as_uri()})
        settled(self.browser)
        self.assertIn("This page cannot be drawn", self.browser.run("return document.body.innerText"))
        self.assertNotEqual(self.browser.messages(), [])

    def test_a_run_that_stopped_early(self):
        solve(self.folder, "stuck", "contact.variant=interpolation", "solver.max_iterations=2",
              "time.steps=20", code=1)
        self.page("stuck.failed")
        self.assertIn("stopped early: step", self.browser.run("return document.body.innerText"))

    def test_the_same_bytes_again(self):
        first, _ = self.page("hertz")
        before = first.read_bytes()
        view(self.folder, "report", "hertz")
        self.assertEqual(first.read_bytes(), before)


class Coding(unittest.TestCase):
    def test_large_runs_stay_small(self):
        """1e5 triangles, 5 steps of fields that are rough by themselves:
        each block beside what it would be raw."""
        rng = np.random.default_rng(1)
        smooth = np.sin(np.linspace(0, 40, 100_000))
        block = coding.Block()
        block.add(smooth, 6)
        self.assertLess(len(block.bytes()), 250_000)
        rough = coding.Block()
        rough.add(rng.normal(size=100_000), 6)
        self.assertLess(len(rough.bytes()), 330_000)

    def test_extremes(self):
        for values in (np.zeros(5), np.array([]), np.array([1e-320, 0]), np.array([1e300, -1e300]),
                       np.array([1e-280, -1])):
            q, e = coding.quantised(values, 6)
            self.assertTrue(np.isfinite(coding.scaled(q.astype(float), e)).all())
            np.testing.assert_allclose(coding.scaled(q.astype(float), e), values, rtol=0,
                                       atol=1e-5 * np.abs(values).max(initial=0) + 1e-290)


if __name__ == "__main__":
    unittest.main()
