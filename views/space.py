"""Pictures of runs in space: the surfaces of deformed bodies, and under them the contact pressure."""
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

import contact_map
import pictures
import surfaces
from columns import ROUNDING, labelled
from contact_surface import Look, surface_of, touching
from pictures import INK, MUTED, bodies_of, plt
from runs import extent, natural_scale
from shapes import placed
from surfaces import Buffer, Seen, camera, painted, show

GLASS = 0.25  # of the colour of bodies through which contact surfaces are seen
AROUND = 0.75  # of the size of the contact, on each side of it in a view of it
LEAST = 0.05  # of the bodies: so large is a contact at least that a view shows


def eye(look):
    return camera(*look.angles)


def window_of(runs, scale, look):
    """What holds all bodies as the camera has them, or the contact that is looked at, with a margin for the
    axes."""
    points = np.concatenate([p for run in runs for p in points_of(run, scale, look)])
    box = np.array([points.min(0), points.max(0)])
    corners = np.stack(np.meshgrid(*box.T), -1).reshape(-1, 3) @ eye(look)[:2].T
    low, high = corners.min(0), corners.max(0)
    margin = 0.12 * (high - low).max()
    if look.nodes is not None:
        size = extent([body for run in runs for body in run.bodies.values()])
        margin = AROUND * max((high - low).max(), LEAST * size)
    return low[0] - margin, high[0] + margin, low[1] - margin, high[1] + (1 if look.nodes is not None
                                                                          else 0.2 / 0.12) * margin


def points_of(run, scale, look):
    for name, body in run.bodies.items():
        if look.nodes is None:
            yield from (body.points, placed(body, scale))
        elif name == look.body:
            yield placed(body, scale)[look.nodes]


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


def draw_bodies(axes, run, look, scale, window, width, values=None, norm=None, colours=None, contact=None):
    """width: of the axes, inches; contact: the name of a field that contact surfaces have, which are seen
    through the bodies. Returns the buffer."""
    turned = eye(look)
    bare = values is None or contact
    seen = [seen_of(body, turned, scale, None if bare or body.rigid else values[name], norm, colours,
                    0.7 if i % 2 else 0.85) for i, (name, body) in enumerate(run.bodies.items())
            if name not in look.hidden]
    buffer = Buffer(seen, window, surfaces.PIXELS * width)
    image = buffer.image()
    if contact:
        buffer = Buffer([contact_seen(body, turned, scale, body.contact[contact], norm, colours)
                         for body in run.bodies.values() if contact in body.contact], window,
                        surfaces.PIXELS * width)
        image[..., 3] *= GLASS
        above = buffer.image()
        image = np.where(above[..., 3:] > 0, above, image)
        draw_outlines(axes, run, look, scale, colors=INK, linewidths=0.5, alpha=0.5, zorder=2.5)
    show(axes, image, window)
    if scale and any(body.displacement.any() for body in run.bodies.values()):
        # as meshed, where deformed bodies do not hide it
        draw_outlines(axes, run, look, 0.0, colors=MUTED, linewidths=0.6, zorder=1, linestyles=[(0, (4, 3))])
    return buffer


def draw_outlines(axes, run, look, scale, **style):
    for name, body in run.bodies.items():
        if name not in look.hidden:
            lines = surface_of(body).outline(placed(body, scale) @ eye(look)[:2].T)
            axes.add_collection(LineCollection(lines, **style), autolim=False)


def contact_seen(body, turned, scale, values, norm, colours):
    """The contact surface of a body, with nodal values."""
    corners, side, at, edges = surface_of(body).triangles(placed(body, scale) @ turned.T, touching(body))
    found = np.einsum("tij,tj->ti", at, values[surface_of(body).nodes[side]])
    back = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] < 0
    corners[back], found[back], edges[back] = (each[back, ::-1] for each in (corners, found, edges))
    return Seen(corners, painted(found, norm, colours), edges)


def zoomed(look, window):
    """Whether a part of the bodies is seen, with axes beside it."""
    return window is not None or look.nodes is not None


def draw_box(axes, views, look, scale, unit):
    """Three edges of the box about the bodies as axes with ticks: the lowest along x and y, the one that is
    furthest to the left or right along z."""
    turned = eye(look)
    points = np.concatenate([placed(body, scale) for each in views for name, body in each.run.bodies.items()
                             if name not in look.hidden])
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


