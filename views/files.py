"""Files that the program writes beside a result: whole or not at all, and never in place of one of others."""
import os
import re
from pathlib import Path

from ending import Wrong

MARK = "written by mortier plot, report or compare"  # in the head of each, where its kind says what made it
HEAD = 4096  # bytes


def is_own(path):
    if path.is_symlink() or not path.is_file():
        return False
    with open(path, "rb") as file:
        return MARK.encode() in file.read(HEAD)


def put(files):
    """path -> bytes: all of them, or where one cannot be written none that was not there before."""
    for path in files:
        if (path.exists() or path.is_symlink()) and not is_own(path):
            raise Wrong(f"{path}: in the way, and no file of mortier; expected another --out")
    new = {}
    try:
        for path, data in files.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            new[path] = path.with_name(f"{path.name}.tmp-{os.getpid()}")
            new[path].write_bytes(data)
        for path, written in new.items():
            os.replace(written, path)
    except OSError as error:
        raise OSError(error.errno, f"{path}: cannot be written: {error.strerror}") from error
    finally:
        for written in new.values():
            written.unlink(missing_ok=True)


def beside(results, ending):
    """The default place of what is made of some results: beside the first, named after all."""
    first = Path(os.path.abspath(results[0]))
    names = [Path(os.path.abspath(each)).name for each in results]
    name = "+".join(dict.fromkeys(names))
    return Path(os.path.relpath(first.parent)) / (re.sub(r"[^\w.+-]", "_", name)[:150] + ending)
