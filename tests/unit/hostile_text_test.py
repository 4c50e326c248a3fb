"""Text of others in scripts, pages and messages: shown, never run."""
import resource
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))
import support  # noqa: E402
from scenes import TWO_BLOCKS  # noqa: E402

RUN = 'exec("touch ran");//'
BREAKS = ["\\n", "\\r", "\\r\\n", "\\u2028", "\\u0085", "\\u0000", "\\u000b", "\\\\\\n", "*/\\n",
          "\\u001b[2J\\n"]
TITLES = [f"a{each}{RUN}" for each in BREAKS] + ['"' + RUN, "\\\\", "日本\\n" + RUN, "-quiet\\n" + RUN]


def toml(text):
    return '"' + text.replace('"', '\\"') + '"'


class HostileText(support.OfTwoBlocks):
    def solve(self, script):
        """FreeFEM reads all of a script; it has no time to solve anything."""
        if shutil.which("FreeFem++-nw") is None:
            self.skipTest("FreeFEM is not installed")
        text = (self.folder / script).read_bytes()
        head = text.split(b"// Boundary conditions")[0]
        self.assertIn(b"real E2", head)
        (self.folder / "head.edp").write_bytes(head)
        done = subprocess.run(["FreeFem++-nw", "-nw", "-ne", "-v", "0", "head.edp"], cwd=self.folder,
                              capture_output=True)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_titles(self):
        for title in TITLES:
            with self.subTest(title):
                self.write(TWO_BLOCKS.replace('"two blocks"', toml(title)))
                self.mortier("freefem", "scene.toml", "scene.edp")
                lines = self.read("scene.edp").splitlines()
                self.assertEqual([line[:2] for line in lines[:4]], ["//", "//", "", "st"])
                self.solve("scene.edp")
                self.assertFalse((self.folder / "ran").exists())

    def test_titles_that_are_set(self):
        self.mortier("freefem", "scene.toml", "scene.edp", "--set", f"title=a\n{RUN}")
        self.solve("scene.edp")
        self.assertFalse((self.folder / "ran").exists())

    def test_titles_in_a_study_with_freefem(self):
        self.write(TWO_BLOCKS.replace('"two blocks"', toml(f"a\\n{RUN}")).replace("steps = 4", "steps = 1"))
        self.write('scene = "scene.toml"\n[[error]]\nquantity = "von_mises_max"\nexact = 10\n[[sweep]]\n'
                   'code = ["freefem"]\n',
                   "study.toml")
        done = support.mortier("study", "study.toml", "--quiet", cwd=self.folder)
        self.assertEqual(done.returncode, 0 if shutil.which("FreeFem++-nw") else 1, done.stderr)
        self.assertEqual(list(self.folder.rglob("ran")), [])

    def test_names_of_files(self):
        for name in ('u"; exec("touch ran"); string zz="u.mesh', "u\n.mesh", "u\\.mesh", "ü.mesh",
                     "u" * 247 + ".mesh"):
            with self.subTest(name):
                shutil.copy(self.folder / "upper.mesh", self.folder / name)
                written = name.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
                self.write(TWO_BLOCKS.replace("upper.mesh", written))
                shown = name.replace("\n", "?")
                self.reject(f'scene.toml:5: body upper: mesh = "{shown}", expected at most 250 printable '
                            'ASCII characters without " and \\ (all that a FreeFEM string can hold)',
                            "freefem", "scene.toml")
        self.write(TWO_BLOCKS)
        for name in (f"a\n{RUN}.toml", f"a\r{RUN}.toml", "é.toml"):
            name = name.replace("/", ":")
            shutil.copy(self.folder / "scene.toml", self.folder / name)
            self.mortier("freefem", name, "scene.edp")
            self.assertTrue(self.read("scene.edp").splitlines()[2] == "", name)

    def test_expressions_hold_nothing_but_arithmetic(self):
        self.write(TWO_BLOCKS.replace('"-10*t"', '"-10*\\n\\tt"'))
        self.mortier("freefem", "scene.toml", "scene.edp")
        self.assertIn("-10.*  t", self.read("scene.edp"))

    def test_messages_are_one_short_line(self):
        for name in ("a\nb.toml", "x\x1b[31m.toml", "\u202etxt.toml", "a" * 100000,
                     b"\xff\xfe.toml".decode(errors="surrogateescape")):
            for command in ("run", "check", "freefem", "study", "plot", "report", "compare"):
                with self.subTest(name=name[:20], command=command):
                    done = subprocess.run([support.PROGRAM, command, name], cwd=self.folder,
                                          capture_output=True)
                    self.assertEqual(done.returncode, 2)
                    text = (done.stderr or done.stdout).decode()  # strictly UTF-8
                    self.assertLess(len(text), 5000)
                    shown = [line for line in text.split("\n") if line]
                    self.assertEqual(len(shown), 1 if command != "check" else 2, text)
                    self.assertTrue(shown[0].isprintable(), text)

    def test_long_settings_and_tables(self):
        table = ("{time=[" + ",".join(str(i / 7000) for i in range(5000)) + "], value=["
                 + ",".join(["1"] * 5000) + "]}")
        setting = f"body.upper.boundary.3.ty={table}"
        for command in ("check", "run"):
            done = support.mortier(command, "scene.toml", "--set", setting[:-1] + ", x=1}", cwd=self.folder,
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS,
                                                                         (1 << 30, 1 << 30)))
            self.assertEqual(done.returncode, 2)
            self.assertLess(len(done.stdout + done.stderr), 5000)
        done = support.mortier("check", "scene.toml", "--set", setting, cwd=self.folder)
        self.assertIn(f"changes at t = {1 / 7000} and at 4996 more times, within a step", done.stdout)
        self.assertLess(len(done.stdout), 5000)

    def test_what_is_no_scene_and_no_number(self):
        (self.folder / "folder.toml").mkdir()
        for command in ("run", "freefem"):
            self.reject("folder.toml: cannot be read, expected a scene (TOML file)", command, "folder.toml")
        for seconds in ("nan", "inf", "-1"):
            self.reject("--checkpoint: ", "run", "scene.toml", "--checkpoint", seconds)


if __name__ == "__main__":
    unittest.main()
