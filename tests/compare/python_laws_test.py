"""Laws as Python callables: the results of the same laws as expressions; what they raise; their lives."""
import gc
import unittest
import weakref

import numpy as np

from own_law_test import MISES
import python_support  # noqa: F401 (the module of the build)

import mortier

NORTON = {"s0": 1e7, "r0": 1e-4, "n": 5}
SOLID = {"tau": 0.1, "g": 0.3, "shear": 2e11 / 1.3}


def scene(law, plane="strain", **time):
    return {"plane": plane,
            "body": [{"name": "upper", "volume": "pointwise",
                      "mesh": {"shape": "rectangle", "cells": 3, "lower": [0, 0], "upper": [1, 1]},
                      "material": {"young": 2e11, "poisson": 0.3, **law},
                      "boundary": [{"label": 3, "ux": 0, "ty": "-1e8*(1 + 0.5*x)*min(t, 0.3)"}]},
                     {"name": "lower",
                      "mesh": {"shape": "rectangle", "cells": [4, 3], "lower": [0, -1], "upper": [1, 0]},
                      "material": {"young": 2e11, "poisson": 0.3},
                      "boundary": [{"label": 1, "ux": 0, "uy": 0}]}],
            "contact": {"nonmortar": {"body": "upper", "label": 1}, "mortar": {"body": "lower", "label": 3}},
            "time": {"end": 1, "steps": 4, **time}}


def expression(factor, parameters, more=None):
    more = more or {}
    rates = {f"rate{c}": f"{factor}*(s{c}{'' if c == '12' else ' - mean'}){more.get(c, '')}"
             for c in ("11", "22", "12", "33")}
    return {"law": "expression", **rates,
            "parameters": {"mises": MISES, "mean": "(s11 + s22 + s33)/3", **parameters}}


def deviator(tensor):
    mean = tensor[:, [0, 1, 3]].sum(axis=1) / 3
    return tensor - np.outer(mean, [1, 1, 0, 1])


def mises_of(s):
    return np.sqrt(1.5 * ((s**2).sum(axis=1) + s[:, 2] ** 2))


def norton(stress, strain, s0, r0, n):
    s = deviator(stress)
    return (1.5 * r0 / s0 * (mises_of(s) / s0) ** (n - 1))[:, None] * s


def norton_slopes(stress, strain, s0, r0, n):
    """By 11, 22, 12, 33: d mises = 1.5 s : ds/mises, 12 counted twice."""
    s = deviator(stress)
    mises = mises_of(s)
    size = np.where(mises > 0, mises, 1)
    factor = 1.5 * r0 / s0 * (mises / s0) ** (n - 1)
    projection = np.eye(4)
    projection[np.ix_([0, 1, 3], [0, 1, 3])] -= 1 / 3
    along = 1.5 * s * [1, 1, 2, 1] / size[:, None]
    return factor[:, None, None] * (projection + (n - 1) / size[:, None, None]
                                    * s[:, :, None] * along[:, None, :])


def solid(stress, strain, tau, g, shear):
    return deviator(stress) / (shear * tau) - g / tau * deviator(strain)


