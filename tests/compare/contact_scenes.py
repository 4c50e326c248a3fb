#!/usr/bin/python3
"""Scenes of contact with a value that is exact, or known from statics, symmetry or a fine mesh: full circles
on long lines, rounded and chamfered tools, corners on slopes, light contact, tipping, falls.

    tests/compare/contact_scenes.py [--only NAME] [--first N] [--count N] [--jobs N] [--mortier PROGRAM]

Each scene is a function of the modules below with its variants; it returns what is wrong. Prints a line for
each that has a fault, then a summary; exit code 1 where there is one. With --all also those that are right.
"""
import sys

import contact_circles
import contact_corners
import contact_edges
import contact_rows
from contact_support import command

SCENES = {scene.__name__: scene for module in (contact_circles, contact_edges, contact_corners, contact_rows)
          for scene in module.SCENES}


def examined(program, name):
    faults = SCENES[name](program)
    return f"{len(faults)} faults", faults


if __name__ == "__main__":
    sys.exit(command(__doc__, examined, len(SCENES), list(SCENES)))
