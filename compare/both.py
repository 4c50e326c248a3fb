"""Both codes on a list of cases: a row each, printed as it is done.
matrix.py and oracle.py say which cases."""
import json
import tempfile
from pathlib import Path

from codes import COMPRESSION, RunError, run_freefem, run_mortier
from compare import compare
import results


def compare_runs(folder, settings, scene=COMPRESSION, within=None):
    """What is to be told of a scene in both codes; where one of them fails, only that."""
    try:
        ours = run_mortier(folder / "mortier", settings, scene)
        chosen = any(setting.startswith("time.tolerance=") for setting in settings)
        steps_of = folder / "mortier" if chosen else None
        theirs = run_freefem(folder / "freefem", settings, scene, steps_of=steps_of)
    except (RunError, results.ResultError) as error:
        return {"agree": False, "verdict": f"FAILED: {error}"}
    verdict = compare(ours, theirs, within)
    return {"agree": verdict.agrees, "verdict": str(verdict), "displacement": verdict.norm("displacement "),
            "stress": verdict.norm("stress"), "force": verdict.norm("contact force"),
            "gap": verdict.norm("contact gap"),
            "mortier_s": ours.wall_time, "freefem_s": theirs.wall_time,
            "ratio": theirs.wall_time / ours.wall_time,
            "mortier_iterations": ours.summary["newton_iterations"],
            "freefem_iterations": theirs.summary["newton_iterations"]}


def compare_all(header, cases, row_of, text_of, keep=None):
    """row_of(case, folder) is a dictionary, text_of(case, row) its line. Returns the rows."""
    print(header, flush=True)
    rows = []
    with tempfile.TemporaryDirectory(prefix="mortier-compare-") as temporary:
        for case in cases:
            rows.append(row_of(case, Path(keep or temporary).resolve() / case.folder))
            print(text_of(case, rows[-1]), flush=True)
    print(f"{sum(row['agree'] for row in rows)} of {len(rows)} pairs of runs agree")
    return rows


def add_options(parser):
    parser.add_argument("--only", nargs="+", default=[], metavar="WORD",
                        help="cases that contain all of these words")
    parser.add_argument("--keep", metavar="DIR", help="keeps the run folders there")
    parser.add_argument("--json", metavar="FILE", help="writes the rows as JSON")


def chosen(parser, arguments, cases):
    """The cases that --only asks for."""
    found = [case for case in cases if all(word in str(case).split() for word in arguments.only)]
    if not found:
        parser.error(f"no case contains {' '.join(arguments.only)}; a case reads: {cases[0]}")
    return found


def finish(arguments, rows):
    """Writes what --json asks for. Returns the exit code."""
    if arguments.json:
        Path(arguments.json).write_text(json.dumps(rows, indent=2) + "\n")
    return 0 if all(row["agree"] for row in rows) else 1
