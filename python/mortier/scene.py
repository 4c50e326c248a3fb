"""Scenes: read from a file, or made of dicts and arrays."""
from __future__ import annotations

import importlib
import os
import shutil
import tempfile
import weakref
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from numpy.typing import ArrayLike

if TYPE_CHECKING:
    import meshio

from mortier import _core, toml
from mortier.errors import Error, InputError, ResultMissing
from mortier.meshes import Mesh, plain, write_meshio
from mortier.run import Run, finished

Settings = Mapping[str, Any] | Sequence[str] | None
T = TypeVar("T")


class Fault(NamedTuple):
    """What `mortier check` names (docs/check.md)."""

    id: str
    severity: str  # "error" or "warning"
    place: str
    message: str
    remedy: str
    more: int  # of this kind, counted only

    def __str__(self) -> str:
        return f"{self.place}: {self.severity}: {self.message}; {self.remedy} [{self.id}]"


class Scene:
    """A scene as it was when it was read; runs of it begin anew each time, and may go on in several threads.

    Made of a dict that says what a file would (docs/scene.md); bodies whose mesh it leaves out have theirs in
    `meshes`. Paths are relative to the current folder. InputError: what the program would say.
    """

    def __init__(self, scene: Mapping[str, Any],
                 meshes: Mapping[str, Mesh | meshio.Mesh | tuple[ArrayLike, ...]] | None = None,
                 set: Settings = None) -> None:
        folder = Path(tempfile.mkdtemp(prefix="mortier-"))
        self._folder = str(folder)
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        bodies = bodies_of(scene)
        known = [body.get("name") for body in bodies]
        for name, mesh in (meshes or {}).items():
            if name not in known:
                raise InputError(f"meshes: no body {name}, expected one of {', '.join(map(str, known))}")
            body = bodies[known.index(name)]
            body["mesh"] = self._written(folder / f"mesh-{known.index(name)}", mesh, f"mesh of {name}",
                                         body.get("mesh"))
        for body in bodies:
            if body.get("name") not in (meshes or {}):
                body["mesh"] = absolute(body.get("mesh"))
        start = {"start": absolute(scene["start"])} if "start" in scene else {}
        path = folder / "scene.toml"
        path.write_text(toml.document({**scene, **start, "body": bodies}), encoding="utf-8")
        self._read(str(path), set)

    @staticmethod
    def _written(path: Path, mesh: Any, of: str, asked: Any) -> Any:
        """The mesh of a body in a file, and what its table `mesh` says of it."""
        if hasattr(mesh, "cells_dict"):
            table = {key: each for key, each in dict(asked or {}).items() if key == "region"}
            write_meshio(path.with_suffix(".msh"), mesh, of, table.get("region"))
            return {**table, "file": path.with_suffix(".msh").name}
        arrays, names = plain(mesh, of)
        path = path.with_suffix(".mesh")
        _core.write_mesh(str(path), of, *arrays)
        with path.open("a", encoding="utf-8") as file:
            file.writelines(f"# {kind} {number} = {each}\n" for kind, each, number in names)
        return path.name

    @classmethod
    def from_meshio(cls, scene: Mapping[str, Any], meshes: Mapping[str, meshio.Mesh] | meshio.Mesh,
                    set: Settings = None) -> Scene:
        """A scene whose bodies have meshes of meshio: triangles, and lines with labels (physical groups of
        Gmsh, references of Medit, cell sets); in space tetrahedra and triangles. One mesh alone is that of
        all bodies, each of which names its `region`.
        """
        if not isinstance(meshes, Mapping):
            meshes = {each.get("name", ""): meshes for each in bodies_of(scene)}
        return cls(scene, meshes, set)

    @classmethod
    def from_gmsh(cls, scene: Mapping[str, Any], set: Settings = None) -> Scene:
        """A scene on the meshed model of the running gmsh (its Python module), with its physical groups: each
        body without `mesh` is the region of its name, or the one that `mesh = {"region": ...}` names."""
        gmsh = importlib.import_module("gmsh")
        bodies = bodies_of(scene)
        folder = tempfile.mkdtemp(prefix="mortier-")
        try:
            path = os.path.join(folder, "model.msh")
            gmsh.write(path)
            for each in bodies:
                each["mesh"] = {"region": each.get("name", ""), **each.get("mesh", {}), "file": path}
            made = cls({**scene, "body": bodies}, set=set)
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        weakref.finalize(made, shutil.rmtree, folder, ignore_errors=True)
        return made

    def _read(self, path: str, set: Settings) -> None:
        self._core = self._told(lambda: _core.Scene(path, toml.settings(set)))

    def _told(self, work: Callable[[], T]) -> T:
        """Messages of a scene that is no file of the user's name it without its folder."""
        try:
            return work()
        except Error as error:
            error.args = (self._shown(str(error)),)
            raise

    def _shown(self, text: str) -> str:
        return text if self._folder is None else text.replace(self._folder + os.sep, "")

    _folder: str | None = None  # of a scene that is no file of the user's

    @property
    def path(self) -> str:
        return self._core.path

    @property
    def text(self) -> str:
        """TOML, as it was read."""
        return self._core.text

    def check(self) -> list[Fault]:
        """What is wrong or doubtful."""
        return [fault._replace(place=self._shown(fault.place), message=self._shown(fault.message))
                for fault in check(self.path, self._core.settings)]

    def run(self, out: str | os.PathLike[str] | None = None, *, threads: int = 1,
            checkpoint: float = 30) -> Run:
        """Solves it; with `out` the result is in that folder too, as of `mortier run --out`.

        StepError, FreeMotion: with `.run`, what was reached. OutputError.
        """
        return self._told(lambda: finished(_core.run(self._core, "" if out is None else os.fspath(out),
                                                     threads, checkpoint, False)))

    def steps(self, *, threads: int = 1) -> Iterator[_core.Step]:
        """The steps, the initial state first, each as it is done.

        Where steps are chosen by their error or meshes are refined, all of them when the run is done: before,
        they may be done again. StepError, FreeMotion: after the last good step.
        """
        if self._core.is_adaptive:
            solution = self._told(lambda: _core.run(self._core, "", threads, 30, True))
            yield from solution.steps
            self._told(lambda: finished(solution))
            return
        steps = _core.Steps(self._core, threads)
        while (step := self._told(steps.next)) is not None:
            yield step
        self._told(lambda: finished(steps.solution))

    def __repr__(self) -> str:
        return f"<mortier.Scene {self._core.title or Path(self.path).name!r}>"


def load(path: str | os.PathLike[str], set: Settings = None) -> Scene:
    """Reads a scene; `set` changes it as --set does: {"time.steps": 20}. InputError."""
    scene = Scene.__new__(Scene)
    try:
        scene._read(os.fspath(path), set)
    except InputError as error:
        raise error if os.path.exists(path) else ResultMissing(str(error)) from error
    return scene


def check(path: str | os.PathLike[str], set: Settings = None) -> list[Fault]:
    """What is wrong or doubtful in a scene, which need not be one that can be read."""
    return [Fault(**each) for each in _core.check(os.fspath(path), toml.settings(set))]


def bodies_of(scene: Mapping[str, Any]) -> list[dict[str, Any]]:
    bodies = scene.get("body", [])
    return [dict(body) for body in ([bodies] if isinstance(bodies, Mapping) else bodies)]


def absolute(mesh: Any) -> Any:
    """The scene stands in another folder than what it names."""
    if isinstance(mesh, (str, os.PathLike)):
        return os.path.abspath(mesh)
    if isinstance(mesh, Mapping) and "file" in mesh:
        return {**mesh, "file": os.path.abspath(mesh["file"])}
    return mesh
