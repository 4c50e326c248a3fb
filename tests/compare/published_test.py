"""Tests that other projects and papers publish (tests/compare/published.py): those that take a second or so
are run, and docs/published.md has all of them."""
import os
import unittest

from support import PROGRAM

os.environ["MORTIER"] = PROGRAM
import published  # noqa: E402
import known  # noqa: E402: published says where it is
import stated  # noqa: E402


class Published(unittest.TestCase):
    def test_rows(self):
        tested = [row for row in published.published_rows.ROWS if row.test]
        self.assertGreaterEqual(len({row.case for row in tested}), 10)
        for row in tested:
            with self.subTest(f"{row.case}: {row.value}"):
                value, off, verdict = known.measure(row)
                print(f"{row.case}: {row.value}: {value} ({row.reference()}), {verdict}")
                self.assertEqual(verdict.split(":")[0], row.test, f"{value}, off by {off}")
                told = published.statement(row, value, off)
                if told:
                    stated.check(self, published.PAGE.read_text(), *told)

    def test_a_value_that_is_off_is_seen(self):
        for row in (known.Row("", "", "", exact=2.0, within=0.01),
                    known.Row("", "", "", exact=(1, 2.0), within=0.01),
                    known.Row("", "", "", exact=(1, 2.0), within=0.01, each=True),
                    known.Row("", "", "", exact=None, theirs=2.0, within=0.01)):
            self.assertLessEqual(row.off(row.reference()), row.within)
            wrong = [1, 2.03] if isinstance(row.exact, tuple) else 2.03
            self.assertGreater(row.off(wrong), row.within)
            self.assertFalse(row.off(float("nan")) <= row.within)

    def test_the_page_has_all_rows(self):
        lines = [line for line in published.PAGE.read_text().splitlines() if line.startswith("| ")]
        self.assertEqual(lines[0], published.line(published.HEADER))
        self.assertEqual(len(lines), 1 + len(published.ROWS))
        self.assertGreaterEqual(len({row.case for row in published.ROWS}), 40)
        for line, row in zip(lines[1:], published.ROWS):
            words = [word.strip().replace("\\|", "|") for word in line.strip("|").split(" | ")]
            possible = [published.facts(row, which) for which in range(published.values(row))]
            self.assertIn([*words[:5], words[7]], possible, line)
            self.assertNotIn("OFF", line)


if __name__ == "__main__":
    unittest.main()
