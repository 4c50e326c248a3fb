"""Results read from folders and pickled; meshes of meshio, of arrays in any order and of a running Gmsh;
errors of Python's own kinds."""
import os
import pickle
import sys
import types
import unittest
from pathlib import Path
from unittest import mock

import meshio
import numpy as np

import python_support  # noqa: F401
from support import OfTwoBlocks
from scenes import HELD_AND_PRESSED, TWO_BLOCKS

import mortier
from mortier import stored

POINTS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [5, 5, 0]])
TRIANGLES = [[0, 2, 1], [0, 2, 3]]  # clockwise, counterclockwise
EDGES = [[0, 1], [2, 3]]


def scene(**mesh):
    return {"body": [{"name": "block", **mesh, "material": {"young": 1e5, "poisson": 0.3},
                      "boundary": [{"label": "foot", "ux": 0, "uy": 0}, {"label": "head", "ty": "-1*t"}]}],
            "time": {"end": 1, "steps": 1}}


class Results(OfTwoBlocks):
    def setUp(self):
        super().setUp()
        self.write(TWO_BLOCKS + HELD_AND_PRESSED)
        self.done = mortier.load(self.folder / "scene.toml", set={"output.every": 1}).run(self.folder / "out")

    def same(self, other):
        self.assertEqual(other.quantities, self.done.quantities)
        self.assertEqual(list(other.history), list(self.done.history))
        for name, column in self.done.history.items():
            np.testing.assert_array_equal(other.history[name], column, name)
        self.assertEqual([step.number for step in other.steps], [step.number for step in self.done.steps])
        for ours, theirs in zip(self.done.steps, other.steps):
            self.assertEqual(theirs.time, ours.time)
            for name in stored.FIELDS:
                for body, values in getattr(ours, name).items():
                    np.testing.assert_array_equal(getattr(theirs, name)[body], values, name)
            for one, two in zip(ours.contact, theirs.contact):
                for name in ("position", *stored.NODAL):
                    np.testing.assert_array_equal(getattr(two, name), getattr(one, name), name)

    def test_a_folder_holds_what_the_run_had(self):
        opened = mortier.open(self.folder / "out")
        self.same(opened)
        self.assertAlmostEqual(opened.quantities["held"], 10, 9)
        self.assertEqual(opened.summary["final"], self.done.summary["final"])
        self.assertEqual(Path(opened.folder), self.folder / "out")
        opened.plot("contact"), opened.to_meshio(), repr(opened), opened._repr_html_()

    def test_a_run_goes_on_from_a_folder(self):
        block = {"body": [{"name": "block", "mesh": {"shape": "rectangle", "cells": 3},
                           "material": {"young": 1000, "poisson": 0.3, "viscosity": 100, "yield_stress": 3},
                           "boundary": [{"label": 1, "uy": 0}, {"label": 4, "ux": 0},
                                        {"label": 3, "ty": "-5*t"}]}]}
        begun = os.path.relpath(self.folder / "begun")
        whole = mortier.Scene({**block, "time": {"end": 2, "steps": 4}}).run()
        mortier.Scene({**block, "time": {"end": 1, "steps": 2}, "output": {"state": True}}).run(begun)
        rest = mortier.Scene({**block, "start": begun, "time": {"end": 2, "steps": 2}}).run()
        np.testing.assert_allclose(rest.stress["block"], whole.stress["block"], rtol=1e-12, atol=1e-12)

    def test_pickled(self):
        self.same(pickle.loads(pickle.dumps(self.done)))
        step = pickle.loads(pickle.dumps(self.done.last))
        np.testing.assert_array_equal(step.contact[0].pressure, self.done.contact[0].pressure)
        error = mortier.StepError("one line", self.done)
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual(str(again), "one line")
        self.same(again.run)

    def test_errors_are_of_pythons_kinds(self):
        for call in (mortier.open, mortier.load):
            with self.assertRaises(FileNotFoundError) as caught:
                call(self.folder / "none")
            self.assertIsInstance(caught.exception, mortier.InputError)
            self.assertIn("none: ", str(caught.exception))
        (self.folder / "empty").mkdir()
        with self.assertRaisesRegex(ValueError, "empty/summary.json: cannot be read"):
            mortier.open(self.folder / "empty")
        self.assertTrue(issubclass(mortier.OutputError, OSError))
        self.assertTrue(issubclass(mortier.FreeMotion, RuntimeError))


