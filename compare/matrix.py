#!/usr/bin/python3
"""Compares both codes on the compression test, over all shared meshes, projections, variants and sides.

    compare/matrix.py [--quick] [--only WORD ...] [--keep DIR] [--json FILE]

--quick takes every mesh pair, projection, variant, side and N once or more; without it, all combinations with
N = 20 and N = 100. Exit code 1 when one pair of runs differs or fails.
"""
import json
import statistics
import sys
import tempfile
from pathlib import Path

from cases import all_cases, quick_cases
from codes import RunError, run_freefem, run_mortier
from compare import compare
import results

CASE = ("pair", "projection", "variant", "nonmortar", "steps")
HEADER = (f"{'pair':<5} {'projection':<11} {'variant':<13} {'nonmortar':<9} {'steps':>5}  "
          f"{'displacement':>12} {'stress':>8} {'force':>8}  {'mortier[s]':>10} {'FreeFEM[s]':>10} {'ratio':>6}  verdict")


def compare_case(case, folder):
    """One row: what it measured, in a dictionary."""
    row = {key: getattr(case, key) for key in CASE} | {"agree": False}
    try:
        ours = run_mortier(folder / "mortier", case.settings)
        theirs = run_freefem(folder / "freefem", case.settings)
    except (RunError, results.ResultError) as error:
        return row | {"verdict": f"FAILED: {error}"}
    verdict = compare(ours, theirs)
    return row | {"agree": verdict.agrees, "verdict": str(verdict),
                  "displacement": verdict.norm("displacement "), "stress": verdict.norm("stress"),
                  "force": verdict.norm("contact force"),
                  "mortier_s": ours.wall_time, "freefem_s": theirs.wall_time,
                  "mortier_iterations": ours.summary["newton_iterations"],
                  "freefem_iterations": theirs.summary["newton_iterations"],
                  "ratio": theirs.wall_time / ours.wall_time}


def row_text(row):
    pair, projection, variant, nonmortar, steps = (row[key] for key in CASE)
    text = f"{pair:<5} {projection:<11} {variant:<13} {nonmortar:<9} {steps:>5}  "
    if "ratio" in row:
        text += (f"{row['displacement']:>12.1e} {row['stress']:>8.1e} {row['force']:>8.1e}  "
                 f"{row['mortier_s']:>10.2f} {row['freefem_s']:>10.2f} {row['ratio']:>6.1f}  ")
    return text + row["verdict"]


def compare_cases(cases, keep=None):
    """Prints a row a case as it is done. Returns the rows."""
    print(HEADER, flush=True)
    rows = []
    with tempfile.TemporaryDirectory(prefix="mortier-matrix-") as temporary:
        for case in cases:
            row = compare_case(case, Path(keep or temporary).resolve() / case.folder)
            print(row_text(row), flush=True)
            rows.append(row)
    good = [row for row in rows if row["agree"]]
    print(f"{len(good)} of {len(rows)} pairs of runs agree", end="")
    for variant in ("mortar", "interpolation"):
        ratios = [row["ratio"] for row in good if row["variant"] == variant]
        if ratios:
            print(f"; wall time FreeFEM/mortier, {variant}: {min(ratios):.1f} to {max(ratios):.1f}, "
                  f"median {statistics.median(ratios):.1f}", end="")
    print()
    return rows


def main():
    parser = results.argument_parser(__doc__)
    parser.add_argument("--quick", action="store_true", help="a subset that takes about a minute")
    parser.add_argument("--only", nargs="+", default=[], metavar="WORD",
                        help="cases that contain all of these words, e.g. 7/11 mortar N=20")
    parser.add_argument("--keep", metavar="DIR", help="keeps the run folders there")
    parser.add_argument("--json", metavar="FILE", help="writes the rows as JSON")
    arguments = parser.parse_args()
    cases = [case for case in (quick_cases() if arguments.quick else all_cases())
             if all(word in str(case).split() for word in arguments.only)]
    if not cases:
        parser.error(f"no case contains {' '.join(arguments.only)}; a case reads: {all_cases()[0]}")
    rows = compare_cases(cases, arguments.keep)
    if arguments.json:
        Path(arguments.json).write_text(json.dumps(rows, indent=2) + "\n")
    return 0 if all(row["agree"] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
