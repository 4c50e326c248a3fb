"""What the rows say: series, fitted orders, the Pareto front, costs at equal error."""
from dataclasses import dataclass

import numpy as np

from problems import StudyError
from table import COSTS, DONE, number

ROUNDING = 1e-11  # relative errors below are rounding and tell no order
# The first of these axes that varies is the one along which orders are fitted: the column that tells how fine
# a run is, what the slope is to be multiplied with, and in what the order is.
REFINED = {"steps": ("steps", -1, "k"), "tolerance": ("tolerance", 1, "tolerance"),
           "accuracy": ("accuracy", 1, "accuracy"), "level": ("dofs", -2, "h")}  # h as dofs^(-1/2)
LAST = 3  # points that an extrapolation goes by


@dataclass
class Series:
    """Rows of a sweep that differ in one axis only, in its order."""
    sweep: str
    fixed: dict  # axis -> value, as text
    axis: str  # that runs; "" for a single row
    rows: list

    def values(self, column):
        return np.array([number(row, column) for row in self.rows], float)  # not a number where it has none

    def label(self, shown):
        """The sweep and those fixed axes that tell its series apart."""
        return ", ".join([self.sweep, *(value_text(axis, self.fixed[axis])
                                        for axis in shown.get(self.sweep, ()) if axis in self.fixed)])


def value_text(axis, value):
    return value if axis in ("code", "variant", "projection", "scheme", "linear") else f"{axis} {value}"


def series_of(plan, rows):
    """Every series of the finished rows."""
    return [each for sweep in plan.sweeps
            for each in along(sweep, rows, next((axis for axis in REFINED if axis in varying(sweep)),
                                                (varying(sweep) or [""])[0]))]


def along_levels(plan, rows):
    """Series along the meshes where both meshes and steps vary."""
    return [each for sweep in plan.sweeps
            if "level" in varying(sweep) and set(varying(sweep)) & {"steps", "tolerance"}
            for each in along(sweep, rows, "level")]


def varying(sweep):
    """The axes of a sweep that take more than one value."""
    axes = dict.fromkeys(axis for case in sweep.cases for axis, _ in case.values)
    return [axis for axis in axes if len({dict(case.values)[axis] for case in sweep.cases}) > 1]


def along(sweep, rows, axis):
    """The series of a sweep in which one axis runs."""
    axes = dict.fromkeys(each for case in sweep.cases for each, _ in case.values)
    groups = {}
    for row in rows:
        if row["sweep"] == sweep.name and row["status"] == DONE:
            fixed = {each: str(row[each]) for each in axes if each != axis}
            groups.setdefault(tuple(fixed.items()), []).append(row)
    for members in groups.values():
        members.sort(key=lambda row: (number(row, axis) is None, number(row, axis) or 0,
                                      str(row.get(axis, ""))))
    return [Series(sweep.name, dict(fixed), axis, members) for fixed, members in groups.items()]


def distinguishing(series):
    """sweep -> the fixed axes whose values differ between its series."""
    values = {}
    for each in series:
        for axis, value in each.fixed.items():
            values.setdefault(each.sweep, {}).setdefault(axis, set()).add(value)
    return {sweep: [axis for axis, found in axes.items() if len(found) > 1] for sweep, axes in values.items()}


def slope(x, y):
    """Least squares in logarithms, and how many points it rests on; None below two points."""
    use = np.isfinite(x) & np.isfinite(y) & (x > 0) & (y > ROUNDING)
    if use.sum() < 2 or np.ptp(np.log(x[use])) == 0:
        return None
    return float(np.polyfit(np.log(x[use]), np.log(y[use]), 1)[0]), int(use.sum())


def order(series, error):
    """Order of an error in what the running axis refines: (order, points, in what);
    None where there is none."""
    if series.axis not in REFINED:
        return None
    column, power, what = REFINED[series.axis]
    found = slope(series.values(column), series.values(f"error {error}"))
    return found and (power * found[0], found[1], what)


