#!/usr/bin/python3
"""The final table of a demo: both variants in both codes.

    compare/table.py DIR [--json FILE]

DIR holds mortier-VARIANT and freefem-VARIANT of the compression test, with a file wall_time in each [s]. Exit
code 1 when the codes differ.
"""
import json
import sys
from pathlib import Path

import results
from compare import compare
from exact import top_backward_euler, top_exact

COLUMNS = ("variant", "code", "von Mises min", "von Mises max", "interpenetr.", "u2 on top", "to exact",
           "to Euler", "Newton", "wall[s]", "verdict")
WIDTHS = (13, 7, 13, 13, 12, 15, 8, 8, 6, 7, 0)


def rows_of(folder):
    """The rows, and whether all codes agree."""
    rows = []
    for variant in ("mortar", "interpolation"):
        ours = results.read(folder / f"mortier-{variant}")
        theirs = results.read(folder / f"freefem-{variant}")
        verdict = compare(ours, theirs)
        for run in (ours, theirs):
            rows.append(row_of(variant, run, ours, verdict))
    return rows


def row_of(variant, run, mesh_of, verdict):
    projection, steps = run.summary["projection"], run.summary["steps"]
    top = results.top_displacement(run, mesh_of)
    seconds = run.folder / "wall_time"
    return {
        "variant": variant, "code": run.code, "projection": projection, "steps": steps,
        "von_mises_min": run.scalars["von_mises_min"], "von_mises_max": run.scalars["von_mises_max"],
        "interpenetration": run.scalars["interpenetration"], "top": top,
        "error_exact": top / top_exact(projection) - 1,
        "error_backward_euler": top / top_backward_euler(projection, steps) - 1,
        "newton_iterations": run.summary["newton_iterations"],
        "wall_time_s": float(seconds.read_text()) if seconds.exists() else run.summary["wall_time_s"],
        "agree": verdict.agrees, "verdict": str(verdict)}


def text(rows):
    lines = ["  ".join(name.rjust(width) if i > 1 else name.ljust(width)
                       for i, (name, width) in enumerate(zip(COLUMNS, WIDTHS)))]
    for row in rows:
        cells = (row["variant"], row["code"], f"{row['von_mises_min']:.9f}", f"{row['von_mises_max']:.9f}",
                 f"{row['interpenetration']:.5e}", f"{row['top']:.12f}", f"{abs(row['error_exact']):.1e}",
                 f"{abs(row['error_backward_euler']):.1e}", str(row["newton_iterations"]),
                 f"{row['wall_time_s']:.2f}", row["verdict"])
        lines.append("  ".join(cell.rjust(width) if i > 1 else cell.ljust(width)
                               for i, (cell, width) in enumerate(zip(cells, WIDTHS))))
    return "\n".join(lines)


def notes(rows):
    projection, steps = rows[0]["projection"], rows[0]["steps"]
    return f"""exact     von Mises 10 Pa, no interpenetration, u2 on top {top_exact(projection):.12f} m;
          with {steps} backward Euler steps {top_backward_euler(projection, steps):.12f} m
to exact  relative error of u2 on top against the exact solution (time and space)
to Euler  and against the exact sum of backward Euler's steps (space and solver only)
verdict   mortier against FreeFEM: displacement within 1e-9, stress and contact forces within 1e-8"""


def main():
    parser = results.argument_parser(__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--json", metavar="FILE", help="writes the rows as JSON")
    arguments = parser.parse_args()
    try:
        rows = rows_of(arguments.folder)
    except results.ResultError as error:
        print(f"table: {error}", file=sys.stderr)
        return 2
    print(f"{text(rows)}\n\n{notes(rows)}")
    if arguments.json:
        Path(arguments.json).write_text(json.dumps(rows, indent=2) + "\n")
    return 0 if all(row["agree"] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
