"""The page of mortier report for bodies in space, in headless Chromium: it turns, cuts and says values, on a
desk and on a phone; pictures take the place of bodies where there is no WebGL or no three.js."""
import io
import json
import time
import unittest
from unittest import mock

import numpy as np
from PIL import Image

from browser import Browser
from scene_parts import body, box, contact, timed
from support import InSharedFolder, mortier
from report_support import choose, settled
from views_support import view
import contact_surface
import results
import three
from other_meshes import barycentric, located
from space_test import CUBES

TILTED = CUBES.replace("-10*t", "-10*t*(1 + x)")
SOFT = ["body.material={young=100, poisson=0.3}", "time.steps=2", "output.every=1"]
MANY = ("dimension = 3\n"
        + body("tool", box([0, 0, 0], [0.4, 0.4, 0.2], [4, 4, 2]), 100, 'label = "left", ux = 0',
               'label = "front", uy = 0', 'label = "top", uz = -0.001')
        + body("block", box([0, 0, -1], [1, 1, 0], 31), 100, 'label = "left", ux = 0',
               'label = "front", uy = 0', 'label = "bottom", uz = 0')
        + contact(("tool", "bottom"), ("block", "top")) + timed())
DESK, PHONE = (900, 700), (390, 844)
READ = "return [{...document.getElementById('read0').dataset}, document.getElementById('read0').textContent]"
SEEN = "return document.getElementById('canvas0').dataset.view.split(',').map(Number)"


