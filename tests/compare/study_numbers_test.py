"""The numbers of a study: norms of errors, expressions, orders, costs at equal error,
what a process takes."""
import sys
import unittest
from pathlib import Path

import numpy as np

import study_support  # noqa: F401
import analysis
import measure
import pictures
import process
import results
import scene
from errors import ErrorMeasure
from expressions import Expression
from problems import RunFailure


def square(cells):
    """A body on the unit square with the fields u = (x, 2 y), s = (x, 1, 0) at the centroids."""
    n = cells + 1
    x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
    points = np.column_stack([x.ravel(), y.ravel()])
    a = (np.arange(cells)[:, None] * n + np.arange(cells)).ravel()
    triangles = np.vstack([np.column_stack([a, a + 1, a + n]), np.column_stack([a + 1, a + n + 1, a + n])])
    stress = np.column_stack([points[triangles].mean(1)[:, 0], np.ones(len(triangles)),
                              np.zeros(len(triangles))])
    return results.Run("test", Path("."), {"b": results.Body(points * [1, 2], stress, points, triangles)},
                       None, {})


def quadratic(cells, rise=0.0):
    """The same square of quadratic triangles, its upper side a parabola that is so much higher in the middle
    of every element, with u = (x^2, x y) at the nodes and s = (2 x + y, 1 - x, y) at the points."""
    body = square(cells).bodies["b"]
    mesh = scene.Mesh.__new__(scene.Mesh)
    mesh.points, mesh.triangles = body.points, body.triangles
    body.points, body.elements = mesh.with_middles()
    upper = np.flatnonzero(body.points[:, 1] > 1 - 1e-9)
    body.points[upper[upper >= (cells + 1)**2], 1] += rise
    x, y = body.points.T
    body.displacement = np.column_stack([x**2, x * y])
    interior = measure.shapes(body, np.full((3, 3), 1 / 6) + np.eye(3) / 2)
    x, y = np.einsum("qi,tij->jtq", interior, body.points[body.elements])
    body.stress_at_points = np.stack([2 * x + y, 1 - x, y], -1)
    body.stress = body.stress_at_points.mean(1)
    return results.Run("test", Path("."), {"b": body}, None, {})


