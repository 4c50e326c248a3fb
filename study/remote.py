"""One run of a study on a machine that has none of its files: `mortier study -`.

Standard input brings the task (what Task.words makes), then the files and the outcome of the reference run;
the answer goes to standard output. Standard input stays open while the answer is wanted: when it ends early,
the run ends too.
"""
import dataclasses
import hashlib
import os
import subprocess
import sys
import tempfile
import threading
import tomllib
from pathlib import Path

import codes
import process
import work
from parcel import packed, unpacked
from problems import RunFailure, StudyError

STAMP = 64  # characters


class Task:
    """What all runs of a study share, and the words that send one of them."""

    def __init__(self, plan, meshes):
        self.plan, self.meshes, self.stamp = plan, meshes, stamp()

    def words(self, case, is_reference):
        """stamp, length, task."""
        data = packed((self.plan, self.meshes, case, is_reference, os.getcwd()))
        return self.stamp + len(data).to_bytes(8, "little") + data


def stamp():
    """Names the program and the scripts: with others a task would not be the same run."""
    here = Path(__file__).resolve().parent
    digest = hashlib.sha256()
    for path in sorted([*here.glob("*.py"), *(here.parent / "compare").glob("*.py")]):
        digest.update(path.name.encode() + path.read_bytes())
    try:
        digest.update(subprocess.run([codes.MORTIER, "--version"], capture_output=True, check=False).stdout)
    except OSError as error:
        raise RunFailure(f"{codes.MORTIER}: {error.strerror}") from error
    return digest.hexdigest().encode()


def files_of(plan, meshes, cases):
    """absolute path -> bytes, packed, of every file that the runs read: the scene, and what a text in it or
    the value of an axis names. StudyError: an absolute path, which is another place on another machine."""
    scene = Path(os.path.abspath(plan.scene))
    named = [(scene.parent, text) for text in texts(tomllib.loads(scene.read_text(encoding="utf-8")))]
    named += [(Path.cwd(), text) for case in cases for _, value in case.values for text in texts(value)]
    paths = {scene, *(path for each in meshes.values() for path in each)}
    for folder, text in named:
        if is_file(folder / text):
            if os.path.isabs(text):
                raise StudyError(f'{plan.scene}: "{text}", expected a relative path: workers have no files')
            paths.add(Path(os.path.abspath(folder / text)))
    return packed({str(path): path.read_bytes() for path in paths})


def texts(value):
    """All texts in a value of TOML."""
    if isinstance(value, str):
        return [value]
    inside = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return [text for each in inside for text in texts(each)]


def is_file(path):
    try:
        return path.is_file()
    except (OSError, ValueError):  # too long a name, a character that no name has
        return False


def serve():
    """Reads a task, makes the run, writes the answer: a row, or the outcome of a reference run."""
    source = sys.stdin.buffer
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what libraries print is no answer
    if source.read(STAMP) != stamp():
        raise RunFailure("mortier here is not the version of the study")
    task, rest = read(source), read(source)
    with tempfile.TemporaryDirectory(prefix="mortier-") as folder:
        def watch():
            os.read(0, 1)  # nothing more comes
            process.stop_all()
        threading.Thread(target=watch, daemon=True).start()
        try:
            answer.write(packed(run(Path(folder), *task, *rest)))
            answer.flush()
        except process.Stopped:
            return


def read(source):
    return unpacked(source.read(int.from_bytes(source.read(8), "little")))


def run(folder, plan, meshes, case, is_reference, cwd, files, truth, at_once):
    def place(path):
        """The place of an absolute path here."""
        return folder / "files" / Path(os.path.abspath(path)).relative_to("/")
    for path, data in unpacked(files).items():
        place(path).parent.mkdir(parents=True, exist_ok=True)
        place(path).write_bytes(data)
    place(cwd).mkdir(parents=True, exist_ok=True)
    scene = place(os.path.abspath(os.path.join(cwd, plan.scene)))
    os.chdir(place(cwd))
    plan = dataclasses.replace(plan, scene=scene)
    meshes = {body: [place(path) for path in paths] for body, paths in meshes.items()}
    if is_reference:
        return work.reference_run(plan, meshes, case, folder / "run")
    return work.row_of(plan, meshes, case, folder / "run", truth and unpacked(truth), at_once)
