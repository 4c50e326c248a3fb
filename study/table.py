"""study.csv: a row a run, kept from study to study by its key."""
import csv
import io
from pathlib import Path

from problems import StudyError

COSTS = {"wall_time": "wall_time[s]", "processor_time": "processor_time[s]", "memory": "memory[MiB]",
         "dofs": "dofs", "iterations": "iterations"}
AFTER = ("status", "reason", "triangles", "dofs", "time_steps", "iterations", "wall_time[s]",
         "processor_time[s]", "memory[MiB]", "at_once")
# of the stress in the energy norm, as the run says it; empty where it does not
CLAIMS = {"estimate": "estimate", "bound": "proved bound"}
DONE = "done"
FAILED = "failed"


def columns(plan):
    axes = dict.fromkeys(axis for case in plan.cases() for axis, _ in case.values)
    return ["key", "sweep", *axes, *AFTER, *CLAIMS, *(f"error {each.name}" for each in plan.errors)]


def is_study(path):
    """Whether a file begins as those of studies do."""
    with open(path, "rb") as file:
        head = file.readline(100000).decode(errors="replace").strip().split(",")
    return head[:2] == ["key", "sweep"] and all(column in head for column in AFTER)


def read(path):
    """key -> row of an older study; nothing where there is none. Rows that are not whole are left out."""
    path = Path(path)
    if not path.exists():
        return {}
    with open(path, newline="", encoding="utf-8", errors="replace") as file:
        try:
            return {row["key"]: row for row in csv.DictReader(file) if row.get("key") and is_done(row)}
        except csv.Error as error:
            raise StudyError(f"{path}: {error}, expected a table of mortier study") from error


def is_done(row):
    values = [column for column in row if column in (*COSTS.values(), *CLAIMS)
              or str(column).startswith("error ")]
    return row.get("status") == DONE and None not in row and \
        all(row[each] == "" or number(row, each) is not None for each in values)


def rows(plan, measurements):
    """A row a sweep and case; what is not measured yet is left out."""
    result = []
    for sweep in plan.sweeps:
        for case in sweep.cases:
            if (row := measurements.get(plan.key(case))) is not None:
                result.append({**row, "sweep": sweep.name})
    return result


def text(plan, measurements):
    file = io.StringIO()
    writer = csv.DictWriter(file, columns(plan), restval="", extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows(plan, measurements))
    return file.getvalue()


def number(row, column):
    """A number of a row; None where it has none."""
    try:
        return float(row[column])
    except (KeyError, TypeError, ValueError):
        return None
