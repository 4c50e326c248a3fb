"""import mortier: numbers bit by bit those of the program, scenes of arrays, errors."""
import csv
import json
import re
import unittest
import warnings

import numpy as np

from python_support import SCENES
from support import InSharedFolder, OfTwoBlocks
from support import mortier as mortier_program

import mortier

MEASURED = ("solve_time_s", "peak_memory_mib", "wall_time_s", "seconds")  # differ from run to run
CASES = {
    "mortar": ("compression.toml", {"time.steps": 10, "output.every": 3}),
    "interpolation": ("compression.toml", {"time.steps": 5, "contact.variant": "interpolation"}),
    "degree-2": ("compression.toml", {"time.steps": 3, "degree": 2}),
    "curved": ("ring.toml", {}),
    "friction": ("hertz.toml", {"contact.friction": 0.1, "time.steps": 3, "output.every": 1}),
    "viscoplastic": ("open-close.toml", {"time.tolerance": 1e-3}),
    "plane-strain": ("thick-cylinder.toml", {"time.steps": 4, "output.every": 2}),
    "accuracy": ("punch.toml", {"accuracy.energy": 0.2, "output.every": 1}),
    "accuracy-in-space": ("cubes.toml", {"accuracy.energy": 0.2, "time.steps": 2,
                                         "body.material.yield_stress": 100,
                                         "body.lower.boundary.bottom.ux": 0}),
    "bound": ("exact-contact.toml", {"accuracy.bound": True}),
    "flow-and-no-bound": ("compression.toml", {"accuracy.bound": True, "time.steps": 4,
                                            "body.material.projection": "frobenius"}),
    "no-bound": ("hertz.toml", {"accuracy.bound": True, "time.steps": 1}),
    "accuracy-and-bound": ("punch.toml", {"accuracy.energy": 0.2, "accuracy.bound": True}),
}


def set_of(changes):
    """The options of the program."""
    words = [f"{key}={str(value).lower() if value is True else value}" for key, value in changes.items()]
    return ["--set", *words] if words else []


def without_measured(summary):
    if isinstance(summary, dict):
        return {key: without_measured(value) for key, value in summary.items() if key not in MEASURED}
    return [without_measured(each) for each in summary] if isinstance(summary, list) else summary


