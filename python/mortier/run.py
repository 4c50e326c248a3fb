"""A run that is done: kept steps, history, summary, pictures."""
from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mortier import _core
from mortier.errors import FreeMotion, StepError

if TYPE_CHECKING:
    import meshio
    from matplotlib.figure import Figure

Numbers = NDArray[np.float64]


def finished(solution: _core.Solution) -> Run:
    """StepError, FreeMotion: the program would end with 1 or 3."""
    run = Run(solution)
    if solution.code:
        raise (FreeMotion if solution.code == FreeMotion.exit_code else StepError)(solution.reason, run)
    return run


class Quantity(float):
    """A number that a scene asks for, at the end of a run."""

    error: float | None  # estimated, because of the meshes
    no_estimate: str  # why there is none
    unit: str

    def __new__(cls, value: float, error: float | None = None, no_estimate: str = "",
                unit: str = "") -> Quantity:
        quantity = super().__new__(cls, value)
        quantity.error, quantity.no_estimate, quantity.unit = error, no_estimate, unit
        return quantity


class Run:
    """The result of a run. Arrays are read only; they stay valid when nothing else of the run is left.

    Fields are those of the last step: run.stress is run.steps[-1].stress.
    """

    def __init__(self, solution: Any) -> None:
        self._solution = solution

    @cached_property
    def steps(self) -> list[_core.Step]:
        """Those that were kept: 0, k, 2k ... with output.every = k, and the last one."""
        return list(self._solution.steps)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """summary.json."""
        return dict(json.loads(self._solution.summary))

    @property
    def folder(self) -> str | None:
        """Of the result; None where it is in memory only."""
        return self._solution.folder or None

    @cached_property
    def history(self) -> dict[str, Any]:
        """Column of history.csv without its unit -> an array with an entry a step; `rung` is a list."""
        return {bare(name): column for name, column in self._solution.history.items()}

    @cached_property
    def units(self) -> dict[str, str]:
        """Column of the history -> its unit."""
        return {bare(name): name[len(bare(name)) + 1:-1] for name in self._solution.history}

    @cached_property
    def quantities(self) -> dict[str, Quantity]:
        """Quantity of the scene -> its value at the end, with its estimated `error`; its range and place
        stand in summary["quantities"], its values by steps in the history."""
        return {name: Quantity(each["value"], each.get("estimated_error"), each.get("no_estimate", ""),
                               each["unit"])
                for name, each in self.summary.get("quantities", {}).items()}

    @property
    def last(self) -> _core.Step:
        return self.steps[-1]

    @property
    def time(self) -> float:
        return self.last.time

    @property
    def displacement(self) -> dict[str, Numbers]:
        return self.last.displacement

    @property
    def stress(self) -> dict[str, Numbers]:
        return self.last.stress

    @property
    def von_mises(self) -> dict[str, Numbers]:
        return self.last.von_mises

    @property
    def contact(self) -> list[_core.Contact]:
        return self.last.contact

    def to_meshio(self, step: _core.Step | None = None) -> dict[str, meshio.Mesh]:
        """Body -> mesh with the fields of a step, the last one where none is given."""
        from mortier.meshes import to_meshio
        return to_meshio(step or self.last)

    def plot(self, kind: str = "fields", *, step: _core.Step | None = None, field: str = "von_mises",
             scale: float | None = None) -> Figure:
        """A picture of `mortier plot`: "fields", "contact" or "history". InputError: nothing to draw."""
        from mortier.pictures import figure
        return figure(self, kind, step or self.last, field, scale)

    def _repr_html_(self) -> str:
        summary = self.summary
        final = summary["final"]
        cells: Mapping[str, Any] = {
            "status": summary["status"], "steps": summary["steps"], "unknowns": summary["dofs"],
            f"time [{self.units['time']}]": final["time"],
            f"von Mises stress [{self.units['von_mises_max']}]": final["von_mises_max"],
            f"contact force [{self.units['contact_force']}]": final["contact_force"],
            "estimated error of the stress": summary["accuracy"]["energy_error"],
            **{f"{name} [{each['unit']}]": each["value"]
               for name, each in summary.get("quantities", {}).items()}}
        rows = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(shown(of))}</td></tr>"
                       for name, of in cells.items())
        title = html.escape(summary["title"] or summary["scene"])
        return f"<table><caption>{title}</caption>{rows}</table>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Run, (self._solution,)

    def __repr__(self) -> str:
        steps = self.summary["steps"]
        return (f"<mortier.Run {self.summary['status']}, "
                f"{steps} step{'' if steps == 1 else 's'}, t = {self.time:.6g}>")


def bare(name: str) -> str:
    return re.sub(r"\[.*", "", name)


def shown(of: Any) -> str:
    return f"{of:.6g}" if isinstance(of, float) else str(of)
