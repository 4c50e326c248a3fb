"""Pictures of runs in space: the surfaces of deformed bodies, and under them the contact pressure."""
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

import pictures
import results
from columns import ROUNDING, labelled
from contact_surface import surface_of
from pictures import COLOURS, INK, MUTED, SIGNED_COLOURS, bodies_of, plt
from runs import extent, natural_scale
from shapes import placed
from surfaces import Buffer, Seen, Surface, camera

LOOK = (-60.0, 25.0)  # azimuth and elevation of the eye, degrees
PIXELS = 130  # on an inch
PRESSURES = "YlOrRd"
ALONG_AN_AXIS = 0.999  # cosine
CLOSED = 0.3  # of the area of a surface that its mean normal has left, below which the eye looks as at bodies
MARKED = 400  # nodes of a contact surface that are not too many to be marked


def window_of(views, scale, look):
    """What holds all bodies as the camera has them, with a margin for the axes."""
    points = np.concatenate([p for body in bodies_of(views)
                             for p in (body.points, body.points + scale * body.displacement)])
    box = np.array([points.min(0), points.max(0)])
    corners = np.stack(np.meshgrid(*box.T), -1).reshape(-1, 3) @ camera(*(look or LOOK))[:2].T
    low, high = corners.min(0), corners.max(0)
    margin = 0.12 * (high - low).max()
    return low[0] - margin, high[0] + margin, low[1] - margin, high[1] + 0.2 * margin


def painted(values, norm, colours):
    """Colours of values by corner of triangles."""
    table = colours(np.linspace(0, 1, 1024))[:, :3]

    def paint(triangles, at):
        seen = norm((at * values[triangles]).sum(1))
        return table[np.clip(np.nan_to_num(seen) * 1024, 0, 1023).astype(int)]
    return paint


def seen_of(body, turned, scale, values, norm, colours, plain):
    """values: by corner of the tetrahedra, by tetrahedron, or None: of one colour."""
    surface = surface_of(body)
    corners, side, at, edges = surface.triangles(placed(body, scale) @ turned.T)
    if values is None:
        return Seen(corners, lambda triangles, _: np.full((len(triangles), 3), plain), edges)
    owner = surface.owner[side]
    if values.ndim == 2:
        of_sides = values[owner[:, None], surface.local[side]]
        of_corners = np.einsum("tij,tj->ti", at, of_sides)
    else:
        of_corners = np.repeat(values[owner][:, None], 3, 1)
    return Seen(corners, painted(of_corners, norm, colours), edges)


def draw_bodies(axes, run, look, scale, window, width, values=None, norm=None, colours=None):
    """width: of the axes, inches. Returns the buffer."""
    turned = camera(*(look or LOOK))
    seen = [seen_of(body, turned, scale, None if values is None else values[name], norm, colours,
                    0.7 if i % 2 else 0.85) for i, (name, body) in enumerate(run.bodies.items())]
    buffer = Buffer(seen, window, PIXELS * width)
    show(axes, buffer, window)
    if scale and any(body.displacement.any() for body in run.bodies.values()):
        for body in run.bodies.values():  # as meshed, where deformed bodies do not hide it
            lines = surface_of(body).outline(body.points @ turned.T)[..., :2]
            axes.add_collection(LineCollection(lines, colors=MUTED, linewidths=0.6, zorder=1,
                                               linestyles=[(0, (4, 3))]), autolim=False)
    return buffer


def show(axes, buffer, window):
    axes.imshow(buffer.image(), extent=window, zorder=2, interpolation="antialiased", aspect="equal")
    axes.set_xlim(window[:2])
    axes.set_ylim(window[2:])


