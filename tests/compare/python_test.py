"""import mortier: numbers bit by bit those of the program, views that outlive their run, errors, threads."""
import _thread
import csv
import ctypes
import gc
import json
import os
import re
import shutil
import subprocess
import sys
import threading
import time
import unittest
import warnings
import zipfile
from pathlib import Path

import numpy as np

from support import PROGRAM, ROOT, InFolder, InSharedFolder, OfTwoBlocks
from support import mortier as mortier_program

PACKAGE = Path(os.environ.get("MORTIER_MODULE", Path(PROGRAM).parent / "python" / "mortier"))
sys.path.insert(0, str(PACKAGE.parent))

import mortier  # noqa: E402

MEASURED = ("solve_time_s", "peak_memory_mib", "wall_time_s", "seconds")  # differ from run to run
SCENES = ROOT / "scenes"
CASES = {
    "mortar": ("compression.toml", {"time.steps": 10, "output.every": 3}),
    "interpolation": ("compression.toml", {"time.steps": 5, "contact.variant": "interpolation"}),
    "degree-2": ("compression.toml", {"time.steps": 3, "degree": 2}),
    "curved": ("ring.toml", {}),
    "viscoplastic": ("open-close.toml", {"time.tolerance": 1e-3}),
    "plane-strain": ("thick-cylinder.toml", {"time.steps": 4, "output.every": 2}),
    "accuracy": ("punch.toml", {"accuracy.energy": 0.2, "output.every": 1}),
    "bound": ("exact-contact.toml", {"accuracy.bound": True}),
    "no-bound": ("hertz.toml", {"accuracy.bound": True, "time.steps": 1}),
    "accuracy-and-bound": ("punch.toml", {"accuracy.energy": 0.2, "accuracy.bound": True}),
}


class MallocInfo(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t)
                for name in ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks",
                             "uordblks", "fordblks", "keepcost")]


LIBC = ctypes.CDLL(None)
LIBC.mallinfo2.restype = MallocInfo
PERTURB, LETTER = -6, 0xA5  # M_PERTURB of mallopt(3)


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
                self.compare(run, folder)
                self.assertEqual("bound" in run.summary["accuracy"], "bound" in name)
                self.assertEqual("reached" in run.summary["accuracy"], "accuracy" in name)

    def compare(self, run, folder):
        self.assertEqual(without_measured(run.summary),
                         without_measured(json.loads((folder / "summary.json").read_text())))
        # Numbers in the tables read back as the same bits.
        rows = list(csv.DictReader((folder / "history.csv").read_text().splitlines()))
        self.assertEqual([f"{name}[{unit}]" if unit else name for name, unit in run.units.items()],
                         list(rows[0]))
        for (name, column), full in zip(run.history.items(), rows[0]):
            told = [row[full] if name == "rung" else float(row[full]) for row in rows]
            self.assertEqual(list(column), told, name)
        contact = {}
        for row in csv.DictReader((folder / "contact.csv").read_text().splitlines()):
            contact.setdefault((int(row["step"]), int(row["interface"])), []).append(row)
        kept = {int(re.search(r"_(\d+)\.vtu", path.name)[1]) for path in folder.glob("*.vtu")}
        self.assertEqual({step.number for step in run.steps}, kept)
        for step in run.steps:
            for k, side in enumerate(step.contact):
                told = {key: np.array([float(row[key]) for row in contact[step.number, k]])
                        for key in ("vertex", "x", "y", "gap", "force", "pressure", "time")}
                for key in ("vertex", "gap", "force", "pressure"):
                    np.testing.assert_array_equal(getattr(side, key), told[key])
                np.testing.assert_array_equal(side.position, np.column_stack([told["x"], told["y"]]))
                self.assertEqual(step.time, told["time"][0])
            for body, mesh in run.to_meshio(step).items():
                self.compare_fields(mesh, folder / f"{body}_{step.number:06d}.vtu")

    def compare_fields(self, mesh, path):
        import meshio
        told = meshio.read(path)
        np.testing.assert_array_equal(mesh.points, told.points[:, :2])
        np.testing.assert_array_equal(mesh.cells[0].data, told.cells[0].data)
        self.assertEqual(mesh.cells[0].type, told.cells[0].type)
        np.testing.assert_array_equal(mesh.point_data["displacement"],
                                      told.point_data["displacement"][:, :2])
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
            read = pictures.views()["runs"].Result(run.folder)
            result, ours = pictures.seen(run, run.last)
            self.assertEqual((result.bodies, result.interfaces, result.kept, list(result.history)),
                             (read.bodies, read.interfaces, read.kept, list(read.history)))
            theirs = read.at(run.last.number)
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


