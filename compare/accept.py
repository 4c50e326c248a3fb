#!/usr/bin/python3
"""Keeps mortier against its own past: the table of accepted scalars, compare/accepted.json (12 digits).

    compare/accept.py            renews the table (look at its differences before committing it)
    compare/accept.py --check    fails (code 1) when a run drifted from it

Cases: the note's test on all shared meshes with N = 20, both sides, and every scene of scenes/ as it stands.
"""
import json
import sys
import tempfile
from pathlib import Path

from cases import all_cases
from codes import ROOT, RunError, run_mortier
from compare import scalar_differences
import results

TABLE = ROOT / "compare" / "accepted.json"
DIGITS = 12
# Steps end at a material residual of 1e-10; what an unlike processor or BLAS leaves below that is no drift.
DRIFT = 1e-9
NOISE = 1e-12  # of the displacement: below, a value is rounding and is kept as 0
TINY = 1e-300  # in place of a size of 0


def runs():
    """Name, settings and scene of every accepted run."""
    for case in all_cases():
        if case.steps == 20:
            yield str(case), case.settings, "scenes/compression.toml"
    for scene in sorted((ROOT / "scenes").glob("*.toml")):
        yield scene.name, [], f"scenes/{scene.name}"


def measure():
    """name -> scalars of all runs."""
    table = {}
    with tempfile.TemporaryDirectory(prefix="mortier-accept-") as folder:
        for name, settings, scene in runs():
            scalars = run_mortier(Path(folder) / "run", settings, scene).scalars
            noise = NOISE * displacement_scale(scalars)
            table[name] = {key: rounded(value) if abs(value) > noise else 0.0
                           for key, value in scalars.items()}
    return table


def rounded(value):
    return float(f"{value:.{DIGITS}g}")


def drift(accepted, measured):
    """What drifted, a line each. Differences count against the size of their kind."""
    lines = [f"{name}: not measured any more" for name in accepted if name not in measured]
    lines += [f"{name}: not in the table" for name in measured if name not in accepted]
    for name in accepted.keys() & measured.keys():
        old, new = accepted[name], measured[name]
        lines += [f"{name}: {key}: in one of the tables only" for key in old.keys() ^ new.keys()]
        sizes = displacement_scale(old), old["von_mises_max"], abs(old["contact_force"])
        lines += [f"{name}: {each.quantity}: {each.first:.12g}, accepted {each.second:.12g}"
                  for each in scalar_differences({key: new[key] for key in new if key in old}, old,
                                                 *(size or TINY for size in sizes))
                  if not each.difference <= min(each.tolerance, DRIFT)]
    return sorted(lines)


def displacement_scale(scalars):
    return max(abs(value) for name, value in scalars.items() if name.startswith("displacement"))


def main():
    parser = results.argument_parser(__doc__)
    parser.add_argument("--check", action="store_true", help="compares instead of renewing")
    parser.add_argument("--table", default=str(TABLE), metavar="FILE", help="another table")
    arguments = parser.parse_args()
    path = Path(arguments.table)
    try:
        measured = measure()
        accepted = results.read_json(path) if arguments.check else None
    except (RunError, results.ResultError) as error:
        print(f"accept: {error}", file=sys.stderr)
        return 1
    if not arguments.check:
        path.write_text(json.dumps(measured, indent=1) + "\n")
        print(f"{path}: {len(measured)} runs accepted")
        return 0
    lines = drift(accepted, measured)
    print("\n".join(lines + [f"{len(measured)} runs, {len(lines)} values drifted"]))
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
