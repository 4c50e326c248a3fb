"""Pictures of runs, drawn by views/ (docs/pictures.md)."""
from __future__ import annotations

import functools
import importlib
import sys
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from mortier import _core
from mortier.errors import InputError
from mortier.meshes import cells_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from mortier.run import Run

KINDS = ("fields", "contact", "history")


def figure(run: Run, kind: str, step: _core.Step, field: str, scale: float | None) -> Figure:
    """InputError: no such picture or field, or nothing to draw."""
    if kind not in KINDS:
        raise InputError(f"plot: {kind!r}, expected one of {', '.join(KINDS)}")
    pictures = views()["pictures"]
    view = pictures.View(*seen(run, step), step.number)
    known = view.result.fields(view.run)
    if field not in known:
        raise InputError(f"plot: field {field!r}, expected one of {', '.join(known)}")
    with pictures.plt.rc_context(pictures.STYLE):
        made = pictures.fields([view], field, scale) if kind == "fields" else \
            getattr(views()["curves"], kind)([view])
    if made is None:
        raise InputError("plot: nothing to draw: "
                         f"{'no contact' if kind == 'contact' else 'fewer than two steps'} in this run")
    pictures.plt.close(made)  # it is shown where it is returned, not by pyplot as well
    return made


@functools.cache
def views() -> dict[str, ModuleType]:
    """The modules of views/ by name. They import each other as scripts do: that their names do not stand
    for modules of the user's, they are taken away again."""
    here = Path(__file__).resolve().parent
    home = next((folder for base in (here, *here.parents) for folder in (base, base / "share" / "mortier")
                 if (folder / "views" / "pictures.py").is_file()
                 and (folder / "compare" / "results.py").is_file()), None)
    if home is None:
        raise ImportError("the folders views/ and compare/ of mortier are found neither above "
                          f"{here} nor in share/mortier")
    folders = [home / "views", home / "compare"]
    names = {path.stem for folder in folders for path in folder.glob("*.py")}
    path, theirs = list(sys.path), {name: sys.modules.pop(name) for name in names & set(sys.modules)}
    sys.path[:0] = map(str, folders)
    try:
        return {name: importlib.import_module(name) for name in ("pictures", "curves", "runs", "results")}
    finally:
        sys.path[:] = path
        for name in names & set(sys.modules):
            del sys.modules[name]
        sys.modules.update(theirs)


def seen(run: Run, step: _core.Step) -> tuple[Any, Any]:
    """The runs.Result and the results.Run that views/ would read from files."""
    runs, results = views()["runs"], views()["results"]
    kept = {each.number: each.time for each in (*run.steps, step)}
    result = runs.Result(Path(run.folder or run.summary["scene"]), run.summary, list(kept.items()),
                         run._solution.history)
    bodies = {}
    for name in step.points:
        axes = step.points[name].shape[1]
        kind = "tetrahedra" if axes == 3 else "triangles"
        elements = getattr(step, kind)[name]
        bodies[name] = results.Body(step.displacement[name], step.stress[name], step.points[name],
                                    cells=cells_of(step, name), **{kind: elements[:, :axes + 1]})
        if elements.shape[1] > axes + 1:
            bodies[name].elements = elements
            bodies[name].stress_at_points = step.stress_at_points[name]
    sides = step.contact
    contact = results.contact_of([])
    if sides:
        def of_all(*names: str) -> list[Any]:
            return [np.concatenate([getattr(side, name) for side in sides]) for name in names]
        rough = "friction" in run.summary["verification"]
        contact = results.Contact(*of_all("vertex", "position", "gap", "force", "pressure"),
                                  np.repeat(np.arange(len(sides)), [len(side.vertex) for side in sides]),
                                  *(of_all("friction", "shear", "slipping", "slip") if rough else ()))
    return result, results.Run("mortier", result.folder, bodies, contact, run.summary)
