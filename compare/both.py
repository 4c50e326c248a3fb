"""Both codes on a list of cases: a row each, printed as it is done.
matrix.py and oracle.py say which cases."""
import json
import statistics
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


def compare_all(cases, keep=None):
    """Prints a row a case as it is done, then how much faster mortier is. Returns the rows."""
    print(f"{cases[0].head()}{'displacement':>12} {'stress':>8} {'force':>8} {'gap':>8}  {'mortier[s]':>10} "
          f"{'FreeFEM[s]':>10} {'ratio':>6}  verdict", flush=True)
    rows = []
    with tempfile.TemporaryDirectory(prefix="mortier-compare-") as temporary:
        for case in cases:
            folder = Path(keep or temporary).resolve() / case.folder
            row = case.row | compare_runs(folder, case.settings, case.scene, case.within)
            rows.append(row)
            numbers = "" if "stress" not in row else (
                f"{row['displacement']:>12.1e} {row['stress']:>8.1e} {row['force']:>8.1e} "
                f"{row['gap']:>8.1e}  {row['mortier_s']:>10.2f} {row['freefem_s']:>10.2f} "
                f"{row['ratio']:>6.1f}  ")
            print(f"{case.line}{numbers}{row['verdict']}", flush=True)
    for variant in dict.fromkeys(case.variant for case in cases):
        ratios = [row["ratio"] for case, row in zip(cases, rows) if row["agree"] and case.variant == variant]
        if ratios:
            print(f"wall time FreeFEM/mortier, {variant}: {min(ratios):.1f} to {max(ratios):.1f}, "
                  f"median {statistics.median(ratios):.1f}")
    print(f"{sum(row['agree'] for row in rows)} of {len(rows)} pairs of runs agree")
    return rows


def main(text, cases, quick=None):
    """The command; text: its help. quick: gives fewer cases. Exit code 1 when one pair differs or fails."""
    parser = results.argument_parser(text)
    if quick:
        parser.add_argument("--quick", action="store_true", help="a subset that takes about a minute")
    parser.add_argument("--only", nargs="+", default=[], metavar="WORD",
                        help="cases that contain all of these words")
    parser.add_argument("--keep", metavar="DIR", help="keeps the run folders there")
    parser.add_argument("--json", metavar="FILE", help="writes the rows as JSON")
    given = parser.parse_args()
    every = (quick if quick and given.quick else cases)()
    found = [case for case in every if all(word in str(case).split() for word in given.only)]
    if not found:
        parser.error(f"no case contains {' '.join(given.only)}; a case reads: {every[0]}")
    rows = compare_all(found, given.keep)
    if given.json:
        Path(given.json).write_text(json.dumps(rows, indent=2) + "\n")
    return 0 if all(row["agree"] for row in rows) else 1
