"""Results without a solver: read from the folder of a run, or copied out of its memory to be pickled."""
from __future__ import annotations

import copyreg
import json
import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from mortier import _core
from mortier.errors import InputError, ResultMissing
from mortier.run import Run, bare

FIELDS = ("points", "regions", "displacement", "stress", "stress_at_points", "von_mises",
          "viscoplastic_strain", "viscoplastic", "error")
NODAL = ("vertex", "gap", "force", "pressure", "friction", "shear", "slip", "slipping")


@dataclass
class StoredContact:
    """As _core.Contact."""

    nonmortar: str
    mortar: str
    position: Any
    vertex: Any
    gap: Any
    force: Any
    pressure: Any
    friction: Any
    shear: Any
    slip: Any
    slipping: Any


@dataclass
class StoredStep:
    """As _core.Step."""

    number: int
    time: float
    values: dict[str, Any]
    points: dict[str, Any]
    regions: dict[str, Any]
    displacement: dict[str, Any]
    stress: dict[str, Any]
    stress_at_points: dict[str, Any]
    von_mises: dict[str, Any]
    viscoplastic_strain: dict[str, Any]
    viscoplastic: dict[str, Any]
    error: dict[str, Any]
    contact: list[StoredContact]
    triangles: dict[str, Any] = field(default_factory=dict)  # none in space
    tetrahedra: dict[str, Any] = field(default_factory=dict)  # none in the plane


@dataclass
class StoredSolution:
    """As _core.Solution."""

    steps: list[StoredStep]
    history: dict[str, Any]
    summary: str
    folder: str
    code: int = 0
    reason: str = ""


def copied(arrays: dict[str, Any]) -> dict[str, Any]:
    return {name: np.array(array) for name, array in arrays.items()}


def contact_of(side: Any) -> StoredContact:
    return StoredContact(side.nonmortar, side.mortar, np.array(side.position),
                         *(np.array(getattr(side, name)) for name in NODAL))


def step_of(step: Any) -> StoredStep:
    fields: Any = {name: copied(getattr(step, name)) for name in FIELDS}
    kind = "tetrahedra" if in_space(step) else "triangles"
    return StoredStep(step.number, step.time, dict(step.values), **fields,
                      contact=[contact_of(side) for side in step.contact],
                      **{kind: copied(getattr(step, kind))})


def in_space(step: Any) -> bool:
    return any(points.shape[1] == 3 for points in step.points.values())


def solution_of(solution: Any) -> StoredSolution:
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


def read(folder: str | os.PathLike[str]) -> StoredSolution:
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


def step_at(run: Any, history: dict[str, Any], number: int, time: float) -> StoredStep:
    """run: results.Run."""
    bodies = run.bodies
    space = any(body.tetrahedra is not None for body in bodies.values())

    def cells(name: str) -> dict[str, Any]:
        return {body: each.cells[name] for body, each in bodies.items()}

    at_points = {name: each.stress[:, None] if each.stress_at_points is None else each.stress_at_points
                 for name, each in bodies.items()}
    row = next((i for i, each in enumerate(history["step"]) if each == number), None)
    return StoredStep(
        number, time, {} if row is None else {bare(name): column[row] for name, column in history.items()},
        {name: each.points for name, each in bodies.items()},
        cells("region"), {name: each.displacement for name, each in bodies.items()},
        {name: each.stress for name, each in bodies.items()}, at_points,
        cells("von_mises"), cells("viscoplastic_strain"), cells("viscoplastic"), cells("error"),
        [side_of(run.contact, index, each) for index, each in enumerate(run.summary["interfaces"])],
        **{"tetrahedra" if space else "triangles":
           {name: each.simplices if each.elements is None else each.elements
            for name, each in bodies.items()}})


def side_of(contact: Any, index: int, interface: dict[str, str]) -> StoredContact:
    """The rows of one interface of results.Contact; what it has no column of is 0."""
    rows = contact.interface == index
    columns = {name: getattr(contact, name) for name in NODAL}
    found = {name: np.zeros(rows.sum()) if of is None else of[rows] for name, of in columns.items()}
    return StoredContact(interface["nonmortar"], interface["mortar"], contact.position[rows],
                         **{name: of.astype(np.int32 if name in ("vertex", "slipping") else float)
                            for name, of in found.items()})