class AsTheProgram(InSharedFolder):
    def test_bit_by_bit(self):
        for name, (scene, changes) in CASES.items():
            with self.subTest(name):
                folder = self.folder / name
                told = mortier_program("run", SCENES / scene, "--quiet", "--out", folder, *set_of(changes))
                self.assertEqual(told.returncode, 0, told.stderr)
                run = mortier.load(SCENES / scene, set=changes).run()
                self.assertEqual(run.folder, None)
                self.compare(run, folder, name)
                self.assertEqual("bound" in run.summary["accuracy"], "bound" in name)
                self.assertEqual("reached" in run.summary["accuracy"], "accuracy" in name)

    def test_refinement_that_aims_at_a_quantity(self):
        path = self.folder / "aimed.toml"
        path.write_text((SCENES / "punch.toml").read_text().replace("../", f"{SCENES.parent}/") + '''
[accuracy]
quantity = "press"
tolerance = 0.02
[[quantity]]
name = "press"
contact_force = { body = "ground", label = 3 }
component = "y"
''')
        folder = self.folder / "aimed"
        told = mortier_program("run", path, "--quiet", "--out", folder)
        self.assertEqual(told.returncode, 0, told.stderr)
        scene = mortier.load(path)
        run = scene.run()
        self.assertGreater(len(run.summary["rounds"]), 1)
        self.compare(run, folder, "aimed")
        # Meshes are refined, so the steps are those of the last round.
        self.assertEqual([step.number for step in scene.steps()], [0, 1])
        out = scene.run(self.folder / "aimed-too")
        self.assertEqual(without_measured(out.summary), without_measured(run.summary))

    def compare(self, run, folder, name):
        self.assertEqual(without_measured(run.summary),
                         without_measured(json.loads((folder / "summary.json").read_text())))
        # Numbers in the tables read back as the same bits.
        rows = list(csv.DictReader((folder / "history.csv").read_text().splitlines()))
        self.assertEqual([f"{name}[{unit}]" if unit else name for name, unit in run.units.items()],
                         list(rows[0]))
        for (key, column), full in zip(run.history.items(), rows[0]):
            told = [row[full] if key == "rung" else float(row[full]) for row in rows]
            self.assertEqual(list(column), told, key)
        contact = {}
        for row in csv.DictReader((folder / "contact.csv").read_text().splitlines()):
            contact.setdefault((int(row["step"]), int(row["interface"])), []).append(row)
        kept = {int(re.search(r"_(\d+)\.vtu", path.name)[1]) for path in folder.glob("*.vtu")}
        self.assertEqual({step.number for step in run.steps}, kept)
        for step in run.steps:
            for k, side in enumerate(step.contact):
                axes = [axis for axis in "xyz" if axis in contact[step.number, k][0]]
                told = {key: np.array([float(row[key]) for row in contact[step.number, k]])
                        for key in ("vertex", *axes, "gap", "force", "pressure", "time")}
                for key in ("vertex", "gap", "force", "pressure"):
                    np.testing.assert_array_equal(getattr(side, key), told[key])
                for key in ("friction", "shear", "slip", "slipping"):
                    rows = contact[step.number, k]
                    of_node = [0.0]*3 if len(axes) == 3 and key != "slipping" else 0.0
                    none = [of_node] * len(rows)
                    written = [float(row[key]) for row in rows] if name == "friction" else none
                    np.testing.assert_array_equal(getattr(side, key), written)
                np.testing.assert_array_equal(side.position, np.column_stack([told[axis] for axis in axes]))
                self.assertEqual(step.time, told["time"][0])
            for body, mesh in run.to_meshio(step).items():
                self.compare_fields(mesh, folder / f"{body}_{step.number:06d}.vtu")

    def compare_fields(self, mesh, path):
        import meshio
        told = meshio.read(path)
        dimension = mesh.points.shape[1]
        np.testing.assert_array_equal(mesh.points, told.points[:, :dimension])
        np.testing.assert_array_equal(mesh.cells[0].data, told.cells[0].data)
        self.assertEqual(mesh.cells[0].type, told.cells[0].type)
        np.testing.assert_array_equal(mesh.point_data["displacement"],
                                      told.point_data["displacement"][:, :dimension])
        for name, values in mesh.cell_data.items():
            np.testing.assert_array_equal(values[0], told.cell_data[name][0], name)

    def test_files(self):
        for name in ("viscoplastic", "accuracy-and-bound"):
            with self.subTest(name):
                self.compare_files(name)

    def compare_files(self, name):
        theirs, ours = self.folder / f"theirs-{name}", self.folder / f"ours-{name}"
        changes = CASES[name][1]
        scene = SCENES / CASES[name][0]
        told = mortier_program("run", scene, "--quiet", "--out", theirs, *set_of(changes))
        self.assertEqual(told.returncode, 0, told.stderr)
        run = mortier.load(scene, set=changes).run(ours)
        self.assertEqual(run.folder, str(ours))
        self.assertEqual(run.summary, json.loads((ours / "summary.json").read_text()))
        names = sorted(path.name for path in theirs.iterdir())
        self.assertEqual(sorted(path.name for path in ours.iterdir()), names)
        for name in set(names) - {"summary.json", "manifest.json"}:
            self.assertEqual((ours / name).read_bytes(), (theirs / name).read_bytes(), name)

    def test_pictures_see_what_the_files_hold(self):
        from mortier import pictures
        for name in ("degree-2", "viscoplastic"):
            scene, changes = CASES[name]
            run = mortier.load(SCENES / scene, set=changes).run(self.folder / f"seen-{name}")
            read = pictures.views()["runs"].read(run.folder)
            result, ours = pictures.seen(run, run.last)
            self.assertEqual((result.interfaces, result.kept, list(result.history)),
                             (read.interfaces, read.kept, list(read.history)))
            theirs = read.at(run.last.number)
            self.assertEqual(list(ours.bodies), list(theirs.bodies))
            for body, other in theirs.bodies.items():
                for field, values in vars(other).items():
                    mine = getattr(ours.bodies[body], field)
                    for key in values if field == "cells" else ():
                        if key in mine:
                            np.testing.assert_array_equal(mine[key], values[key], key)
                    if field != "cells":
                        np.testing.assert_array_equal(mine, values, field)
            for field, values in vars(theirs.contact).items():
                np.testing.assert_array_equal(getattr(ours.contact, field), values, field)

    def test_steps_are_those_of_a_run(self):
        for name in ("mortar", "viscoplastic"):
            scene, changes = CASES[name]
            every = mortier.load(SCENES / scene, set={**changes, "output.every": 1}).run()
            steps = list(mortier.load(SCENES / scene, set=changes).steps())
            self.assertEqual([step.number for step in steps], list(range(len(every.steps))))
            for step, other in zip(steps, every.steps):
                self.assertEqual(step.time, other.time)
                for body, u in step.displacement.items():
                    np.testing.assert_array_equal(u, other.displacement[body])
                np.testing.assert_array_equal(step.contact[0].pressure, other.contact[0].pressure)
            self.assertEqual([step.values["iterations"] for step in steps[1:]],
                             list(every.history["iterations"]))