def draw_box(axes, views, look, scale, unit):
    """Three edges of the box about the bodies as axes with ticks: the lowest along x and y, the one that is
    furthest to the left or right along z."""
    turned = camera(*(look or LOOK))
    points = np.concatenate([placed(body, scale) for body in bodies_of(views)])
    low, high = points.min(0), points.max(0)
    size, middle = (high - low).max(), ((low + high) / 2) @ turned.T
    for axis, name in enumerate("xyz"):
        across = [i for i in range(3) if i != axis]
        ends = []
        for a in (0, 1):
            for b in (0, 1):
                end = np.empty((2, 3))
                end[:, axis] = low[axis], high[axis]
                end[:, across] = np.where([a, b], high[across], low[across])
                ends.append(end @ turned.T)
        if np.linalg.norm((ends[0][1] - ends[0][0])[:2]) < 0.08 * size:
            continue  # towards the eye
        edge = min(ends, key=lambda each: (each[:, 1] if axis < 2 else each[:, 0]).mean())
        along = (edge[1] - edge[0])[:2] / np.linalg.norm((edge[1] - edge[0])[:2])
        out = np.array([along[1], -along[0]])
        out *= 1 if out @ (edge.mean(0) - middle)[:2] >= 0 else -1
        span = (low[axis], high[axis])
        ticks = [x for x in MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]).tick_values(*span)
                 if span[0] - 1e-9 * size <= x <= span[1] + 1e-9 * size]
        foot = edge[:, :2] + 0.02 * size * out
        axes.plot(*foot.T, color=MUTED, lw=0.7, zorder=1.5, clip_on=False)
        style = {"ha": "center", "va": "center", "textcoords": "offset points", "annotation_clip": False}
        for x in ticks:
            at = foot[0] + (foot[1] - foot[0]) * (x - span[0]) / max(span[1] - span[0], 1e-300)
            axes.plot(*np.array([at, at + 0.015 * size * out]).T, color=MUTED, lw=0.7, zorder=1.5,
                      clip_on=False)
            axes.annotate(f"{0 if abs(x) < 1e-9 * size else x:.6g}", at, 12 * out, fontsize=7, **style)
        axes.annotate(labelled(name, unit), foot.mean(0), 27 * out, **style)
    axes.set_axis_off()


def mark_largest(axes, view, look, scale, field, values, buffer, window):
    """In words, with its place; a circle where it is seen."""
    flat = np.concatenate([each.ravel() for each in values.values()])
    if not field.marked or not np.ptp(flat) > ROUNDING * np.abs(flat).max():
        return
    turned, words = camera(*(look or LOOK)), []
    for end in [max] if not field.signed else [max, min]:
        name = end(values, key=lambda each: getattr(values[each], end.__name__)())
        found, body = values[name], view.run.bodies[name]
        at = np.unravel_index(getattr(found, f"arg{end.__name__}")(), found.shape)
        corners = body.tetrahedra[at[0]]
        chosen = corners[[at[1]]] if len(at) == 2 else corners
        where = body.points[chosen].mean(0) + 0.0
        size = f"{found[at]:.4g} {field.unit}".rstrip()
        words.append(f"{'largest' if end is max else 'smallest'} {size} in {name} at "
                     f"({', '.join(f'{x:.4g}' for x in where)})")
        point = placed(body, scale)[chosen].mean(0) @ turned.T
        if buffer.shows((point - [window[0], window[2], 0]) / buffer.size):
            axes.plot(*point[:2], marker="o", ms=5, mfc="none", mec=INK, mew=1, zorder=8,
                      path_effects=[withStroke(linewidth=2.2, foreground="white")])
    axes.text(0.5, 0.03, "\n".join(words), transform=axes.transAxes, ha="center", va="top", fontsize=8)


def fields(views, field_name, scale, window, norm, colours, panels, raw, look):
    """As pictures.fields; window: as the camera has it."""
    field, values, cut = None, [None] * len(views), False
    if field_name != "none":
        field = views[0].result.fields(views[0].run)[field_name]
        values = [pictures.shown_values(each, field, raw) for each in views]
        natural = pictures.colours_of(field, [(each.run.bodies, value)
                                              for each, value in zip(views, values)])
        cut = natural[2] and norm is None
        norm, colours = norm or natural[0], colours or natural[1]
    scale = scale if scale is not None else natural_scale(bodies_of(views))
    alike = all(list(each.run.bodies) == list(views[0].run.bodies) for each in views)
    columns = [views if alike else [each] for each in views]
    windows = [window or window_of(of, scale, look) for of in columns]
    pictures.require_drawable(views, scale, windows[0])
    maps = [[Map(each, k) for k in interfaces_of(each)[:2]] if panels else [] for each in views]
    rows = max(map(len, maps))
    aspect = (windows[0][3] - windows[0][2]) / (windows[0][1] - windows[0][0])
    width = 4.6 if len(views) > 1 else min(5.8, max(4.2, 5.0 / aspect))
    heights = [min(max(width * aspect, 1.5), 9), *[0.62 * width] * rows]
    figure = plt.figure(figsize=(len(views) * width + 1.3, sum(heights) + 0.8 + 0.4 * rows),
                        layout="constrained")
    grid = figure.add_gridspec(1 + rows, len(views), height_ratios=heights)
    whole, below = [], []
    pressures = norm_of([each.pressure for of in maps for each in of], signed=False) if rows else None
    for i, (each, value) in enumerate(zip(views, values)):
        axes = figure.add_subplot(grid[0, i])
        whole.append(axes)
        buffer = draw_bodies(axes, each.run, look, scale, windows[i], width, value, norm, colours)
        draw_box(axes, columns[i], look, scale, each.result.length_unit)
        if value is not None:
            mark_largest(axes, each, look, scale, field, value, buffer, windows[i])
        axes.set_title(pictures.title_of(each, views, scale, round(12 * width)), loc="left")
        if each.result.failed and (stuck := each.result.stuck(each.run)):
            mark_failure(axes, each, look, scale, *stuck[:2])
        for k, of_interface in enumerate(maps[i]):
            below.append(figure.add_subplot(grid[1 + k, i]))
            of_interface.draw(below[-1], of_interface.pressure, *pressures, 0.5 * width)
            below[-1].set_title(of_interface.words + ("; filled dots: in contact" if of_interface.marked
                                                      else ""), loc="left", fontsize=8.5)
    if field is not None:
        figure.colorbar(ScalarMappable(norm, colours), ax=whole, label=labelled(field.words, field.unit),
                        shrink=0.8, extend=("both" if field.signed else "max") if cut else "neither")
    if rows:
        figure.colorbar(ScalarMappable(*pressures), ax=below, shrink=0.9,
                        label=labelled("contact pressure", views[0].result.stress_unit))
    return figure


