"""mortier plot, report and compare: pictures and a page of results (docs/pictures.md), results beside others
(docs/compare.md).

Exit codes: 0 done, 1 output cannot be written or results differ, 2 wrong input; of a run that fails, its own.
"""
import argparse
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "compare")]

from ending import Wrong, code_of, complain, require, shown  # noqa: E402

PICTURES = ("fields", "contact", "history")
VIEWS = ("front", "top", "contact")


def numbers(count):
    """A reader of `count` finite numbers between commas: a list, of count 1 the number."""
    def read(text):
        try:
            values = [float(word) for word in text.split(",")]
        except ValueError:
            values = []
        if len(values) != count or not all(map(math.isfinite, values)):
            raise argparse.ArgumentTypeError(f"{text}: expected {count} numbers"
                                             if count > 1 else f"{text}: expected a number")
        return values if count > 1 else values[0]
    return read


def a_view(text):
    """front, top, contact, or azimuth and elevation of the eye in degrees."""
    if text in VIEWS:
        return text
    try:
        azimuth, elevation = numbers(2)(text)
        if abs(azimuth) <= 360 and abs(elevation) <= 90:
            return azimuth, elevation
    except argparse.ArgumentTypeError:
        pass
    raise argparse.ArgumentTypeError(f"{text}: expected {', '.join(VIEWS)} or AZIMUTH,ELEVATION in degrees, "
                                     "-360 to 360 and -90 to 90")


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Wrong(f"{message} (see mortier --help)")


def arguments(words):
    parser = Parser(prog="mortier")
    commands = parser.add_subparsers(dest="command", required=True)
    plot = commands.add_parser("plot")
    plot.add_argument("--step", type=int)
    plot.add_argument("--field", default="von_mises")
    plot.add_argument("--scale", type=numbers(1))
    plot.add_argument("--window", type=numbers(4))
    plot.add_argument("--view", type=a_view)
    plot.add_argument("--only", choices=PICTURES)
    plot.add_argument("--animate", action="store_true")
    plot.add_argument("--raw", action="store_true")
    report = commands.add_parser("report")
    for each in (plot, report):
        each.add_argument("--out", type=Path)
        each.add_argument("results", nargs="+")
    compare = commands.add_parser("compare")
    compare.add_argument("--set", action="append", default=[])
    compare.add_argument("--accept")
    compare.add_argument("--against", action="append", default=[])
    compare.add_argument("--within", type=numbers(1))
    compare.add_argument("--picture", type=Path)
    compare.add_argument("scene")
    return parser.parse_args(words)


def plot(given):
    require("numpy", "meshio")
    import runs

    # 1. The runs, and what is wrong with the options before anything is drawn.
    results = [runs.read(folder) for folder in given.results]
    require("matplotlib")
    import contact_surface
    import curves
    import files
    import images
    import pictures
    if len(given.results) > len(curves.OF_RUNS):
        raise Wrong(f"{len(given.results)} results, expected {len(curves.OF_RUNS)} at most")
    space = in_space(results, given)
    if given.view and not space:
        raise Wrong("--view: for results in space only")
    views = [pictures.view(result, given.step) for result in results]
    known = set.intersection(*[set(each.result.fields(each.run)) for each in views])
    if given.field != "none" and given.field not in known:
        ordered = [name for name in views[0].result.fields(views[0].run) if name in known]
        raise Wrong(f"--field {given.field}: expected one of {', '.join([*ordered, 'none'])}")
    if given.window and not (given.window[0] < given.window[1] and given.window[2] < given.window[3]):
        raise Wrong("--window: expected XMIN,XMAX,YMIN,YMAX, each minimum below its maximum")
    if given.animate and max(len(result.kept) for result in results) < 2:
        raise Wrong(f"{given.results[0]}: --animate: one step was kept only (mortier run --set "
                    "output.every=1 keeps all)")
    look = contact_surface.look_of(views[0].run, results[0].interfaces, given.view) if space else None
    if space and look is None:
        raise Wrong(f"{given.results[0]}: --view contact: no contact in this run")
    folder = given.out or files.beside(given.results, ".plots")
    single = folder.suffix[1:] if folder.suffix in (".png", ".svg", ".gif") else None
    if single == "gif" and not given.animate:
        raise Wrong(f"--out {folder}: a .gif is for --animate")
    if given.animate and single in ("png", "svg"):
        raise Wrong(f"--out {folder}: --animate makes a .gif")

    # 2. The pictures.
    made = {}
    with pictures.plt.rc_context(pictures.STYLE):
        if given.animate:
            made[folder if single else folder / "animation.gif"] = images.animation(
                results, given.field, given.scale, given.window, given.raw, look)
        wanted = [] if given.animate and (single or not given.only) else [given.only] if given.only else \
            ["fields"] if single else PICTURES
        for name in wanted:
            figure = {"fields": lambda: pictures.fields(views, given.field, given.scale, given.window,
                                                        raw=given.raw, look=look),
                      "contact": lambda: curves.contact(views),
                      "history": lambda: curves.history(views)}[name]()
            if figure is None:
                if given.only:
                    raise Wrong(f"{given.results[0]}: nothing to draw: "
                                    f"{'no contact' if name == 'contact' else 'fewer than two steps'} in "
                                    "this run")
                continue
            box = images.laid_out(figure)
            for kind in (single,) if single else ("png", "svg"):
                made[folder if single else folder / f"{name}.{kind}"] = images.picture(figure, kind,
                                                                                       bbox_inches=box)
            pictures.plt.close(figure)
    files.put(made)
    for path in made:
        print(shown(path))