class Norms(unittest.TestCase):
    MATERIALS = {"b": (2.0, 0.25)}

    def exact(self, **components):
        return measure.Exact({"": {c: Expression(e) for c, e in components.items()}}, [], 1.0)

    def test_linear_displacements_are_exact(self):
        error = measure.field_error("displacement", square(3), self.exact(ux="x", uy="2*y*t"), self.MATERIALS)
        self.assertLess(error, 1e-15)

    def test_energy_norm_of_a_known_difference(self):
        # s - exact = (x - xc, 0, 0): the energy of a linear function about its mean, h^2/18 |T| a right
        # triangle, over that of (x, 1, 0): (1/3 + 1 - 2 nu/2).
        error = measure.field_error("energy", square(4), self.exact(s11="x", s22="1", s12="0"),
                                    self.MATERIALS)
        self.assertAlmostEqual(error, np.sqrt(1 / 16 / 18 / (1 / 3 + 1 - 0.25)), places=12)

    def test_quadratic_displacements_and_linear_stresses_are_exact(self):
        run = quadratic(3)
        for quantity, exact in (("displacement", {"ux": "x^2", "uy": "x*y"}),
                                ("energy", {"s11": "2*x + y", "s22": "1 - x", "s12": "y"})):
            with self.subTest(quantity):
                def error(truth, quantity=quantity):
                    return measure.field_error(quantity, run, truth, self.MATERIALS)
                self.assertLess(error(self.exact(**exact)), 1e-14)
                self.assertLess(error(quadratic(2)), 1e-13)
                # The mean alone does not do: the fields are not constant.
                other = {name: text.replace("x", "0.5") for name, text in exact.items()}
                self.assertGreater(error(self.exact(**other)), 0.1)

    def test_places_in_curved_triangles(self):
        sampled = measure.Sampled(quadratic(2, rise=0.06))
        body = sampled.bodies["b"]
        at = np.random.default_rng(1).dirichlet([1, 1, 1], (len(body.elements), 20))
        places = np.einsum("tqi,tij->tqj", measure.shapes(body, at), body.points[body.elements])
        found = np.broadcast_to(np.arange(len(body.elements))[:, None], at.shape[:2])
        self.assertLess(np.abs(sampled.barycentric("b", places, found) - at).max(), 1e-13)
        straight = measure.barycentric(body.points[body.triangles[found]].reshape(-1, 3, 2),
                                       places.reshape(-1, 2)).reshape(at.shape)
        self.assertGreater(np.abs(straight - at).max(), 1e-3)

    def test_area_below_a_parabola(self):
        _, weights = measure.quadrature(quadratic(2, rise=0.06).bodies["b"])
        self.assertAlmostEqual(weights.sum(), 1 + 2 / 3 * 0.06, places=14)

    def test_energy_norm_in_plane_strain(self):
        # The same with s33 = nu (s11 + s22), which the exact field is given: s11 and s22 count 1 - nu^2,
        # their product -2 nu (1 + nu).
        run, nu = square(4), 0.25
        body = run.bodies["b"]
        body.stress = np.column_stack([body.stress, nu * (body.stress[:, 0] + body.stress[:, 1])])
        error = measure.field_error("energy", run, self.exact(s11="x", s22="1", s12="0"), self.MATERIALS)
        size = (1 - nu**2) * (1 / 3 + 1) - nu * (1 + nu)
        self.assertAlmostEqual(error, np.sqrt((1 - nu**2) / 16 / 18 / size), places=12)

    def test_norms_of_whole_rings(self):
        """Weighted by the radius: s - exact = (x - xc, 0, 0, 0) on the square, the integral of x (x - xc)^2
        over a right triangle is xc |T| h^2/18 + |T| h^3/270 or minus that, and both kinds sum up."""
        run = square(4)
        body = run.bodies["b"]
        body.stress = np.column_stack([body.stress, 0 * body.stress[:, 0]])
        fields = {"s11": "x", "s22": "1", "s12": "0", "s33": "0"}
        error = measure.field_error("energy", run, self.exact(**fields), self.MATERIALS, ring=True)
        xc, third = body.points[body.triangles].mean(1)[:, 0], np.where(np.arange(32) < 16, 1, -1) / 270
        size = 1 / 4 + 1 / 2 - 2 * 0.25 / 3  # of x (x^2 + 1 - 2 nu x)
        self.assertAlmostEqual(error, np.sqrt(((xc / 16 / 18 + third / 64) / 32).sum() / size), places=12)
        with self.assertRaisesRegex(RunFailure, "expected the stress around the axis"):
            measure.field_error("energy", run, self.exact(s11="x", s22="1", s12="0"), self.MATERIALS, True)
        with self.assertRaisesRegex(RunFailure, "expected none in plane stress"):
            measure.field_error("energy", square(4), self.exact(**fields), self.MATERIALS)
        # u = (x, 2 y) against (0, 2 y): x^3 over x^3 + 4 x y^2
        error = measure.field_error("displacement", square(3), self.exact(ux="0", uy="2*y"), self.MATERIALS,
                                    ring=True)
        self.assertAlmostEqual(error, np.sqrt(1 / 4 / (2 / 3)), places=12)

    def test_pressure_of_a_ring_from_nodal_forces(self):
        r = np.array([0.5, 0.7, 1.2, 1.5])
        at, weights = np.polynomial.legendre.leggauss(4)
        force = np.zeros(4)
        for i, (a, b) in enumerate(zip(r[:-1], r[1:])):
            x = a + (b - a) * (at + 1) / 2
            w = (b - a) / 2 * weights * 2 * np.pi * x * (1 + x)
            force[i] += (w * (b - x) / (b - a)).sum()
            force[i + 1] += (w * (x - a) / (b - a)).sum()
        run = results.Run("test", Path("."), {}, results.Contact(
            np.arange(4), np.column_stack([r, 0 * r]), 0 * r, force), {})
        self.assertLess(measure.pressure_error(run, self.exact(p="1 + x"), ring=True), 1e-14)
        # x over x (2 + x)^2
        error = measure.pressure_error(run, self.exact(p="2 + x"), ring=True)
        self.assertAlmostEqual(error, np.sqrt(1 / (4 + 13 / 3 + 5 / 4)), places=12)

    def test_against_a_finer_run(self):
        coarse, fine = square(2), square(8)
        self.assertLess(measure.field_error("displacement", coarse, fine, self.MATERIALS), 1e-14)
        self.assertEqual(measure.field_error("energy", fine, fine, self.MATERIALS), 0)
        difference = measure.field_error("energy", coarse, fine, self.MATERIALS)
        exact = measure.field_error("energy", coarse, self.exact(s11="x", s22="1", s12="0"), self.MATERIALS)
        # what the finer run lacks
        self.assertAlmostEqual(difference / exact, np.sqrt(1 - 1 / 16), delta=2e-3)

    def test_pressure_from_nodal_forces(self):
        s = np.array([0, 0.2, 0.7, 1.0])
        mass = np.array([[2, 1, 0, 0], [1, 7, 2.5, 0], [0, 2.5, 8, 1.5], [0, 0, 1.5, 3]]) * 0.2 / 6
        run = results.Run("test", Path("."), {}, results.Contact(np.arange(4), np.column_stack([s, 0 * s]),
                                                                 0 * s, mass @ (1 + s)), {})
        self.assertLess(measure.pressure_error(run, self.exact(p="1 + x")), 1e-14)

    def test_pressure_on_an_arc(self):
        # Over the top of a circle x is no order. Any run of it, whichever body has it to its left,
        # has the same line.
        angle = np.linspace(0.1, np.pi - 0.1, 40)
        position = 3 * np.column_stack([np.cos(angle), np.sin(angle)])
        for position in (position, position[::-1], position @ [[0, 1], [-1, 0]]):
            run = results.Run("test", Path("."), {}, results.Contact(np.arange(40), position, 0 * angle,
                                                                     0 * angle, 1 + position[:, 1]), {})
            s, p, there = measure.pressure_line(run)
            np.testing.assert_allclose(np.diff(s), 6 * np.sin((angle[1] - angle[0]) / 2), rtol=1e-12)
            np.testing.assert_allclose(p, 1 + there[:, 1])
            self.assertLess(measure.pressure_error(run, self.exact(p="1 + y")), 1e-14)
        finer = np.linspace(0.1, np.pi - 0.1, 79)
        position = 3 * np.column_stack([np.cos(finer), np.sin(finer)]) @ [[0, 1], [-1, 0]]
        truth = results.Run("test", Path("."), {}, results.Contact(np.arange(79), position, 0 * finer,
                                                                   0 * finer, 1 + position[:, 1]), {})
        self.assertLess(measure.pressure_error(run, truth), 1e-3)

    def test_expressions(self):
        x = np.array([-1.0, 0.5])
        for text, value in (("2^3^0.5", 2**3**0.5), ("-2^2", -4),
                            ("x < 0 ? -1 : x > 0.4 && x < 1 ? 2 : 3", [-1, 2]),
                            ("max(x, 0) + min(1, 2)", [1, 1.5]), ("abs(x ? x : 1)", [1, 0.5]),
                            ("1e-3*t", 2e-3)):
            np.testing.assert_allclose(Expression(text)(x, 0 * x, 2.0), np.broadcast_to(value, 2),
                                       err_msg=text)
        for text in ("x.real", "[1]", "lambda: 1", "open('f')", "x[0]", "'a'", "x if x else y", "z", "sin",
                     "1 +", ")(", "x % 2", "not x", "x is y", "max(*x)"):
            with self.assertRaises(ValueError, msg=text):
                Expression(text)(x, x, 0.0)

    def test_front_and_equal_error(self):
        self.assertEqual(analysis.front([(1, 1), (2, 2), (3, 0.5), (2.5, 0.9), (4, 0.5)]), [0, 3, 2])
        rows = [{"steps": n, "error e": 1 / n, "wall_time[s]": n} for n in (1, 2, 4, 8)]
        line = analysis.Series("s", {}, "steps", rows)
        self.assertAlmostEqual(analysis.order(line, "e")[0], 1, places=12)
        for at, value, how in ((0.3, 1 / 0.3, "between runs"), (0.01, 100, "extrapolated"),
                               (2, 1, "at most")):
            found = analysis.cost_at(line, "e", at, "wall_time")
            self.assertAlmostEqual(found.value, value, places=9)
            self.assertEqual(found.how, how)

    def test_estimates_and_bounds_are_lines_of_their_own(self):
        rows = [{"steps": n, "error e": 1 / n, "estimate": 0.9 / n, "bound": "" if n == 2 else 1.1 / n,
                 "dofs": n} for n in (4, 1, 2)]
        line = analysis.Series("s", {}, "steps", rows)
        for quantity, expected in (("energy", {"estimate": [0.9, 0.45, 0.225], "proved bound": [1.1, 0.275]}),
                                   ("displacement", {})):
            figure = pictures.work_precision([line], ErrorMeasure("e", quantity), "dofs")
            axes, = figure.axes
            names = [text.get_text() for text in axes.get_legend().get_texts()]
            self.assertEqual(names[1:-1], list(expected))
            drawn = [list(each.get_ydata()) for each in axes.lines if each.get_label().startswith("_")]
            for values in expected.values():
                self.assertTrue(any(np.allclose(values, ys) for ys in drawn if len(ys) == len(values)), drawn)

    def test_memory_and_time_of_a_process(self):
        cost, output = process.measured([sys.executable, "-c", "a = bytearray(300 << 20); print(len(a))"])
        self.assertEqual(output.strip(), str(300 << 20))
        self.assertTrue(300 < cost.memory < 340, cost.memory)
        small, _ = process.measured(["true"])
        self.assertLess(small.memory, 20)
        with self.assertRaisesRegex(RunFailure, "stopped after 0.2 s"):
            process.measured(["sleep", "60"], timeout=0.2)
        with self.assertRaisesRegex(RunFailure, "out of luck"):
            process.measured(["sh", "-c", "echo out of luck; exit 3"])


if __name__ == "__main__":
    unittest.main()
