"""What a page of mortier report has of runs in space: surfaces and, to be cut, tetrahedra; nodal values,
recovered where they are of tetrahedra. views/page/solids.js reads them back.

Vertices of the page are nodes at corners of elements, one for each region that meets there, in an order in
which neighbours are close. Middles of quadratic sides follow; of them the page has what the mean of both ends
misses.
"""
import base64
import html

import numpy as np

import contact_surface
from coding import NOISE, block, numbers, thinned, without_noise
from contact_line import keys_of
from contact_surface import surface_of
from recovery import Means
from results import von_mises
from runs import IN_SPACE, top

NUMBERS = 1_100_000  # of all steps and meshes together, so that the page stays small
MANY = 200_000  # of a step: beyond that numbers have a digit less
DOTS = 90  # on an inch of a picture
CURVE_BITS = 10  # of each coordinate in the order of the vertices
CONTACT = 8  # in the marks of a triangle, behind one bit for each sharp side


class Mesh:
    """Of one body. interior: with what the surface does not have."""

    def __init__(self, body, interior):
        surface, n = surface_of(body), len(body.points)
        self.means = Means(body)
        places = self.means.places
        sides = places[surface.owner[:, None], surface.local]
        used = np.unique(places if interior else sides)
        used = used[np.argsort(along_curve(body.points[used % n]), kind="stable")]
        number = np.full(self.means.count, len(used))  # one too large: not in the page
        number[used] = np.arange(len(used))
        self.body, self.nodes, self.used = body, used % n, used
        self.region, self.weight = self.means.regions[used // n], self.means.weight[used]
        near = np.zeros(self.means.count, bool)
        if body.near is not None:
            near[places[body.near]] = True
        self.near = near[used]
        self.set_triangles(number[sides], surface)
        self.tetrahedra = np.sort(number[places], axis=1) if interior else np.zeros((0, 4), int)
        self.tetrahedra = self.tetrahedra[np.lexsort(self.tetrahedra.T[::-1])]

    def set_triangles(self, triangles, surface):
        """Each from its first vertex on, in the order of these."""
        turn = (triangles.argmin(1)[:, None] + np.arange(3)) % 3

        def turned(values):
            return np.take_along_axis(values, turn, 1)
        marks = turned(surface.sharp) @ [1, 2, 4]
        marks[contact_surface.touching(self.body)] += CONTACT
        triangles = turned(triangles)
        order = np.lexsort(triangles.T[::-1])
        self.triangles, self.marks = triangles[order], marks[order]
        self.ends, self.middles = np.zeros((0, 2), int), np.zeros(0, int)
        if surface.middles is not None:  # in the order in which sides are met first
            between = turned(surface.middles)[order].ravel()
            ends = np.stack([self.triangles, np.roll(self.triangles, -1, 1)], 2).reshape(-1, 2)
            first = np.sort(np.unique(keys_of(np.sort(ends, 1)), return_index=True)[1])
            self.ends, self.middles = ends[first], between[first]

    def recovered(self, values):
        """By vertex of the page, of values by tetrahedron: their mean around it."""
        return self.means(values)[self.used]

    def at_nodes(self, values):
        return values[self.nodes]

    def missed(self, values):
        """In the middles of sides, by the mean of their ends."""
        return values[self.middles] - self.at_nodes(values)[self.ends].mean(1)

    def block(self):
        size = np.ptp(self.body.points, axis=0).max()
        missed = [self.missed(x) for x in self.body.points.T]
        first, last = self.triangles[:, 0], self.tetrahedra
        integers = (first, self.triangles[:, 1] - first, self.triangles[:, 2] - first, self.marks,
                    last[:, 0], *np.diff(last, axis=1).T, self.region)
        return block([*((self.at_nodes(x), 5) for x in self.body.points.T),
                      *((np.where(np.abs(each) > NOISE * size, each, 0), 3) for each in missed),
                      *((each, None) for each in integers)])[0]

    def json(self, name):
        return {"name": name, "vertices": len(self.nodes), "middles": len(self.middles),
                "triangles": len(self.triangles), "tetrahedra": len(self.tetrahedra),
                "mesh": self.block()}


def along_curve(points):
    """Keys by which neighbours in space are close in the order of a Z curve."""
    low, size = points.min(0), max(np.ptp(points, axis=0).max(), 1e-300)
    cells = np.clip((points - low) / size * 2**CURVE_BITS, 0, 2**CURVE_BITS - 1).astype(np.int64)
    keys = np.zeros(len(points), np.int64)
    for bit in range(CURVE_BITS):
        for axis in range(3):
            keys |= (cells[:, axis] >> bit & 1) << 3 * bit + axis
    return keys


def values_of(mesh, touching, fields):
    """Field name -> values by vertex of the page, of contact fields by those of `touching`, which are contact
    nodes; of displacements in the middles of sides as well, by their means."""
    found = {}
    for name, field in fields.items():
        if name in ("von_mises", "region", "u"):
            continue
        if field.of_contact:
            found[name] = np.nan_to_num(mesh.at_nodes(field.values(mesh.body))[touching])
        elif field.by_vertex:
            values = field.values(mesh.body)
            found[name], found[f"{name}_middles"] = mesh.at_nodes(values), mesh.missed(values)
        else:
            found[name] = mesh.recovered(field.values(mesh.body))
    return found


def digits_of(name, many):
    if name.endswith("_middles") or name in ("viscoplastic", "error"):
        return 2
    return 4 if many else 5


def step_block(meshes, fields, touching, later, many):
    """The arrays of every body in the order of `order_of`; and the ends of all fields."""
    values = {name: values_of(mesh, touching[name], fields) for name, mesh in meshes.items()}
    without_noise(list(values.values()))
    return (*block([(of_body[name], digits_of(name, many)) for of_body in values.values()
                    for name in order_of(fields)], later), ranges_of(meshes, fields, values))


def order_of(fields):
    names = [name for name in fields if name not in ("von_mises", "region", "u")]
    return [each for name in names
            for each in ((name, f"{name}_middles") if name in ("ux", "uy", "uz") else (name,))]


def ranges_of(meshes, fields, values):
    """Of each field the least and the largest value, and where its colours end."""
    found = {}
    weights = np.concatenate([mesh.weight for mesh in meshes.values()])
    near = np.concatenate([mesh.near for mesh in meshes.values()])
    for name, field in fields.items():
        if name == "region":
            each = np.concatenate([mesh.region for mesh in meshes.values()])
        elif name == "u":
            each = np.concatenate([np.sqrt(sum(of[f"u{c}"]**2 for c in "xyz")) for of in values.values()])
        elif name == "von_mises":
            each = np.concatenate([von_mises(*(of[f"s{c}"] for c in IN_SPACE)) for of in values.values()])
        else:
            each = np.concatenate([of[name] for of in values.values()])
        ends = (each.min(initial=0), each.max(initial=0)) if field.of_contact else (each.min(), each.max())
        found[name] = numbers((*ends, top(field, each, weights, near)))
    return found


def run_data(result, share):
    """The run at the last step, its fields, what the page knows of its bodies, and `still`, HTML; share: of
    NUMBERS."""
    last = result.at(result.kept[-1][0])
    contact_surface.attach(last, result.interfaces)
    fields = result.fields(last)
    room = NUMBERS * share
    elements = sum(len(body.tetrahedra) for body in last.bodies.values())
    nodes = sum(len(body.points) for body in last.bodies.values())
    interior = 3 * elements + 13 * nodes < room
    meshes = {name: Mesh(body, interior) for name, body in last.bodies.items()}
    of_meshes = sum(3 * len(mesh.tetrahedra) + 3 * len(mesh.nodes) for mesh in meshes.values())
    of_step = sum(9 * len(mesh.nodes) + 3 * len(mesh.middles) for mesh in meshes.values())
    kept = thinned(result.kept, (room - of_meshes) / of_step)
    picture = still(result)  # now that the step is read
    bodies, touching = [], {}
    for name, mesh in meshes.items():
        body = last.bodies[name]
        gap = mesh.at_nodes(body.contact["gap"]) if "gap" in body.contact else np.zeros(0)
        touching[name] = np.flatnonzero(np.isfinite(gap))
        bodies.append({**mesh.json(name), "rigid": body.rigid, "touching": len(touching[name]),
                       "contact": block([(touching[name], None)])[0]})
    steps, ranges, later = [], [], None
    for step, time in reversed(kept):  # the page shows the last one first
        run = result.at(step)
        contact_surface.attach(run, result.interfaces)
        for name, mesh in meshes.items():
            mesh.body = run.bodies[name]
        arrays, later, ends = step_block(meshes, fields, touching, later, of_step > MANY)
        steps.append({"step": step, "time": time, **arrays})
        ranges.append(ends)
    return last, fields, {"bodies": bodies, "order": order_of(fields), "steps": steps[::-1],
                          "ranges": ranges[::-1], "lines": [], "views": views_of(result, last),
                          "interior": interior, "still": picture}


def still(result):
    """The last step as a picture, in HTML."""
    import images
    import pictures

    with pictures.plt.rc_context(pictures.STYLE):
        figure = pictures.fields([pictures.view(result)])
        data = images.small(images.picture(figure, "png", dpi=DOTS))
        pictures.plt.close(figure)
    return (f'<img alt="deformed bodies of {html.escape(result.name)}" '
            f'src="data:image/png;base64,{base64.b64encode(data).decode()}">')


def views_of(result, run):
    """Name -> angles of the eye, the body whose contact is shown, and bodies that are left out."""
    found = {}
    for name in (*contact_surface.NAMED, contact_surface.CONTACT):
        if look := contact_surface.look_of(run, result.interfaces, name):
            found[name] = {"angles": look.angles, "hidden": look.hidden, "body": look.body}
    return found
