"""Files that the program writes beside a result: whole or not at all, and never in place of a file of others.

Each carries a seal, the SHA-256 of the rest: what has another one, or none,
was made or changed by somebody else.
"""
import hashlib
import os
import re
import zlib
from pathlib import Path

from ending import Wrong

MOST_BYTES = 4 << 30  # of a picture or a page


def seal_of(data, kind):
    """The seal, and how many bytes of the file follow it."""
    text = b"mortier " + hashlib.sha256(data).hexdigest().encode()
    if kind == "png":
        chunk = b"tEXtComment\0" + text
        return (len(chunk) - 4).to_bytes(4, "big") + chunk + zlib.crc32(chunk).to_bytes(4, "big"), 12
    if kind == "gif":
        return b"\x21\xfe" + bytes([len(text)]) + text + b"\0", 1
    return b"<!-- " + text + b" -->\n", 0


def sealed(data, kind):
    seal, after = seal_of(data, kind)
    at = len(data) - after
    return data[:at] + seal + data[at:]


def is_own(path):
    if path.is_symlink() or not path.is_file():
        return False
    if path.stat().st_size > MOST_BYTES:
        return False
    data, kind = path.read_bytes(), path.suffix[1:]
    seal, after = seal_of(b"", kind)
    at = len(data) - after - len(seal)
    return at > 0 and sealed(data[:at] + data[at + len(seal):], kind) == data


def put(files):
    """path -> bytes: all of them, or where one cannot be written none that was not there before."""
    for path in files:
        if (path.exists() or path.is_symlink()) and not is_own(path):
            raise Wrong(f"{path}: in the way, and no file of mortier or changed since; expected "
                        "another --out")
    new = {}
    try:
        for path, data in files.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            new[path] = path.with_name(f"{path.name}.tmp-{os.getpid()}")
            new[path].write_bytes(sealed(data, path.suffix[1:]))
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
