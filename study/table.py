"""study.csv: a row a run, kept from study to study by its key."""
import csv
import os
from pathlib import Path

COSTS = {"wall_time": "wall_time[s]", "processor_time": "processor_time[s]", "memory": "memory[MiB]", "dofs": "dofs",
         "iterations": "iterations"}
AFTER = ("status", "reason", "triangles", "dofs", "time_steps", "iterations", "wall_time[s]", "processor_time[s]",
         "memory[MiB]", "at_once")
DONE = "done"
FAILED = "failed"


def columns(plan):
    axes = dict.fromkeys(axis for case in plan.cases() for axis, _ in case.values)
    return ["key", "sweep", *axes, *AFTER, *(f"error {each.name}" for each in plan.errors)]


def read(path):
    """key -> row of an older study; nothing where there is none."""
    path = Path(path)
    if not path.exists():
        return {}
    with open(path, newline="") as file:
        return {row["key"]: row for row in csv.DictReader(file) if row.get("key") and row.get("status") == DONE}


def rows(plan, measurements):
    """A row a sweep and case; what is not measured yet is left out."""
    result = []
    for sweep in plan.sweeps:
        for case in sweep.cases:
            if (row := measurements.get(plan.key(case))) is not None:
                result.append({**row, "sweep": sweep.name})
    return result


def write(path, plan, measurements):
    """In place of the older file in one go."""
    path = Path(path)
    temporary = path.with_suffix(".csv.tmp")
    with open(temporary, "w", newline="") as file:
        writer = csv.DictWriter(file, columns(plan), restval="", extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows(plan, measurements))
    os.replace(temporary, path)


def number(row, column):
    """A number of a row; None where it has none."""
    try:
        return float(row[column])
    except (KeyError, TypeError, ValueError):
        return None
