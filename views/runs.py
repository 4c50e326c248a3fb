"""A result as pictures and reports need it: kept steps, fields by name, lines of contact, units."""
import os
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import contact_surface
import results
from contact_line import ContactLine
from ending import Wrong, shown
from other_meshes import areas_of


@dataclass
class Field:
    name: str
    words: str
    unit: str
    by_vertex: bool  # else by triangle
    signed: bool  # zero is the middle of its colours
    values: callable  # of a results.Body

    @property
    def recoverable(self):
        """Whether it is constant in triangles because the triangles are linear."""
        return self.name == "von_mises" or self.name[1:].isdigit()

    @property
    def of_contact(self):
        """Whether only contact surfaces have it."""
        return self.name in contact_surface.FIELDS

    @property
    def marked(self):
        """Whether its largest value says something."""
        return self.name not in ("viscoplastic", "region")


COMPONENTS, IN_SPACE = ("11", "22", "12", "33"), ("11", "22", "33", "12", "23", "13")
AROUND_AXIS = (" (radial)", " (axial)", " (shear)", " (hoop)")  # what these are of bodies of revolution


def read(folder):
    """The Result in a folder. ResultError: it is no result of mortier run, or damaged."""
    place = Path(folder)
    if not os.path.isdir(folder):  # which is false for a name that is too long as well
        raise results.ResultError(f"{folder}: no such folder, expected a result of mortier run")
    summary = results.read_summary(place, failed=True)
    if summary.get("code") == "FreeFEM":
        raise results.ResultError(f"{folder}: a result of FreeFEM, which holds no meshes; expected one of "
                                  "mortier run")
    bodies = [body["name"] for body in results.body_list(place, summary)]
    interfaces = summary.get("interfaces")
    if not isinstance(interfaces, list) or not all(
            isinstance(each, dict) and each.get("nonmortar") in bodies and each.get("mortar") in bodies
            for each in interfaces):
        raise results.ResultError(f"{place / 'summary.json'}: interfaces of bodies that there are not")
    return Result(place, summary, results.kept_steps(place), results.read_history(place),
                  results.contact_tables(place))


