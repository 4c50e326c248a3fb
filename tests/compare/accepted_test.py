"""mortier against its own past: accepted scalars are met, and drift is caught."""
import copy
import json
import unittest

import support  # noqa: F401
from accept import DIGITS, TABLE, drift, measure


class Accepted(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.accepted = json.loads(TABLE.read_text())

    def test_no_drift(self):
        self.assertEqual(drift(self.accepted, measure()), [])

    def test_values_have_the_stated_digits(self):
        for name, scalars in self.accepted.items():
            for key, value in scalars.items():
                self.assertEqual(value, float(f"{value:.{DIGITS}g}"), f"{name}: {key}")

    def test_drift_of_any_scalar_is_caught(self):
        name = next(name for name in self.accepted if "interpolation" in name)
        for key, value in self.accepted[name].items():
            if value == 0:
                continue
            with self.subTest(key):
                measured = copy.deepcopy(self.accepted)
                measured[name][key] *= 1 + 1e-6
                lines = drift(self.accepted, measured)
                self.assertEqual(len(lines), 1)
                self.assertIn(key, lines[0])

    def test_not_a_number_is_caught(self):
        name = next(iter(self.accepted))
        measured = copy.deepcopy(self.accepted)
        measured[name]["von_mises_max"] = float("nan")
        self.assertEqual(len(drift(self.accepted, measured)), 1)

    def test_a_run_that_is_new_or_gone_is_caught(self):
        fewer = copy.deepcopy(self.accepted)
        del fewer[next(iter(fewer))]
        self.assertEqual(len(drift(self.accepted, fewer)), 1)
        self.assertEqual(len(drift(fewer, self.accepted)), 1)

    def test_a_scalar_that_is_gone_is_caught(self):
        fewer = copy.deepcopy(self.accepted)
        del fewer[next(iter(fewer))]["interpenetration"]
        self.assertEqual(len(drift(self.accepted, fewer)), 1)


if __name__ == "__main__":
    unittest.main()
