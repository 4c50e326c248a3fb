"""Results in space in the views: mortier plot, report and compare, and the Python module."""
import json
import shutil
import unittest
import warnings
from unittest import mock

import numpy as np

from scene_parts import body, box, timed
from support import PROGRAM, ROOT, InSharedFolder, mortier
from views_support import view
from surfaces import Buffer, Seen, Surface, camera
import contact_surface
import pictures
import results
import runs
import space
import surfaces
import three
from space_test import CUBES

SOFT = ["body.material={young=100, poisson=0.3}", "time.steps=2", "output.every=1"]
ALONE = ("dimension = 3\n"
         + body("column", box([0, 0, 0], [1, 1, 2], [1, 1, 2]), 100,
                'label = "bottom", ux = 0, uy = 0, uz = 0', 'label = "top", tx = "t"') + timed())


class SpaceViews(InSharedFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name, text, settings in (("cubes", CUBES, SOFT), ("alone", ALONE, ["degree=2"]),
                                     ("finer", CUBES, [*SOFT, "body.lower.mesh.cells=4"])):
            (cls.folder / f"{name}.toml").write_text(text)
            done = mortier("run", f"{name}.toml", "--quiet", "--out", name, "--set", *settings,
                           cwd=cls.folder)
            assert done.returncode == 0, done.stderr
        cls.enterClassContext(mock.patch.object(surfaces, "PIXELS", 25))  # coarse images are fast

    def see(self, *words, code=0):
        found, shown, errors = view(self.folder, *words)
        self.assertEqual(found, code, shown + errors)
        self.assertEqual(len(errors.splitlines()), 1 if code else 0, errors)
        return shown if code == 0 else errors

    def test_a_result_is_read_in_three_components(self):
        run = results.read(self.folder / "alone")
        body = run.bodies["column"]
        self.assertIsNone(body.triangles)
        self.assertEqual((body.tetrahedra.shape[1], body.elements.shape[1]), (4, 10))
        self.assertEqual(body.stress_at_points.shape[1:], (4, 6))
        self.assertGreater(run.scalars["displacement_max_x"], 0)
        self.assertEqual(run.scalars["displacement_min_z"], body.displacement[:, 2].min())
        contact = results.read(self.folder / "cubes").contact
        self.assertEqual(np.ptp(contact.position, axis=0).tolist(), [1, 1, 0])

    def test_von_mises_stress_of_six_components_is_that_of_the_files(self):
        body = results.read(self.folder / "alone").bodies["column"]
        body.stress_at_points = None
        pure = results.Body(body.displacement, np.array([[0, 0, 0, 1, 2, 3.0], [5, 5, 1, 0, 0, 0]]))
        np.testing.assert_allclose(pure.von_mises, [np.sqrt(3 * 14), 4])

    def test_the_surface_is_closed_and_seen_from_outside(self):
        for name in ("cubes", "alone"):
            for body in results.read(self.folder / name).bodies.values():
                surface = Surface(body)
                corners, *_ = surface.triangles(body.points)
                a, b, c = np.moveaxis(corners, 1, 0)
                volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
                self.assertAlmostEqual(volume, runs.areas(body).sum(), delta=1e-12)
                self.assertEqual(len(surface.outline(body.points)[0]), 2)
                lines = surface.outline(body.points)  # the edges of a box
                self.assertAlmostEqual(np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).sum(),
                                       12 if name == "cubes" else 16, delta=1e-12)

    def test_what_is_behind_is_hidden(self):
        square = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 0.0]]])

        def seen(height, colour, turned=False):
            corners = (square + [0, 0, height])[:, ::-1] if turned else square + [0, 0, height]
            return Seen(corners, lambda triangles, _: np.tile(colour, (len(triangles), 1)),
                        np.zeros((2, 3), int), shaded=False)
        red, green = [1.0, 0, 0], [0, 1.0, 0]
        for each in ([seen(1, red), seen(0, green)], [seen(0, green), seen(1, red)],
                     [seen(2, green, turned=True), seen(1, red)]):
            for at_once in (1, 3_000_000):  # one after the other, and together
                with mock.patch("surfaces.AT_ONCE", at_once):
                    image = Buffer(each, (0, 1, 0, 1), 20).image()
                np.testing.assert_allclose(image[10, 10], [1, 0, 0, 1])
        image = Buffer([seen(0, red)], (-1, 1, 0, 1), 20).image()
        self.assertEqual((image[5, 3, 3], image[5, 15, 3]), (0, 1))

    def test_the_camera_is_where_it_is_said_to_be(self):
        np.testing.assert_allclose(camera(-90, 0), [[1, 0, 0], [0, 0, 1], [0, -1, 0]], atol=1e-15)
        np.testing.assert_allclose(camera(0, 90)[2], [0, 0, 1], atol=1e-15)

    def test_colours_are_the_values_of_the_files(self):
        norm, colours = pictures.Normalize(0, 10), pictures.matplotlib.colormaps["viridis"]
        run = results.read(self.folder / "cubes")
        body = run.bodies["upper"]
        seen = space.seen_of(body, camera(*contact_surface.START), 0.0, body.von_mises, norm, colours, 0)
        np.testing.assert_allclose(seen.colours(np.array([0]), np.full((1, 3), 1 / 3))[0], colours(1.0)[:3],
                                   atol=0.01)
        by_corner = body.points[body.tetrahedra][..., 2] * 10  # a field that is z
        seen = space.seen_of(body, np.eye(3), 0.0, by_corner, norm, colours, 0)
        for i in (0, len(seen.corners) - 1):
            np.testing.assert_allclose(seen.colours(np.array([i]), np.array([[0, 1.0, 0]]))[0],
                                       colours(seen.corners[i, 1, 2])[:3], atol=0.01)

    def test_pictures_of_contact_and_of_a_body_alone(self):
        self.assertEqual(len(self.see("plot", "cubes").split()), 6)
        made = self.see("plot", "alone", "--view=20,-30", "--field", "s13", "--scale", "2", "--only",
                        "fields")
        self.assertEqual(made.split(), ["alone.plots/fields.png", "alone.plots/fields.svg"])
        self.see("plot", "cubes", "finer", "--raw", "--field", "uz", "--out", "both.png")
        self.see("plot", "cubes", "--animate", "--out", "moving.gif")
        errors = self.see("plot", "alone", "--only", "contact", code=2)
        self.assertIn("no contact", errors)

    def test_the_map_of_the_pressure_has_all_of_the_surface(self):
        result = runs.read(self.folder / "cubes")
        of = space.contact_map.Map(pictures.view(result), 0)
        a, b, c = np.moveaxis(of.body.points[of.surface.nodes[of.chosen]], 1, 0)
        self.assertAlmostEqual(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2, 1, delta=1e-12)
        np.testing.assert_allclose(of.turned[:2], [[1, 0, 0], [0, 1, 0]], atol=1e-12)
        self.assertFalse(of.folded)
        np.testing.assert_allclose(of.pressure, 10, rtol=1e-6)
        with pictures.plt.rc_context(pictures.STYLE):
            figure, axes = pictures.plt.subplots()
            of.draw(axes, of.pressure, pictures.Normalize(0, 10), pictures.matplotlib.colormaps["viridis"], 2)
            self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("x [m]", "y [m]"))
            image = axes.images[0].get_array()
            self.assertTrue((image[5:-5, 5:-5, 3] == 1).all())  # covered
            pictures.plt.close(figure)

    def test_views_have_names(self):
        result = runs.read(self.folder / "cubes")
        seen = pictures.view(result)
        for name, angles in (("front", (-90, 0)), ("top", (-90, 90)), ("contact", (-90, -90))):
            self.assertEqual(contact_surface.look_of(seen.run, result.interfaces, name).angles, angles)
            self.see("plot", "cubes", "--view", name, "--only", "fields", "--out", f"{name}.png")
        look = contact_surface.look_of(seen.run, result.interfaces, "contact")
        self.assertEqual((look.body, look.hidden), ("upper", ("lower",)))
        self.assertEqual(np.ptp(seen.run.bodies["upper"].points[look.nodes], axis=0).tolist(), [1, 1, 0])
        self.assertIn("no contact", self.see("plot", "alone", "--view", "contact", code=2))
        self.assertIn("front, top, contact", self.see("plot", "cubes", "--view", "side", code=2))

    def test_a_surface_in_a_hole_is_seen_through_its_opening(self):
        angle = np.linspace(0, 2 * np.pi, 25)[:-1]
        ring = np.concatenate([r * np.column_stack([np.cos(angle), np.sin(angle)]) for r in (1, 2)])
        points = np.concatenate([np.column_stack([ring, np.full(48, z)]) for z in (0.0, 1.0)])
        cells = []
        for i in range(24):
            j = (i + 1) % 24
            for a, b, c in ((i, 24 + i, 24 + j), (i, 24 + j, j)):
                d, e, f = a + 48, b + 48, c + 48
                cells += [(a, b, c, d), (b, c, d, e), (c, d, e, f)]
        body = results.Body(np.zeros((96, 3)), np.zeros((len(cells), 6)), points,
                            tetrahedra=np.array(cells))
        nodes = contact_surface.surface_of(body).nodes
        inside = np.flatnonzero(np.isclose(np.hypot(*points[nodes][..., :2].transpose(2, 0, 1)), 1).all(1))
        self.assertEqual(len(inside), 48)
        azimuth, elevation = contact_surface.best_angles(body, inside, np.ones(48))
        self.assertGreater(abs(elevation), 20)
        self.assertLess(abs(elevation), 80)

    def test_a_window_is_of_the_picture(self):
        seen, look = [pictures.view(runs.read(self.folder / "cubes"))], contact_surface.Look((-90.0, 0.0))
        with pictures.plt.rc_context(pictures.STYLE):
            figure = pictures.fields(seen, window=(0.1, 0.9, -0.3, 0.4), look=look)
            axes = figure.axes[0]
            self.assertEqual((*axes.get_xlim(), *axes.get_ylim()), (0.1, 0.9, -0.3, 0.4))
            self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("x [m]", "z [m]"))
            pictures.plt.close(figure)

    def test_colours_show_the_contact(self):
        run = pictures.view(runs.read(self.folder / "finer")).run
        near = run.bodies["upper"].near
        self.assertTrue(0 < near.sum() <= len(near))
        field = runs.Field("von_mises", "", "", False, False, None)
        values, weights = np.r_[np.full(10_000, 0.1), np.full(10, 1.0), 50.0], np.ones(10_011)
        close = values >= 1
        self.assertEqual(runs.top(field, values, weights, close & False), 0.1)
        self.assertEqual(runs.top(field, values, weights, close), 1)  # not the singular place

    def test_contact_surfaces_are_seen_through_the_bodies(self):
        seen = [pictures.view(runs.read(self.folder / "cubes"))]
        with pictures.plt.rc_context(pictures.STYLE):
            for name in ("pressure", "gap"):
                figure = pictures.fields(seen, name)
                image = figure.axes[0].images[0].get_array()
                self.assertTrue((image[..., 3] == space.GLASS).any() and (image[..., 3] == 1).any())
                pictures.plt.close(figure)

    def test_files_have_pressure_and_gap(self):
        import meshio
        done = mortier("run", "cubes.toml", "--quiet", "--out", "quadratic", "--set", *SOFT, "degree=2",
                       cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        contact = results.read(self.folder / "quadratic").contact
        mesh = meshio.read(self.folder / "quadratic" / "upper_000002.vtu")
        self.assertNotIn("gap", meshio.read(self.folder / "quadratic" / "lower_000002.vtu").point_data)
        for name, known in (("contact_pressure", contact.pressure), ("gap", contact.gap)):
            values = mesh.point_data[name]
            np.testing.assert_allclose(values[contact.vertex], known, rtol=1e-12, atol=1e-25)
            below = mesh.points[:, 2] == 0
            has = mesh.point_data["nonmortar"] == 1
            self.assertEqual(has.tolist(), below.tolist())  # middles of sides as well
            self.assertTrue((values[~has] == 0).all())
            for middle, ends in enumerate(([0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3])):
                nodes = mesh.cells_dict["tetra10"]
                mean = values[nodes[:, ends]].mean(1)
                on = has[nodes[:, ends]].all(1)
                np.testing.assert_allclose(values[nodes[on, 4 + middle]], mean[on], rtol=1e-12, atol=1e-25)

    def test_options_of_the_plane_are_refused(self):
        self.assertIn("--window", self.see("plot", "cubes", "--window=1,0,0,1", code=2))
        self.assertIn("s23", self.see("plot", "cubes", "--field", "s21", code=2))
        self.assertIn("--view", self.see("plot", "cubes", "--view=1000,2", code=2))
        plane = mortier("run", ROOT / "scenes/compression.toml", "--quiet", "--out", "plane", "--set",
                        "time.steps=1", cwd=self.folder)
        self.assertEqual(plane.returncode, 0)
        self.assertIn("--view", self.see("plot", "plane", "--view=10,20", code=2))
        self.assertIn("in the plane and in space", self.see("plot", "plane", "cubes", code=2))
        self.assertIn("in the plane and in space", self.see("report", "plane", "cubes", code=2))

    def test_a_damaged_result_is_refused_in_one_line(self):
        shutil.copytree(self.folder / "cubes", self.folder / "damaged")
        path = self.folder / "damaged" / "contact.csv"
        rows = [line.split(",") for line in path.read_text().splitlines()]
        path.write_text("".join(",".join(row[:6] + row[7:]) + "\n" for row in rows))
        self.assertIn("no column z", self.see("plot", "damaged", code=2))
        summary = json.loads((self.folder / "damaged/summary.json").read_text())
        (self.folder / "damaged/summary.json").write_text(json.dumps({**summary, "plane": "strain"}))
        self.assertIn("expected", self.see("plot", "damaged", code=2))

    def test_a_run_that_stopped_early_is_drawn(self):
        shutil.copytree(self.folder / "cubes", self.folder / "cubes.failed")
        path = self.folder / "cubes.failed" / "summary.json"
        stuck = {"body": "upper", "tetrahedron": 3, "at": [0, 0, 0], "material_residual": 1, "time": 1}
        path.write_text(json.dumps({**json.loads(path.read_text()), "status": "failed", "stuck": stuck,
                                    "reason": "no such state"}))
        result = runs.read(self.folder / "cubes.failed")
        self.assertIn("upper, tetrahedron 3 at (", result.stuck(result.at(2))[2])
        self.see("plot", "cubes.failed", "--only", "fields", "--out", "failed.png")

    def test_the_page_has_a_picture_and_says_where_three_js_is_missing(self):
        told = self.see("report", "cubes", "alone", "--out", "page.html")
        self.assertNotIn("libjs-three", told)
        page = (self.folder / "page.html").read_text()
        for words in ("bodies in space", "tetrahedra", "displacement z", "Contact surfaces", "pressed",
                      "Permission is hereby granted"):
            self.assertIn(words, page)
        self.assertEqual(page.count('src="data:image/png'), 2)
        with mock.patch.object(three, "FOLDER", self.folder / "nowhere"):
            told = self.see("report", "cubes", "--out", "still.html")
        self.assertIn("libjs-three is not installed", told)
        self.assertEqual(len(told.splitlines()), 1)
        self.assertNotIn("Permission is hereby granted", (self.folder / "still.html").read_text())

    def test_compare_with_a_result_on_the_same_and_on_other_meshes(self):
        settings = [f"--set={each}" for each in SOFT]
        with mock.patch("codes.MORTIER", PROGRAM):
            self.assertIn("agrees", self.see("compare", "cubes.toml", *settings, "--against=cubes"))
            self.assertIn("--within", self.see("compare", "cubes.toml", *settings, "--against=finer", code=2))
            told = self.see("compare", "cubes.toml", *settings, "--against=finer", "--within=1e-6")
            self.assertIn("contact resultant z", told)
            swapped = ["--set=contact.swap=true", "--set=quantity.pressure.largest_pressure.body=lower",
                       "--set=quantity.pressure.largest_pressure.label=top"]
            self.see("compare", "cubes.toml", *settings, *swapped, "--against=finer", "--within=1e-6")
            with mock.patch("sys.stdout"):
                code, told, _ = view(self.folder, "compare", "cubes.toml", *settings,
                                     "--set=quantity.top.component=x", "--set=body.upper.material.young=50",
                                     "--against=cubes", "--picture=off.png")
            self.assertEqual(code, 1)
            self.assertIn("of the largest", told)
            self.assertTrue((self.folder / "off.png").exists())
            self.see("compare", "cubes.toml", *settings, "--accept=kept.json")
            self.see("compare", "cubes.toml", *settings, "--against=kept.json")

    def test_points_are_found_in_tetrahedra(self):
        from other_meshes import barycentric, located
        body = results.read(self.folder / "finer").bodies["lower"]
        points = np.random.default_rng(1).uniform([0, 0, -1], [1, 1, 0], (200, 3))
        found, inside = located(body, np.concatenate([points, [[5, 0, 0]]]), "lower")
        self.assertEqual(inside.tolist(), [True] * 200 + [False])
        weights = barycentric(body.points[body.tetrahedra[found[:200]]], points)
        self.assertGreater(weights.min(), -1e-9)
        corners = body.points[body.tetrahedra[found[:200]]]
        np.testing.assert_allclose(np.einsum("ij,ijk->ik", weights, corners), points, atol=1e-12)

    def test_results_are_read_by_the_python_module(self):
        from python_support import PACKAGE
        if not (PACKAGE / "stored.py").is_file():
            self.skipTest("the Python module is not built")
        import pickle

        import mortier as module
        run = module.open(self.folder / "cubes")
        step = pickle.loads(pickle.dumps(run)).last
        self.assertEqual(step.tetrahedra["upper"].shape, (48, 4))
        self.assertEqual(step.triangles, {})
        self.assertEqual((step.points["upper"].shape[1], step.contact[0].position.shape[1]), (3, 3))
        self.assertEqual(run.to_meshio()["upper"].cells[0].type, "tetra")
        self.assertEqual(module.open(self.folder / "alone").to_meshio()["column"].cells[0].type, "tetra10")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for kind in ("fields", "contact", "history"):
                run.plot(kind)


if __name__ == "__main__":
    unittest.main()
