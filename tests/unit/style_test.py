"""No line is longer than 110 characters, but for rows of Markdown tables and single long words; files that
comments of C++ name are there."""
import ast
import collections
import os
import re
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

    def test_files_that_comments_name_are_there(self):
        names = {path.name for path in sources()}
        named, missing = 0, []
        for path in (*(ROOT / "cpp").rglob("*.h"), *(ROOT / "cpp").rglob("*.cpp")):
            for comment in re.findall(r"//(.*)", path.read_text(encoding="utf-8")):
                for file in re.findall(r"\b\w[\w/]*\.(?:h|cpp|py|md|idp|edp|js)\b", comment):
                    named += 1
                    place = Path(file)
                    there = (any((folder / place).is_file() for folder in (ROOT / "cpp", ROOT, path.parent))
                             if "/" in file else place.name in names)
                    if not there:
                        missing.append(f"{path.relative_to(ROOT)}: {file}")
        self.assertEqual(missing, [])
        self.assertGreater(named, 100)

    def test_rules_and_numbers_of_many_digits_stand_in_one_place(self):
        """Quadrature rules, units and the like: a copy in another file drifts."""
        places = {}
        for path in (ROOT / "cpp").rglob("*.*"):
            for number in re.findall(r"\b\d+\.\d{7,}\b", path.read_text(encoding="utf-8")):
                places.setdefault(f"{float(number):.9g}", set()).add(str(path.relative_to(ROOT)))
        self.assertEqual({number: files for number, files in places.items() if len(files) > 1}, {})
        self.assertGreater(len(places), 40)

    def test_no_test_takes_the_name_of_another_one(self):
        """The later of two classes or methods of one name is the only one that runs."""
        twice, read = [], 0
        for path in (ROOT / "tests").rglob("*_test.py"):
            module = ast.parse(path.read_text(encoding="utf-8"))
            for scope in (module, *(each for each in module.body if isinstance(each, ast.ClassDef))):
                names = collections.Counter(each.name for each in scope.body
                                            if isinstance(each, (ast.ClassDef, ast.FunctionDef)))
                read += len(names)
                twice += [f"{path.relative_to(ROOT)}: {name}" for name, count in names.items() if count > 1]
        self.assertEqual(twice, [])
        self.assertGreater(read, 1000)

    def test_a_long_line_would_be_seen(self):
        table, prose = "| " + "word " * 30 + "|", "word " * 30
        self.assertTrue(may_be_long(ROOT / "README.md", table))
        self.assertFalse(may_be_long(ROOT / "README.md", prose))
        self.assertFalse(may_be_long(ROOT / "demo", table))


if __name__ == "__main__":
    unittest.main()
