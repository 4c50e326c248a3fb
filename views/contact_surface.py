"""Contact surfaces of bodies in space: nodal values, what is near them; from where bodies are seen."""
from dataclasses import dataclass

import numpy as np

from surfaces import MIDDLE, Buffer, Seen, Surface, camera

FIELDS = ("pressure", "gap")
NAMED = {"front": (-90.0, 0.0), "top": (-90.0, 90.0)}  # azimuth and elevation of the eye, degrees
CONTACT = "contact"
START = (-60.0, 25.0)
CURVED = 0.3  # of the area of a surface that its mean normal has left, below which it has no side
ALONG_AN_AXIS = 0.9  # cosine
TILTS = (35, 65)  # degrees from the mean normal, of directions that are tried
PIXELS = 100


def surface_of(body):
    """Made once for a body as it was read."""
    if not hasattr(body, "surface"):
        body.surface = Surface(body)
    return body.surface


def attach(run, interfaces):
    """Gives bodies `contact`, pressure and gap by node (not a number where there is none; of a node on two
    nonmortar sides the larger pressure and the smaller gap; in the middle of a side the mean of its ends),
    and `near`, whether a tetrahedron is near closed contact, no farther than that is large; None where
    nothing is closed."""
    contact = run.contact
    nonmortar = {each["nonmortar"] for each in interfaces}
    for name, body in run.bodies.items():
        body.contact, body.near = {}, None
        if name not in nonmortar:
            continue
        for which, merge in (("pressure", np.fmax), ("gap", np.fmin)):
            values = np.full(len(body.points), np.nan)
            rows = np.isin(contact.interface, [k for k, each in enumerate(interfaces)
                                               if each["nonmortar"] == name])
            merge.at(values, contact.vertex[rows], getattr(contact, which)[rows])
            body.contact[which] = with_middles(body, values)
    for k, each in enumerate(interfaces):
        closed = (contact.interface == k) & (contact.force > 0)
        points, body = contact.position[closed], run.bodies[each["nonmortar"]]
        if not len(points) or points.shape[1] != 3:
            continue
        beside = np.isin(body.tetrahedra, contact.vertex[closed]).any(1)
        elements = np.ptp(body.points[body.tetrahedra[beside]], axis=1)
        margin = np.ptp(points, axis=0).max() + elements.max(1).mean()
        for of in (body, run.bodies[each["mortar"]]):
            middles = of.points[of.tetrahedra].mean(1)
            found = ((middles >= points.min(0) - margin) & (middles <= points.max(0) + margin)).all(1)
            of.near = found if of.near is None else of.near | found


def with_middles(body, values):
    if body.elements is None:
        return values
    ends = np.array([[np.argwhere(MIDDLE == m)[0] for m in range(4, 10)]])[0]
    nodes, middles = body.elements[:, :4][:, ends], body.elements[:, 4:]
    known = np.isfinite(values[nodes]).all(2) & np.isnan(values[middles])
    values[middles[known]] = values[nodes[known]].mean(1)
    return values


def touching(body):
    """Numbers of the sides of its surface that are contact surface."""
    if "gap" not in body.contact:
        return np.zeros(0, int)
    return np.flatnonzero(np.isfinite(body.contact["gap"][surface_of(body).nodes]).all(1))


@dataclass
class Look:
    """From where bodies are seen: azimuth and elevation of the eye in degrees; which body and nodes of it are
    in the middle (all: None); and the bodies that are left out because they are in front."""
    angles: tuple = START
    body: str = None
    nodes: np.ndarray = None
    hidden: tuple = ()


def look_of(run, interfaces, view):
    """view: a name, angles, or None. None for `contact` where there is none: the interface with the largest
    force is seen."""
    if view != CONTACT:
        return Look(START if view is None else NAMED[view] if isinstance(view, str) else tuple(view))
    contact = run.contact
    if not interfaces or not len(contact.vertex):
        return None
    forces = [contact.force[contact.interface == k].sum() for k in range(len(interfaces))]
    of = interfaces[int(np.argmax(forces))]
    body = run.bodies[of["nonmortar"]]
    sides = touching(body)
    if not len(sides):
        return None
    nodes = surface_of(body).nodes[sides]
    pressure = np.nan_to_num(body.contact["pressure"][nodes]).sum(1)
    closed = pressure > 0 if (pressure > 0).any() else np.ones(len(sides), bool)
    return Look(best_angles(body, sides[closed], pressure[closed]), of["nonmortar"], np.unique(nodes[closed]),
                (of["mortar"],))


def best_angles(body, sides, pressure):
    """Along the normal of some sides of a body, its mean weighted by pressure, or the axis that it is close
    to, where they are seen from there; else from where most of their area is."""
    corners = body.points[surface_of(body).nodes]
    a, b, c = np.moveaxis(corners[sides], 1, 0)
    doubled = np.cross(b - a, c - a)
    doubled *= (pressure if pressure.any() else np.ones(len(sides)))[:, None]
    normal, area = doubled.sum(0), np.linalg.norm(doubled, axis=1).sum()
    tried = [np.array(each, float) for each in np.ndindex(3, 3, 3) if each != (1, 1, 1)]
    tried = [(each - 1) / np.linalg.norm(each - 1) for each in tried]
    if np.linalg.norm(normal) > CURVED * area:
        along = normal / np.linalg.norm(normal)
        if np.abs(along).max() > ALONG_AN_AXIS:
            along = np.round(along)
        across = np.eye(3)[np.abs(along).argmin()]
        right = np.cross(along, across) / np.linalg.norm(np.cross(along, across))
        up = np.cross(right, along)
        facing = np.cross(b - a, c - a) @ along
        if seen_area(corners, sides, along) > 0.7 * facing[facing > 0].sum() / 2:
            return angles_of(along)
        tried = [np.cos(t) * along + np.sin(t) * (np.cos(p) * right + np.sin(p) * up)
                 for t in np.radians(TILTS) for p in np.arange(8) * np.pi / 4]
    return angles_of(max(tried, key=lambda each: seen_area(corners, sides, each)))


def angles_of(eye):
    x, y, z = eye
    azimuth = np.degrees(np.arctan2(y, x)) if np.hypot(x, y) > 1e-6 else -90.0
    return float(round(azimuth, 3)) + 0.0, float(round(np.degrees(np.arcsin(np.clip(z, -1, 1))), 3)) + 0.0


def seen_area(corners, sides, eye):
    """Of some of the triangles, from a direction."""
    turned = camera(*angles_of(eye))
    placed = corners @ turned.T
    low, high = placed.reshape(-1, 3).min(0), placed.reshape(-1, 3).max(0)
    seen = Seen(placed, None, np.zeros((len(placed), 3), int))
    buffer = Buffer([seen], (low[0], high[0], low[1], high[1]), PIXELS)
    found = np.zeros(len(placed) + 1, bool)
    found[sides] = True
    return found[buffer.found].sum() * buffer.size**2
