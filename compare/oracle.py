#!/usr/bin/python3
"""Compares both codes on the scenes of scenes/: sloped and curved interfaces, three bodies, rollers, given
distances.

    compare/oracle.py [--only WORD ...] [--keep DIR] [--json FILE]

Exit code 1 when one pair of runs differs or fails.
"""
import sys

from both import add_options, chosen, compare_all, compare_runs, finish
from cases import scene_cases
import results

HEADER = (f"{'scene':<15} {'variant':<13} {'what':<42} {'displacement':>12} {'stress':>8} {'force':>8} "
          f"{'gap':>8}  {'mortier[s]':>10} {'FreeFEM[s]':>10}  verdict")


def compare_case(case, folder):
    return {"case": str(case)} | compare_runs(folder, case.settings, case.scene, case.within)


def row_text(case, row):
    text = f"{case.name:<15} {case.variant:<13} {case.what:<42} "
    if "stress" in row:
        text += (f"{row['displacement']:>12.1e} {row['stress']:>8.1e} {row['force']:>8.1e} "
                 f"{row['gap']:>8.1e}  {row['mortier_s']:>10.2f} {row['freefem_s']:>10.2f}  ")
    return text + row["verdict"]


def compare_scenes(cases, keep=None):
    """Prints a row a case as it is done. Returns the rows."""
    return compare_all(HEADER, cases, compare_case, row_text, keep)


def main():
    parser = results.argument_parser(__doc__)
    add_options(parser)
    arguments = parser.parse_args()
    return finish(arguments, compare_scenes(chosen(parser, arguments, scene_cases()), arguments.keep))


if __name__ == "__main__":
    sys.exit(main())