class OfArrays(OfTwoBlocks):
    def test_a_scene_of_dicts_is_that_of_its_file(self):
        import tomllib
        import meshio
        scene = tomllib.loads(self.read("scene.toml"))
        meshes = {}
        for body in scene["body"]:
            mesh = meshio.read(self.folder / body.pop("mesh"))
            meshes[body["name"]] = (mesh.points[:, :2], mesh.cells_dict["triangle"], mesh.cells_dict["line"],
                                    mesh.get_cell_data("medit:ref", "line"))
        ours = mortier.Scene(scene, meshes=meshes)
        self.assertEqual(ours.check(), mortier.check(self.folder / "scene.toml"))
        run, other = ours.run(), mortier.load(self.folder / "scene.toml").run()
        for body in other.displacement:
            np.testing.assert_array_equal(run.displacement[body], other.displacement[body])
            np.testing.assert_array_equal(run.stress[body], other.stress[body])
        np.testing.assert_array_equal(run.contact[0].pressure, other.contact[0].pressure)

    def test_what_is_wrong_is_told(self):
        def refused(message, scene, **options):
            with self.assertRaises(mortier.InputError) as told:
                mortier.Scene(scene, **options)
            self.assertIn(message, str(told.exception))
            self.assertNotIn("\n", str(told.exception))
            self.assertNotIn("/tmp", str(told.exception).replace(str(self.folder), ""))
        sound = {"body": [{"name": "a", "material": {"young": 1, "poisson": 0.6},
                           "mesh": {"shape": "rectangle", "cells": 1}}], "time": {"end": 1, "steps": 1}}
        refused("poisson = 0.6, expected -1 < poisson < 0.5", sound)
        refused("meshes: no body b, expected one of a", sound, meshes={"b": ((), (), (), ())})
        refused("time: a value of type NoneType", {**sound, "time": None})
        refused("unknown key key?", {**sound, "key\n\"": "\u2028\"'\x7f\n"})
        square = [[0, 0], [1, 0], [0, 1]]
        refused("mesh of a: triangles of shape (1, 2), expected (n, 3)", sound,
                meshes={"a": (square, [[0, 1]], [[0, 1]], [1])})
        refused("mesh of a: labels of shape (2,), expected (1,)", sound,
                meshes={"a": (square, [[0, 1, 2]], [[0, 1]], [1, 2])})
        refused("mesh of a: ", sound, meshes={"a": (square, [[0, 1, 7]], [[0, 1]], [1])})
        refused("mesh of a: ", sound, meshes={"a": ([[0, 0], [np.nan, 0], [0, 1]], [[0, 1, 2]],
                                                    [[0, 1]], [1])})


