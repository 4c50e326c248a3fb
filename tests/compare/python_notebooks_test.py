"""The notebooks of docs/notebooks: each cell is run, and what it says holds."""
import ast
import contextlib
import io
import json
import os
import unittest

import python_support  # noqa: F401
from support import ROOT

import matplotlib  # noqa: E402

matplotlib.use("Agg")

from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

FOLDER = ROOT / "docs" / "notebooks"


def run(cell, names):
    """What a notebook shows of a cell: what it prints, and the value of its last line."""
    tree = ast.parse(cell)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    with contextlib.redirect_stdout(io.StringIO()) as told:
        exec(compile(tree, "cell", "exec"), names)
        value = eval(compile(ast.Expression(last.value), "cell", "eval"), names) if last else None
    return told.getvalue(), value


class Notebooks(unittest.TestCase):
    def execute(self, name):
        """Names after the last cell; what was printed; the values that were shown."""
        notebook = json.loads((FOLDER / f"{name}.ipynb").read_text())
        self.assertEqual(notebook["nbformat"], 4)
        self.addCleanup(os.chdir, os.getcwd())
        self.addCleanup(plt.close, "all")
        os.chdir(FOLDER)
        before, names, shown = sorted(FOLDER.iterdir()), {}, []
        for cell in notebook["cells"]:
            self.assertIn(cell["cell_type"], ("code", "markdown"))
            if cell["cell_type"] == "code":
                self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None))
                shown.append(run("".join(cell["source"]), names))
        printed, values = "".join(text for text, _ in shown), [of for _, of in shown if of is not None]
        figures = [of for of in values if isinstance(of, Figure)]
        self.assertGreaterEqual(len(figures), 2)
        for figure in figures:
            figure.savefig(io.BytesIO(), format="png")
        self.assertEqual(sorted(FOLDER.iterdir()), before)
        return names, printed, values

    def test_all_are_known(self):
        self.assertEqual({path.name for path in FOLDER.iterdir()},
                         {"error-against-cost.ipynb", "lesson.ipynb", "note.ipynb", "own-part.ipynb"})

    def test_note(self):
        names, _, values = self.execute("note")
        self.assertLess(names["worst"]["mortar"], 1e-9)
        self.assertGreater(names["worst"]["interpolation"], 5)
        self.assertAlmostEqual(names["orders"]["backward-euler"], 1, delta=0.05)
        self.assertAlmostEqual(names["orders"]["sdirk2"], 2, delta=0.1)
        self.assertIn("<td>converged</td>", values[0]._repr_html_())

    def test_own_part(self):
        names, printed, _ = self.execute("own-part")
        self.assertIn("[sliver]", printed)
        self.assertAlmostEqual(names["pressure"][-1] / names["hertz"][-1], 1, delta=0.01)
        self.assertAlmostEqual(names["side"].force.sum(), names["force"][-1], delta=1e-9 * names["force"][-1])

    def test_lesson(self):
        names, _, _ = self.execute("lesson")
        self.assertAlmostEqual(names["power"], 0.5, delta=0.05)
        self.assertAlmostEqual(names["growth"], 0.5, delta=0.05)
        self.assertAlmostEqual(names["order"], 0.5, delta=0.1)
        self.assertLess(abs(names["forces"][-1] / names["forces"][-2] - 1), 0.01)
        self.assertLess(names["worst"]["mortar"], 1e-12)
        self.assertGreater(names["worst"]["interpolation"], 0.5)

    def test_error_against_cost(self):
        names, printed, _ = self.execute("error-against-cost")
        for name, bounds in names["bounds"].items():
            self.assertTrue((bounds > names["estimates"][name]).all(), name)
        self.assertEqual(printed.count("1 % with some"), 3)
        at_most = {name: error.min() for name, error in names["estimates"].items()}
        self.assertLess(at_most["refined, degree 2"], 0.001)
        self.assertLess(at_most["mortar"], at_most["interpolation"])


if __name__ == "__main__":
    unittest.main()
