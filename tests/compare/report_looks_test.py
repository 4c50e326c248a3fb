"""Looks of the pages of mortier report: colours, legends, letters, on a desk and on a phone, in the light and
in the dark; and text of others is shown, never run."""
import json
import re
import shutil
import unittest

import numpy as np

from report_support import Pages, choose, settled
import recovery
import results

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


class Looks(Pages):
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
        smooth = max(results.von_mises(*(recovery.averaged(body, s) for s in body.stress.T)).max()
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


if __name__ == "__main__":
    unittest.main()
