"""mortier study STUDY.toml: error against cost over a sweep of runs (docs/study.md).

Exit codes: 0 done (runs that failed are rows with their reason), 1 no run has a result, or output cannot be
written, 2 wrong input.
"""
import argparse
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "compare")]

import plan as plans  # noqa: E402
from ending import code_of, require, shown  # noqa: E402
from problems import RunFailure  # noqa: E402


def arguments():
    """As the program gives them, which has their help and checks the number of jobs."""
    parser = argparse.ArgumentParser(prog="mortier study")
    parser.add_argument("study")  # -: a run of a study of another machine, from standard input (remote.py)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--scheduler")
    parser.add_argument("--quiet", action="store_true")
    return parser.parse_args()


def study(given, say):
    # 1. The plan, checked as a whole before anything is written.
    require("numpy")
    plan = plans.read(given.study)
    require("matplotlib", "meshio")
    import analysis
    import pictures
    import report
    import table
    from folder import Folder
    from sweep import Here, Runner

    place = None
    if given.scheduler is not None:
        require("distributed")
        from cluster import Workers
        place = Workers(given.scheduler, say)
    out = given.out or Path("out") / plan.path.stem
    with Folder(out) as folder:
        # 2. The runs that are not done yet.
        runner = Runner(plan, folder, place or Here(folder, given.jobs), say)
        measurements = runner.run()
        rows = table.rows(plan, measurements)

        # 3. What they say.
        series, levels = analysis.series_of(plan, rows), analysis.along_levels(plan, rows)
        made, files = pictures.draw(plan, series)
        folder.put_own({**files, "report.html": report.page(plan, rows, series, levels, made,
                                                            files).encode()})
        for label, error, order, step, runs in report.order_rows(plan, [*series, *levels]):
            say(f"order {order} in {step:<9} {error}: {label} ({runs} runs)")
        for found in analysis.comparisons(plan, series):
            for line in analysis.comparison_text(*found):
                say(line)
        failed = sum(row["status"] != table.DONE for row in rows)
        say(f"{out}/report.html: {len(rows)} runs" + (f", {failed} without a result (reasons in study.csv)"
                                                      if failed else ""))
        if failed == len(rows):
            raise RunFailure(f"no run has a result (reasons in {out}/study.csv)")


def main():
    given = arguments()
    out = sys.stdout  # readers of results silence what libraries print, in any thread

    def say(line):
        if not given.quiet:
            print(shown(line), file=out, flush=True)
    if given.study == "-":
        require("numpy")
        import remote
        return code_of(remote.serve, "a run for a study", expected="a task", kept="nothing is kept")
    return code_of(lambda: study(given, say), given.study, expected="a study (docs/study.md)",
                   kept="finished runs are kept", place=given.out or "out")


if __name__ == "__main__":
    sys.exit(main())