class Pages(InSharedFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name, text, settings in (("cubes", TILTED, SOFT), ("quadratic", TILTED, [*SOFT, "degree=2"])):
            (cls.folder / f"{name}.toml").write_text(text)
            done = mortier("run", f"{name}.toml", "--quiet", "--out", name, "--set", *settings,
                           cwd=cls.folder)
            assert done.returncode == 0, done.stderr
            assert view(cls.folder, "report", name)[0] == 0
        cls.browser = Browser(*DESK)
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        super().setUp()
        self.open("cubes")

    def open(self, name, size=DESK):
        self.browser.size(*size)
        self.browser.open(self.folder / f"{name}.html")
        settled(self.browser)
        self.browser.run("document.getElementById('canvas0').scrollIntoView({block: 'center'})")

    def tearDown(self):
        for message in self.browser.messages():  # software that draws; pictures of it are read back
            self.assertIn("GPU stall due to ReadPixels", message)

    def area(self):
        return self.browser.run("const r = document.getElementById('canvas0').getBoundingClientRect(); "
                                "return [r.left, r.top, r.width, r.height]")

    def at(self, right, down):
        left, top, wide, tall = self.area()
        return left + right * wide, top + down * tall

    def read(self, right, down):
        """What the page says of a place of the picture, given by parts of its width and height."""
        self.browser.point(*self.at(right, down))
        settled(self.browser)
        return self.browser.run(READ)

    def picture(self):
        """Colours of the canvas, rows x columns x 3."""
        settled(self.browser)
        left, top, wide, tall = map(round, self.area())
        seen = np.asarray(Image.open(io.BytesIO(self.browser.picture())).convert("RGB"), int)
        return seen[top + 2:top + tall - 2, left + 2:left + wide - 2]

    def reddish(self):
        """The part of the picture in colours of pressure: yellow to red."""
        red, _, blue = np.moveaxis(self.picture(), 2, 0)
        return np.mean((red > 100) & (red - blue > 60))

    def drag(self, first, last):
        """With the left button, in one step."""
        moves = [{"type": "pointerMove", "duration": 0, "x": round(x), "y": round(y)}
                 for x, y in (first, last)]
        self.browser.send("POST", "/actions", {"actions": [
            {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
             "actions": [moves[0], {"type": "pointerDown", "button": 0}, moves[1],
                         {"type": "pointerUp", "button": 0}]}]})
        settled(self.browser)

    def touch(self, *paths):
        """Fingers, each from its first place to its last."""
        def at(places):
            return [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(places)]
        self.browser.cdp("Input.dispatchTouchEvent", type="touchStart",
                         touchPoints=at(path[0] for path in paths))
        for part in (0.5, 1.0):
            moved = [tuple(a + part * (b - a) for a, b in zip(*path)) for path in paths]
            self.browser.cdp("Input.dispatchTouchEvent", type="touchMove", touchPoints=at(moved))
        self.browser.cdp("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        settled(self.browser)

    def press(self, name):
        self.browser.run("document.getElementById(arguments[0]).click()", name)
        settled(self.browser)

    def values_in_file(self, name, field, told):
        """Of the file, linear in the tetrahedron where a place that the page tells is."""
        run = results.read_mortier(self.folder / name)
        body, place = run.bodies[told["body"]], np.array([[float(told[axis]) for axis in "xyz"]])
        cell = located(body, place, told["body"])[0][0]
        corners = body.tetrahedra[cell]
        at = barycentric(body.points[corners][None], place)[0]
        return float(at @ field(body)[corners]), np.abs(field(body)).max()

    def test_contact_is_seen_first_over_the_whole_width(self):
        self.assertEqual(self.browser.run("return document.getElementById('field').value"), "pressure")
        wide = self.browser.run("return [document.querySelector('main').clientWidth, "
                                "document.getElementById('canvas0').clientWidth]")
        self.assertGreater(wide[1], 0.95 * wide[0])
        self.assertGreater(self.reddish(), 0.02)
        self.assertIn("contact pressure",
                      self.browser.run("return document.querySelector('.bar').textContent"))
        for other in ("gap", "von_mises", "uz", "s23", "e11", "error", "viscoplastic", "region"):
            choose(self.browser, "field", other)
            self.assertGreater(self.picture().std(), 10, other)

    def test_mouse_wheel_and_keys_turn_and_zoom(self):
        start, first = self.browser.run(SEEN), self.picture()
        np.testing.assert_allclose(start[:2], contact_surface.START, atol=1e-2)
        self.drag(self.at(0.5, 0.5), self.at(0.6, 0.6))
        turned = self.browser.run(SEEN)
        self.assertLess(turned[0], start[0] - 5)
        self.assertGreater(turned[1], start[1] + 5)
        self.assertGreater(np.mean(np.abs(self.picture() - first) > 20), 0.02)
        for key, moved in zip("\ue012\ue014\ue013\ue015", ((-10, 0), (10, 0), (0, 10), (0, -10))):
            before = self.browser.run(SEEN)
            self.browser.press("#canvas0", key)
            settled(self.browser)
            np.testing.assert_allclose(np.subtract(self.browser.run(SEEN), before)[:2], moved, atol=0.02)
        before = self.browser.run(SEEN)
        self.browser.press("#canvas0", "+")
        settled(self.browser)
        self.assertAlmostEqual(self.browser.run(SEEN)[2] / before[2], 1.25, delta=0.01)
        x, y = map(round, self.at(0.5, 0.5))
        self.browser.cdp("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=240)
        time.sleep(0.2)
        settled(self.browser)
        self.assertLess(self.browser.run(SEEN)[2], 1.24 * before[2])
        self.browser.press("#canvas0", "0")
        settled(self.browser)
        self.assertGreater(self.browser.run(SEEN)[2], 0.1)

    def test_views_have_names(self):
        for name, angles, key in (("front", (-90, 0), "1"), ("top", (-90, 90), "2"),
                                  ("contact", (-90, -90), "3")):
            for press in (lambda: self.press(f"view-{name}"), lambda: self.browser.press("#canvas0", key)):
                self.press("whole")
                self.drag(self.at(0.5, 0.5), self.at(0.45, 0.55))
                press()
                settled(self.browser)
                seen = self.browser.run(SEEN)
                np.testing.assert_allclose(seen[:2], angles, atol=0.01, err_msg=name)
        self.assertGreater(self.reddish(), 0.05)
        hidden = ("return [...document.querySelectorAll('[id^=body]')].filter(e => !e.checked)"
                  ".map(e => e.value)")
        self.assertEqual(self.browser.run(hidden), ["lower"])
        self.press("view-front")
        self.assertEqual(self.browser.run(hidden), [])

    def test_values_are_those_of_the_files(self):
        fields = {"uz": lambda body: body.displacement[:, 2], "ux": lambda body: body.displacement[:, 0]}
        for name in ("cubes", "quadratic"):
            self.open(name)
            choose(self.browser, "scale", 0)  # as meshed
            for field, of in fields.items():
                choose(self.browser, "field", field)
                found = [self.read(*place)[0] for place in ((0.45, 0.35), (0.5, 0.7), (0.55, 0.6))]
                self.assertEqual({each["body"] for each in found}, {"upper", "lower"})
                for told in found:
                    exact, largest = self.values_in_file(name, of, told)
                    self.assertAlmostEqual(float(told["value"]), exact,
                                           delta=(1e-4 if name == "cubes" else 0.02) * largest)
            self.press("view-front")  # places are those under the pointer; two lengths are the bodies
            (left, _), (right, _) = self.read(0.45, 0.3), self.read(0.55, 0.3)
            _, _, wide, tall = self.area()
            apart = 0.1 * wide / (tall / 2) / self.browser.run(SEEN)[2] * 2
            self.assertAlmostEqual(float(right["x"]) - float(left["x"]), apart, delta=0.05 * apart)
        self.open("cubes")
        run = results.read_mortier(self.folder / "cubes")
        told, words = self.read(0.5, 0.55)
        self.assertEqual(told["body"], "upper")
        self.assertRegex(words, r"^contact pressure \S+ Pa in upper at \(.*\) as meshed: gap .*von Mises")
        along = {round(x, 6): pressure for (x, _, _), pressure in zip(run.contact.position,
                                                                      run.contact.pressure)}
        at_x = np.interp(float(told["x"]), *zip(*sorted(along.items())))
        self.assertAlmostEqual(float(told["value"]), at_x, delta=0.2 * run.contact.pressure.max())
        self.assertAlmostEqual(float(told["z"]), 0, delta=1e-6)
        told, words = self.read(0.02, 0.02)
        self.assertEqual(told, {})
        self.assertIn("Drag", words)

    def test_a_plane_cuts(self):
        choose(self.browser, "scale", 0)
        choose(self.browser, "field", "uz")
        self.press("view-front")
        whole = self.read(0.52, 0.3)[0]
        self.assertAlmostEqual(float(whole["y"]), 0, delta=1e-4)
        choose(self.browser, "cut", "1")
        for part, y in ((500, 0.5), (200, 0.2)):
            choose(self.browser, "cut-at", part)
            told = self.read(0.52, 0.3)[0]
            self.assertAlmostEqual(float(told["y"]), y, delta=1e-4)  # the section, not what is behind it
            exact, largest = self.values_in_file("cubes", lambda body: body.displacement[:, 2], told)
            self.assertAlmostEqual(float(told["value"]), exact, delta=1e-4 * largest)
        self.press("flip")
        self.assertAlmostEqual(float(self.read(0.52, 0.3)[0]["y"]), 0, delta=1e-4)
        choose(self.browser, "cut", "0")
        self.press("view-front")
        before = self.picture()
        choose(self.browser, "cut-at", 900)
        self.assertGreater(np.mean(np.abs(self.picture() - before) > 20), 0.02)
        choose(self.browser, "cut", "-1")
        choose(self.browser, "field", "pressure")
        self.press("whole")
        uncut = self.reddish()
        self.assertGreater(uncut, 0.02)
        choose(self.browser, "cut", "0")
        choose(self.browser, "cut-at", 500)
        self.assertLess(self.reddish(), 0.9 * uncut)  # contact surfaces are cut as well

    def test_bodies_are_left_out_and_time_goes_on(self):
        choose(self.browser, "field", "uz")
        before = self.picture()
        self.press("body0")
        self.assertGreater(np.mean(np.abs(self.picture() - before) > 20), 0.02)
        self.assertEqual(self.read(0.5, 0.6)[0]["body"], "lower")
        self.press("body0")
        values = []
        for step in (1, 2):
            choose(self.browser, "step", step)
            values.append(float(self.read(0.5, 0.3)[0]["value"]))
        self.assertAlmostEqual(values[0] / values[1], 0.5, delta=0.05)

    def test_phone(self):
        self.open("cubes", PHONE)
        wide, tall = PHONE
        self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth"), wide)
        self.assertGreater(self.area()[2], 0.9 * wide)
        self.assertLess(self.area()[3], 0.75 * tall)
        cells = self.browser.run("return [...document.querySelectorAll('#quantities td')].filter(e => "
                                 "e.textContent).map(e => [e.dataset.head, e.getBoundingClientRect().right])")
        self.assertIn("error", [head for head, _ in cells])
        self.assertLessEqual(max(right for _, right in cells), wide)
        before = self.browser.run(SEEN)
        self.touch((self.at(0.5, 0.5), self.at(0.7, 0.5)))
        turned = self.browser.run(SEEN)
        self.assertGreater(abs(turned[0] - before[0]), 10)
        self.touch((self.at(0.45, 0.5), self.at(0.3, 0.5)), (self.at(0.55, 0.5), self.at(0.7, 0.5)))
        self.assertGreater(self.browser.run(SEEN)[2], 1.5 * turned[2])
        choose(self.browser, "field", "uz")
        x, y = self.at(0.5, 0.5)
        self.touch(((x, y), (x, y)))  # a finger on a body says what is there
        self.assertIn("displacement", self.browser.run(READ)[1])

    def test_pictures_where_bodies_cannot_be_turned(self):
        with mock.patch.object(three, "FOLDER", self.folder / "nowhere"):
            code, _, errors = view(self.folder, "report", "cubes", "--out", "still.html")
        self.assertEqual((code, errors), (0, ""))
        browser = Browser(*DESK, webgl=False)
        try:
            for name, words in (("cubes", "no WebGL"), ("still", "libjs-three")):
                browser.open(self.folder / f"{name}.html")
                settled(browser)
                self.assertIn(words, browser.run("return document.getElementById('still').textContent"))
                found = browser.run("const i = [...document.querySelectorAll('img')]; return [i.length, "
                                    "i[0].getBoundingClientRect().width, i[0].naturalWidth, "
                                    "document.querySelector('.controls').offsetParent === null]")
                self.assertEqual((found[0], found[3]), (1, True))
                self.assertGreater(min(found[1:3]), 300)
                self.assertEqual(browser.messages(), [])
        finally:
            browser.close()

    def test_large_bodies(self):
        """1e5 unknowns: 2 MB, and at most 1 s of processor time until the page answers."""
        (self.folder / "many.toml").write_text(MANY)
        done = mortier("run", "many.toml", "--quiet", "--out", "many", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads((self.folder / "many/summary.json").read_text())
        self.assertGreater(sum(body["dofs"] for body in summary["bodies"]), 98_000)
        self.assertEqual(view(self.folder, "report", "many")[0], 0)
        size = (self.folder / "many.html").stat().st_size
        self.browser.cdp("Performance.enable", timeDomain="threadTicks")
        try:
            milliseconds = self.browser.open(self.folder / "many.html")
            metrics = {each["name"]: each["value"] for each in
                       self.browser.cdp("Performance.getMetrics")["metrics"]}
        finally:
            self.browser.cdp("Performance.disable")
        print(f"1e5 unknowns: {size / 1e6:.2f} MB, usable after {milliseconds:.0f} ms, "
              f"{1e3 * metrics['TaskDuration']:.0f} ms of processor time")
        self.assertLess(size, 2e6)
        self.assertLess(metrics["TaskDuration"], 1)
        choose(self.browser, "field", "uz")
        choose(self.browser, "cut", "1")  # the inside is there as well
        self.press("view-front")
        self.assertAlmostEqual(float(self.read(0.5, 0.6)[0]["y"]), 0.5, delta=1e-3)


if __name__ == "__main__":
    unittest.main()
