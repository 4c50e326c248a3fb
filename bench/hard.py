#!/usr/bin/python3
"""Hard problems of contact: what mortier finds beside exact or published values, and beside other codes.

    bench/hard.py [WORD ...] [--no-peers] [--json FILE]

The rows are in bench/hard/rows.py, their scenes beside it; with words, only rows that have one of them.
The verdict of a row is `within` its tolerance, `named` where the value is off and the program said so by
itself (a warning, or the reason why it ended), or OFF. The other codes are those that are installed: FreeFEM
(Debian package freefem++), GetFEM (python3-getfem), CalculiX (calculix-ccx). Exit code 1 where a row is OFF.
"""
import argparse
import json
import os
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENES = ROOT / "bench" / "hard"
sys.path[:0] = [*(str(ROOT / each) for each in ("bench/peer_codes", "study", "compare")), str(SCENES)]

import codes  # noqa: E402
import drivers  # noqa: E402, F401: GetFEM, CalculiX
import rows  # noqa: E402
import scene as scenes  # noqa: E402
from known import measure  # noqa: E402
from plan import Case  # noqa: E402
from problems import RunFailure  # noqa: E402

codes.MORTIER = str(Path(codes.MORTIER).resolve())  # runs are in other folders
NAMES = {"freefem": "FreeFEM", "getfem": "GetFEM", "calculix": "CalculiX"}


def peer(row, code):
    """The value of another code on the same meshes, or why there is none."""
    (settings,) = row.runs()
    pairs = [setting.split("=", 1) for setting in settings]
    case = Case((("code", code), *((key, scenes.value_of(text)) for key, text in pairs)))
    with tempfile.TemporaryDirectory(prefix="mortier-hard-") as name:
        try:
            return row.read(codes.run(case, row.scene, {}, Path(name) / "run", timeout=300).run)
        except (RunFailure, KeyError) as failure:
            return str(failure).splitlines()[0]


def shown(value):
    return f"{value:.5g}" if isinstance(value, (int, float)) else "-"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", metavar="WORD")
    parser.add_argument("--no-peers", action="store_true", help="mortier alone")
    parser.add_argument("--json", type=Path, metavar="FILE", help="writes the rows as JSON")
    given = parser.parse_args()
    os.environ.setdefault("MORTIER", codes.MORTIER)
    found, case = [], None
    print(f"{'value':<66} {'ours':>10} {'peer':>18} {'exact':>10} {'off':>8} {'s':>6}  verdict")
    for row in rows.ROWS:
        if given.words and not any(word in f"{row.case} {row.value}" for word in given.words):
            continue
        if row.case != case:
            case = row.case
            print(f"\n{case} ({row.source})")
        begin = time.perf_counter()
        value, off, verdict = measure(row)
        seconds = time.perf_counter() - begin
        peers = {} if given.no_peers else {NAMES[code]: peer(row, code) for code in row.peers}
        words = [f"{name} {each if isinstance(each, str) else shown(each)}" for name, each in peers.items()]
        words += [] if words else [""]
        print(f"{row.value:<66} {shown(value):>10} {words[0]:>18} {shown(row.reference()):>10} "
              f"{'' if off is None else f'{off:.1e}':>8} {seconds:>6.1f}  {verdict}", flush=True)
        for each in words[1:]:
            print(f"{'':<66} {'':>10} {each:>18}", flush=True)
        found.append({"case": row.case, "value": row.value, "ours": value, "peers": peers,
                      "exact": row.exact, "theirs": row.theirs,
                      "off": off, "verdict": verdict, "seconds": seconds, "source": row.source})
    count = {kind: sum(row["verdict"].startswith(kind) for row in found)
             for kind in ("within", "named", "OFF", "skipped")}
    print("\n" + ", ".join(f"{number} {kind}" for kind, number in count.items()))
    if given.json:
        given.json.write_text(json.dumps(found, indent=2) + "\n")
    return 1 if count["OFF"] or not found else 0


if __name__ == "__main__":
    sys.exit(main())
