"""Results of both codes, read into the same form: fields by vertex and triangle, contact by node, scalars.

A run folder of mortier is described in docs/results.md, one of FreeFEM in freefem/README.md. Whatever is
missing, cut short or not finite is a ResultError with the file's name.
"""
import argparse
import contextlib
import csv
import io
import json
import math
import os
import re
import stat
import threading
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np


def argument_parser(text):
    """Options of a script whose help is its docstring."""
    return argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)


class ResultError(Exception):
    """A run folder that cannot be read, or that holds no finished run."""


LARGEST = 1e300  # beyond it, sums and differences of a few numbers overflow
FINAL = ("time", "von_mises_min", "von_mises_max", "interpenetration", "contact_force", "active_nodes")


def von_mises(*components):
    """Of stresses, in the order of the files."""
    if len(components) == 6:
        s11, s22, s33, s12, s23, s13 = components
    else:
        s11, s22, s12, s33, s23, s13 = (*components, *[0.0] * (6 - len(components)))
    return np.sqrt(((s11 - s22)**2 + (s22 - s33)**2 + (s33 - s11)**2) / 2 + 3 * (s12**2 + s23**2 + s13**2))


@dataclass
class Body:
    displacement: np.ndarray  # vertices x 2, or x 3 in space [m]
    # triangles x 3: s11, s22, s12 [Pa]; x 4 in plane strain, s33; tetrahedra x 6: s11, s22, s33, s12, s23,
    # s13
    stress: np.ndarray
    # vertices x 2 or 3, as meshed [m]; behind them the middles of quadratic elements; None where the code
    # does not write it
    points: np.ndarray = None
    triangles: np.ndarray = None  # triangles x 3, numbers of the corners
    elements: np.ndarray = None  # x 6, or 10 in space, middles behind corners; None where they are linear
    stress_at_points: np.ndarray = None  # x 3 points, or 4, x components [Pa]; of quadratic elements only
    cells: dict = field(default_factory=dict)  # name -> all values by triangle that the code writes
    rigid: bool = False  # a tool: no stress of it is written, and zeros stand for it here
    tetrahedra: np.ndarray = None  # of a body in space, which has no triangles: x 4, numbers of the corners

    @property
    def simplices(self):
        """Triangles, or the tetrahedra of a body in space."""
        return self.triangles if self.tetrahedra is None else self.tetrahedra

    @property
    def von_mises(self):
        return von_mises(*self.stress.T)


@dataclass
class Contact:
    """Nodes in the order of the contact line; in space in that of the vertices."""
    vertex: np.ndarray  # of the nonmortar mesh, from 0
    position: np.ndarray  # nodes x 2 or 3, as meshed [m]
    gap: np.ndarray  # positive: apart [m]
    force: np.ndarray  # nodal [N/m]
    pressure: np.ndarray = None  # [Pa]; None where the code does not write it
    interface: np.ndarray = None  # from 0; None where the code does not write it
    # None where no interface has friction or the code does not write it; in space vectors, nodes x 3
    friction: np.ndarray = None  # nodal, along the line [N/m]
    shear: np.ndarray = None  # [Pa]
    slipping: np.ndarray = None  # sign of the shear stress where it slipped in the last step, else 0
    slip: np.ndarray = None  # relative tangential displacement [m]


@dataclass
class Run:
    code: str  # mortier, FreeFEM
    folder: Path
    bodies: dict  # name -> Body
    contact: Contact
    summary: dict
    wall_time: float = math.nan  # of the whole process, where it was measured [s]
    scalars: dict = field(default_factory=dict)  # name -> number, all of one step


def read(folder):
    """A run of either code."""
    folder = Path(folder)
    if not folder.is_dir():
        raise ResultError(f"{folder}: no such folder")
    return read_freefem(folder) if read_summary(folder).get("code") == "FreeFEM" else read_mortier(folder)


def read_mortier(folder, step=None, failed=False):
    """A kept step of a run of mortier, the last one where none is named; failed:
    of a run that stopped early as well."""
    folder = Path(folder)
    summary = read_summary(folder, failed)
    tables = contact_tables(folder)
    return mortier_run(folder, summary, tables, summary.get("steps", 0) if step is None else step)


