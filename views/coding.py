"""Numbers as few bytes: decimals, differences, deflated. views/page/data.js reads them back."""
import base64
import re
import zlib

import numpy as np

NOISE = 1e-9  # of the largest of a kind of field


def numbers(values, digits=6):
    return [float(f"{value:.{digits}g}") for value in values]


def thinned(steps, most):
    """So many steps of those that were kept, one at least, the last one among them."""
    if len(steps) <= most:
        return steps
    return [steps[i] for i in sorted({round(i) for i in np.linspace(len(steps) - 1, 0, max(1, int(most)))})]


def without_noise(bodies):
    """bodies: of each name of a field -> numbers. A component below the rounding of the others of its kind
    becomes 0."""
    for kind in ("u[xyz]", r"s\d\d", r"e\d\d"):
        largest = {name: max(np.abs(each[name]).max(initial=0) for each in bodies)
                   for name in bodies[0] if re.fullmatch(kind, name)}
        for name, own in largest.items():
            if own < NOISE * max(largest.values()):
                for each in bodies:
                    each[name] = np.zeros_like(each[name])


def quantised(values, digits):
    """Integers and the exponent e of the power of ten that they are times; so many digits for the largest
    value."""
    largest = np.abs(values).max(initial=0)
    if not largest > 1e-290:
        return np.zeros(len(values), np.int64), 0
    e = int(np.floor(np.log10(largest))) - digits + 1
    return np.floor(scaled(values, -e) + 0.5).astype(np.int64), e


def scaled(numbers, e):
    """numbers times 10^e, with one rounding, as JavaScript has it too."""
    return numbers * float(f"1e{e}") if e >= 0 else numbers / float(f"1e{-e}")


def deflated(data):
    packer = zlib.compressobj(9, zlib.DEFLATED, -15, 9)
    return packer.compress(data) + packer.flush()


def packed(data):
    """As text."""
    return base64.b64encode(deflated(data)).decode()


def block(arrays, later=None):
    """Of (values, digits), or of integers as they are, (values, None): what a page has, and integers with
    their exponents.

    later: the integers of a block like this one. Numbers are what they are more than there or than the one
    before, whichever is less in all. Signs are in the last bit; bytes of one weight stand together."""
    forms, integers, parts = [], [], []
    for k, (values, digits) in enumerate(arrays):
        q, e = (np.asarray(values, np.int64), 0) if digits is None else quantised(np.asarray(values, float),
                                                                                  digits)
        more, there = np.diff(q, prepend=0), q - later[k][0] if later and later[k][1] == e else None
        if from_later := there is not None and np.abs(there).sum() < np.abs(more).sum():
            more = there
        folded = np.where(more < 0, -2 * more - 1, 2 * more).astype("<u4")
        forms.append([e, int(from_later)])
        integers.append((q, e))
        parts.append(np.ascontiguousarray(folded.view(np.uint8).reshape(-1, 4).T).tobytes())
    return {"f": forms, "d": packed(b"".join(parts))}, integers
