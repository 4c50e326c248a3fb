#!/usr/bin/python3
"""Compares both codes on the compression test, over all shared meshes, projections, variants and sides.

    compare/matrix.py [--quick] [--only WORD ...] [--keep DIR] [--json FILE]

--quick takes every mesh pair, projection, variant, side and N once or more; without it, all combinations with
N = 20 and N = 100. Exit code 1 when one pair of runs differs or fails.
"""
import sys

from both import main
from cases import all_cases, quick_cases

if __name__ == "__main__":
    sys.exit(main(__doc__, all_cases, quick_cases))
