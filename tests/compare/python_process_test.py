"""import mortier in a process that goes on: views that outlive their run, memory, threads, signals."""
import _thread
import ctypes
import gc
import os
import sys
import threading
import time
import unittest
import warnings

import numpy as np

import python_support  # noqa: F401
from support import OfTwoBlocks

import mortier


class MallocInfo(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t)
                for name in ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks",
                             "uordblks", "fordblks", "keepcost")]


LIBC = ctypes.CDLL(None)
LIBC.mallinfo2.restype = MallocInfo
PERTURB, LETTER = -6, 0xA5  # M_PERTURB of mallopt(3)


LONG = {"time.steps": 100000}


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
        for step in self.scene.steps():  # OpenBLAS makes its threads anew after a fork of this process
            break
        gc.collect()
        before = threading.active_count(), len(os.listdir("/proc/self/task"))
        for step in self.scene.steps():
            if step.number == 1:
                break
        kept = step.displacement["upper"].copy()
        gc.collect()
        self.assertEqual((threading.active_count(), len(os.listdir("/proc/self/task"))), before)
        np.testing.assert_array_equal(step.displacement["upper"], kept)


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
        begin = time.process_time()
        try:
            with self.assertRaises(KeyboardInterrupt) as told:
                work()
        finally:
            over.set()
            timer.cancel()
        self.assertLess(time.process_time() - begin, 30)
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


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    unittest.main()
