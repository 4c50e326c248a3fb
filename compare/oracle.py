#!/usr/bin/python3
"""Compares both codes on the scenes of scenes/: sloped and curved interfaces, three bodies, rollers, given
distances.

    compare/oracle.py [--only WORD ...] [--keep DIR] [--json FILE]

Exit code 1 when one pair of runs differs or fails.
"""
import sys

from both import main
from cases import scene_cases

if __name__ == "__main__":
    sys.exit(main(__doc__, scene_cases))