def in_space(results, given):
    kinds = {result.space for result in results}
    if len(kinds) == 2:
        raise Wrong(f"{' '.join(given.results)}: results in the plane and in space, expected one kind")
    return True in kinds


def make_report(given):
    require("numpy", "meshio")
    import files
    import report
    import runs

    out = given.out or files.beside(given.results, ".html")
    if out.suffix != ".html":
        raise Wrong(f"--out {out}: expected a file NAME.html")
    found = [runs.read(folder) for folder in given.results]
    space = in_space(found, given)
    if space:
        require("matplotlib")
        import curves
        import three
        if len(found) > len(curves.OF_RUNS):
            raise Wrong(f"{len(found)} results, expected {len(curves.OF_RUNS)} at most")
    page = report.page(found)
    files.put({out: page.encode()})
    still = f"; {three.MISSING}" if space and three.program() is None else ""
    print(f"{shown(out)}: {len(page.encode()) / 1e6:.2f} MB{still}")


def compare(given):
    """0: they agree, 1: they differ; of a run that fails, its own exit code."""
    require("numpy", "meshio", *(["matplotlib"] if given.picture else []))
    import comparison

    if given.within is not None and not given.within > 0:
        raise Wrong("--within: expected a number above 0")
    if given.accept and (given.against or given.picture):
        raise Wrong("--accept: keeps a result and compares nothing, expected no --against or --picture")
    if given.within is not None and not given.against and not given.accept:
        raise Wrong("--within: for --against only; both codes agree to rounding")
    if given.picture and given.picture.suffix not in (".png", ".svg"):
        raise Wrong(f"--picture {given.picture}: expected a file NAME.png or NAME.svg")
    try:
        return comparison.accept(given) if given.accept else comparison.run(given)
    except comparison.CodeFailed as error:
        sys.stderr.write(last_words(str(error)))
        return error.code if error.code in (1, 2, 3) else 1


def last_words(text):
    """The messages of a run that failed, which is the program itself: as they are."""
    lines = text.strip().splitlines()
    return "".join(f"{line}\n" for line in [each for each in lines if each.startswith("mortier: ")]
                   or lines[-8:])


def view(given):
    require("numpy")
    import results
    try:
        return {"plot": plot, "report": make_report, "compare": compare}[given.command](given)
    except results.ResultError as error:
        raise Wrong(error) from error


def main():
    try:
        given = arguments(sys.argv[1:])
    except Wrong as error:
        return complain(error, 2)
    of = given.scene if given.command == "compare" else given.results[0]
    return code_of(lambda: view(given), f"{given.command} {of}", expected="a result of mortier run",
                   kept="nothing was written")


if __name__ == "__main__":
    sys.exit(main())
