"""Faults of the environment and of the input: no room, no reader, folders that vanish, kill -9,
a thousand broken scenes."""
import os
import re
import resource
import shutil
import signal
import subprocess
import unittest

from mutations import explore, require_whole
from scenes import (BODY_KEYS, CONTACT_KEYS, ELASTIC_KEYS, FRICTION_KEYS, LAW_KEYS, TOOL_KEYS, TWO_BLOCKS,
                    lower_heat)
from shape_scenes import GEOMETRY_KEYS, ONE_BODY, SHAPE_KEYS, SPACE_KEYS
from support import HANGS, PROGRAM, OfTwoBlocks, mortier, told, warned

LONG = ("--set", "time.steps=1000000")


def limit_files(size):
    def apply():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return apply


def vanish(path):
    """Removes a folder into which a run is writing."""
    while path.exists():
        shutil.rmtree(path, ignore_errors=True)


class Environment(OfTwoBlocks):
    def begin(self, *arguments):
        """A long run, once it has made its folder and some steps."""
        process = subprocess.Popen([PROGRAM, "run", "scene.toml", *LONG, *arguments], cwd=self.folder,
                                   text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.kill)
        for line in process.stdout:
            if line.split()[0] == "3":
                break
        process.stdout.close()
        return process

    def temporaries(self):
        return [name for name in self.names("out") if ".tmp-" in name or ".mortier-" in name]

    def test_scenes_are_sound_before_they_are_changed(self):
        self.write(lower_heat(18), "lower.heat")
        for scene in (TWO_BLOCKS, CONTACT_KEYS, BODY_KEYS, ELASTIC_KEYS, FRICTION_KEYS, LAW_KEYS, ONE_BODY,
                      SHAPE_KEYS, TOOL_KEYS, SPACE_KEYS):
            self.write(scene)
            self.mortier("run", "scene.toml", "--quiet", "--out", "out")
            require_whole(self.folder / "out")

    def test_scenes_hold_every_key(self):
        listed = subprocess.run([PROGRAM, "keys"], stdout=subprocess.PIPE, text=True, check=True).stdout
        keys = {line.split("\t")[0].rpartition(".")[2] for line in listed.splitlines()}
        self.assertGreater(len(keys), 40)
        written = set(re.findall(r"\w+(?= = )|(?<=\[)\w+|(?<=\.)\w+(?=\])",
                                 CONTACT_KEYS + BODY_KEYS + ELASTIC_KEYS + FRICTION_KEYS + GEOMETRY_KEYS +
                                 SHAPE_KEYS + ONE_BODY + LAW_KEYS + TOOL_KEYS + SPACE_KEYS))
        self.assertEqual(keys - written, {"start", "set"})  # of several runs: going_on_test

    def test_mutated_scenes_and_meshes(self):
        faults, codes = explore(PROGRAM, 0, 250, patience=1)
        self.assertEqual(faults, [])
        self.assertGreater(codes[0], 20)
        self.assertGreater(codes[2], 100)

    def test_no_room_for_the_result(self):
        self.mortier("run", "scene.toml", "--quiet", "--set", "output.every=1")
        before = self.read("out/scene/summary.json")
        largest = max(path.stat().st_size for path in (self.folder / "out/scene").iterdir())
        for size in [0, 1, 100, 500, 1500, 3000, largest - 1]:
            with self.subTest(size=size):
                done = self.mortier("run", "scene.toml", "--quiet", "--set", "output.every=1", code=1,
                                    preexec_fn=limit_files(size))
                self.assertIn("cannot be written: File too large", done.stderr)
                self.assertEqual(self.read("out/scene/summary.json"), before)
                self.assertEqual(self.names("out"), ["scene"])
        self.mortier("run", "scene.toml", "--quiet", "--set", "output.every=1",
                     preexec_fn=limit_files(largest))

    def test_room_that_comes_back(self):
        steps = ["--set", "time.steps=300"]
        self.mortier("run", "scene.toml", "--quiet", *steps, "--out", "out/whole")
        done = self.mortier("run", "scene.toml", "--quiet", *steps, "--checkpoint", "0", code=1,
                            preexec_fn=limit_files(30000))
        self.assertIn("history.csv: cannot be written: File too large; mortier run --restart "
                      "out/scene goes on", done.stderr)
        self.mortier("run", "--restart", "out/scene", "--quiet")
        for name in ("history.csv", "contact.csv", "upper_000300.vtu", "lower_000300.vtu", "fields.pvd"):
            self.assertEqual(*((self.folder / "out" / run / name).read_bytes() for run in ("whole", "scene")),
                             name)

    def test_no_room_for_a_mesh_or_a_script(self):
        before = (self.folder / "upper.mesh").read_bytes()
        for size in [0, 1, 100, 1000]:
            self.mortier("mesh", "crisscross", "--cells", "9", "upper.mesh", code=1,
                         preexec_fn=limit_files(size))
            self.mortier("freefem", "scene.toml", "new.edp", code=1, preexec_fn=limit_files(size))
        self.assertEqual((self.folder / "upper.mesh").read_bytes(), before)
        self.assertEqual(self.names(), ["lower.mesh", "scene.toml", "upper.mesh"])

    def test_full_devices(self):
        self.mortier("mesh", "crisscross", "--cells", "2", "/dev/full", code=1)
        self.mortier("freefem", "scene.toml", "/dev/full", code=1)
        with open("/dev/full", "w") as full:
            for arguments in (["mesh", "info", "upper.mesh"], ["freefem", "scene.toml"],
                              ["run", "scene.toml"]):
                done = self.mortier(*arguments, code=1, stdout=full)
                self.assertIn("standard output: cannot be written: No space left on device", done.stderr)
        require_whole(self.folder / "out/scene")

    def test_reader_that_goes_away(self):
        process = subprocess.Popen([PROGRAM, "run", "scene.toml", "--set", "time.steps=200"], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        process.stdout.close()
        self.assertEqual((process.stderr.read(), process.wait(timeout=HANGS)), (b"", 0))
        process.stderr.close()
        require_whole(self.folder / "out/scene")

    def test_places_where_nothing_can_be_made(self):
        self.write("mine", "file")
        for out in ("file", "file/out", "/proc/self/out", "/dev/null/out", "x" * 300):
            with self.subTest(out=out):
                self.mortier("run", "scene.toml", "--quiet", "--out", out, code=2 if out == "file" else 1)
        self.mortier("mesh", "crisscross", "--cells", "2", "file/new.mesh", code=1)
        self.mortier("mesh", "crisscross", "--cells", "2", "none/new.mesh", code=1)
        self.assertEqual(self.names(), ["file", "lower.mesh", "scene.toml", "upper.mesh"])

    def test_places_that_cannot_be_replaced_are_found_before_the_run(self):
        for name in ("shared", "shared/theirs", "closed", "closed/out"):
            (self.folder / name).mkdir()
        (self.folder / "dangling").symlink_to("nothing")
        (self.folder / "mine.failed").symlink_to("nothing")
        self.write("{}", "closed/out/summary.json")
        # where every user reaches it, wherever the build is and whatever the umask
        program = shutil.copy(PROGRAM, self.folder)
        run = [program, "run", "scene.toml", "--quiet", "--set", "time.steps=1000000", "--out"]
        user = {}
        if os.geteuid() == 0:  # as a user who owns nothing of it
            for path in (self.folder, self.folder / "shared"):
                path.chmod(0o1777)
            for path in (self.folder / "shared/theirs", *self.folder.iterdir()):
                if path.is_file() or path.name == "theirs":
                    path.chmod(0o755)
            user = {"user": 65534}
        else:
            (self.folder / "shared/theirs").chmod(0o555)
            (self.folder / "closed").chmod(0o555)
        for out, reason in (("dangling", "a link to nothing"),
                            ("mine", "mine.failed: exists and is no result"),
                            (".", "the current folder"), ("..", "the current folder"),
                            (str(self.folder), "the current folder"),
                            ("shared/theirs", "shared/theirs: cannot be replaced"),
                            ("closed/new", "Permission denied")):
            with self.subTest(out=out):
                done = subprocess.run([*run, out], cwd=self.folder, capture_output=True, text=True,
                                      timeout=HANGS, **user)
                self.assertIn(done.returncode, (1, 2), done.stderr)
                self.assertIn(reason, done.stderr)
                self.assertEqual(done.stderr.count("\n"), 1)
        (self.folder / "closed").chmod(0o755)
        (self.folder / "shared/theirs").chmod(0o755)
        self.assertEqual(self.names("closed"), ["out"])
        self.assertEqual(self.names("shared"), ["theirs"])

    def test_the_current_folder_is_not_replaced(self):
        self.mortier("run", "scene.toml", "--quiet")
        here = self.folder / "out/scene"
        before = (here.stat().st_ino, (here / "summary.json").read_bytes())
        for out in (".", "../scene", str(here), "..", "../../out/scene/"):
            with self.subTest(out=out):
                done = mortier("run", "../../scene.toml", "--quiet", "--out", out, cwd=here)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn("the current folder or one above it", done.stderr)
                self.assertEqual((here.stat().st_ino, (here / "summary.json").read_bytes()), before)

    def test_two_processes_at_once(self):
        for _ in range(10):
            runs = [subprocess.Popen([PROGRAM, "run", "scene.toml", "--quiet", "--set",
                                      f"time.steps={steps}"], text=True,
                                     cwd=self.folder, stderr=subprocess.PIPE) for steps in (1, 2, 3, 4)]
            for process in runs:
                errors = process.communicate(timeout=HANGS)[1]
                self.assertTrue(process.returncode == 0 or (process.returncode == 2
                                                            and ": in use, " in errors), errors)
            self.assertIn(0, [process.returncode for process in runs])
            require_whole(self.folder / "out/scene")
            self.assertEqual(self.names("out"), ["scene"])

    def test_folder_that_vanishes(self):
        for what in ("out", "out/scene.tmp-*"):
            with self.subTest(what=what):
                process = self.begin("--set", "output.every=1")
                for path in self.folder.glob(what):
                    vanish(path)
                err = process.stderr.read()
                self.assertEqual(process.wait(timeout=HANGS), 1, err)
                process.stderr.close()
                self.assertEqual(len(told(err)), 1, err)
                self.assertEqual(warned(err), ["output-large"])
                self.assertFalse((self.folder / "out/scene").exists())

    def test_what_a_killed_run_left_goes_with_the_next(self):
        process = self.begin()
        process.kill()
        process.wait()
        process.stderr.close()
        left, = self.temporaries()
        self.write("mine", f"out/{left}/picture.png")
        self.mortier("run", "scene.toml", "--quiet")
        self.assertEqual(self.names("out"), ["scene"])
        self.assertEqual(self.read("out/scene/picture.png"), "mine")
        require_whole(self.folder / "out/scene")

    def test_the_folder_of_a_living_run_is_left_alone(self):
        living = self.begin()
        left, = self.temporaries()
        done = self.mortier("run", "scene.toml", "--quiet", code=2)
        self.assertEqual(done.stderr, f"mortier: out/scene: in use, the run in out/{left} still goes on\n")
        self.assertEqual(self.temporaries(), [left])
        self.assertIn("history.csv", self.names("out/" + left))
        living.send_signal(signal.SIGINT)
        living.wait(timeout=HANGS)
        living.stderr.close()
        self.mortier("run", "scene.toml", "--quiet")
        require_whole(self.folder / "out/scene")
        self.assertEqual(self.temporaries(), [])

    def test_no_memory(self):
        self.mortier("mesh", "crisscross", "--cells", "300", "upper.mesh")
        self.write(ONE_BODY)
        size = 250 << 20
        done = self.mortier("run", "scene.toml", "--quiet", code=1,
                            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size)))
        self.assertEqual(done.stderr, "mortier: out of memory\n")
        self.assertEqual([path for path in self.folder.glob("out/*")], [])


if __name__ == "__main__":
    unittest.main()
