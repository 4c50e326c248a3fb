"""mortier plot: pictures of any run."""
import unittest
import xml.etree.ElementTree as xml

import numpy as np
from PIL import Image

from support import InSharedFolder, mortier
from views_support import solve, view
import curves
import pictures
import recovery
import results
import runs

NAMES = ["contact.png", "contact.svg", "fields.png", "fields.svg", "history.png", "history.svg"]


def colours(path):
    with Image.open(path) as picture:
        return len(picture.convert("RGB").getcolors(1 << 24))


def jump(run):
    """Abscissae of the common refinement of the line y = 0, and there u1.n1 + u2.n2, positive where the
    bodies penetrate [m]; exact, for both traces are linear between the abscissae."""
    sides = []
    for name in ("upper", "lower"):
        body = run.bodies[name]
        nodes = np.flatnonzero(body.points[:, 1] == 0)
        nodes = nodes[np.argsort(body.points[nodes, 0])]
        sides.append((body.points[nodes, 0], body.displacement[nodes, 1]))
    x = np.union1d(sides[0][0], sides[1][0])
    return x, np.interp(x, *sides[1]) - np.interp(x, *sides[0])


class Pictures(InSharedFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        solve(cls.folder, "mortar", "output.every=2")
        solve(cls.folder, "interpolation", "output.every=1", "contact.variant=interpolation")
        solve(cls.folder, "stuck", "contact.variant=interpolation", "solver.max_iterations=2",
              "time.steps=20", code=1)

    def plot(self, *words, code=0):
        found, shown, errors = view(self.folder, "plot", *words)
        self.assertEqual(found, code, shown + errors)
        self.assertEqual(len(errors.splitlines()), 1 if code else 0, errors)
        return errors if code else shown.split()

    def test_without_options(self):
        shown = mortier("plot", "interpolation", cwd=self.folder).stdout.split()
        self.assertEqual(sorted(shown), [f"interpolation.plots/{name}" for name in NAMES])
        for name in NAMES:
            path = self.folder / "interpolation.plots" / name
            if path.suffix == ".png":
                self.assertGreater(colours(path), 20, name)
            else:
                self.assertTrue(xml.parse(path).getroot().tag.endswith("svg"))
        before = {name: (self.folder / "interpolation.plots" / name).read_bytes() for name in NAMES}
        self.plot("interpolation/")
        for name in NAMES:
            self.assertEqual((self.folder / "interpolation.plots" / name).read_bytes(), before[name], name)

    def test_every_field_of_both_runs_side_by_side(self):
        result = runs.read(self.folder / "mortar")
        names = list(result.fields(result.at(4)))
        self.assertLessEqual({"von_mises", "s12", "u", "uy", "e22", "viscoplastic", "error", "region"},
                             set(names))
        made = {self.plot("mortar", "interpolation", "--only", "fields", "--field", name, "--step", 2,
                          "--out", f"{name}.png")[0]
                for name in ["none", "uy"]}
        self.assertEqual(len(made), 2)
        for name in made:
            with Image.open(self.folder / name) as picture:
                self.assertGreater(picture.width, 800)
        for name in names:  # drawn here, without a process each
            with pictures.plt.rc_context(pictures.STYLE):
                figure = pictures.fields([pictures.view(result)], name, strips=False)
                self.assertIn(result.fields(result.at(4))[name].words, figure.axes[-1].get_ylabel())
                pictures.plt.close(figure)

    def test_what_is_drawn_is_what_the_files_hold(self):
        column = pictures.view(runs.read(self.folder / "interpolation"))
        with pictures.plt.rc_context(pictures.STYLE):
            figure = pictures.fields([column], "von_mises", scale=3, raw=True)
            of_mesh = [c for c in figure.axes[0].collections if c.get_array() is not None]
            for (name, body), drawn in zip(column.run.bodies.items(), of_mesh):
                np.testing.assert_array_equal(drawn.get_array(), body.cells["von_mises"])
                corners = np.stack([path.vertices[:3] for path in drawn.get_paths()])
                np.testing.assert_allclose(corners, (body.points + 3 * body.displacement)[body.triangles],
                                           rtol=0, atol=1e-14)
            contact = curves.contact([column])
            pressure, gap = contact.axes[0].lines[0], contact.axes[1].lines[0]
            np.testing.assert_array_equal(pressure.get_ydata(), column.run.contact.pressure)
            np.testing.assert_array_equal(gap.get_ydata(), column.run.contact.gap)
            history = curves.history([column])
            np.testing.assert_array_equal(history.axes[0].lines[0].get_ydata(),
                                          column.result.history["contact_force[N/m]"])
            self.assertIn("[N/m]", history.axes[0].get_title(loc="left"))
            column.result.history["reaction[kN]"] = np.arange(4.0)
            other = curves.history([column])
            self.assertIn("reaction [kN]", [axes.get_title(loc="left") for axes in other.axes])
            for figure in (history, other):  # one of an odd number of pictures, below each column its time
                *of_time, path = [each for each in figure.axes if each.axison]
                for axes in of_time[-2:]:
                    self.assertEqual(axes.get_xlabel(), "time [s]")
                    self.assertTrue(axes.xaxis.get_major_ticks()[0].label1.get_visible())
                self.assertEqual(path.get_xlabel(), "largest displacement [m]")
                for values, column_of in zip(path.lines[0].get_data(), ("displacement_max[m]",
                                                                        "contact_force[N/m]")):
                    np.testing.assert_array_equal(values, [0, *column.result.history[column_of]])
            pictures.plt.close("all")

    def test_shear_is_drawn_where_there_is_friction(self):
        solve(self.folder, "rubbed", "output.every=1", "contact.friction=0.15",
              "body.material.yield_stress=100",
              "body.lower.boundary=[{label=1, ux=0, uy=0}]",
              "body.upper.boundary=[{label=3, uy='-1e-11*t', ux='8e-12*t'}]")
        column = pictures.view(runs.read(self.folder / "rubbed"))
        contact, figure = column.run.contact, curves.contact([column])
        shear, slips = figure.axes[0].lines[1:3]
        self.assertGreater(np.abs(contact.shear).max(), 0)
        np.testing.assert_array_equal(shear.get_ydata(), contact.shear)
        np.testing.assert_array_equal(slips.get_xdata(), contact.position[contact.slipping != 0, 0])
        self.assertTrue(0 < len(slips.get_xdata()) < len(contact.shear))
        pictures.plt.close(figure)

    def test_legends_cover_nothing(self):
        """Curves that fill their axes, names that fit in one row and names that do not."""
        for names in (("a", "b", "c"), tuple(f"{letter * 40} of a long name" for letter in "abc")):
            columns = [pictures.view(runs.read(self.folder / "interpolation")) for _ in names]
            for i, (each, name) in enumerate(zip(columns, names)):
                # a zigzag from top to bottom, for each run its own: there is no free place
                each.result.folder = self.folder / name
                force = np.where((np.arange(len(each.run.contact.pressure)) + i) % 2, 10.0, 0.0)
                each.run.contact.pressure = force
            with pictures.plt.rc_context(pictures.STYLE):
                for figure in (curves.contact(columns, 5.0), curves.history(columns)):
                    figure.canvas.draw()
                    legend, = figure.legends
                    entries = [text.get_text() for text in legend.get_texts()]
                    self.assertEqual(entries[:3], list(names))
                    box = legend.get_window_extent()
                    for axes in figure.axes:
                        self.assertIsNone(axes.get_legend())
                        self.assertFalse(box.overlaps(axes.get_tightbbox()), axes.get_title(loc="left"))
                    self.assertGreaterEqual(box.y0, 0)
                    self.assertLess(box.height, 0.25 * figure.bbox.height)
            pictures.plt.close("all")

    def test_between_the_nodes_the_gap_is_that_of_both_meshes(self):
        for name, swapped in (("interpolation", False), ("swapped", True)):
            if swapped:
                solve(self.folder, name, "contact.variant=interpolation", "contact.swap=true")
            run = results.read_mortier(self.folder / name)
            line = runs.read(self.folder / name).lines(run)[0]
            x, penetration = jump(run)
            np.testing.assert_allclose(line.jump[0], x, rtol=0, atol=1e-12)
            np.testing.assert_allclose(line.jump[1], -penetration, rtol=0, atol=1e-12)
            self.assertGreater(penetration.max(), 1e-4)
            self.assertEqual(len(line.mortar_trace), 6 if swapped else 16)

    def test_curves_are_unrolled(self):
        solve(self.folder, "ring", scene="ring")
        result = runs.read(self.folder / "ring")
        line = result.lines(result.at(result.step()))[0]
        self.assertAlmostEqual(line.lengths[-1], np.pi / 2, delta=1e-3)
        self.assertEqual(line.name, "length along the line")
        self.assertLess(np.ptp(line.nonmortar_trace[:, 1]), 1e-3)
        self.assertLess(np.ptp(line.mortar_trace[:, :, 1]), 1e-3)

    def test_the_nonmortar_body_is_where_it_is(self):
        for name, swapped in (("interpolation", False), ("below", True)):
            if swapped:
                solve(self.folder, name, "contact.variant=interpolation", "contact.swap=true")
            run = results.read_mortier(self.folder / name)
            line = runs.read(self.folder / name).lines(run)[0]
            self.assertEqual(line.nonmortar, "lower" if swapped else "upper")
            for body in ("upper", "lower"):
                ordinates = line.placed(run.bodies[body].points, 0 * run.bodies[body].displacement)[:, 1]
                self.assertGreaterEqual((1 if body == "upper" else -1) * ordinates.mean(), 0.1)

    def test_rounding_is_not_drawn(self):
        """The overlap of the bodies with mortar is rounding, with interpolation it is not."""
        for name, drawn in (("mortar", False), ("interpolation", True)):
            figure = curves.history([pictures.view(runs.read(self.folder / name))])
            titles = [axes.get_title(loc="left") for axes in figure.axes]
            self.assertEqual("overlap of the bodies [m^2]" in titles, drawn)
            self.assertIn("contact force [N/m]", titles)
            self.assertIn("contact force [N/m] over displacement", titles)
            pictures.plt.close(figure)

    def test_recovered_values_are_means_and_constants_stay(self):
        column = pictures.view(runs.read(self.folder / "interpolation"))
        field = column.result.fields(column.run)["s22"]
        shown = pictures.shown_values(column, field, raw=False)
        for name, body in column.run.bodies.items():
            corners = body.points[body.triangles]
            area = np.abs(np.linalg.det(np.stack([corners[:, 1] - corners[:, 0],
                                                  corners[:, 2] - corners[:, 0]], 1))) / 2
            vertex = body.triangles[7, 1]
            around = (body.triangles == vertex).any(1)
            expected = (area * body.stress[:, 1])[around].sum() / area[around].sum()
            self.assertAlmostEqual(shown[name][7, 1], expected, delta=1e-12 * abs(expected))
            np.testing.assert_allclose(recovery.averaged(body, np.full(len(body.triangles), 3.0)), 3)
            # two regions that meet are not mixed
            body.cells["region"] = (np.arange(len(body.triangles)) < 20).astype(float)
            two = recovery.averaged(body, body.cells["region"])
            self.assertEqual(set(np.unique(two)), {0.0, 1.0})

    def test_the_scale_counts_areas(self):
        """A refined corner has many triangles and little area."""
        body = results.Body(np.zeros((8, 2)), np.zeros((2, 3)), np.array(
            [[0, 0], [1, 0], [0, 1], [1, 1], [2, 0], [2.001, 0], [2, 0.001], [3, 3]], float),
            np.array([[0, 1, 2], [1, 3, 2], *[[4, 5, 6]] * 50]))
        field = runs.Field("s11", "", "", False, False, None)
        values = {"a": np.array([1.0, 2.0, *[100.0] * 50])}
        self.assertEqual(runs.top_of(field, {"a": body}, values), 2)

    def test_animation(self):
        self.plot("interpolation", "--animate", "--out", "a.gif")
        with Image.open(self.folder / "a.gif") as gif:
            self.assertEqual(gif.n_frames, 5)
            gif.seek(4)
            self.assertGreater(len(gif.convert("RGB").getcolors(1 << 24)), 20)

    def test_a_run_that_stopped_early(self):
        self.plot("stuck.failed")
        result = runs.read(self.folder / "stuck.failed")
        self.assertIn("did not converge", result.reason)
        column = pictures.view(result)
        body, triangle, words = result.stuck(column.run)
        told = result.summary["stuck"]
        self.assertEqual((body, triangle), (told["body"], told["triangle"]))
        corners = column.run.bodies[body].points[column.run.bodies[body].triangles[triangle]]
        self.assertLess(abs(corners.mean(0) - told["at"]).max(), 1e-12)
        self.assertIn("largest residual of the law", words)
        # Without it the largest stress is marked, as where a file has been damaged.
        for damaged in (None, {}, {"body": body}, {**told, "triangle": 10**6}, {**told, "body": ["x"]}):
            result.summary["stuck"] = damaged
            other, at, _ = result.stuck(column.run)
            self.assertEqual(column.run.bodies[other].von_mises[at],
                             max(b.von_mises.max() for b in column.run.bodies.values()))
        result.summary["stuck"] = told
        with pictures.plt.rc_context(pictures.STYLE):
            title = pictures.fields([column]).axes[0].get_title(loc="left").replace("\n", " ")
        self.assertIn(result.reason, title)
        self.assertIn(words, title)

    def test_a_run_that_stopped_in_its_first_step(self):
        solve(self.folder, "first", "contact.variant=interpolation", "solver.max_iterations=1",
              "time.steps=1", code=1)
        self.plot("first.failed")
        result = runs.read(self.folder / "first.failed")
        self.assertIsNotNone(result.stuck(result.at(0)))
        del result.summary["stuck"]
        run = result.at(0)
        for body in run.bodies.values():
            body.stress = 0 * body.stress
        self.assertIsNone(result.stuck(run))

    def test_quadratic_displacements(self):
        solve(self.folder, "quadratic", "output.every=1", "degree=2")
        self.assertEqual(len(self.plot("quadratic", "mortar")), len(NAMES))
        for name in ("u", "s12", "error"):
            self.plot("quadratic", "--only", "fields", "--field", name, "--out", f"quadratic-{name}.png")
            self.assertGreater(colours(self.folder / f"quadratic-{name}.png"), 20, name)
        code, told, errors = view(self.folder, "report", "quadratic")
        self.assertEqual((code, errors), (0, ""))

    def test_results_without_contact(self):
        solve(self.folder, "cook", scene="cook")
        self.assertEqual(sorted(self.plot("cook")), ["cook.plots/fields.png", "cook.plots/fields.svg",
                                                     "cook.plots/history.png", "cook.plots/history.svg"])
        self.assertIn("no contact", self.plot("cook", "--only", "contact", code=2))

    def test_scale_is_free_of_units(self):
        run = results.read_mortier(self.folder / "mortar")
        for factor in (1e-9, 1e9):
            for body in run.bodies.values():
                body.points, body.displacement = body.points * factor, body.displacement * factor
            self.assertEqual(runs.natural_scale(run.bodies.values()), 1)
        for body in run.bodies.values():
            body.displacement = body.displacement * 1e-4
        self.assertEqual(runs.natural_scale(run.bodies.values()), 1000)


if __name__ == "__main__":
    unittest.main()
