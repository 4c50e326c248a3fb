"""What the documentation says is true: commands run, scenes run, files and functions exist."""
import csv
import functools
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
import unittest
from pathlib import Path

import stated
import tutorial
from support import PROGRAM, ROOT, InFolder, InSharedFolder

TUTORIAL = ROOT / "docs" / "tutorial.md"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md")),
         ROOT / "freefem" / "README.md"]
LABELS = {"unit", "theory", "compare"}
# Files that an example takes for granted, and the command that makes them.
PREPARED = {"finer.mesh": "mesh crisscross --cells 12 finer.mesh"}


def blocks(page):
    """Language and text of the fenced blocks."""
    return re.findall(r"^```(\w*)\n(.*?)^```", page.read_text(), re.M | re.S)


def is_command(line):
    return re.match(r"(\w+=\S+ )*(\./|build[\w-]*/|compare/|tests/|bench/|mortier |cmake |ctest |ninja "
                    r"|FreeFem\S* )", line)


def commands():
    """(page, command) of every line of a block that begins with a command; comments left out."""
    for page in PAGES:
        for language, text in blocks(page):
            lines = [line for line in re.sub(r"\\\n\s*", "", text).splitlines() if line.strip()]
            if language in ("", "sh", "bash") and is_command(lines[0]):
                for line in lines:
                    for command in re.sub(r"\s+#.*", "", line).split("&&"):
                        yield page, command.strip()


def mentioned():
    """(page, command) of those that stand in the text or in a table."""
    for page in PAGES:
        prose = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S)
        for text in re.findall(r"`([^`\n]+)`", prose):
            if is_command(text):
                for command in text.replace("\\|", "|").split("&&"):  # a bar of a table's cell
                    yield page, command.strip()


def run(words, folder, expected=0):
    done = subprocess.run(list(map(str, words)), cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True)
    assert done.returncode == expected, f"{words}: exit code {done.returncode}\n{done.stdout[-2000:]}"
    return done.stdout


@functools.cache
def help_of(path):
    return run([sys.executable, path, "--help"], ROOT)


class Tutorial(InFolder):
    def test_from_an_empty_folder_to_pictures(self):
        files = tutorial.files()
        self.assertEqual(sorted(files), ["pin.toml", "press.geo", "press.toml"])
        for name, text in files.items():
            self.write(text, name)
            if name.endswith(".toml"):
                self.assertLessEqual(sum(bool(line) for line in text.splitlines()), 25)
        shutil.copy(tutorial.COPIED, self.folder)
        # Every command of the page is one of those.
        self.assertEqual(tutorial.commands(), [command for page, command in commands() if page == TUTORIAL])
        told = {}
        for command in tutorial.commands():
            program, *words = shlex.split(command)
            self.assertEqual(program, "mortier")
            told[command] = run([PROGRAM, *words], self.folder)
        self.assertIn("0 errors, 0 warnings", told["mortier check press.toml"])
        found = re.search(r"force (-?[\d.]+) N/mm", told["mortier run press.toml --accuracy 0.02"])[1]
        self.states_the_numbers_of(told)
        # Force against displacement, and the pressure along the line.
        with (self.folder / "out/press/history.csv").open() as text:
            forces = [float(row["force[N/mm]"]) for row in csv.DictReader(text)]
        self.assertEqual(len(forces), 5)
        self.assertEqual(forces, sorted(forces, reverse=True))
        with (self.folder / "out/press/contact.csv").open() as text:
            self.assertGreater(max(float(row["pressure"]) for row in csv.DictReader(text)), 0)
        for name in tutorial.MADE:
            self.assertTrue((self.folder / name).is_file(), name)
        # No bound, as `check` says and the page shows; what is kept has the accuracy that was asked for.
        bound = told["mortier check press.toml --set accuracy.bound=true"]
        self.assertIn(re.search(r"^left out   accuracy: .*$", TUTORIAL.read_text(), re.M)[0], bound)
        kept = json.loads(self.read("press.json"))
        self.assertEqual(kept["settings"], ["accuracy.energy=0.02"])
        self.assertAlmostEqual(kept["quantities"]["force"]["value"] / float(found), 1, delta=1e-6)
        self.assertIn("press.toml: agrees", told["mortier compare press.toml --against press.json"])
        # The part in space.
        sides = re.findall(r"^label \d .*: (x .*)$", TUTORIAL.read_text(), re.M)
        self.assertEqual(len(sides), 5)
        found = re.findall(r"^label \d .*: (x .*)$", told["mortier mesh info pin.step"], re.M)
        self.assertEqual(found, sides)
        self.assertIn("0 errors, 0 warnings", told["mortier check pin.toml"])

    def states_the_numbers_of(self, told):
        """All but times; of another Gmsh, which makes other meshes, the forces to some digits."""
        page, number = TUTORIAL.read_text(), 0
        press, pin = (told[f"mortier run {words}"]
                      for words in ("press.toml --accuracy 0.02", "pin.toml --accuracy 0.1"))
        rounds = stated.read("{} {} {} 5 {} % {} % {_}", press)
        force = "quantities force {} N/mm (changed by {} % in the last round)"
        of_pin = "quantities force {} N (changed by {} % in the last round)"
        stiffness = 1 / ((1 - 0.3**2) / 210000 + (1 - 0.35**2) / 3000)
        stated.check(self, page, "Hertz's force on a half space, which is softer than the block, is {} N",
                     -stiffness / 3 * 5**0.5 * 0.1**1.5)
        if rounds[:2] != stated.read("{} {} {_} 5 {_} % {_} % {_}", page)[:2]:
            for statement, log, within in ((force, press, 1e-3), (of_pin, pin, 0.05)):
                shown, found = stated.read(statement, page)[0], stated.read(statement, log)[0]
                self.assertAlmostEqual(found, shown, delta=within * abs(shown))
            return
        for row in zip(*[iter(rounds)] * 5):
            number += stated.check(self, page, f"{row[0]:.0f} {{}} {{}} 5 {{}} % {{}} % {{_}}", *row[1:])
        for statement, log in ((force, press), (of_pin, pin)):
            number += stated.check(self, page, statement, *stated.read(statement, log))
        number += stated.check(self, page, "The {} % are the error of the stress", rounds[-2])
        number += stated.check(self, page, "on top is {} N per mm of depth; the last refinement has changed "
                               "it by {} %", *stated.read(force, press))
        for label in range(1, 6):
            statement = f"label {label} {{}} triangles, area {{}}: x"
            number += stated.check(self, page, statement,
                                   *stated.read(statement, told["mortier mesh info pin.step"]))
        self.assertGreaterEqual(number, 40)