def mark_failure(axes, view, look, scale, name, element):
    body = view.run.bodies[name]
    at = placed(body, scale)[body.tetrahedra[element]].mean(0) @ camera(*(look or LOOK)).T
    axes.plot(*at[:2], marker="o", ms=16, mfc="none", mec="#d00000", mew=1.8, zorder=9, clip_on=False)


def draw_difference(axes, run, values, norm, colours, at):
    """Of two results on one mesh, on the bodies as meshed; a circle where it is largest, which may be
    inside."""
    bodies = list(run.bodies.values())
    points = np.concatenate([body.points for body in bodies])
    corners = np.stack(np.meshgrid(*np.array([points.min(0), points.max(0)]).T), -1).reshape(-1, 3)
    turned = camera(*LOOK)
    low, high = (corners @ turned[:2].T).min(0), (corners @ turned[:2].T).max(0)
    margin = 0.12 * (high - low).max()
    window = low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin
    draw_bodies(axes, run, LOOK, 0.0, window, 5.0, values, norm, colours)
    axes.plot(*(at @ turned[:2].T), marker="o", ms=14, mfc="none", mec="#d00000", mew=1.6, zorder=9)
    axes.set_axis_off()


def interfaces_of(view):
    return [k for k in range(len(view.result.interfaces)) if (view.run.contact.interface == k).any()]


def norm_of(values, signed, smallest=0.0):
    """Norm and colours of nodal values."""
    values = np.concatenate(values)
    low, high = min(values.min(), 0.0), max(values.max(), 0.0)
    if both := signed and low < -ROUNDING * high:
        low, high = -max(-low, high), max(-low, high)
    if not high - low > smallest:  # rounding is drawn as nothing
        high = smallest or 1.0
        low = -high if both else 0.0
    name = SIGNED_COLOURS if both else COLOURS if signed else PRESSURES
    return Normalize(low, high), plt.get_cmap(name)


