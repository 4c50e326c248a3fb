#!/usr/bin/python3
"""Breaks cpp/ in small ways, one at a time, and says which of these faults no test sees.

    tests/mutation_run.py [--only TEXT] [--first N] [--labels unit,theory,compare] [--folder DIR]

The faults stand in tests/mutations.txt. Everything happens on a copy of the tracked files in DIR, with a
build folder that is kept. A fault costs the files that hold it, and each test is linked when its turn comes.
Only tests are run that use the layer of the fault, unit tests that include it first, until one fails, crashes
or computes for more than seven minutes. What fails without a fault too is left out, and the others are run.
"""
import argparse
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
LABELS = ("unit", "theory", "compare")
# libraries that scripts load
LOADED = {"FAILING_CALLS": "failing-calls", "DEAF_METIS": "deaf-metis", "TRAPPING_METIS": "trapping-metis"}
LIMIT = 400  # seconds of a processor that a process of a test may take

def faults():
    """(file, text, text with the fault) of each paragraph of mutations.txt."""
    paragraphs = (ROOT / "tests/mutations.txt").read_text().strip().split("\n\n")
    for paragraph in paragraphs:
        lines = [line for line in paragraph.splitlines() if not line.startswith("#")]
        if lines:
            file, old, new = lines
            yield file, old.removeprefix("- "), new.removeprefix("+ ")


def places(text, wanted):
    """Where the words of `wanted` stand, however the lines are broken."""
    return list(re.finditer(r"\s+".join(map(re.escape, wanted.split())), text))