class Commands(InSharedFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name in ("scenes", "shared-meshes", "freefem"):
            shutil.copytree(ROOT / name, cls.folder / name)
        for name, command in PREPARED.items():
            run([PROGRAM, *command.split()], cls.folder)
        (cls.folder / "roller.toml").write_text(dict(blocks(ROOT / "README.md"))["toml"])

    def test_every_command(self):
        found = list(commands())
        self.assertGreater(len(found), 20)
        for page, command in found:
            if page == TUTORIAL:
                continue
            with self.subTest(f"{page.name}: {command}"):
                self.check(shlex.split(command))

    def test_every_command_in_the_text(self):
        found = list(mentioned())
        self.assertGreater(len(found), 20)
        for page, command in found:
            with self.subTest(f"{page.name}: {command}"):
                words = shlex.split(command)
                if words[0] == "mortier":
                    self.check_options(words[1:])
                elif len(words) > 1 or not (ROOT / command).exists():
                    self.check(words)

    def check(self, words):
        while re.match(r"\w+=", words[0]):
            words = words[1:]
        if words[0].endswith("python3"):
            words = words[1:]
        program = Path(words[0])
        if program.name == "mortier":
            self.check_mortier(words[1:])
        elif program.name in ("cmake", "ctest", "ninja"):
            self.check_tool(words)
        elif program.name.startswith("FreeFem"):
            run([*words, "-steps", 2], self.folder)  # the last of an option counts
        elif program.suffix == ".py":
            self.check_script(ROOT / program, words[1:])
        elif program.parts[0].startswith("build"):
            self.check_built(program, words[1:])
        else:
            self.assertTrue(os.access(ROOT / program, os.X_OK), f"{program} is no program of ours")
            self.check_labels(words)

    def check_mortier(self, words):
        # long, or after a run that was stopped: tests of their own
        if words[0] == "study" or "--restart" in words or "--animate" in words:
            self.check_options(words)
        else:
            if words[0] == "plot" and "--only" not in words and any(word.startswith("--") for word in words):
                words += ["--only", "fields"]  # the commands without options draw all
            run([PROGRAM, *words], self.folder)

    def check_options(self, words):
        """Of mortier; names in capitals stand for a file of the user's."""
        below = [] if len(words) == 1 or not re.fullmatch("[a-z]+", words[1]) else words[1:2]
        help_text = run([PROGRAM, words[0], *below, "--help"], self.folder)
        for word in words[1:]:
            if word.startswith("--"):
                self.assertIn(word.split("=")[0], help_text)
            elif word.endswith(".toml") and not re.search("[A-Z]{2}", word):
                self.assertTrue((ROOT / word).is_file() or (self.folder / word).is_file(), word)

    def check_tool(self, words):
        for option, value in zip(words, words[1:]):
            if option == "--preset":
                presets = json.loads((ROOT / "CMakePresets.json").read_text())
                kinds = {"cmake": "buildPresets" if "--build" in words else "configurePresets",
                         "ctest": "testPresets"}
                self.assertIn(value, [preset["name"] for preset in presets[kinds[words[0]]]])
        self.check_labels(words)
        for option, value in zip(words, words[1:]):
            if words[0] == "ctest" and option == "-R":
                for name in value.split("|"):
                    self.assertTrue(list((ROOT / "tests").rglob(f"{name}.py")) or name in all_tests(), name)

    def check_labels(self, words):
        for option, value in zip(words, words[1:]):
            if option == "-L":
                self.assertIn(value, LABELS)

    def check_script(self, path, words):
        self.assertTrue(path.is_file(), path)
        if path.name.endswith("_test.py"):
            for word in words:
                if not word.startswith("-"):
                    self.assertIn(f"def {word.split('.')[-1]}(", path.read_text())
            return
        self.assertTrue(os.access(path, os.X_OK), f"{path} is not executable")
        help_text = help_of(path)
        for word in words:
            if word.startswith("--"):
                self.assertIn(word, help_text)

    def check_built(self, program, words):
        folder, name = program.parts[1], program.name
        if name.endswith("_tests"):
            sources = list((ROOT / "tests" / name.removesuffix("_tests")).glob("*_test.cpp"))
            self.assertTrue(sources, program)
        else:
            names = (name, name.removeprefix("bench_"))
            sources = [path for path in (ROOT / folder).rglob("*.cpp") if path.stem in names]
            self.assertEqual(len(sources), 1, f"{program}: {len(sources)} sources")
        text = "\n".join(path.read_text() for path in sources)
        for word in words:
            if word.startswith("--gtest_filter="):
                for suite, test in re.findall(r"(\w+)\.(\w+|\*)", word.split("=")[1]):
                    test = r"\w+" if test == "*" else test
                    self.assertRegex(text, rf"TEST(_F|_P)?\({suite},\s*{test}\)")


def all_tests():
    return "\n".join(path.read_text() for path in (ROOT / "tests").rglob("*_test.cpp"))


class Scenes(InFolder):
    """Blocks of TOML: whole scenes run, parts of scenes are TOML."""

    def test_every_block(self):
        whole = 0
        for page in PAGES:
            for language, text in blocks(page):
                if language != "toml" or page == TUTORIAL:
                    continue
                with self.subTest(f"{page.name}: {text.splitlines()[0]}"):
                    scene = tomllib.loads(text)
                    if "body" in scene and "time" in scene:
                        whole += 1
                        self.run_scene(text)
        self.assertGreaterEqual(whole, 1)

    def run_scene(self, text):
        self.setUp()  # a folder of its own
        for command in re.findall(r"# mortier (mesh .*)", text):
            self.mortier(*shlex.split(command))
        self.write(text)
        self.mortier("run", "scene.toml")


class Keys(InFolder):
    """The table of keys is the program's (cpp/scene/key_table.cpp)."""

    def test_the_table_is_that_of_the_program(self):
        page = (ROOT / "docs" / "scene.md").read_text()
        told = self.mortier("keys", "--markdown").stdout
        self.assertGreater(told.count("\n"), 100)
        self.assertIn("\n\n" + told + "\n", page, "mortier keys --markdown writes another table")

    def test_every_key_that_is_listed_can_be_set(self):
        """As far as --set goes: what is wrong is the value, or what it stands beside."""
        self.write("[[body]]\nname = \"a\"\nmesh = \"a.mesh\"\n[time]\nend = 1\nsteps = 1\n")
        listed = [line.split("\t")[0] for line in self.mortier("keys").stdout.splitlines()]
        self.assertGreater(len(listed), 120)
        self.assertEqual(len(listed), len(set(listed)))
        for key in listed:
            if key.startswith("body.mesh."):
                continue  # the scene names a file
            told = self.mortier("run", "scene.toml", "--set", f"{key}=nonsense", code=2).stderr
            self.assertNotIn(": no ", told, key)
            self.assertNotIn("unknown key", told, key)


class Meshes(InFolder):
    """The commands of shared-meshes/README.md make the meshes that stand beside it."""

    def test_commands_make_the_same_bytes(self):
        page = ROOT / "shared-meshes" / "README.md"
        made = 0
        for command, name in re.findall(r"^mortier (mesh .* (\S+\.mesh))$", page.read_text(), re.M):
            self.mortier(*shlex.split(command))
            with self.subTest(name):
                self.assertEqual((self.folder / name).read_bytes(), (page.parent / name).read_bytes())
            made += 1
        self.assertGreater(made, 10)


class Links(unittest.TestCase):
    def test_files_of_links_exist(self):
        for page in PAGES:
            for target in re.findall(r"\]\(([^)#:\s]+)\)|src=\"([^\":]+)\"", page.read_text()):
                path = page.parent / (target[0] or target[1])
                with self.subTest(f"{page.name}: {path.name}"):
                    self.assertTrue(path.exists(), path)


class Theory(unittest.TestCase):
    """Pages on the method, measurements.md and decisions.md name files and functions of cpp/, and tests."""

    def test_names_exist(self):
        text = "\n".join((ROOT / "docs" / name).read_text()
                         for name in ("theory.md", "sliding.md", "space.md", "measurements.md",
                                      "decisions.md"))
        prose = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
        files = {str(path.relative_to(ROOT / "cpp")): path for path in (ROOT / "cpp").rglob("*")
                 if path.is_file()}
        names = {path.name for path in files.values()}
        identifiers = set(re.findall(r"\w+", "\n".join(path.read_text() for path in files.values())))
        checked = 0
        for word in re.findall(r"`([^`\n]+)`", prose):
            with self.subTest(word):
                if re.fullmatch(r"[\w/]+\.(h|cpp)", word):
                    self.assertTrue(word in files or word in names or (ROOT / word).is_file(), "no such file")
                elif re.fullmatch(r"\w+(::\w+)+", word) or re.fullmatch(r"[A-Za-z]\w*[a-z][A-Z]\w*", word):
                    for part in word.split("::"):
                        self.assertIn(part, identifiers)
                else:
                    continue
                checked += 1
        self.assertGreater(checked, 30)

    def test_words_of_the_glossary_are_in_the_code(self):
        files = (ROOT / "cpp").rglob("*.*")
        identifiers = set(re.findall(r"\w+", "\n".join(path.read_text() for path in files)))
        rows = [line.split("|") for line in (ROOT / "docs" / "glossary.md").read_text().splitlines()]
        names = [name for row in rows if len(row) == 6 for name in re.findall(r"`([\w:]+)`", row[3])]
        self.assertGreater(len(names), 40)
        for name in names:
            self.assertLessEqual(set(name.split("::")), identifiers, name)

    def test_a_step_is_told_in_the_order_of_its_calls(self):
        text = (ROOT / "docs" / "theory.md").read_text()
        chapter = text.partition("## solver: one step\n")[2].partition("\n## ")[0]
        told = re.findall(r"^\*\*(\d+)\. `(\w+)`", chapter, re.M)
        self.assertEqual([int(number) for number, _ in told], list(range(1, len(told) + 1)))
        self.assertLessEqual(len(told), 8)
        solver = ROOT / "cpp" / "solver"
        called = [name for _, name in told]
        self.assertEqual(called[:2], ["solveStep", "newton"])
        self.assertIn("newton(", (solver / "solve_step.cpp").read_text())
        # newton() calls Factorised::solve, which condenses, solves contact and expands.
        solve = (solver / "step_friction.cpp").read_text().partition("Factorised::solve(")[2]
        iteration = "newton(" + (solver / "newton.cpp").read_text().partition("StepOutcome newton(")[2]
        iteration = iteration.replace("factorised->solve(", solve.partition("\n}\n")[0])
        words = re.findall(r"(\w+)\(", iteration)
        self.assertEqual(list(dict.fromkeys(word for word in words if word in called)), called[1:])


if __name__ == "__main__":
    unittest.main()
