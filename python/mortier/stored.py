"""Results without a solver: read from the folder of a run, or copied out of its memory to be pickled."""
from __future__ import annotations

import copyreg
import json
import os
from collections.abc import Callable
from dataclasses import make_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mortier import _core
from mortier.errors import InputError, ResultMissing
from mortier.run import Run, bare

FIELDS = ("points", "regions", "displacement", "stress", "stress_at_points", "von_mises",
          "viscoplastic_strain", "viscoplastic", "error")
NODAL = ("vertex", "gap", "force", "pressure", "friction", "shear", "slip", "slipping")


def record(name: str, *fields: str) -> Any:
    """A class with these members, as the one of _core."""
    return make_dataclass(name, fields, namespace={"__module__": __name__})


StoredContact = record("StoredContact", "nonmortar", "mortar", "position", *NODAL)
StoredStep = record("StoredStep", "number", "time", "values", *FIELDS, "contact", "triangles", "tetrahedra")
StoredSolution = record("StoredSolution", "steps", "history", "summary", "folder", "code", "reason")


def copied(arrays: dict[str, Any]) -> dict[str, Any]:
    return {name: np.array(array) for name, array in arrays.items()}


def contact_of(side: Any) -> Any:
    return StoredContact(side.nonmortar, side.mortar, np.array(side.position),
                         *(np.array(getattr(side, name)) for name in NODAL))


def step_of(step: Any) -> Any:
    """In space there are no triangles, in the plane no tetrahedra."""
    space = any(points.shape[1] == 3 for points in step.points.values())
    return StoredStep(step.number, step.time, dict(step.values),
                      *(copied(getattr(step, name)) for name in FIELDS),
                      [contact_of(side) for side in step.contact],
                      {} if space else copied(step.triangles), copied(step.tetrahedra) if space else {})


def solution_of(solution: Any) -> Any:
    history = {name: list(column) if isinstance(column, list) else np.array(column)
               for name, column in solution.history.items()}
    return StoredSolution([step_of(step) for step in solution.steps], history, solution.summary,
                          solution.folder, solution.code, solution.reason)


def pickled_as(copy: Callable[[Any], Any]) -> Any:
    def reduce(of: Any) -> tuple[Any, ...]:
        stored = copy(of)
        return type(stored), tuple(vars(stored).values())
    return reduce


copyreg.pickle(_core.Contact, pickled_as(contact_of))
copyreg.pickle(_core.Step, pickled_as(step_of))
copyreg.pickle(_core.Solution, pickled_as(solution_of))


def open_result(folder: str | os.PathLike[str]) -> Run:
    """The result of `mortier run` in a folder, also of a run that stopped early (OUT.failed).

    ResultMissing: no such folder. InputError: no result of a run.
    """
    return Run(read(folder))


def read(folder: str | os.PathLike[str]) -> Any:
    from mortier.pictures import views
    results = views()["results"]
    place = Path(folder)
    if not place.is_dir():
        raise ResultMissing(f"{folder}: no such folder, expected a result of mortier run")
    try:
        summary = results.read_summary(place, failed=True)
        history = results.read_history(place)
        tables = results.contact_tables(place)
        steps = [step_at(results.mortier_run(place, summary, tables, number), history, number, time)
                 for number, time in results.kept_steps(place)]
    except (results.ResultError, KeyError, TypeError, ValueError) as error:
        raise InputError(str(error) if isinstance(error, results.ResultError)
                         else f"{folder}: {error!r}, expected a result of mortier run") from error
    code = {"failed": 1, "unheld": 3}.get(summary["status"], 0)
    return StoredSolution(steps, history, json.dumps(summary), str(place), code, summary.get("reason", ""))


def step_at(run: Any, history: dict[str, Any], number: int, time: float) -> Any:
    """run: results.Run."""
    def of(values: Callable[[Any], Any]) -> dict[str, Any]:
        return {name: values(body) for name, body in run.bodies.items()}

    def cells(name: str) -> dict[str, Any]:
        return of(lambda body: body.cells[name])

    space = any(body.tetrahedra is not None for body in run.bodies.values())
    elements = of(lambda body: body.simplices if body.elements is None else body.elements)
    row = next((i for i, each in enumerate(history["step"]) if each == number), None)
    return StoredStep(
        number, time, {} if row is None else {bare(name): column[row] for name, column in history.items()},
        of(lambda body: body.points), cells("region"),
        of(lambda body: body.displacement), of(lambda body: body.stress),
        of(lambda body: body.stress[:, None] if body.stress_at_points is None else body.stress_at_points),
        *map(cells, FIELDS[5:]),
        [side_of(run.contact, index, each) for index, each in enumerate(run.summary["interfaces"])],
        {} if space else elements, elements if space else {})


def side_of(contact: Any, index: int, interface: dict[str, str]) -> Any:
    """The rows of one interface of results.Contact; what it has no column of is 0."""
    rows = contact.interface == index
    columns = {name: getattr(contact, name) for name in NODAL}
    axes = contact.position.shape[1]

    def none(name: str) -> Any:
        along = axes == 3 and name in ("friction", "shear", "slip")
        return np.zeros((rows.sum(), 3) if along else rows.sum())
    found = {name: none(name) if of is None else of[rows] for name, of in columns.items()}
    return StoredContact(interface["nonmortar"], interface["mortar"], contact.position[rows],
                         **{name: of.astype(np.int32 if name in ("vertex", "slipping") else float)
                            for name, of in found.items()})
