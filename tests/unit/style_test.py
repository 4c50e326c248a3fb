"""No line is longer than 110 characters, but for rows of Markdown tables and single long words."""
import os
import unittest
from pathlib import Path

ROOT = Path(os.environ.get("MORTIER_ROOT", Path(__file__).resolve().parents[2]))
FOLDERS = (".ci", "bench", "compare", "cpp", "docs", "examples", "freefem", "packaging", "python", "scenes",
           "scripts", "shared-meshes", "study", "tests", "views")
DATA = {".mesh", ".png", ".gif", ".pyc"}
CORPUS = ROOT / "tests" / "fuzz" / "corpus"  # bytes for the readers
WIDTH = 110


def sources():
    for path in (*ROOT.iterdir(), *(path for folder in FOLDERS for path in (ROOT / folder).rglob("*"))):
        if path.is_file() and path.suffix not in DATA and CORPUS not in path.parents:
            yield path


def may_be_long(path, line):
    return (path.suffix == ".md" and line.startswith("|")) or max(map(len, line.split())) > WIDTH - 10


class Style(unittest.TestCase):
    def test_lines_are_short(self):
        long, read = [], 0
        for path in sources():
            for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
                read += 1
                if len(line) > WIDTH and not may_be_long(path, line):
                    long.append(f"{path.relative_to(ROOT)}:{number}: {len(line)} characters")
        self.assertEqual(long, [])
        self.assertGreater(read, 40_000)

    def test_a_long_line_would_be_seen(self):
        table, prose = "| " + "word " * 30 + "|", "word " * 30
        self.assertTrue(may_be_long(ROOT / "README.md", table))
        self.assertFalse(may_be_long(ROOT / "README.md", prose))
        self.assertFalse(may_be_long(ROOT / "demo", table))


if __name__ == "__main__":
    unittest.main()
