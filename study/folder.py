"""The folder of a study: what is in it and not the study's own is left as it is.

study.csv is known by its header; manifest.json records the pictures and the page with their checksums. All
that passes (meshes, runs, files that are just written) is in mortier-work-PID,
which the next study takes away after a kill.
"""
import fcntl
import hashlib
import json
import os
import re
import shutil
import time
from pathlib import Path

import table
from problems import RunFailure, StudyError

FORMAT = "mortier study 1"
RECORD = "manifest.json"
PASSING = ("meshes", "runs", "new")


class Folder:
    def __init__(self, path):
        """StudyError: it is no folder of a study, nor a new one."""
        self.path = Path(path)
        if self.path.is_symlink() and not self.path.exists():
            raise StudyError(f"--out {path}: a link to nothing, expected a folder of a study or a new one")
        for each in (self.path, self.path / "study.csv"):
            if each.exists() and not (each.is_dir() if each == self.path else each.is_file()):
                raise StudyError(f"--out {path}: {each} is in the way, expected a folder of a study "
                                 "or a new one")
        csv = self.path / "study.csv"
        if self.path.exists() and any(not works(each) for each in self.path.iterdir()) and not csv.exists():
            raise StudyError(f"--out {path}: holds other files, expected a folder of a study or a new one")
        if csv.exists() and not table.is_study(csv):
            raise StudyError(f"--out {path}: study.csv is not one of mortier study, expected a folder of a "
                             "study or a new one")
        self.path.mkdir(parents=True, exist_ok=True)
        self.lock = os.open(self.path, os.O_RDONLY | os.O_DIRECTORY)
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise StudyError(f"--out {path}: in use, a study in it still goes on") from error
        except OSError:
            pass  # a file system without locks
        for each in self.path.iterdir():
            if works(each):
                clear(each)
        self.work = self.path / f"mortier-work-{os.getpid()}"
        self.work.mkdir()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        clear(self.work)
        os.close(self.lock)

    def passing(self, name):
        """A folder for the time of the study."""
        folder = self.work / name
        folder.mkdir(exist_ok=True)
        return folder

    def put(self, name, data):
        """A file in place of an older one, as a whole."""
        new = self.work / "new"
        new.write_bytes(data)
        os.replace(new, self.path / name)

    def put_own(self, files):
        """name -> bytes: takes the place of what an earlier study wrote, and of nothing else."""
        old = self.record()
        for name in files:
            if exists(self.path / name) and not self.is_own(name, old):
                keep(self.path / name)
        sums = {name: checksum(data) for name, data in files.items()}
        self.write_record({**old, **{name: [*old.get(name, ()), sum_] for name, sum_ in sums.items()}})
        for name, data in files.items():
            self.put(name, data)
        for name in old:
            if name not in files and self.is_own(name, old):
                (self.path / name).unlink()
        self.write_record({name: [sum_] for name, sum_ in sums.items()})

    def record(self):
        """name -> checksums of what may stand there."""
        try:
            if exists(self.path / RECORD) and not (self.path / RECORD).is_file():
                raise ValueError("a folder or a pipe")
            record = json.loads((self.path / RECORD).read_text(encoding="utf-8"))
            files = {name: list(map(str, sums)) for name, sums in record["files"].items()
                     if Path(name).name == name}
            if record["format"] == FORMAT:
                return files
        except FileNotFoundError:
            return {}
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
            pass
        keep(self.path / RECORD)
        return {}

    def write_record(self, files):
        self.put(RECORD, (json.dumps({"format": FORMAT, "files": files}, indent=2) + "\n").encode())

    def is_own(self, name, record):
        path = self.path / name
        return (path.is_file() and not path.is_symlink()
                and checksum(path.read_bytes()) in record.get(name, ()))


def checksum(data):
    return hashlib.sha256(data).hexdigest()


def exists(path):
    return path.exists() or path.is_symlink()


def works(path):
    return re.fullmatch(r"mortier-work-\d+",
                        path.name) is not None and path.is_dir() and not path.is_symlink() and \
        all(each.name in PASSING for each in path.iterdir())


def clear(work):
    """What has been put there by others stays."""
    for _ in range(50):
        for name in PASSING:
            path = work / name
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)
            else:
                path.unlink(missing_ok=True)
        try:
            return work.rmdir()
        except OSError:
            if not any(exists(work / name) for name in PASSING):
                return None
        time.sleep(0.02)  # a run of a killed study is just ending
    return None


def keep(path):
    """Moves a file of others out of the way."""
    to, again = path.with_name(path.name + ".kept"), 1
    while exists(to):
        again += 1
        to = path.with_name(f"{path.name}.kept-{again}")
    try:
        path.rename(to)
    except OSError as error:
        raise RunFailure(f"{path}: in the way, cannot be moved: {error.strerror}") from error
