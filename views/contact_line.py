"""The line of contact of an interface, and what lies about it in coordinates of that line.

Abscissa: the length along the nonmortar line as meshed, or x or y where that grows along the whole line.
Ordinate: the distance from it; the nonmortar body is above, or below where it lies below the other one. On a
straight line this is a rotation; on a curve it is the curve unrolled.
"""
import numpy as np

FACING = -0.5  # the cosine of 120 degrees between the normals of sides that face each other


def keys_of(rows):
    """A number for each row of small integers from 0, in the order of the rows."""
    size = int(rows.max(initial=0)) + 1
    if size ** rows.shape[1] > np.iinfo(np.int64).max:
        return np.unique(rows, axis=0, return_inverse=True)[1].ravel()
    return np.ravel_multi_index(rows.T, (size,) * rows.shape[1])


def boundary_sides(sides):
    """Numbers of the sides that belong to one element only, each given by its nodes."""
    _, first, count = np.unique(keys_of(np.sort(sides, axis=1)), return_index=True, return_counts=True)
    return first[count == 1]


def boundary_edges(triangles, owners=False):
    """Edges of one triangle only, the body to their left; with owners also the triangle of each, and which of
    its sides it is."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    of_one = boundary_sides(edges)
    if owners:
        return edges[of_one], of_one % len(triangles), of_one // len(triangles)
    return edges[of_one]


class ContactLine:
    def __init__(self, run, nonmortar, mortar, rows, scale=1.0, axes=("x", "y")):
        """rows: of run.contact, the nodes of the line in its order, the nonmortar body to the left; scale: of
        the displacements in the traces of both sides; axes: names of the coordinates."""
        self.scale = scale
        self.nonmortar, self.mortar = nonmortar, mortar
        across = run.contact.position[rows[-1]] - run.contact.position[rows[0]]
        self.flipped = across[np.abs(across).argmax()] < 0
        self.rows = rows[::-1] if self.flipped else rows
        self.vertices = run.contact.vertex[self.rows]
        self.points = run.contact.position[self.rows]
        self.lengths = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(self.points, axis=0).T))])
        # The coordinate that grows along the line names its points better than the length does.
        self.abscissa, self.name = self.lengths, "length along the line"
        for name, values in zip(axes, self.points.T):
            if (np.diff(values) >= 0).all() and np.ptp(values) > 0.8 * self.lengths[-1]:
                self.abscissa, self.name = values, name
                break
        contact = run.contact
        self.gap, self.force, self.pressure = contact.gap[self.rows], contact.force[
            self.rows], contact.pressure[self.rows]
        # Along the line as it is drawn, what the nonmortar body exerts; None without friction.
        side = -1.0 if self.flipped else 1.0
        self.shear = None if contact.shear is None else side * contact.shear[self.rows]
        self.slipping = None if contact.slipping is None else contact.slipping[self.rows] != 0

        # Segments of the polygon, and normals at its nodes: the mean of those beside a node.
        ends = np.flatnonzero(np.diff(self.lengths) > 0)
        self.start, self.along = self.points[ends], self.points[ends + 1] - self.points[ends]
        self.length = np.hypot(*self.along.T)
        self.along = self.along / self.length[:, None]
        self.begin, self.segments = self.lengths[ends], ends
        # To the right of the line as it was: out of the nonmortar body.
        normals = side * np.stack([self.along[:, 1], -self.along[:, 0]], 1)
        at_nodes = np.zeros_like(self.points)
        np.add.at(at_nodes, ends, normals)
        np.add.at(at_nodes, ends + 1, normals)
        self.normals = at_nodes / np.maximum(np.hypot(*at_nodes.T), 1e-300)[:, None]
        x, y = self.normals.mean(0)
        self.up = -1.0 if y > max(abs(x), 1e-6) else 1.0  # of the ordinates of the nonmortar body

        body, other = run.bodies[nonmortar], run.bodies[mortar]
        edges = self.facing_edges(other)
        moved = body.displacement[self.vertices]
        self.nonmortar_trace = self.placed(self.points, moved)
        vertices, corners = np.unique(edges, return_inverse=True)
        points, theirs = other.points[vertices], other.displacement[vertices]
        self.mortar_trace = (self.placed(points, theirs)[corners.reshape(-1, 2)]
                             if len(edges) else np.zeros((0, 2, 2)))
        self.jump = self.jump_along(moved, points, theirs) if len(edges) else None

    def jump_along(self, ours, points, theirs):
        """Abscissae, and there the gap between the nodes of both sides, where they coincide as meshed:
        u1.n1 + u2.n2 with its sign turned, exact, for both traces are linear between the abscissae. None
        where they do not coincide, or where the scene gives another distance than that as meshed."""
        length, foot, _, normal, _ = self.frame(points)
        small = 1e-9 * self.lengths[-1]
        if np.abs(((points - foot) * normal).sum(-1)).max() > small:
            return None
        order = np.argsort(length)
        at = np.union1d(length, self.lengths)
        at = at[(at >= length.min()) & (at <= length.max()) & (at >= 0) & (at <= self.lengths[-1])]
        gap = np.interp(at, length[order], (theirs * normal).sum(-1)[order]) - \
            np.interp(at, self.lengths, (ours * self.normals).sum(-1))
        if len(at) < 2 or abs(np.median(np.interp(self.lengths, at,
                                                  gap) - self.gap)) > 0.5 * np.ptp(gap) + small:
            return None
        return np.interp(at, self.lengths, self.abscissa), gap

    def nearest(self, points):
        """Segment and position on it, 0 to 1, of the nearest point of the line;
        and whether it is beyond an end."""
        relative = points[:, None, :] - self.start
        position = np.clip((relative * self.along).sum(-1) / self.length, 0, 1)
        offset = relative - (position * self.length)[..., None] * self.along
        segment = (offset**2).sum(-1).argmin(1)
        each = np.arange(len(points))
        exact = (relative[each, segment] * self.along[segment]).sum(-1) / self.length[segment]
        last = len(self.length) - 1
        beyond = ((segment == 0) & (exact < -1e-6)) | ((segment == last) & (exact > 1 + 1e-6))
        return segment, position[each, segment], beyond

    def frame(self, points):
        """Length along the line, point on it, unit tangent and normal out of the nonmortar body,
        for points near it."""
        segment, position, beyond = self.nearest(points)
        node = self.segments[segment]
        normal = (1 - position)[:, None] * self.normals[node] + position[:, None] * self.normals[node + 1]
        normal /= np.maximum(np.hypot(*normal.T), 1e-300)[:, None]
        # Beyond an end the line goes on straight.
        foot = self.start[segment] + (position * self.length[segment])[:, None] * self.along[segment]
        tangent = self.along[segment]
        over = np.where(beyond, ((points - foot) * tangent).sum(-1), 0)
        foot = foot + over[:, None] * tangent
        return self.begin[segment] + position * self.length[segment] + over, foot, tangent, normal, beyond

    def placed(self, points, displacement):
        """Abscissa and ordinate of displaced points, n x 2."""
        displacement = self.scale * displacement
        length, foot, tangent, normal, _ = self.frame(points)
        distance = ((points - foot) * normal).sum(-1)
        x = np.interp(length, self.lengths, self.abscissa)
        beyond = length - self.lengths[-1]
        x += np.where(length < 0, length, 0) + np.where(beyond > 0, beyond, 0)
        across = distance + (displacement * normal).sum(-1)
        return np.stack([x + (displacement * tangent).sum(-1), -self.up * across], 1)

    def facing_edges(self, other):
        """Boundary edges of the mortar body that face the line, as pairs of vertices."""
        edges = boundary_edges(other.triangles)
        low, high = self.points.min(0), self.points.max(0)
        reach = 0.2 * self.lengths[-1]
        ends = other.points[edges]
        middle = ends.mean(1)
        edges = edges[((middle > low - reach) & (middle < high + reach)).all(1)]
        if not len(edges):
            return edges
        ends = other.points[edges]
        vector = ends[:, 1] - ends[:, 0]
        outward = np.stack([vector[:, 1], -vector[:, 0]], 1) / np.maximum(np.hypot(*vector.T),
                                                                          1e-300)[:, None]
        _, foot, _, normal, beyond = self.frame(ends.mean(1))
        near = np.hypot(*(ends.mean(1) - foot).T) < reach
        return edges[((outward * normal).sum(-1) < FACING) & near & ~beyond]

    def window(self):
        """The part of the line that is worth a closer look: contact and half its width beside it,
        or all of it."""
        low, high = self.abscissa[0], self.abscissa[-1]
        active = self.abscissa[self.force > 0]
        if len(active):
            margin = max(0.5 * np.ptp(active), 3 * (high - low) / max(len(self.abscissa) - 1, 1))
            low, high = max(low, active[0] - margin), min(high, active[-1] + margin)
        return low, high