def mortier_run(folder, summary, tables, step):
    """One step of a run; tables are contact_tables."""
    bodies = {b["name"]: read_vtu(folder / f"{b['name']}_{step:06d}.vtu") for b in body_list(folder, summary)}
    components = min((body.stress.shape[-1] for body in bodies.values() if not body.rigid), default=3)
    for body in bodies.values():
        body.stress = body.stress[:, :components] if body.rigid else body.stress
    for description in summary["bodies"]:
        require_shape(folder, description["name"], bodies[description["name"]], description,
                      summary.get("plane") == "space")
    for name, body in bodies.items():
        require_mesh(folder, name, body)
    return finished(Run("mortier", folder, bodies, tables.get(step, contact_of([])), summary))


def kept_steps(folder):
    """(step, time) of those that a run of mortier has kept, from the collection that ParaView opens."""
    path, kept = Path(folder) / "fields.pvd", {}
    try:
        for entry in xml.parse(checked(path)).getroot().iter("DataSet"):
            name = entry.get("file", "")
            file = re.fullmatch(r"[\w-]+_(\d{6,10})\.vtu", name, re.ASCII)
            if file is None:
                raise ResultError(f"{path}: file {name[:60]!r}, expected BODY_STEP.vtu in the same folder")
            kept[int(file[1])] = float(entry.get("timestep", "nan"))
    except (OSError, xml.ParseError, ValueError) as error:
        raise ResultError(f"{path}: {error}") from error
    if not kept or not np.isfinite(list(kept.values())).all():
        raise ResultError(f"{path}: names no step of a run")
    return sorted(kept.items())


def contact_tables(folder):
    """step -> Contact, of all that contact.csv holds."""
    rows = {}
    path = Path(folder) / "contact.csv"
    try:
        for row in read_csv(path):
            rows.setdefault(int(row["step"]), []).append(row)
        return {step: contact_of(each) for step, each in rows.items()}
    except (KeyError, TypeError, ValueError) as error:
        raise ResultError(f"{path}: {error!r}, expected a table of mortier run") from error


def contact_of(rows):
    def column(name):
        return np.array([float(row[name]) for row in rows])

    def along_contact(name):
        if rows and f"{name}_x" in rows[0]:
            return np.column_stack([column(f"{name}_{x}") for x in "xyz"])
        return column(name) if rows and name in rows[0] else None
    axes = "xyz" if rows and "z" in rows[0] else "xy"
    return Contact(column("vertex").astype(int), np.column_stack([column(x) for x in axes]), column("gap"),
                   column("force"), column("pressure"), column("interface").astype(int),
                   *map(along_contact, ("friction", "shear", "slipping", "slip")))


def read_history(folder):
    """history.csv: column -> numbers, one a step; `rung` is text. Units stand in the names: `time[s]`."""
    path = Path(folder) / "history.csv"
    rows = read_csv(path)
    try:
        history = {name: [row[name] for row in rows] if name == "rung"
                   else np.array([float(row[name]) for row in rows])
                   for name in (rows[0] if rows else ())}
    except (KeyError, TypeError, ValueError) as error:
        raise ResultError(f"{path}: {error!r}, expected a table of mortier run") from error
    for name, values in history.items():
        if name != "rung":
            require_finite(folder, f"history.csv: {name}", values)
    return history


def read_freefem(folder):
    """A run of the FreeFEM method."""
    folder = Path(folder)
    summary = read_summary(folder)
    dimension = 3 if summary.get("dimension") == 3 else 2
    components = (6,) if dimension == 3 else (3, 4)
    bodies = {b["name"]: Body(read_table(folder / f"{b['name']}.displacement.txt", dimension),
                              read_table(folder / f"{b['name']}.stress.txt", *components))
              for b in body_list(folder, summary)}
    for name, body in bodies.items():
        if (path := folder / f"{name}.stress_at_points.txt").exists():
            table = read_table(path, 9, 12)
            body.stress_at_points = table.reshape(len(table), 3, -1)
    table = read_table(folder / "contact.txt", *((6,) if dimension == 3 else (5, 6)))
    vertex, position, gap, force, *friction = np.split(table, [1, *range(1 + dimension, table.shape[1])], 1)
    contact = Contact(vertex[:, 0].astype(int), position, gap[:, 0], force[:, 0],
                      friction=friction[0][:, 0] if friction else None)
    return finished(Run("FreeFEM", folder, bodies, contact, summary))


