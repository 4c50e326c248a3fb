"""Rows of bench/hard.py that take a second or so: each is what it says, within its tolerance, or off and
named by the program."""
import os
import sys
import unittest

from support import PROGRAM, ROOT

os.environ["MORTIER"] = PROGRAM
sys.path.insert(0, str(ROOT / "bench"))
import hard  # noqa: E402
import published  # noqa: E402
import stated  # noqa: E402


class Hard(unittest.TestCase):
    def test_rows(self):
        tested = [row for row in hard.rows.ROWS if row.test]
        self.assertGreaterEqual(len(tested), 10)
        for row in tested:
            with self.subTest(f"{row.case}: {row.value}"):
                value, off, verdict = hard.measure(row)
                print(f"{row.case}: {row.value}: {value} ({row.exact}), {verdict}")
                self.assertEqual(verdict.split(":")[0], row.test, f"{value}, off by {off}")
                if row.published and (told := published.statement(row, value, off)):
                    stated.check(self, published.PAGE.read_text(), *told)


if __name__ == "__main__":
    unittest.main()
