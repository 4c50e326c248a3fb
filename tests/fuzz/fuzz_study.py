#!/usr/bin/env python3
"""Study files by seeded changes of sound ones: each is read, or refused with a StudyError of one short line.

fuzz_study.py [--count N] [--seed N]    prints what was found, ends with 1 if anything was
"""
import argparse
import random
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "study"))

import plan  # noqa: E402
from problems import StudyError, shown  # noqa: E402

WORDS = ["1e999", "-1", "nan", "inf", '"', "\n", "[", "]", "{", "}", "[[error]]", "[[sweep]]", "=", ".",
         "\\u0000", "\x00", "\\", "é",
         "99999999999999999999", "a" * 400, "(" * 300, "sin(", "x.y", "true", "1979-05-27", "[[[[", "exact",
         "level", "key = 1\n"]


def changed(text, texts, rng):
    for _ in range(rng.randrange(1, 5)):
        begin, size = rng.randrange(len(text) + 1), rng.randrange(30)
        other = rng.choice(texts)
        at = rng.randrange(len(other))
        new = rng.choice(["", rng.choice(WORDS), text[begin:begin + size] * 2, other[at:at + size],
                          chr(rng.randrange(0x500))])
        text = text[:begin] + new + text[begin + rng.choice([0, size]):]
    return text


def explore(count, seed=0):
    """Findings, and how many files were read and refused."""
    texts = [path.read_text() for path in sorted((ROOT / "scenes/studies").glob("*.toml"))]
    texts = [text.replace('scene = "', f'scene = "{ROOT}/scenes/studies/') for text in texts]
    findings, numbers = [], {"read": 0, "refused": 0}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "study.toml"
        for i in range(seed, seed + count):
            rng = random.Random(i)
            text = changed(rng.choice(texts), texts, rng)
            file.write_text(text, encoding="utf-8", errors="replace")
            try:
                plan.read(file).cases()
                numbers["read"] += 1
            # the second has a message of its own (study/__main__.py)
            except (StudyError, RecursionError) as error:
                numbers["refused"] += 1
                if len(shown(error)) > 5000:
                    findings.append(f"seed {i}: a message of {len(shown(error))} characters")
            except Exception as error:
                findings.append(f"seed {i}: {type(error).__name__}: {error}\n{text!r}")
    return findings, numbers


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100000)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    findings, numbers = explore(given.count, given.seed)
    print("\n".join(findings[:20]))
    print(f"{numbers}, {len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
