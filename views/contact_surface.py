"""Contact surfaces of bodies in space: nodal values on them, what is near them, from where they are seen."""
from dataclasses import dataclass

import numpy as np

from surfaces import MIDDLE, Buffer, Seen, Surface, camera

FIELDS = ("pressure", "gap")
NAMED = {"front": (-90.0, 0.0), "top": (-90.0, 90.0)}  # azimuth and elevation of the eye, degrees
CONTACT = "contact"
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
    nonmortar sides the larger pressure and the smaller gap; in the middle of a side the mean of its ends), and
    `near`, whether a tetrahedron is near closed contact; None where nothing is closed."""
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
    closed = [contact.position[(contact.interface == k) & (contact.force > 0)] for k in range(len(interfaces))]
    for name, body in run.bodies.items():
        for points, each in zip(closed, interfaces):
            if len(points) and points.shape[1] == 3 and name in (each["nonmortar"], each["mortar"]):
                found = near(body, points)
                body.near = found if body.near is None else body.near | found


def with_middles(body, values):
    if body.elements is None:
        return values
    ends = np.array([[np.argwhere(MIDDLE == m)[0] for m in range(4, 10)]])[0]
    nodes, middles = body.elements[:, :4][:, ends], body.elements[:, 4:]
    known = np.isfinite(values[nodes]).all(2) & np.isnan(values[middles])
    values[middles[known]] = values[nodes[known]].mean(1)
    return values


def near(body, points):
    """Whether a tetrahedron is in the box about closed nodes and half of its size, or has one of its nodes."""
    low, high = points.min(0), points.max(0)
    margin = 0.5 * (high - low).max()
    middles = body.points[body.tetrahedra].mean(1)
    inside = ((middles >= low - margin) & (middles <= high + margin)).all(1)
    pressure = body.contact.get("pressure")
    return inside if pressure is None else inside | (pressure[body.tetrahedra] > 0).any(1)


def touching(body):
    """Numbers of the sides of its surface that are contact surface."""
    if "gap" not in body.contact:
        return np.zeros(0, int)
    return np.flatnonzero(np.isfinite(body.contact["gap"][surface_of(body).nodes]).all(1))


@dataclass
class Look:
    """From where the contact is seen: azimuth and elevation in degrees, what is shown (two corners of a box),
    and the bodies that are left out because they are in front."""
    angles: tuple
    box: np.ndarray
    hidden: list


def contact_look(run, interfaces):
    """Of the interface with the largest force; None where there is no contact surface."""
    contact = run.contact
    forces = [contact.force[contact.interface == k].sum() for k in range(len(interfaces))]
    if not forces or not len(contact.vertex):
        return None
    of = interfaces[int(np.argmax(forces))]
    body = run.bodies[of["nonmortar"]]
    sides = touching(body)
    if not len(sides):
        return None
    nodes = surface_of(body).nodes
    pressure = np.nan_to_num(body.contact["pressure"][nodes[sides]]).sum(1)
    closed = pressure > 0 if (pressure > 0).any() else np.ones(len(sides), bool)
    seen = body.points[nodes[sides[closed]]]
    box = np.array([seen.reshape(-1, 3).min(0), seen.reshape(-1, 3).max(0)])
    return Look(best_angles(body, sides[closed], pressure[closed]), box, [of["mortar"]])


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