def body_list(folder, summary):
    """The bodies of summary.json, of which names of files are made."""
    bodies = summary.get("bodies")
    if not isinstance(bodies, list) or not bodies:
        raise ResultError(f"{folder / 'summary.json'}: no bodies")
    for body in bodies:
        if not isinstance(body, dict) or not re.fullmatch(r"[\w-]+", str(body.get("name")), re.ASCII):
            raise ResultError(f"{folder / 'summary.json'}: a body without a name")
    return bodies


def finished(run):
    if len(run.contact.vertex) == 0 and run.summary.get("interfaces") != []:
        raise ResultError(f"{run.folder}: no contact nodes of the last step")
    for name, body in run.bodies.items():
        require_finite(run.folder, f"displacement of {name}", body.displacement)
        require_finite(run.folder, f"stress of {name}", body.stress)
    for name in ("force", "gap", "friction", "shear", "slipping", "slip", "position"):
        if getattr(run.contact, name) is not None:
            require_finite(run.folder, f"{name} of contact nodes", getattr(run.contact, name))
    try:
        final = run.summary["final"]
        for key in FINAL:
            run.scalars[key] = float(final[key])
        for key in ("displacement_min", "displacement_max"):
            components = next(iter(run.bodies.values())).displacement.shape[1]
            for axis, value in zip("xyz"[:components], final[key], strict=True):
                run.scalars[f"{key}_{axis}"] = float(value)
        run.scalars["steps"] = float(run.summary["steps"])
    except (KeyError, TypeError, ValueError) as error:
        raise ResultError(f"{run.folder / 'summary.json'}: {error!r}") from error
    require_finite(run.folder, "scalars of summary.json", np.array(list(run.scalars.values())))
    return run


def top_displacement(run, mesh_of):
    """Mean u2 of the nodes on top [m]; `mesh_of` is a run of the same meshes that knows their points."""
    top = max(body.points[:, 1].max() for body in mesh_of.bodies.values())
    values = [run.bodies[name].displacement[body.points[:, 1] == top, 1]
              for name, body in mesh_of.bodies.items()]
    return float(np.mean(np.concatenate(values)))


def checked(path, times=10):
    """The path of a regular file that can be read; its size, `times` over, must fit into memory."""
    most = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // times
    try:
        facts = os.stat(path)
    except OSError as error:
        raise ResultError(f"{path}: cannot be read: {error.strerror}") from error
    if not stat.S_ISREG(facts.st_mode):
        raise ResultError(f"{path}: no regular file")
    if facts.st_size > most:
        raise ResultError(f"{path}: {facts.st_size / 1e9:.3g} GB, expected {most / 1e9:.3g} at most "
                          "(by the memory of this machine)")
    return path


