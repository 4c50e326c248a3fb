"""Fields as few bytes: decimals of a fixed place, predicted, deflated. views/page/data.js reads them back.

An array of numbers becomes integers times 10^e, with so many digits for its largest value; what is kept is
what a prediction misses: from the number before it, from the same place in the block that was coded before,
or from two such blocks as if they went on. Signs are folded into the last bit
(0, -1, 1, -2, ... become 0, 1, 2, 3, ...) and bytes of the same weight stand together.
"""
import base64
import zlib

import numpy as np

BEFORE, EARLIER, GIVEN, ONWARD = range(4)  # predictions; GIVEN: by the caller


def quantised(values, digits):
    """Integers and the exponent e; so many digits for the largest value."""
    largest = np.abs(values).max(initial=0)
    if not largest > 1e-290:
        return np.zeros(len(values), np.int64), 0
    e = int(np.floor(np.log10(largest))) - digits + 1
    return np.floor(scaled(values, -e) + 0.5).astype(np.int64), e


def scaled(numbers, e):
    """numbers times 10^e, with one rounding, as JavaScript has it too."""
    return numbers * float(f"1e{e}") if e >= 0 else numbers / float(f"1e{-e}")


def requantised(earlier, e0, e):
    """Integers times 10^e0 as integers times 10^e."""
    return np.floor(scaled(earlier, e0 - e) + 0.5).astype(np.int64)


def folded(differences):
    """Bytes of the folded numbers, those of one weight together, and how many weights there are."""
    folded_ = np.where(differences < 0, -2 * differences - 1, 2 * differences).astype("<u8")
    weights = max(1, (int(folded_.max(initial=0)).bit_length() + 7) // 8)
    return np.ascontiguousarray(folded_.view(np.uint8).reshape(-1, 8)[:, :weights].T).tobytes(), weights


def deflated(data, level=9):
    packer = zlib.compressobj(level, zlib.DEFLATED, -15, 9)
    return packer.compress(data) + packer.flush()


class Block:
    """Arrays of one step, or of a mesh, which are unpacked together."""

    def __init__(self, earlier=None):
        self.earlier, self.integers, self.forms, self.parts = earlier, [], [], []
        if earlier is not None and earlier.earlier is not None:
            earlier.earlier.earlier = None  # two are all that is looked back at

    def add(self, values, digits, given=None):
        """given: (function of e that predicts integers); else the better one of the other two."""
        q, e = quantised(np.asarray(values, float), digits)
        tries = []
        if given is not None:
            tries.append((GIVEN, given(e)))
        else:
            tries.append((BEFORE, np.concatenate([[0], q[:-1]]) if len(q) else q))
            if (last := self.back(1, e)) is not None:
                tries.append((EARLIER, last))
                if (last_but_one := self.back(2, e)) is not None:
                    tries.append((ONWARD, 2 * last - last_but_one))
        packed = [(*folded(q - prediction), how) for how, prediction in tries]
        data, weights, how = (min(packed, key=lambda each: len(deflated(each[0], 1)))
                              if len(packed) > 1 else packed[0])
        self.integers.append((q, e))
        self.forms.append([e, how, weights])
        self.parts.append(data)
        return q, e

    def add_integers(self, numbers):
        """As they are: so many digits that the exponent is 0; predicted by the one before or by 0."""
        numbers = np.asarray(numbers, np.int64)
        largest = int(np.abs(numbers).max(initial=0))
        by_zero, by_before = (len(deflated(folded(each)[0], 1)) for each in (numbers, np.diff(numbers)))
        self.add(numbers.astype(float), len(str(largest)) if largest else 1,
                 (lambda e: 0) if by_zero < by_before else None)

    def back(self, blocks, e):
        """The integers of the same array so many blocks earlier, times 10^e here;
        None where they are too different."""
        block = self.earlier if blocks == 1 else self.earlier and self.earlier.earlier
        if block is None:
            return None
        q, e0 = block.integers[len(self.integers)]
        return requantised(q, e0, e) if abs(e0 - e) < 9 else None

    def bytes(self):
        return deflated(b"".join(self.parts))

    def json(self):
        return {"f": self.forms, "d": base64.b64encode(self.bytes()).decode()}