class Views(OfTwoBlocks):
    def setUp(self):
        super().setUp()
        self.scene = mortier.load(self.folder / "scene.toml")

    def test_arrays_outlive_all_else(self):
        LIBC.mallopt(PERTURB, LETTER)  # what is freed is overwritten
        self.addCleanup(LIBC.mallopt, PERTURB, 0)
        run = self.scene.run()
        arrays = [run.displacement["upper"], run.stress["lower"], run.contact[0].pressure,
                  run.last.points["upper"], run.history["time"], run.last.error["upper"]]
        copies = [array.copy() for array in arrays]
        self.assertFalse(any(array.flags.owndata for array in arrays))
        del run
        self.scene = None
        gc.collect()
        mortier.load(self.folder / "scene.toml", set={"time.steps": 2}).run()
        for array, copy in zip(arrays, copies):
            np.testing.assert_array_equal(array, copy)
            with self.assertRaises(ValueError):
                array[...] = 0
            with self.assertRaises(ValueError):
                array.flags.writeable = True

    def test_memory_does_not_grow(self):
        def held():
            """Bytes of the C library and blocks of Python's that are in use."""
            gc.collect()
            told = LIBC.mallinfo2()
            return np.array([told.uordblks + told.hblkhd, sys.getallocatedblocks()])

        def cycles(count):
            for i in range(count):
                scene = mortier.load(self.folder / "scene.toml", set={"time.steps": 1 + i % 3})
                run = scene.run()
                views = run.stress["upper"], run.history["time"], run.contact[0].gap
                steps = scene.steps()
                next(steps)
                del run, views, steps
                with self.assertRaises(mortier.InputError):
                    mortier.load(self.folder / "scene.toml", set={"time.steps": -1})
        cycles(100)
        before = held()
        cycles(1000)
        byte, block = held() - before
        self.assertLess(byte, 24 * 1000)  # the least that the C library gives is 24 bytes
        self.assertLess(block, 500)

    def test_a_loop_that_is_left_ends_the_run(self):
        before = threading.active_count(), len(os.listdir("/proc/self/task"))
        for step in self.scene.steps():
            if step.number == 1:
                break
        kept = step.displacement["upper"].copy()
        gc.collect()
        self.assertEqual((threading.active_count(), len(os.listdir("/proc/self/task"))), before)
        np.testing.assert_array_equal(step.displacement["upper"], kept)


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


LONG = {"time.steps": 100000}


class Threads(OfTwoBlocks):
    def scene(self):
        return mortier.load(self.folder / "scene.toml", set=LONG)

    def interrupted(self, work, begun=lambda: True):
        """Ctrl-C half a second after it begins, or as soon as it has begun."""
        over = threading.Event()

        def interrupt():
            while not begun() and not over.is_set():
                time.sleep(1e-3)
            if not over.is_set():
                _thread.interrupt_main()
        timer = threading.Timer(0 if begun() is False else 0.5, interrupt)
        timer.start()
        begin = time.monotonic()
        try:
            with self.assertRaises(KeyboardInterrupt) as told:
                work()
        finally:
            over.set()
            timer.cancel()
        self.assertLess(time.monotonic() - begin, 30)
        return told.exception

    def test_others_work_meanwhile(self):
        counted = 0
        over = threading.Event()

        def count():
            nonlocal counted
            while not over.is_set():
                counted += 1
                time.sleep(1e-3)
        thread = threading.Thread(target=count)
        thread.start()
        self.interrupted(lambda: self.scene().run())
        over.set()
        thread.join()
        self.assertGreater(counted, 50)

    def test_ctrl_c(self):
        self.interrupted(lambda: self.scene().run())
        self.interrupted(lambda: list(self.scene().steps()))
        # and the next run is whole
        self.assertEqual(mortier.load(self.folder / "scene.toml").run().summary["status"], "converged")

    def test_what_ctrl_c_stops_can_go_on(self):
        out = self.folder / "out"
        settings = {"time.steps": 3000}
        scene = mortier.load(self.folder / "scene.toml", set=settings)
        for _ in range(2):  # the second run takes the place of the first
            seen = set(self.folder.glob("out.tmp-*/checkpoint*"))
            error = self.interrupted(lambda: scene.run(out, checkpoint=0), lambda: bool(
                set(self.folder.glob("out.tmp-*/checkpoint*")) - seen))
        self.assertIn("mortier run --restart", "".join(getattr(error, "__notes__", [])))
        self.assertFalse(out.exists())
        self.mortier("run", "--restart", out, "--quiet")
        whole = scene.run(self.folder / "whole")
        self.assertEqual(len(whole.history["time"]), 3000)
        for name in ("history.csv", "contact.csv", "upper_003000.vtu"):
            self.assertEqual((out / name).read_bytes(), (self.folder / "whole" / name).read_bytes(), name)

    def test_runs_at_once_are_the_same(self):
        scene = mortier.load(self.folder / "scene.toml", set={"time.steps": 40})
        alone = scene.run()
        runs = [None] * 4

        def one(i):
            runs[i] = scene.run()
        threads = [threading.Thread(target=one, args=(i,)) for i in range(len(runs))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for run in runs:
            np.testing.assert_array_equal(run.stress["upper"], alone.stress["upper"])


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
        self.assertIn("mesh-0.mesh: warning: 2 triangles in all; refine the mesh", done.stdout)
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
                if name not in ("contact", "vertex", "gap", "force", "pressure", "position"):
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