class Errors(OfTwoBlocks):
    def as_the_program(self, kind, *settings, scene=None):
        """The same line and code; the error."""
        scene = scene or self.folder / "scene.toml"
        with self.assertRaises(kind) as told:
            mortier.load(scene, set=list(settings)).run(self.folder / "out")
        words = ["run", scene, "--out", self.folder / "out", "--quiet"]
        done = self.mortier(*words, *(["--set", *settings] if settings else []), code=kind.exit_code)
        lines = [line for line in done.stderr.splitlines() if "warning: " not in line]
        self.assertEqual([f"mortier: {told.exception}"], lines)
        return told.exception

    def test_wrong_input(self):
        self.as_the_program(mortier.InputError, "time.steps=0")
        self.as_the_program(mortier.InputError, "body.upper.mesh=none.mesh")
        self.as_the_program(mortier.InputError, "body.upper.boundary.4.label=77")
        self.assertTrue(issubclass(mortier.InputError, ValueError))

    def test_free_motion(self):
        self.write(re.sub(r"boundary = .*", "", self.read("scene.toml")))
        self.as_the_program(mortier.FreeMotion)

    def test_a_step_that_cannot_be_solved(self):
        load = "abs(t - 0.375) < 0.1 ? -1/(t - t) : -t"  # where it is tried before the run it is finite
        error = self.as_the_program(mortier.StepError, f'body.upper.boundary.3.ty="{load}"', "time.steps=8")
        self.assertEqual(error.run.last.number, 2)
        self.assertEqual(error.run.summary["status"], "failed")
        steps = mortier.load(self.folder / "scene.toml",
                             set={"body.upper.boundary.3.ty": load, "time.steps": 8}).steps()
        numbers = []
        with self.assertRaises(mortier.StepError) as told:
            for step in steps:
                numbers.append(step.number)
        self.assertEqual(numbers, [0, 1, 2])
        self.assertIn("the state after step 2 is in memory", str(told.exception))

    def test_accuracy_that_is_not_reached(self):
        error = self.as_the_program(mortier.StepError, "accuracy.energy=0.001", "accuracy.max_unknowns=300",
                                    scene=SCENES / "punch.toml")
        self.assertFalse(error.run.summary["accuracy"]["reached"])

    def test_a_tolerance_that_is_not_reached(self):
        moved = 'body.upper.boundary=[{label=4,ux=0},{label=3,uy="t<0.5?0:-1e-12"}]'
        error = self.as_the_program(mortier.StepError, moved, "body.material.young=3e15",
                                    'time.scheme="sdirk2"', "time.tolerance=1e-3")
        self.assertFalse(error.run.summary["accuracy"]["time_reached"])

    def test_a_folder_that_cannot_be_written(self):
        (self.folder / "out").mkdir()
        (self.folder / "out" / "mine").touch()
        self.as_the_program(mortier.InputError)

    def test_faults(self):
        for settings in ({"body.upper.material.poisson": 0.6}, {"time.steps": 1}, {}):
            faults = mortier.check(self.folder / "scene.toml", settings)
            done = mortier_program("check", self.folder / "scene.toml", "--json", *set_of(settings))
            self.assertEqual([fault._asdict() for fault in faults], json.loads(done.stdout)["faults"])
        self.assertEqual(mortier.load(self.folder / "scene.toml").check(), faults)
        self.assertIn("poisson = 0.6", str(mortier.check(self.folder / "scene.toml",
                                                         {"body.upper.material.poisson": 0.6})[0]))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    unittest.main()
