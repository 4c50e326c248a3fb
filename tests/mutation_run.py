#!/usr/bin/python3
"""Breaks cpp/ in small ways, one at a time, and says which of these faults no test sees.

    tests/mutation_run.py [--only TEXT] [--seconds S] [--folder DIR]

The faults stand in tests/mutations.txt. Everything happens on a copy of the tracked files in DIR, with the layers as
shared libraries, so that a fault costs one compile and one link. The tests run first without a fault: one that fails
then is left out, and so is one that takes more than S seconds. With a fault, unit tests that include its layer come
first, then all others, the short ones first, until one fails, crashes, or takes four times as long as it should.
"""
import argparse
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
LABELS = ("unit", "theory", "compare")
FASTEST_LIMIT = 30  # seconds: what a test may take that takes no time


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

    def __init__(self, folder):
        self.source, self.build = folder / "source", folder / "build"
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        names = [name for name in listed.split("\0") if name and (ROOT / name).is_file()]
        for name in names:
            self.refresh(name)
        for old in [path for path in self.source.rglob("*") if path.is_file()]:
            if str(old.relative_to(self.source)) not in names:
                old.unlink()
        self.tests = {path.stem: label for label in LABELS
                      for path in sorted((self.source / "tests" / label).glob("*_test.*"))}
        self.run("cmake", "-S", self.source, "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                 "-DBUILD_SHARED_LIBS=ON", "-DCMAKE_LINK_DEPENDS_NO_SHARED=ON", "-DMORTIER_BENCH=OFF")

    def refresh(self, name):
        """The file as it is in the tree; one that is the same keeps its time, so that nothing is built again."""
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
        path = self.source / "tests" / self.tests[test] / f"{test}.py"
        return path if path.is_file() else None

    def passes(self, test, limit):
        """None where it does, otherwise how it fails."""
        script = self.script(test)
        if script:
            command = ["/usr/bin/python3", script, "-f"]
        elif not self.make(test):
            return "does not compile"
        else:
            command = [self.build / "tests" / test, "--gtest_fail_fast", "--gtest_brief=1"]
        environment = dict(os.environ, MORTIER=str(self.build / "mortier"), MORTIER_ROOT=str(self.source),
                           FAILING_CALLS=str(self.build / "tests/libfailing-calls.so"))
        process = subprocess.Popen(command, cwd=self.build, env=environment, start_new_session=True,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            return None if process.wait(limit) == 0 else "fails"
        except subprocess.TimeoutExpired:
            return f"takes more than {limit:.0f} s"
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()

    def sees(self, test, layer):
        return not self.script(test) and self.tests[test] == "unit" and \
            f'#include "{layer}/' in (self.source / "tests/unit" / f"{test}.cpp").read_text()


def timed(tree, most):
    """Seconds of each test that passes without a fault."""
    if not tree.make("all"):
        sys.exit("the tree does not compile")
    seconds = {}
    for test in tree.tests:
        begin = time.monotonic()
        failure = tree.passes(test, most)
        if failure:
            print(f"left out: {test} {failure} without a fault", flush=True)
        else:
            seconds[test] = time.monotonic() - begin
    return seconds


def catch(tree, seconds, file, old, new):
    """(the first test that sees the fault, how) or None; raises ValueError where the fault cannot be injected."""
    path = tree.source / file
    sound = path.read_text()
    found = places(sound, old)
    if len(found) != 1:
        raise ValueError(f"stands {len(found)} times in the file, expected once")
    path.write_text(sound[:found[0].start()] + new + sound[found[0].end():])
    try:
        if not tree.make("mortier"):
            raise ValueError("does not compile")
        layer = file.split("/")[1]
        for test in sorted(seconds, key=lambda name: (not tree.sees(name, layer), seconds[name])):
            failure = tree.passes(test, FASTEST_LIMIT + 4 * seconds[test])
            if failure:
                return test, failure
        return None
    finally:
        path.write_text(sound)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="TEXT", default="", help="faults with this in their file, text or change")
    parser.add_argument("--seconds", type=float, default=300, help="tests that take longer are left out (300)")
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build-mutations", help="build-mutations/")
    options = parser.parse_args()
    tree = Tree(options.folder.resolve())
    seconds = timed(tree, options.seconds)
    print(f"{len(seconds)} tests, {sum(seconds.values()):.0f} s", flush=True)
    caught, missed, broken = 0, [], []
    for file, old, new in faults():
        name = f"{file}: {old}  ->  {new}"
        if options.only not in name:
            continue
        begin = time.monotonic()
        try:
            catcher = catch(tree, seconds, file, old, new)
        except ValueError as error:
            broken.append(name)
            print(f"no fault  {name}\n          {error}", flush=True)
            continue
        caught += catcher is not None
        if not catcher:
            missed.append(name)
        how = " ".join(catcher) if catcher else "NOT SEEN"
        print(f"{time.monotonic() - begin:6.0f} s  {name}\n          {how}", flush=True)
    total = caught + len(missed)
    print(f"\n{caught} of {total} faults are seen ({100 * caught / max(total, 1):.1f} %)")
    for name in missed:
        print(f"not seen  {name}")
    return 1 if missed or broken else 0


if __name__ == "__main__":
    sys.exit(main())