def front(points):
    """Indices of the points that no other beats in both cost and error, by cost."""
    best, chosen = np.inf, []
    for i in sorted(range(len(points)), key=lambda i: points[i]):
        if points[i][1] < best:
            best = points[i][1]
            chosen.append(i)
    return chosen


@dataclass
class CostAt:
    """What a series costs to reach an error."""
    value: float
    how: str  # "measured", "between runs", "extrapolated", "at most" (all runs are better), "never"


def cost_at(series, error, at, cost):
    """Interpolated in logarithms between runs; beyond the best run by the slope of the last ones."""
    e, c = series.values(f"error {error}"), series.values(COSTS[cost])
    use = np.isfinite(e) & np.isfinite(c) & (c > 0)
    e, c = np.maximum(e[use], 1e-300), c[use]
    if not len(e):
        return CostAt(np.nan, "never")
    reached = np.flatnonzero(e <= at)
    if len(reached):
        i = reached[np.argmin(c[reached])]
        dearer = [j for j in range(len(e)) if e[j] > at and c[j] <= c[i]]
        if not dearer:
            return CostAt(float(c[i]), "measured" if np.isclose(e[i], at) else "at most")
        j = max(dearer, key=lambda j: c[j])
        if e[i] < ROUNDING:
            return CostAt(float(c[i]), "at most")
        part = np.log(at / e[j]) / np.log(e[i] / e[j])
        return CostAt(float(np.exp(np.log(c[j]) + part * np.log(c[i] / c[j]))), "between runs")
    last = np.argsort(c)[-LAST:]
    if len(last) < 2 or np.ptp(np.log(e[last])) == 0:
        return CostAt(np.inf, "never")
    inverse = np.polyfit(np.log(e[last]), np.log(c[last]), 1)
    if inverse[0] >= 0:  # the error does not fall with cost
        return CostAt(np.inf, "never")
    return CostAt(float(np.exp(np.polyval(inverse, np.log(at)))), "extrapolated")


def chosen(series, side):
    """The one series that a comparison means."""
    axes = {axis: str(value) for axis, value in side.items() if axis != "sweep"}
    found = [each for each in series if each.sweep == side["sweep"] and axes.items() <= each.fixed.items()]
    if len(found) != 1:
        raise StudyError(f"compare: {side}: {len(found)} series, expected one")
    return found[0]


def comparisons(plan, series):
    """(comparison, {cost: (dear, cheap)}) of each; the reason in words where a side has no run."""
    result = []
    for each in plan.comparisons:
        try:
            dear, cheap = chosen(series, each.dear), chosen(series, each.cheap)
        except StudyError as error:
            result.append((each, None, str(error)))
            continue
        costs = {cost: (cost_at(dear, each.error, each.at, cost), cost_at(cheap, each.error, each.at, cost))
                 for cost in ("wall_time", "processor_time", "iterations", "dofs")}
        result.append((each, costs, ""))
    return result


def words(side):
    return side["sweep"] + "".join(f", {value_text(axis, value)}" for axis, value in side.items()
                                   if axis != "sweep")


def comparison_text(each, costs, reason):
    """One comparison in lines for the terminal and the report."""
    head = f"{each.error} = {each.at:g}: {words(each.dear)}  over  {words(each.cheap)}"
    if costs is None:
        return [head, f"  not compared: {reason}"]
    lines = [head]
    for cost, (dear, cheap) in costs.items():
        if cost == "dofs" and not (np.isfinite(dear.value) and not np.isclose(dear.value, cheap.value)):
            continue  # the same meshes throughout
        ratio = dear.value / cheap.value if np.isfinite(cheap.value) and cheap.value else np.nan
        name = COSTS[cost].replace("_", " ")
        lines.append(f"  {name:<18} {dear.value:>12.4g} ({dear.how}) / {cheap.value:.4g} ({cheap.how})"
                     + (f" = {ratio:.3g} times" if np.isfinite(ratio) else ""))
    return lines
