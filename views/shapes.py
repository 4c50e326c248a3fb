"""Triangles and outlines of bodies as they are drawn: sides of quadratic triangles are curves."""
import numpy as np

from contact_line import boundary_edges

PIECES = 6  # of a side of a triangle with a curved side
CURVED = 1e-3  # of its length that a side is off its chord, from which on it is drawn as a curve


def placed(body, scale):
    return body.points + scale * body.displacement


def curved_sides(body, scale):
    """Of the boundary: triangle, which side of it, and how far its middle is off the chord; curved ones."""
    edges, owner, side = boundary_edges(body.triangles, owners=True)
    if body.elements is None:
        return owner[:0], side[:0], np.zeros((0, 2))
    points = placed(body, scale)
    ends = points[edges]
    off = points[body.elements[owner, 3 + side]] - ends.mean(1)
    found = np.hypot(*off.T) > CURVED * np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    return owner[found], side[found], off[found]


def pieces(body, scale):
    """Corners of the triangles as drawn, n x 3 x 2, the triangle that each is of, and the barycentric
    coordinates of its corners there, n x 3 x 3."""
    owner, side, off = curved_sides(body, scale)
    straight = np.ones(len(body.triangles), bool)
    straight[owner] = False
    corners = placed(body, scale)[body.triangles]
    plain = np.flatnonzero(straight)
    if not len(owner):
        return corners, plain, np.broadcast_to(np.eye(3), (len(plain), 3, 3))
    small = []
    for p in range(PIECES):
        for q in range(PIECES - p):
            small.append([(p, q), (p + 1, q), (p, q + 1)])
            if p + q + 2 <= PIECES:
                small.append([(p + 1, q), (p + 1, q + 1), (p, q + 1)])
    small = np.array(small) / PIECES
    small = np.concatenate([small, 1 - small.sum(-1, keepdims=True)], -1)  # k x 3 x 3
    bent = np.unique(owner)
    fine = np.einsum("kij,tjd->tkid", small, corners[bent])
    at = np.searchsorted(bent, owner)
    bubble = 4 * small[:, :, side] * small[:, :, (side + 1) % 3]  # k x 3 x sides
    np.add.at(fine, at, np.einsum("kis,sd->skid", bubble, off))
    count = len(small)
    return (np.concatenate([corners[plain], fine.reshape(-1, 3, 2)]),
            np.concatenate([plain, np.repeat(bent, count)]),
            np.concatenate([np.broadcast_to(np.eye(3), (len(plain), 3, 3)),
                            np.tile(small, (len(bent), 1, 1))]))


def outline(body, scale):
    """The boundary as lines, n x 2 x 2; of a curved side PIECES lines."""
    points = placed(body, scale)
    edges, owner, side = boundary_edges(body.triangles, owners=True)
    ends = points[edges]
    if body.elements is None:
        return ends
    off = points[body.elements[owner, 3 + side]] - ends.mean(1)
    s = np.linspace(0, 1, PIECES + 1)[:, None]
    curves = (1 - s) * ends[:, None, 0] + s * ends[:, None, 1] + 4 * s * (1 - s) * off[:, None]
    return np.stack([curves[:, :-1], curves[:, 1:]], 2).reshape(-1, 2, 2)


def sides(body, scale):
    """The sides of all triangles, each once, straight: n x 2 x 2."""
    corners = body.triangles
    edges = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    return placed(body, scale)[np.unique(edges, axis=0)]
