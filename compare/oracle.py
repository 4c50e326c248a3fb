#!/usr/bin/python3
"""Compares both codes on the scenes of scenes/: sloped and curved interfaces, three bodies, rollers, given
distances.

    compare/oracle.py [--only WORD ...] [--keep DIR] [--json FILE]

Exit code 1 when one pair of runs differs or fails.
"""
import json
import sys
import tempfile
from pathlib import Path

from cases import scene_cases
from codes import RunError, run_freefem, run_mortier
from compare import compare
import results

HEADER = (f"{'scene':<15} {'variant':<13} {'what':<42} {'displacement':>12} {'stress':>8} {'force':>8} {'gap':>8}  "
          f"{'mortier[s]':>10} {'FreeFEM[s]':>10}  verdict")


def compare_case(case, folder):
    """One row: what it measured, in a dictionary."""
    row = {"case": str(case), "agree": False}
    try:
        ours = run_mortier(folder / "mortier", case.settings, case.scene)
        theirs = run_freefem(folder / "freefem", case.settings, case.scene)
    except (RunError, results.ResultError) as error:
        return row | {"verdict": f"FAILED: {error}"}
    verdict = compare(ours, theirs)
    return row | {"agree": verdict.agrees, "verdict": str(verdict), "displacement": verdict.norm("displacement "),
                  "stress": verdict.norm("stress"), "force": verdict.norm("contact force"),
                  "gap": verdict.norm("contact gap"), "mortier_s": ours.wall_time, "freefem_s": theirs.wall_time}


def row_text(case, row):
    text = f"{case.name:<15} {case.variant:<13} {case.what:<42} "
    if "stress" in row:
        text += (f"{row['displacement']:>12.1e} {row['stress']:>8.1e} {row['force']:>8.1e} {row['gap']:>8.1e}  "
                 f"{row['mortier_s']:>10.2f} {row['freefem_s']:>10.2f}  ")
    return text + row["verdict"]


def compare_scenes(cases, keep=None):
    """Prints a row a case as it is done. Returns the rows."""
    print(HEADER, flush=True)
    rows = []
    with tempfile.TemporaryDirectory(prefix="mortier-oracle-") as temporary:
        for number, case in enumerate(cases):
            row = compare_case(case, Path(keep or temporary).resolve() / f"{number:02d}-{case.name}")
            print(row_text(case, row), flush=True)
            rows.append(row)
    print(f"{sum(row['agree'] for row in rows)} of {len(rows)} pairs of runs agree")
    return rows


def main():
    parser = results.argument_parser(__doc__)
    parser.add_argument("--only", nargs="+", default=[], metavar="WORD", help="cases that contain all of these words")
    parser.add_argument("--keep", metavar="DIR", help="keeps the run folders there")
    parser.add_argument("--json", metavar="FILE", help="writes the rows as JSON")
    arguments = parser.parse_args()
    cases = [case for case in scene_cases() if all(word in str(case).split() for word in arguments.only)]
    if not cases:
        parser.error(f"no case contains {' '.join(arguments.only)}; a case reads: {scene_cases()[0]}")
    rows = compare_scenes(cases, arguments.keep)
    if arguments.json:
        Path(arguments.json).write_text(json.dumps(rows, indent=2) + "\n")
    return 0 if all(row["agree"] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