class Map:
    """The nonmortar surface of an interface as meshed, seen along its mean normal; a closed one as bodies
    are."""

    def __init__(self, view, interface):
        contact, described = view.run.contact, view.result.interfaces[interface]
        self.words = f"{described['nonmortar']} on {described['mortar']}"
        rows = np.flatnonzero(contact.interface == interface)
        if contact.position.shape[1] != 3:
            raise results.ResultError(f"{view.result.folder / 'contact.csv'}: no column z")
        self.body, self.unit = view.run.bodies[described["nonmortar"]], view.result.length_unit
        self.vertex, self.closed = contact.vertex[rows], contact.force[rows] > 0
        self.pressure, self.gap = contact.pressure[rows], contact.gap[rows]
        self.surface = surface_of(self.body)
        self.chosen = np.flatnonzero(np.isin(self.surface.nodes, self.vertex).all(1))
        self.look()
        self.marked = len(rows) <= MARKED and not self.folded

    def look(self):
        """Rows to the right, upwards and towards the eye: the first two along axes where they can be."""
        a, b, c = np.moveaxis(self.body.points[self.surface.nodes[self.chosen]], 1, 0)
        doubled = np.cross(b - a, c - a)
        normal, area = doubled.sum(0), np.linalg.norm(doubled, axis=1).sum()
        self.folded = not np.linalg.norm(normal) > CLOSED * area
        if self.folded:
            self.turned = camera(*LOOK)
            return
        normal /= np.linalg.norm(normal)
        axis = int(np.abs(normal).argmax())
        right, up = np.delete(np.eye(3), axis, 0)
        up = up - (up @ normal) * normal
        up /= np.linalg.norm(up)
        right = np.cross(up, normal) * (1 if np.cross(up, normal) @ right >= 0 else -1)
        self.turned = np.array([right, up, normal])

    def draw(self, axes, values, norm, colours, width):
        at = self.body.points[self.vertex] @ self.turned.T
        low, high = at[:, :2].min(0), at[:, :2].max(0)
        margin = 0.04 * max((high - low).max(), 1e-9 * extent([self.body]))
        window = low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin
        if len(self.chosen):
            by_node = np.zeros(len(self.body.points))
            by_node[self.vertex] = values
            corners, _, _, edges = Surface.triangles(Straight(self.surface), self.body.points @ self.turned.T,
                                                     self.chosen)
            edges = np.minimum(edges, 1)
            nodes = self.surface.nodes[self.chosen]
            if np.linalg.det(self.turned) < 0:  # seen from behind, that axes point to the right and upwards
                corners, edges, nodes = corners[:, ::-1], edges[:, ::-1], nodes[:, ::-1]
            seen = [Seen(corners, painted(by_node[nodes], norm, colours), edges, shaded=self.folded)]
            show(axes, Buffer(seen, window, PIXELS * width), window)
        if self.marked:
            for closed, fill in ((True, INK), (False, "white")):
                chosen = at[self.closed == closed, :2]
                if len(chosen):  # a line without points would have a place in the layout
                    axes.plot(*chosen.T, ls="", marker="o", ms=2.6, mfc=fill, mec=INK, mew=0.5, zorder=5,
                              clip_on=False)
        axes.set_aspect("equal")
        axes.set_xlim(window[:2])
        axes.set_ylim(window[2:])
        for row, label in ((self.turned[0], axes.set_xlabel), (self.turned[1], axes.set_ylabel)):
            axis = int(np.abs(row).argmax())
            label(labelled("xyz"[axis] if row[axis] > ALONG_AN_AXIS else
                           f"along ({', '.join(f'{x:.2f}' for x in row + 0.0)})", self.unit))


class Straight:
    """A surface without the middles of its sides: contact nodes are its corners."""

    def __init__(self, surface):
        self.nodes, self.sharp, self.middles = surface.nodes, surface.sharp, None


def contact(views):
    """Pressure and gap on the nonmortar surface of every interface."""
    columns = [(each, Map(each, k)) for each in views for k in interfaces_of(each)]
    if not columns:
        return None
    n, width = len(columns), 4.0
    figure, axes = plt.subplots(2, n, figsize=(1.8 + width * n, 7.6), squeeze=False, layout="constrained")
    small = ROUNDING * extent(bodies_of(views))
    drawn = [norm_of([each.pressure for _, each in columns], signed=False),
             norm_of([each.gap for _, each in columns], True, small)]
    for (view, each), (above, below) in zip(columns, axes.T):
        each.draw(above, each.pressure, *drawn[0], width)
        each.draw(below, each.gap, *drawn[1], width)
        above.set_title((f"{view.result.name}: " if len(views) > 1 else "") + each.words, loc="left")
    words = ("contact pressure", "gap, weighted, at nodes")
    units = (views[0].result.stress_unit, views[0].result.length_unit)
    for row, of_row, what, unit in zip(axes, drawn, words, units):
        figure.colorbar(ScalarMappable(*of_row), ax=row, shrink=0.9, label=labelled(what, unit))
    time = pictures.time_words(views[0].result, views[0].step)
    figure.suptitle(f"{views[0].result.title}, {time}" if len(views) == 1 else time, x=0.02, ha="left",
                    fontsize=10.5)
    if any(each.marked for _, each in columns):
        figure.text(0.02, 0.0, "dots: nodes of the nonmortar side, filled where there is contact", fontsize=8,
                    va="bottom")
        figure.get_layout_engine().set(rect=(0, 0.03, 1, 0.97))
    return figure