def mark_largest(axes, view, look, scale, field, values, buffer, window, given):
    """In words, with its place; a circle where it is seen."""
    values = {name: each for name, each in values.items() if np.isfinite(each).any()}
    flat = np.concatenate([each[np.isfinite(each)] for each in values.values()])
    if not field.marked or not np.ptp(flat) > ROUNDING * np.abs(flat).max():
        return
    turned, words = eye(look), []
    for end in [max] if not field.signed else [max, min]:
        name = end(values, key=lambda each: getattr(np, f"nan{end.__name__}")(values[each]))
        found, body = values[name], view.run.bodies[name]
        at = np.unravel_index(getattr(np, f"nanarg{end.__name__}")(found), found.shape)
        corners = body.tetrahedra[at[0]]
        chosen = corners[[at[1]]] if len(at) == 2 else corners
        where = body.points[chosen].mean(0) + 0.0
        value = found[at] if abs(found[at]) > ROUNDING * np.abs(flat).max() else 0.0
        size = f"{value:.4g} {field.unit}".rstrip()
        words.append(f"{'largest' if end is max else 'smallest'} {size} in {name} at "
                     f"({', '.join(f'{x:.4g}' for x in where)})")
        point = placed(body, scale)[chosen].mean(0) @ turned.T
        if buffer.shows((point - [window[0], window[2], 0]) / buffer.size):
            axes.plot(*point[:2], marker="o", ms=5, mfc="none", mec=INK, mew=1, zorder=8,
                      path_effects=[withStroke(linewidth=2.2, foreground="white")])
    axes.annotate("\n".join(words), (0.5, 0), (0, -32 if zoomed(look, given) else -12), "axes fraction",
                  "offset points", ha="center", va="top", fontsize=8, annotation_clip=False)


def fields(views, field_name, scale, window, norm, colours, panels, raw, look):
    """As pictures.fields; window: as the camera has it."""
    look = look or Look()
    field, values, norm, colours, cut = pictures.coloured(views, field_name, norm, colours, raw)
    scale = scale if scale is not None else natural_scale(bodies_of(views))
    alike = all(list(each.run.bodies) == list(views[0].run.bodies) for each in views)
    columns = [views if alike else [each] for each in views]
    windows = [window or pictures.whole_window(of, scale, look) for of in columns]
    pictures.require_drawable(views, scale, windows[0])
    maps = [[contact_map.Map(each, k) for k in contact_map.interfaces_of(each)[:2]] if panels else []
            for each in views]
    rows = max(map(len, maps))
    aspect = (windows[0][3] - windows[0][2]) / (windows[0][1] - windows[0][0])
    width = 4.6 if len(views) > 1 else min(5.8, max(4.2, 5.0 / aspect))
    heights = [min(max(width * aspect, 1.5), 9), *[0.62 * width] * rows]
    figure = plt.figure(figsize=(len(views) * width + 1.3, sum(heights) + 0.8 + 0.4 * rows),
                        layout="constrained")
    grid = figure.add_gridspec(1 + rows, len(views), height_ratios=heights)
    whole, below = [], []
    nodal = [each.pressure for of in maps for each in of]
    pressures = contact_map.norm_of(nodal, signed=False) if rows else None
    for i, (each, value) in enumerate(zip(views, values)):
        axes = figure.add_subplot(grid[0, i])
        whole.append(axes)
        buffer = draw_bodies(axes, each.run, look, scale, windows[i], width, value, norm, colours,
                             field.name if field is not None and field.of_contact else None)
        if zoomed(look, window):
            contact_map.name_axes(axes, eye(look), each.result.length_unit)
        else:
            draw_box(axes, columns[i], look, scale, each.result.length_unit)
        if value is not None:
            mark_largest(axes, each, look, scale, field, value, buffer, windows[i], window)
        axes.set_title(pictures.title_of(each, views, scale, round(12 * width)), loc="left")
        if each.result.failed and (stuck := each.result.stuck(each.run)):
            body = each.run.bodies[stuck[0]]
            at = placed(body, scale)[body.tetrahedra[stuck[1]]].mean(0)
            pictures.circle(axes, eye(look)[:2] @ at)
        for k, of_interface in enumerate(maps[i]):
            below.append(figure.add_subplot(grid[1 + k, i]))
            of_interface.draw(below[-1], of_interface.pressure, *pressures, 0.5 * width)
            below[-1].set_title(of_interface.words + ("; filled dots: in contact" if of_interface.marked
                                                      else ""), loc="left", fontsize=8.5)
    if field is not None:
        pictures.add_scale(figure, whole, field, norm, colours, cut, 0.8)
    if rows:
        figure.colorbar(ScalarMappable(*pressures), ax=below, shrink=0.9,
                        label=labelled("contact pressure", views[0].result.stress_unit))
    return figure


def draw_difference(axes, run, values, norm, colours, at):
    """Of two results on one mesh, on the bodies as meshed; a circle where it is largest, which may be
    inside."""
    look = Look()
    draw_bodies(axes, run, look, 0.0, window_of([run], 0.0, look), 5.0, values, norm, colours)
    pictures.circle(axes, eye(look)[:2] @ at)
    axes.set_axis_off()