class Result:
    def __init__(self, folder, summary, kept, history, tables=None):
        """kept: (number, time) of steps; history: column of history.csv -> numbers; tables:
        results.contact_tables of a result that is in files."""
        self.folder, self.summary, self.interfaces = folder, summary, summary["interfaces"]
        self.kept, self.history, self.tables, self.steps_read = kept, history, tables, {}

    @property
    def revolved(self):
        return self.summary.get("plane") == "axisymmetric"

    @property
    def space(self):
        return self.summary.get("plane") == "space"

    @property
    def axes(self):
        return ("x", "y", "z") if self.space else ("r", "z") if self.revolved else ("x", "y")

    @property
    def meanings(self):
        """Of the components of stress and strain, behind their names."""
        return AROUND_AXIS if self.revolved else ("",) * 6

    @property
    def failed(self):
        return self.summary["status"] != "converged"

    @property
    def reason(self):
        """Of a run that stopped early."""
        return shown(self.summary.get("reason", "no reason given"), 300)

    @property
    def name(self):
        return shown(self.folder.resolve().name, 60)

    @property
    def title(self):
        return shown(self.summary.get("title") or self.name, 120)

    def unit(self, column):
        """Of a column of history.csv, which names it: von_mises_max[Pa]."""
        for name in self.history:
            if found := re.fullmatch(re.escape(column) + r"\[(.*)\]", name):
                return found[1]
        return ""

    @property
    def stress_unit(self):
        return self.unit("von_mises_max")

    @property
    def length_unit(self):
        return self.unit("displacement_max")

    @property
    def time_unit(self):
        return self.unit("time")

    def step(self, given=None):
        """The number of a kept step; the last one where none is named."""
        steps = [step for step, _ in self.kept]
        if given is None:
            return steps[-1]
        if given not in steps:
            listed = ", ".join(map(str, steps[:8])) + (f", ... {steps[-1]}" if len(steps) > 8 else "")
            raise Wrong(f"{self.folder}: step {given} was not kept, expected one of {listed} "
                            "(mortier run --set output.every=1 keeps all)")
        return given

    def time(self, step):
        return dict(self.kept)[step]

    def at(self, step):
        """The results.Run of a kept step."""
        if step not in self.steps_read:
            run = results.mortier_run(self.folder, self.summary, self.tables, step)
            contact = run.contact
            for each, vertex in zip(contact.interface, contact.vertex):
                if not (0 <= each < len(self.interfaces) and
                        0 <= vertex < len(run.bodies[self.interfaces[each]["nonmortar"]].points)):
                    raise results.ResultError(f"{self.folder / 'contact.csv'}: interface {each}, "
                                              f"vertex {vertex}: there is no such node")
            results.require_finite(self.folder, "contact pressures", contact.pressure)
            if self.space and len(contact.vertex) and contact.position.shape[1] != 3:
                raise results.ResultError(f"{self.folder / 'contact.csv'}: no column z")
            self.steps_read = {step: run}  # the last one only: a run of many steps need not fit in memory
        return self.steps_read[step]

    def lines(self, run, scale=1.0):
        """The ContactLine of every interface that has two nodes or more; none in space."""
        found = []
        if self.space:
            return found
        for k, interface in enumerate(self.interfaces):
            rows = np.flatnonzero(run.contact.interface == k)
            if len(rows) > 1:
                found.append(ContactLine(run, interface["nonmortar"], interface["mortar"], rows, scale,
                                         self.axes))
        return found

    def fields(self, run):
        """name -> Field, of those that every body has."""
        stress, length = self.stress_unit, self.length_unit
        made = [Field("von_mises", "von Mises stress", stress, False, False,
                      lambda body: body.cells["von_mises"])]
        components = min(body.stress.shape[1] for body in run.bodies.values())
        names = IN_SPACE if self.space else COMPONENTS[:components]
        for c, name in enumerate(names):
            made.append(Field(f"s{name}", f"stress s{name}{self.meanings[c]}", stress, False, True,
                              lambda body, c=c: body.stress[:, c]))
        made.append(Field("u", "displacement", length, True, False,
                          lambda body: np.linalg.norm(body.displacement, axis=1)))
        for c, axis in enumerate(self.axes):
            made.append(Field(f"u{'xyz'[c]}", f"displacement {axis}", length, True, True,
                              lambda body, c=c: body.displacement[:, c]))
        for c, name in enumerate(names):
            made.append(Field(f"e{name}", f"viscoplastic strain e{name}{self.meanings[c]}", "", False, True,
                              lambda body, c=c: body.cells["viscoplastic_strain"].reshape(len(body.simplices),
                                                                                          -1)[:, c]))
        made += [Field("viscoplastic", "yielding", "", False, False,
                       lambda body: body.cells["viscoplastic"].astype(float)),
                 Field("error", f"estimated error of the stress, share of the {self.element}", "", False,
                       False,
                       lambda body: body.cells["error"]),
                 *self.contact_fields(run),
                 Field("region", "region", "", False, False, lambda body: body.cells["region"].astype(float))]
        return {field.name: field for field in made}

    def contact_fields(self, run):
        """Of bodies in space: values by node, not a number off the nonmortar sides."""
        if not self.space or not len(run.contact.vertex):
            return []
        return [Field(name, words, unit, True, signed,
                      lambda body, name=name: body.contact.get(name, np.full(len(body.points), np.nan)))
                for name, words, unit, signed in (("pressure", "contact pressure", self.stress_unit, False),
                                                  ("gap", "gap", self.length_unit, True))]

    def stuck(self, run):
        """Body, triangle and words of the place to look at where a run stopped early: the largest residual
        of the material law in the step that was not solved, else the largest stress of the last good state,
        beyond yield where anything flows; None before there is any."""
        told = self.summary.get("stuck")
        if isinstance(told, dict):
            name, triangle = told.get("body"), told.get(self.element)
            known = isinstance(name, str) and name in run.bodies and type(triangle) is int
            if known and 0 <= triangle < len(run.bodies[name].simplices):
                return name, triangle, f"largest residual of the law, {self.place(run, name, triangle)}"
        found = []
        for name, body in run.bodies.items():
            flows = body.cells.get("viscoplastic", np.zeros(len(body.simplices)))
            stress = body.von_mises
            triangle = int(np.lexsort((stress, flows))[-1])
            found.append((flows[triangle], stress[triangle], name, triangle))
        flows, stress, name, triangle = max(found)
        if not stress > 0:
            return None
        return name, triangle, (f"largest stress{' beyond yield' if flows else ''}, "
                                f"{self.place(run, name, triangle)}")

    @property
    def element(self):
        return "tetrahedron" if self.space else "triangle"

    @property
    def elements(self):
        return "tetrahedra" if self.space else "triangles"

    def place(self, run, name, element):
        where = run.bodies[name].points[run.bodies[name].simplices[element]].mean(0)
        return f"{name}, {self.element} {element} at ({', '.join(f'{x:.4g}' for x in where)})"

    def values(self, run, field):
        """Body name -> values; ResultError where a body has none."""
        try:
            found = {name: np.asarray(field.values(body), float) for name, body in run.bodies.items()}
        except (KeyError, IndexError, ValueError, TypeError) as error:
            raise results.ResultError(
                f"{self.folder}: no field {field.name} in the .vtu files: {error!r}") from error
        for name, values in found.items():
            body = run.bodies[name]
            if values.shape != (len(body.points if field.by_vertex else body.simplices),):
                raise results.ResultError(f"{self.folder}: body {name}: {field.name} has the wrong shape "
                                          f"{values.shape}")
        return found


