"""mortier study STUDY.toml: error against cost over a sweep of runs (docs/study.md).

Exit codes: 0 done (runs that failed are rows with their reason), 1 no run has a result, or output cannot be written,
2 wrong input.
"""
import argparse
import importlib
import os
import signal
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import plan as plans  # noqa: E402
from problems import RunFailure, StudyError, shown  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(prog="mortier study", description=__doc__.splitlines()[0])
    parser.add_argument("study", metavar="STUDY", help="study, a TOML file")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder of the result (default: out/ and the study's name)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N",
                        help="runs at once (default: one a processor; wall times count only with 1)")
    parser.add_argument("--quiet", action="store_true", help="prints nothing but errors")
    found = parser.parse_args()
    if found.jobs < 1:
        parser.error(f"--jobs {found.jobs}: expected an integer >= 1")
    return found


def require(*modules):
    """Debian's packages of Python modules; another Python may lack them."""
    for module in modules:
        try:
            importlib.import_module(module)
        except ImportError as error:
            raise RunFailure(f"the Python module {module} is missing (Debian package python3-{module})") from error


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
    from sweep import Runner

    out = given.out or Path("out") / plan.path.stem
    with Folder(out) as folder:
        # 2. The runs that are not done yet.
        runner = Runner(plan, folder, given.jobs, say)
        measurements = runner.run()
        rows = table.rows(plan, measurements)

        # 3. What they say.
        series, levels = analysis.series_of(plan, rows), analysis.along_levels(plan, rows)
        made, files = pictures.draw(plan, series)
        folder.put_own({**files, "report.html": report.page(plan, rows, series, levels, made, files).encode()})
        for label, error, order, step, runs in report.order_rows(plan, [*series, *levels]):
            say(f"order {order} in {step:<9} {error}: {label} ({runs} runs)")
        for found in analysis.comparisons(plan, series):
            for line in analysis.comparison_text(*found):
                say(line)
        failed = sum(row["status"] != table.DONE for row in rows)
        say(f"{out}/report.html: {len(rows)} runs" + (f", {failed} without a result (reasons in study.csv)" if failed else ""))
        if failed == len(rows):
            raise RunFailure(f"no run has a result (reasons in {out}/study.csv)")
        return 0


def interrupt(*_):
    raise KeyboardInterrupt


def main():
    given = arguments()
    signal.signal(signal.SIGTERM, interrupt)
    try:
        return study(given, (lambda line: None) if given.quiet else lambda line: print(shown(line), flush=True))
    except StudyError as error:
        return complain(error, 2)
    except RunFailure as error:
        return complain(f"{given.study}: {error}", 1)
    except OSError as error:
        return complain(f"{given.study}: {error.filename or given.out or 'out'}: {error.strerror or error}", 1)
    except RecursionError:
        return complain(f"{given.study}: nested too deeply, expected a study (docs/study.md)", 2)
    except KeyboardInterrupt:
        return complain(f"{given.study}: interrupted; finished runs are kept", 1)
    except Exception as error:  # a fault of this program
        return complain(f"{given.study}: {type(error).__name__}: {error}; please report this", 1)


def complain(text, code):
    print(f"mortier: {shown(text)}", file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