class Tree:
    """The copy, its build folder and its test programs."""

    def __init__(self, folder, labels):
        self.source, self.build = folder, folder / "build"
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True,
                                text=True).stdout
        names = [name for name in listed.split("\0") if name and (ROOT / name).is_file()]
        for name in names:
            self.refresh(name)
        for old in [path for part in ("cpp", "tests") for path in (self.source / part).rglob("*")
                    if path.is_file()]:
            if str(old.relative_to(self.source)) not in names:
                old.unlink()
        self.tests = [f"{label}/{path.stem}" for label in labels
                      for path in sorted((self.source / "tests" / label).glob("*_test.*"))]
        self.files = {test: self.files_of(test) for test in self.tests}
        self.seconds = {}
        self.run("cmake", "-S", self.source, "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release")

    def refresh(self, name):
        """The file as it is in the tree; one that is the same keeps its time,
        so that nothing is built again."""
        target, content = self.source / name, (ROOT / name).read_bytes()
        if not target.is_file() or target.read_bytes() != content:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
            shutil.copymode(ROOT / name, target)

    @staticmethod
    def run(*command):
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")

    def make(self, target):
        """True where it compiles."""
        return subprocess.run(["ninja", "-C", self.build, target], capture_output=True).returncode == 0

    def script(self, test):
        path = self.source / "tests" / f"{test}.py"
        return path if path.is_file() else None

    def files_of(self, test):
        """What a test includes itself, and all that it uses by way of others; nothing of a script."""
        own = self.source / "tests" / f"{test}.cpp"
        seen, new, direct = set(), [] if self.script(test) else [own], set()
        while new:
            path = new.pop()
            names = re.findall(r'#include "(.+?)"', path.read_text())
            direct |= set(names) if path == own else set()
            for place in [self.source / folder / name for name in names for folder in ("cpp", "tests")]:
                for each in (place, place.with_suffix(".cpp")):
                    if each.is_file() and each not in seen:
                        seen.add(each)
                        new.append(each)
        return direct, {str(path.relative_to(self.source)) for path in seen}

    def turn(self, test, file):
        """By which the tests that may see a fault of a file are ordered; None for one that cannot."""
        direct, seen = self.files[test]
        layer, header = file.split("/")[1], (self.source / file).with_suffix(".h")
        if not self.script(test):
            if header.is_file() and file not in seen:
                return None
            if not any(name.startswith(f"cpp/{layer}/") for name in seen):
                return None
        own = str(header.relative_to(self.source / "cpp")) in direct
        beside = any(name.startswith(layer + "/") for name in direct)
        return not own, not beside, LABELS.index(test.split("/")[0]), self.seconds.get(test, 1)

    def passes(self, test):
        """None where it does, otherwise how it fails."""
        script = self.script(test)
        if script:
            command = ["/usr/bin/python3", script, "-f"]
            if not all(map(self.make, ("mortier", *LOADED.values()))):
                return "does not compile"
        elif not self.make(f"{pathlib.Path(test).parent}_tests"):
            return "does not compile"
        else:
            text = (self.source / "tests" / f"{test}.cpp").read_text()
            suites = sorted(set(re.findall(r"^TEST(?:_F|_P)?\((\w+),", text, re.MULTILINE)))
            command = [self.build / "tests" / f"{pathlib.Path(test).parent}_tests", "--gtest_fail_fast",
                       "--gtest_brief=1", "--gtest_filter=" + ":".join(f"{suite}.*" for suite in suites)]
        environment = dict(os.environ, MORTIER=str(self.build / "mortier"), MORTIER_ROOT=str(self.source))
        environment |= {name: str(self.build / f"tests/lib{target}.so") for name, target in LOADED.items()}
        begin = time.monotonic()
        process = subprocess.Popen(command, cwd=self.build, env=environment, start_new_session=True,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL,
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT)))
        try:
            status = process.wait(30 * LIMIT)
        except subprocess.TimeoutExpired:
            status = -signal.SIGXCPU
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()
        if status == 0:
            self.seconds[test] = time.monotonic() - begin
        return None if status == 0 else "fails" if status > 0 else signal.Signals(-status).name

    def catch(self, file, old, new):
        """(the first test that fails with the fault, how), or None; raises ValueError where it cannot be
        injected."""
        path = self.source / file
        sound = path.read_text()
        found = places(sound, old)
        if len(found) != 1:
            raise ValueError(f"stands {len(found)} times in the file, expected once")
        path.write_text(sound[:found[0].start()] + new + sound[found[0].end():])
        turns = {test: self.turn(test, file) for test in self.tests}
        try:
            for test in sorted((test for test in turns if turns[test]), key=turns.get):
                failure = self.passes(test)
                if failure == "does not compile":
                    raise ValueError(failure)
                if failure:
                    return test, failure
        finally:
            path.write_text(sound)
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="TEXT", default="",
                        help="faults with this in their file, text or change")
    parser.add_argument("--first", type=int, default=1, metavar="N",
                        help="number of the first fault that is injected")
    parser.add_argument("--labels", default=",".join(LABELS), help="of the tests that may see a fault (all)")
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build-mutations",
                        help="build-mutations/")
    options = parser.parse_args()
    tree = Tree(options.folder.resolve(), options.labels.split(","))
    todo = [(f"{number} {file}: {old}  ->  {new}", file, old, new)
            for number, (file, old, new) in enumerate(faults(), 1) if number >= options.first]
    todo = [fault for fault in todo if options.only in fault[0]]
    seen, missed, broken = {}, [], []
    while todo:
        for fault in todo:
            begin, verdict = time.monotonic(), "no test sees it"
            try:
                catcher = tree.catch(*fault[1:])
                if catcher:
                    seen.setdefault(catcher[0], []).append(fault)
                    verdict = " ".join(catcher)
                else:
                    missed.append(fault[0])
            except ValueError as error:
                broken.append(fault[0])
                verdict = f"NO FAULT: {error}"
            print(f"{time.monotonic() - begin:6.0f} s  {fault[0]}\n          {verdict}", flush=True)
        unsound = {test: failure for test, failure in zip(seen, map(tree.passes, seen)) if failure}
        for test, failure in unsound.items():
            print(f"{test} {failure} without a fault: the others are asked for what it saw")
        todo = [fault for test in unsound for fault in seen.pop(test)]
        tree.tests = [test for test in tree.tests if test not in unsound]
    total = len(missed) + sum(map(len, seen.values()))
    print(f"\n{total - len(missed)} of {total} faults are seen "
          f"({100 - 100 * len(missed) / max(total, 1):.1f} %)")
    for name in missed:
        print(f"not seen  {name}")
    return 1 if missed or broken else 0


if __name__ == "__main__":
    sys.exit(main())
