#!/usr/bin/python3
"""Compares both codes on the compression test, over all shared meshes, projections, variants and sides.

    compare/matrix.py [--quick] [--only WORD ...] [--keep DIR] [--json FILE]

--quick takes every mesh pair, projection, variant, side and N once or more; without it, all combinations with
N = 20 and N = 100. Exit code 1 when one pair of runs differs or fails.
"""
import statistics
import sys

from both import add_options, chosen, compare_all, compare_runs, finish
from cases import all_cases, quick_cases
import results

CASE = ("pair", "projection", "variant", "nonmortar", "steps")
HEADER = (f"{'pair':<5} {'projection':<11} {'variant':<13} {'nonmortar':<9} {'steps':>5}  "
          f"{'displacement':>12} {'stress':>8} {'force':>8}  {'mortier[s]':>10} {'FreeFEM[s]':>10} "
          f"{'ratio':>6}  verdict")


def compare_case(case, folder):
    return {key: getattr(case, key) for key in CASE} | compare_runs(folder, case.settings)


def row_text(_, row):
    pair, projection, variant, nonmortar, steps = (row[key] for key in CASE)
    text = f"{pair:<5} {projection:<11} {variant:<13} {nonmortar:<9} {steps:>5}  "
    if "ratio" in row:
        text += (f"{row['displacement']:>12.1e} {row['stress']:>8.1e} {row['force']:>8.1e}  "
                 f"{row['mortier_s']:>10.2f} {row['freefem_s']:>10.2f} {row['ratio']:>6.1f}  ")
    return text + row["verdict"]


def compare_cases(cases, keep=None):
    """Prints a row a case as it is done, then how much faster mortier is. Returns the rows."""
    rows = compare_all(HEADER, cases, compare_case, row_text, keep)
    for variant in ("mortar", "interpolation"):
        ratios = [row["ratio"] for row in rows if row["agree"] and row["variant"] == variant]
        if ratios:
            print(f"wall time FreeFEM/mortier, {variant}: {min(ratios):.1f} to {max(ratios):.1f}, "
                  f"median {statistics.median(ratios):.1f}")
    return rows


def main():
    parser = results.argument_parser(__doc__)
    parser.add_argument("--quick", action="store_true", help="a subset that takes about a minute")
    add_options(parser)
    arguments = parser.parse_args()
    cases = chosen(parser, arguments, quick_cases() if arguments.quick else all_cases())
    return finish(arguments, compare_cases(cases, arguments.keep))


if __name__ == "__main__":
    sys.exit(main())