def areas(body):
    """Of the triangles as meshed; the volumes of tetrahedra."""
    return areas_of(body.points[body.simplices])


def top_of(field, bodies, values):
    """Where the colours of a field end. values: by triangle, by corner of the triangles or by vertex."""
    of_all, weights, near = [], [], []
    for name, body in bodies.items():
        each, area = values[name], areas(body)
        each = each[body.simplices] if field.by_vertex and each.ndim == 1 else each
        close = np.zeros(len(area), bool) if getattr(body, "near", None) is None else body.near
        times = each.size // len(area)
        of_all.append(each.ravel())
        weights.append(np.repeat(area, times))
        near.append(np.repeat(close, times))
    return top(field, *map(np.concatenate, (of_all, weights, near)))


def top(field, values, weights, near):
    """99.5 % of the area (in space: volume) has a smaller value, and 90 % of what is near closed contact; on
    contact surfaces see top_of_contact. All are one number a place."""
    sizes = np.abs(values) if field.signed or field.of_contact else values
    if field.of_contact:
        return top_of_contact(sizes)
    found = weighted_quantile(sizes, weights, 0.995)
    return max(found, weighted_quantile(sizes[near], weights[near], 0.9)) if near.any() else found


def top_of_contact(sizes):
    """1.5 times the value below which values are half of the sum: peaks at edges are beyond it."""
    sizes = sizes[sizes > 0]
    return 1.5 * weighted_quantile(sizes, sizes, 0.5) if len(sizes) else 0.0


def weighted_quantile(sizes, weights, share):
    """The least value of which the weights up to it are that share."""
    order = np.argsort(sizes, kind="stable")
    summed = np.cumsum(weights[order])
    return sizes[order[min(np.searchsorted(summed, share * summed[-1]), len(order) - 1)]]


def extent(bodies):
    """The larger side of the box about bodies as meshed."""
    points = np.concatenate([body.points for body in bodies])
    return max(np.ptp(points, axis=0).max(), 1e-300)


def natural_scale(bodies):
    """1 where displacements can be seen as they are; else the 1, 2 or 5 times a power of ten that makes the
    largest some 5 % of the bodies."""
    ratio = max(np.abs(body.displacement).max() for body in bodies) / extent(bodies)
    if not 0 < ratio < 1e300 or 0.01 <= ratio <= 0.5:
        return 1.0
    wanted = 0.05 / ratio
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(max(each for each in (1, 2, 5) if each * power <= wanted * (1 + 1e-9)) * power)
