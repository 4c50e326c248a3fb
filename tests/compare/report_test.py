"""Pages of mortier report in headless Chromium: what one points at is what the files hold, by mouse and by
keyboard."""
import base64
import unittest

import numpy as np

from report_support import Pages, choose, hovered, settled
from scene_parts import body, contact, shape, timed
from support import ROOT, mortier
from views_support import solve, view
import coding
import recovery
import results
import runs

RING = ('title = "A ring in a ring, closed"\n'
        + body("inner", '"inner.mesh"', 100, 'label = 1, pressure = "1*t", ut = 0')
        + body("outer", '"outer.mesh"', "young = 50, poisson = 0.2", "label = 2, un = 0, ut = 0")
        + contact(("inner", 2), ("outer", 1), initial="close") + timed(2) + "[output]\nevery = 1\n")
COARSE = ("degree = 2\n"
          + body("ring", shape("annulus", inner=1, outer=2, cells=[8, 1], span="full"), 100,
                 "label = 1, pressure = 1", "label = 2, un = 0, ut = 0") + timed())


class Contents(Pages):
    def test_hovered_values_are_those_of_the_files(self):
        path, milliseconds = self.page("mortar", "interpolation")
        self.assertLess(path.stat().st_size, 2e6)  # of two runs
        self.assertLess(milliseconds, 10000)
        for step, fields in ((100, ("von_mises", "s12", "uy", "u", "e22", "error")), (37, ("s12", "error")),
                             (0, ("uy",))):
            choose(self.browser, "step", step)
            for field in fields:
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
        (self.folder / "ring.toml").write_text(RING)
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
            result = runs.read(self.folder / name)
            run = result.at(100)
            line = result.lines(run)[0]
            body = run.bodies[line.nonmortar]
            widths[name] = np.abs(recovery.NormalStress(body, line)(body) - line.pressure).max()
        self.assertLess(widths["mortar"], 1e-9)
        self.assertGreater(widths["interpolation"], 1)
        self.page("interpolation")
        self.assertEqual(self.browser.run("return document.querySelectorAll('#pressure0-0 .under').length"),
                         1)

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
        for values, most in ((np.sin(np.linspace(0, 40, 100_000)), 250_000),
                             (rng.normal(size=100_000), 330_000)):
            self.assertLess(len(base64.b64decode(coding.block([(values, 6)])[0]["d"])), most)

    def test_extremes(self):
        for values in (np.zeros(5), np.array([]), np.array([1e-320, 0]), np.array([1e300, -1e300]),
                       np.array([1e-280, -1])):
            q, e = coding.quantised(values, 6)
            self.assertTrue(np.isfinite(coding.scaled(q.astype(float), e)).all())
            np.testing.assert_allclose(coding.scaled(q.astype(float), e), values, rtol=0,
                                       atol=1e-5 * np.abs(values).max(initial=0) + 1e-290)


if __name__ == "__main__":
    unittest.main()
