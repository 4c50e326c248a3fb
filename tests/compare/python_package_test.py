"""The Python module as one meets it: what it shows, its page, installed, its types."""
import csv
import os
import re
import shutil
import subprocess
import sys
import unittest
import warnings
import zipfile

from python_support import PACKAGE, SCENES
from support import ROOT, InFolder, InSharedFolder, OfTwoBlocks

import mortier


class Shown(OfTwoBlocks):
    def test_pictures_and_tables(self):
        import matplotlib
        matplotlib.use("svg")
        sys.modules["results"] = results = type(sys)("results")  # a module of the user's
        self.addCleanup(sys.modules.pop, "results")
        run = mortier.load(self.folder / "scene.toml").run()
        for kind in ("fields", "contact", "history"):
            figure = run.plot(kind)
            figure.savefig(self.folder / f"{kind}.png")
            self.assertGreater((self.folder / f"{kind}.png").stat().st_size, 5000)
        self.assertEqual(matplotlib.get_backend().lower(), "svg")
        self.assertIs(sys.modules["results"], results)
        self.assertFalse({"pictures", "runs", "ending"} & set(sys.modules))
        with self.assertRaisesRegex(mortier.InputError, "field 'none', expected one of von_mises"):
            run.plot(field="none")
        page = run._repr_html_()
        self.assertIn("<caption>two blocks</caption>", page)
        self.assertIn("<td>converged</td>", page)
        self.assertIn("two blocks", repr(mortier.load(self.folder / "scene.toml")))


class Page(InFolder):
    """docs/python.md."""

    def test_every_example(self):
        for name in ("scenes", "shared-meshes"):
            shutil.copytree(ROOT / name, self.folder / name)
        text = (ROOT / "docs" / "python.md").read_text()
        blocks = re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)
        self.assertGreaterEqual(len(blocks), 5)
        done = subprocess.run([sys.executable, "-c", "\n".join(blocks)], cwd=self.folder, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              env={**os.environ, "PYTHONPATH": str(PACKAGE.parent)})
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("yield_stress = 1e+06 Pa, the loads are at most of the order of 10 Pa;", done.stdout)
        self.assertIn("more than 7.2 Pa at t = 0.75", done.stdout)
        self.assertIn("poisson = 0.6, expected -1 < poisson < 0.5", done.stdout)

    def test_names_are_there(self):
        run = mortier.Scene({"body": {"name": "a", "material": {"young": 1, "poisson": 0.3},
                                      "mesh": {"shape": "rectangle", "cells": 1},
                                      "boundary": {"label": 1, "ux": 0, "uy": 0}},
                             "time": {"end": 1, "steps": 1}}).run()
        text = (ROOT / "docs" / "python.md").read_text()
        for rows, of in zip(re.findall(r"^\| of a (?:run|step) .*\n\|.*\n((?:\|.*\n)+)", text, re.M),
                            (run, run.last)):
            cells = [row.split("|")[1] for row in rows.splitlines()]
            names = [name for cell in cells for name in re.findall(r"`(\w+)[`(]", cell)]
            self.assertGreater(len(names), 8)
            for name in names:
                if name not in ("contact", "vertex", "gap", "force", "pressure", "position", "friction",
                                "shear", "slip", "slipping"):
                    self.assertTrue(hasattr(of, name), name)


class Installed(InSharedFolder):
    """What `cmake --install` puts in place, and a wheel of what is built."""

    def use(self, *places):
        """A run and a picture by a Python that sees nothing of the source tree."""
        text = ("import sys, mortier\n"
                f"run = mortier.load({str(SCENES / 'compression.toml')!r}, set={{'time.steps': 2}}).run()\n"
                "print(mortier.__file__, run.contact[0].pressure.max(), len(run.plot().axes))\n")
        done = subprocess.run([sys.executable, "-c", text], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True,
                              env={**os.environ, "PYTHONPATH": os.pathsep.join(map(str, places))})
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertTrue(done.stdout.startswith(str(places[0])), done.stdout)
        self.assertRegex(done.stdout, r" (10\.0\d*|9\.99\d*) 3$")

    def test_cmake_says_where_it_is(self):
        told = ""
        for component in ("python", "scripts"):  # other targets need not be built
            done = subprocess.run(["cmake", "--install", PACKAGE.parents[1], "--component", component,
                                   "--prefix", self.folder / "prefix"], text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT)
            self.assertEqual(done.returncode, 0, done.stdout)
            told += done.stdout
        self.use(re.search(r"^-- For import mortier: PYTHONPATH=(.*)$", told, re.M)[1])

    def test_a_wheel(self):
        text = f"import build_backend\nprint(build_backend.build_wheel({str(self.folder)!r}, " \
               f"{{'build': {str(PACKAGE.parents[1])!r}}}))"
        done = subprocess.run([sys.executable, "-c", text], cwd=ROOT / "python", text=True, check=True,
                              stdout=subprocess.PIPE)
        name = done.stdout.splitlines()[-1]
        self.assertRegex(name, r"^mortier-[\d.]+-cp3\d+-cp3\d+-linux_\w+\.whl$")
        with zipfile.ZipFile(self.folder / name) as wheel:
            wheel.extractall(self.folder / "wheel")
            record = next(each for each in wheel.namelist() if each.endswith("RECORD"))
            listed = [row[0] for row in csv.reader(wheel.read(record).decode().splitlines())]
            self.assertEqual(sorted(listed), sorted(wheel.namelist()))
        self.use(self.folder / "wheel")


class Types(unittest.TestCase):
    def test_mypy(self):
        done = subprocess.run(["mypy", "--config-file", ROOT / "pyproject.toml", "--cache-dir", os.devnull,
                               ROOT / "python" / "mortier"], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_the_stub_names_what_there_is(self):
        from mortier import _core
        text = (PACKAGE / "_core.pyi").read_text()
        for name in ("Contact", "Step", "Scene", "Solution", "Steps"):
            block = re.search(rf"^class {name}:\n(.*?)(?=^\S|\Z)", text, re.M | re.S)[1]
            self.assertEqual({each for each in re.findall(r"def (\w+)", block) if each != "__init__"},
                             {each for each in vars(getattr(_core, name)) if not each.startswith("_")}, name)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    unittest.main()