def read_json(path):
    try:
        return json.loads(checked(path).read_text(encoding="utf-8"),
                          parse_constant=lambda word: not_finite(path, word))
    except OSError as error:
        raise ResultError(f"{path}: cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise ResultError(f"{path}: {error}") from error


def read_summary(folder, failed=False):
    """failed: a run that stopped early will do."""
    path = Path(folder) / "summary.json"
    summary = read_json(path)
    if not isinstance(summary, dict) or not isinstance(summary.get("steps", 0), int):
        raise ResultError(f"{path}: no summary of a run")
    if summary.get("status") != "converged" and not (failed
                                                     and summary.get("status") in ("failed", "unheld")):
        raise ResultError(f"{path}: status {summary.get('status')}, expected converged")
    return summary


def not_finite(path, word):
    raise ResultError(f"{path}: {word}, expected a number")


def read_csv(path):
    try:
        with open(checked(path), newline="") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        raise ResultError(f"{path}: {error.strerror}") from error
    except (csv.Error, ValueError) as error:
        raise ResultError(f"{path}: {error}") from error
    for number, row in enumerate(rows, 1):
        if None in row or None in row.values():  # as DictReader marks them
            raise ResultError(f"{path}: row {number} has not as many cells as there are columns")
    return rows


def read_table(path, *columns):
    """Numbers, one line an item, so many in a line."""
    try:
        if os.stat(checked(path)).st_size == 0:
            return np.empty((0, columns[0]))
        table = np.loadtxt(checked(path), ndmin=2)
    except (OSError, ValueError) as error:
        raise ResultError(f"{path}: {error}") from error
    if table.shape[1] not in columns:
        raise ResultError(f"{path}: {table.shape[1]} columns, expected {' or '.join(map(str, columns))}")
    return table


silenced = threading.Lock()  # the standard output is one for all threads
CELLS = ("triangle", "triangle6", "tetra", "tetra10")


def with_meshio(path, use=lambda mesh: mesh):
    """What use() makes of a mesh file."""
    import meshio  # slow to load, and FreeFEM's results do without

    checked(path, times=4)
    try:
        # it prints as well
        with silenced, contextlib.redirect_stdout(io.StringIO()), \
                contextlib.redirect_stderr(io.StringIO()):
            mesh = meshio.read(path)
        return use(mesh)
    except (Exception, SystemExit) as error:  # meshio ends the process on some faults
        raise ResultError(f"{path}: cannot be read: {error!r}") from error


def read_vtu(path):
    def body_of(mesh):
        elements = next(mesh.cells_dict[kind] for kind in CELLS if kind in mesh.cells_dict)
        corners, components = (3, 4) if elements.shape[1] in (3, 6) else (4, 6)
        cells = {name: values[0] for name, values in mesh.cell_data.items()}
        if rigid := "stress" not in cells:
            count, scalars = len(elements), ("von_mises", "viscoplastic", "error")
            cells |= {"stress": np.zeros((count, components)),
                      "viscoplastic_strain": np.zeros((count, components)),
                      **{name: np.zeros(count) for name in scalars}}
            if elements.shape[1] > corners:
                cells["stress_at_points"] = np.zeros((count, corners * components))
        axes = corners - 1
        body = Body(mesh.point_data["displacement"][:, :axes], cells["stress"], mesh.points[:, :axes],
                    **{"triangles" if axes == 2 else "tetrahedra": elements[:, :corners]},
                    cells=cells, rigid=rigid)
        if elements.shape[1] > corners and "stress_at_points" in cells:
            body.elements = elements
            body.stress_at_points = cells["stress_at_points"].reshape(len(elements), corners, -1)
        return body
    return with_meshio(path, body_of)


def require_shape(folder, name, body, described, space):
    kind, axes, components = ("tetrahedra", 3, (6,)) if space else ("triangles", 2, (3, 4))
    nodes, count = described.get("nodes"), described.get(kind)
    if body.displacement.shape != (nodes, axes) or \
            body.stress.shape not in [(count, each) for each in components]:
        found = "triangles" if body.tetrahedra is None else "tetrahedra"
        raise ResultError(f"{folder}: body {name}: {len(body.displacement)} vertices and {len(body.stress)} "
                          f"{found}, expected {nodes} and {count}" + (f" {kind}" if found != kind else ""))


def require_mesh(folder, name, body):
    require_finite(folder, f"points of {name}", body.points)
    corners = body.simplices
    kind = "triangle" if body.tetrahedra is None else "tetrahedron"
    if corners.min() < 0 or corners.max() >= len(body.points):
        raise ResultError(f"{folder}: body {name}: a {kind} of vertices that there are not")
    for each, values in body.cells.items():
        if len(values) != len(corners):
            raise ResultError(f"{folder}: body {name}: {each} of {len(values)} elements, expected "
                              f"{len(corners)}")
        require_finite(folder, f"{each} of {name}", values)


def require_finite(folder, what, values):
    if not (np.abs(values) < LARGEST).all():
        raise ResultError(f"{folder}: {what}: not finite, or {LARGEST:g} and more")