class Laws(unittest.TestCase):
    def registered(self, name, rate, *arguments, **options):
        mortier.register_law(name, rate, *arguments, **options)
        self.addCleanup(mortier.forget_law, name)
        return {"law": name}

    def assert_same(self, ours, theirs, within):
        for body in ("upper", "lower"):
            for field in ("displacement", "stress", "viscoplastic_strain"):
                a, b = (getattr(run.last, field)[body] for run in (ours, theirs))
                self.assertLess(np.abs(a - b).max(), within * max(np.abs(b).max(), 1e-300), field)

    def test_equals_expressions(self):
        as_expression = expression("1.5*r0/s0*(mises/s0)^(n - 1)", NORTON)
        for plane in ("stress", "strain"):
            for slopes in (None, norton_slopes):
                for scheme in ("backward-euler", "sdirk2"):
                    with self.subTest(plane=plane, slopes=slopes, scheme=scheme):
                        law = self.registered("own-norton", norton, slopes) | {"parameters": NORTON}
                        ours = mortier.Scene(scene(law, plane, scheme=scheme)).run()
                        theirs = mortier.Scene(scene(as_expression, plane, scheme=scheme)).run()
                        self.assert_same(ours, theirs, 1e-10)

    def test_depends_on_the_strain(self):
        more = {c: f" - g/tau*(e{c}{'' if c == '12' else ' - em'})" for c in ("11", "22", "12", "33")}
        as_expression = expression("1/(shear*tau)", SOLID | {"em": "(e11 + e22 + e33)/3"}, more)
        law = self.registered("own-solid", solid, of_strain=True) | {"parameters": SOLID}
        built_in = {"law": "standard-solid", "relaxation_time": 0.1, "relaxed_fraction": 0.3}
        ours, theirs, expected = (mortier.Scene(scene(each)).run() for each in (law, as_expression, built_in))
        self.assert_same(theirs, expected, 1e-11)
        self.assert_same(ours, theirs, 1e-9)

    def test_several_threads(self):
        law = self.registered("own-norton", norton) | {"parameters": NORTON}
        self.assert_same(mortier.Scene(scene(law)).run(threads=3), mortier.Scene(scene(law)).run(), 1e-12)

    def test_calls_have_the_shapes_that_are_documented(self):
        seen = set()

        def watched(stress, strain):
            seen.add((stress.shape[1:], strain.shape[1:], stress.dtype, stress.shape == strain.shape))
            return 0 * stress

        steps = mortier.Scene(scene(self.registered("watched", watched))).steps()
        self.assertEqual(sum(1 for _ in steps), 5)
        self.assertEqual(seen, {((4,), (4,), np.dtype(float), True)})

    def test_what_it_raises_is_raised(self):
        class Odd(Exception):
            pass

        def raising(stress, strain):
            if np.abs(stress).max() > 1e6:
                raise Odd("so much")
            return 1e-12 * stress

        read = mortier.Scene(scene(self.registered("raising", raising)))
        with self.assertRaisesRegex(Odd, "so much"):
            read.run()
        with self.assertRaisesRegex(Odd, "so much"):
            for _ in read.steps():
                pass
        for rate, message in ((lambda s, e: s[:, :3], r"a rate of shape \(1, 3\), expected \(1, 4\)"),
                              (lambda s, e: np.nan * s, "expected a rate that is a number")):
            with self.assertRaisesRegex(mortier.InputError, message):
                mortier.Scene(scene(self.registered("wrong", rate))).run()
        with self.assertRaisesRegex(mortier.InputError, r"a derivative of shape .*expected \(\d+, 4, 4\)"):
            mortier.Scene(scene(self.registered("wrong", lambda s, e: 1e-12 * s, lambda s, e: s))).run()
        with self.assertRaises(TypeError):
            mortier.Scene(scene(self.registered("wrong", norton))).run()  # its parameters are missing

    def test_names(self):
        for name in ("norton", "expression", "", "a b", "a.b"):
            with self.assertRaises(mortier.InputError):
                mortier.register_law(name, norton)
        with self.assertRaisesRegex(mortier.InputError, 'law = "own", expected one of elastic, perzyna'):
            mortier.Scene(scene({"law": "own"}))
        with self.assertRaisesRegex(mortier.InputError, "expected a finite number"):
            mortier.Scene(scene(self.registered("own", norton) | {"parameters": {"n": "2*3"}}))
        with self.assertRaisesRegex(mortier.InputError, 'exponent = 3, expected it beside law = "norton"'):
            mortier.Scene(scene(self.registered("own", norton) | {"exponent": 3}))

    def test_lives_as_long_as_its_scenes(self):
        class Law:
            def __call__(self, stress, strain):
                return 1e-13 * stress

        law = Law()
        alive = weakref.ref(law)
        mortier.register_law("living", law)
        read = mortier.Scene(scene({"law": "living"}))
        mortier.forget_law("living")
        del law
        gc.collect()
        read.run()
        self.assertIsNotNone(alive())
        del read
        gc.collect()
        self.assertIsNone(alive())


if __name__ == "__main__":
    unittest.main()
