"""Surfaces of bodies in space as images: orthographic projection, what is hidden by a depth buffer."""
from dataclasses import dataclass

import numpy as np

from contact_line import boundary_sides, keys_of
from other_meshes import volumes

OUTWARD = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])  # sides of a tetrahedron, seen from outside
MIDDLE = np.array([[0, 4, 6, 7], [4, 1, 5, 8], [6, 5, 2, 9], [7, 8, 9, 3]])  # node between two corners
# A quadratic side as four triangles: barycentric coordinates of their corners, and which of their sides,
# each opposite a corner, lie along a side of the whole.
QUARTERS = np.array([[[2, 0, 0], [1, 1, 0], [1, 0, 1]], [[1, 1, 0], [0, 2, 0], [0, 1, 1]],
                     [[1, 0, 1], [0, 1, 1], [0, 0, 2]], [[1, 1, 0], [0, 1, 1], [1, 0, 1]]]) / 2
ALONG = np.array([[False, True, True], [True, False, True], [True, True, False], [False] * 3])
SHARP = 0.8  # cosine of the angle between sides of the surface with an edge between them
PIXELS = 130  # on an inch
FINER = 2  # pixels of the buffer on one of the image
AT_ONCE = 3_000_000  # pixels of triangles
LIGHT = np.array([-0.36, 0.55, 0.75])
INK, MESH = np.array([0.13, 0.13, 0.13]), np.array([0.2, 0.2, 0.23])


def camera(azimuth, elevation):
    """Rows: to the right, upwards, towards the eye. Angles in degrees, of the eye about z from x on, and
    above the plane of x and y."""
    a, e = np.radians([azimuth, elevation])
    eye = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.array([right, np.cross(eye, right), eye])


class Surface:
    """The sides of tetrahedra that belong to one only, counterclockwise from outside."""

    def __init__(self, body):
        turned = volumes(body.points[body.tetrahedra]) < 0
        sides = np.where(turned[:, None, None], OUTWARD[:, ::-1], OUTWARD)  # cells x 4 x 3, corners of each
        every = np.take_along_axis(body.tetrahedra[:, None, :], sides, 2)
        of_one = boundary_sides(every.reshape(-1, 3))
        self.owner, self.local = of_one // 4, sides.reshape(-1, 3)[of_one]
        self.nodes = every.reshape(-1, 3)[of_one]
        self.middles = None
        if body.elements is not None:
            between = MIDDLE[self.local, np.roll(self.local, -1, 1)]  # of 0-1, 1-2, 2-0
            self.middles = np.take_along_axis(body.elements[self.owner], between, 1)
        self.sharp = self.sharp_sides(body.points)

    def sharp_sides(self, points):
        """n x 3, of the side opposite each corner."""
        a, b, c = np.moveaxis(points[self.nodes], 1, 0)
        normal = np.cross(b - a, c - a)
        normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
        edges = np.sort(np.stack([self.nodes[:, [1, 2]], self.nodes[:, [2, 0]], self.nodes[:, [0, 1]]], 1), 2)
        _, number, count = np.unique(keys_of(edges.reshape(-1, 2)), return_inverse=True, return_counts=True)
        summed = np.zeros((len(count), 3))
        np.add.at(summed, number, np.repeat(normal, 3, 0))
        cosine = ((summed**2).sum(1) - 2) / 2  # of two sides
        return ((count != 2) | (cosine < SHARP))[number].reshape(-1, 3)

    def triangles(self, placed, chosen=slice(None), straight=False):
        """Of the sides: corners n x 3 x 3, the side that each is of, the barycentric coordinates of its
        corners there, and of its sides 0: within an element, 1: between elements, 2: an edge of the
        surface."""
        numbers = np.arange(len(self.nodes))[chosen]
        corners, edges = placed[self.nodes[numbers]], 1 + self.sharp[numbers].astype(int)
        if self.middles is None or straight:
            return corners, numbers, np.broadcast_to(np.eye(3), corners.shape), edges
        nodes = np.concatenate([corners, placed[self.middles[numbers]]], 1)
        split = nodes[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3, 3)
        return (split, np.repeat(numbers, 4), np.tile(QUARTERS, (len(numbers), 1, 1)),
                (edges[:, None] * ALONG).reshape(-1, 3))

    def outline(self, placed):
        """Edges of the surface, n x 2 x 3."""
        side, opposite = np.nonzero(self.sharp)
        ends = np.stack([self.nodes[side, (opposite + 1) % 3], self.nodes[side, (opposite + 2) % 3]], 1)
        return placed[np.unique(np.sort(ends, 1), axis=0)]