class Meshes(unittest.TestCase):
    def least(self, made):
        return made.run().displacement["block"].min()

    def expected(self):
        square = mortier.Mesh(POINTS[:4, :2], [[0, 1, 2], [0, 2, 3]], EDGES, ["foot", "head"])
        return self.least(mortier.Scene(scene(), {"block": square}))

    def test_any_orientation_unused_vertices_three_columns_and_names(self):
        mesh = mortier.Mesh(POINTS, TRIANGLES, EDGES, ["foot", "head"], ["steel", "steel"])
        self.assertEqual(self.least(mortier.Scene(scene(), {"block": mesh})), self.expected())
        bent = POINTS + [[0, 0, 0], [0, 0, 0], [0, 0, 1], [0, 0, 0], [0, 0, 0]]
        with self.assertRaisesRegex(mortier.InputError, "mesh of block: points with z from 0 to 1"):
            mortier.Scene(scene(), {"block": mesh._replace(points=bent)})

    def test_meshes_of_meshio(self):
        cells = [("triangle", TRIANGLES), ("line", EDGES)]
        physical = [np.array([7, 7]), np.array([1, 3])]
        grouped = meshio.Mesh(POINTS, cells, cell_data={"gmsh:physical": physical},
                              field_data={"foot": [1, 1], "head": [3, 1], "whole": [7, 2]})
        sets = meshio.Mesh(POINTS, cells, cell_sets={"foot": [np.array([], int), np.array([0])],
                                                     "head": [np.array([], int), np.array([1])]})
        for mesh in (grouped, sets):
            self.assertEqual(self.least(mortier.Scene.from_meshio(scene(), {"block": mesh})), self.expected())
        of_region = scene(mesh={"region": "whole"})
        self.assertEqual(self.least(mortier.Scene.from_meshio(of_region, grouped)), self.expected())
        with self.assertRaisesRegex(mortier.InputError, "region none: expected one of whole"):
            mortier.Scene.from_meshio(scene(mesh={"region": "none"}), grouped)
        lines = meshio.Mesh(POINTS, [("line", EDGES)])
        with self.assertRaisesRegex(mortier.InputError, "mesh of block: cells line, expected triangles"):
            mortier.Scene.from_meshio(scene(), {"block": lines})

    def test_a_mesh_of_meshio_in_space(self):
        cells = [("tetra", [[0, 1, 2, 3]]), ("triangle", [[0, 1, 2], [1, 2, 3]])]
        mesh = meshio.Mesh(np.eye(4, 3, -1), cells,
                           cell_data={"medit:ref": [np.array([4]), np.array([1, 3])]})
        asked = {**scene(mesh={"region": 4}), "dimension": 3}
        asked["body"][0]["boundary"] = [{"label": 1, "ux": 0, "uy": 0, "uz": 0}, {"label": 3, "tz": "-1*t"}]
        stiffness = 1e5 * 0.7 / (1.3 * 0.4) / 6  # of the one node that is not held
        self.assertAlmostEqual(self.least(mortier.Scene.from_meshio(asked, mesh)),
                               -np.sqrt(3) / 6 / stiffness, 15)

    def test_the_model_of_a_running_gmsh(self):
        """gmsh.write() is what is asked of it."""
        text = ('$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 "foot"\n1 3 "head"\n'
                '2 7 "block"\n$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n'
                "$Elements\n4\n1 1 2 1 1 1 2\n2 1 2 3 3 3 4\n3 2 2 7 7 1 2 3\n4 2 2 7 7 1 3 4\n"
                "$EndElements\n")
        gmsh = types.SimpleNamespace(write=lambda path: Path(path).write_text(text))
        with mock.patch.dict(sys.modules, {"gmsh": gmsh}):
            made = mortier.Scene.from_gmsh(scene())
        self.assertEqual(self.least(made), self.expected())
        self.assertEqual([fault.id for fault in made.check() if fault.severity == "error"], [])


if __name__ == "__main__":
    unittest.main()