@dataclass
class Seen:
    """Triangles as the camera has them, n x 3 x 3: to the right, upwards, towards the eye."""
    corners: np.ndarray
    colours: callable  # (triangles, barycentric coordinates n x 3) -> n x 3, red, green, blue from 0 to 1
    edges: np.ndarray  # as Surface.triangles has them
    shaded: bool = True


class Buffer:
    """What is seen in each pixel: the number of a triangle in the order given, or -1."""

    def __init__(self, all_seen, window, width):
        left, right, low, high = window
        self.wide = FINER * max(int(width), 8)
        self.size = (right - left) / self.wide  # of a pixel
        self.tall = max(int(round((high - low) / self.size)), 1)
        self.all_seen = [each for each in all_seen if len(each.corners)]
        corners = np.concatenate([each.corners for each in self.all_seen])
        self.corners = (corners - [left, low, 0]) / self.size
        (ax, ay), (bx, by) = [(self.corners[:, i, :2] - self.corners[:, 0, :2]).T for i in (1, 2)]
        self.doubled = ax * by - ay * bx  # areas; what shows its back is not seen
        self.gradients = self.barycentric_gradients()
        self.found = np.full(self.tall * self.wide, -1)
        self.depth = np.full(self.tall * self.wide, -np.inf)
        lower = np.clip(np.floor(self.corners[..., :2].min(1)), 0, [self.wide, self.tall]).astype(int)
        upper = np.clip(np.ceil(self.corners[..., :2].max(1)), 0, [self.wide, self.tall]).astype(int)
        boxes = np.where(self.doubled[:, None] > 0, np.maximum(upper - lower, 0), 0)
        pixels = boxes.prod(1)
        part = (np.cumsum(pixels) - pixels) // AT_ONCE
        for each in np.unique(part[pixels > 0]):
            chosen = np.flatnonzero((part == each) & (pixels > 0))
            self.draw(chosen, lower[chosen], boxes[chosen, 0], pixels[chosen])

    def draw(self, chosen, lower, wide, pixels):
        triangle = np.repeat(np.arange(len(chosen)), pixels)
        within = np.arange(len(triangle)) - np.repeat(np.cumsum(pixels) - pixels, pixels)
        x, y = lower[triangle, 0] + within % wide[triangle], lower[triangle, 1] + within // wide[triangle]
        at = self.barycentric(chosen[triangle], x, y)
        inside = np.flatnonzero((at[0] >= -1e-9) & (at[1] >= -1e-9) & (at[2] >= -1e-9))
        triangle, place = triangle[inside], (y * self.wide + x)[inside]
        heights = self.corners[chosen, :, 2]
        depth = sum(at[i][inside] * heights[:, i][triangle] for i in range(3))
        seen = np.flatnonzero(depth > self.depth[place])
        seen = seen[np.argsort(depth[seen], kind="stable")]  # the last one that is written stays
        self.depth[place[seen]], self.found[place[seen]] = depth[seen], chosen[triangle[seen]]

    def barycentric_gradients(self):
        """3 x 2 arrays, an entry a triangle."""
        ahead, behind = (np.roll(self.corners[..., :2], shift, 1) for shift in (-1, 1))
        area = np.where(self.doubled > 0, self.doubled, 1)[:, None]
        return np.stack([(ahead - behind)[..., 1] / area, (behind - ahead)[..., 0] / area]).transpose(2, 0, 1)

    def barycentric(self, triangle, x, y):
        """Of the middles of pixels, 3 x n."""
        found = []
        for along, across in self.gradients:
            start = 1 / 3 - along * self.corners[:, :, 0].mean(1) - across * self.corners[:, :, 1].mean(1)
            found.append(start[triangle] + along[triangle] * (x + 0.5) + across[triangle] * (y + 0.5))
        return np.array(found)

    def image(self):
        """Rows from above, red, green, blue and how much of a pixel is covered."""
        place = np.flatnonzero(self.found >= 0)
        triangle = self.found[place]
        at = self.barycentric(triangle, place % self.wide, place // self.wide).T
        colours = np.zeros((len(place), 3))
        first = np.cumsum([0, *(len(each.corners) for each in self.all_seen)])
        edges = np.concatenate([each.edges for each in self.all_seen])[triangle]
        for i, each in enumerate(self.all_seen):
            own = np.flatnonzero((triangle >= first[i]) & (triangle < first[i + 1]))
            colours[own] = each.colours(triangle[own] - first[i], at[own])
            if each.shaded:
                colours[own] *= self.light()[triangle[own], None]
        height = (self.doubled[:, None] / np.maximum(self.lengths(), 1e-300))[triangle]  # pixels
        near = np.clip(0.5 * FINER + 0.5 - at * height, 0, 1)
        weak = 0.45 * np.clip((height / FINER - 3) / 9, 0, 1)  # small elements are not dark
        mesh = (near * weak * (edges == 1)).max(1)[:, None]
        ink = (near * 0.85 * (edges == 2)).max(1)[:, None]
        colours = colours * (1 - mesh) + MESH * mesh
        colours = colours * (1 - ink) + INK * ink
        painted = np.zeros((self.tall * self.wide, 4))
        painted[place, :3], painted[place, 3] = colours, 1
        painted = painted.reshape(self.tall, self.wide, 4)
        painted[self.rim(first), :3] = INK
        return self.averaged(painted)[::-1]

    def light(self):
        a, b, c = (self.corners[:, i] for i in range(3))
        normal = np.cross(b - a, c - a)
        normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
        return 0.78 + 0.22 * np.clip(normal @ LIGHT, 0, 1)

    def lengths(self):
        corners = self.corners[..., :2]
        return np.linalg.norm(np.roll(corners, -1, 1) - np.roll(corners, 1, 1), axis=2)

    def rim(self, first):
        """Pixels of a body beside those of another one, or of none, behind it."""
        body = np.where(self.found < 0, -1, np.searchsorted(first, self.found, "right"))
        body = body.reshape(self.tall, -1)
        depth = self.depth.reshape(body.shape)
        found = np.zeros(body.shape, bool)
        for axis in (0, 1):
            for ahead, behind in ((slice(1, None), slice(None, -1)), (slice(None, -1), slice(1, None))):
                here, there = [(each, slice(None))[::1 if axis == 0 else -1] for each in (ahead, behind)]
                found[here] |= (body[here] >= 0) & (body[here] != body[there]) & (depth[here] > depth[there])
        return found

    def averaged(self, painted):
        """FINER pixels to one."""
        tall, wide = -(-self.tall // FINER), self.wide // FINER
        whole = np.zeros((tall * FINER, self.wide, 4))
        whole[:self.tall] = painted
        whole[..., :3] *= whole[..., 3:]
        mean = whole.reshape(tall, FINER, wide, FINER, 4).mean((1, 3))
        mean[..., :3] /= np.maximum(mean[..., 3:], 1e-12)
        return np.clip(mean, 0, 1)

    def shows(self, point):
        """Whether a point of a surface, as the camera has it, is not hidden. low, left: of the window."""
        x, y = np.floor(point[:2]).astype(int)
        if not (0 <= x < self.wide and 0 <= y < self.tall):
            return False
        return point[2] >= self.depth.reshape(self.tall, -1)[y, x] - 3


def painted(values, norm, colours):
    """Colours of values by corner of triangles."""
    table = colours(np.linspace(0, 1, 1024))[:, :3]

    def paint(triangles, at):
        seen = norm((at * values[triangles]).sum(1))
        return table[np.clip(np.nan_to_num(seen) * 1024, 0, 1023).astype(int)]
    return paint


def show(axes, image, window):
    axes.imshow(image, extent=window, zorder=2, interpolation="antialiased", aspect="equal")
    axes.set_xlim(window[:2])
    axes.set_ylim(window[2:])
