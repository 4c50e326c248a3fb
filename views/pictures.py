"""Pictures of runs: deformed bodies, and under them the line of contact magnified."""
import textwrap
from dataclasses import dataclass

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.patheffects import withStroke

import contact_surface
import shapes
from columns import ROUNDING, labelled
from ending import Wrong
from recovery import averaged, averaged_von_mises
from runs import extent, natural_scale, top_of

INK, MUTED, MESH, GRID = "#222222", "#777777", "#55555a", "#dddddd"
NONMORTAR, MORTAR = "#b0128a", "#0b7a3b"
COLOURS, SIGNED_COLOURS, PRESSURES = "viridis", "RdBu_r", "YlOrRd"
STYLE = {
    "font.family": "DejaVu Sans", "font.size": 9, "axes.titlesize": 10.5, "axes.labelsize": 9,
    "text.color": INK, "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK,
    "axes.edgecolor": MUTED, "axes.linewidth": 0.7, "xtick.labelsize": 8, "ytick.labelsize": 8,
    "axes.spines.top": False, "axes.spines.right": False, "axes.axisbelow": True, "grid.color": GRID,
    "grid.linewidth": 0.6,
    "legend.fontsize": 8, "legend.frameon": False, "savefig.dpi": 150, "svg.hashsalt": "mortier",
    "svg.fonttype": "path", "text.parse_math": False,  # titles and names are shown as they are
}
FINE = 20_000  # triangles of a body
FAR = 1e6  # times the bodies: what is larger or smaller cannot be drawn beside them


@dataclass
class View:
    """One column of a picture: a run at a step."""
    result: object  # runs.Result
    run: object  # results.Run
    step: int

    def __post_init__(self):
        if self.result.space:
            contact_surface.attach(self.run, self.result.interfaces)


def view(result, step=None):
    step = result.step(step)
    return View(result, result.at(step), step)


def time_words(result, step):
    return f"t = {result.time(step):.6g} {result.time_unit}".rstrip()


def bodies_of(views):
    return [body for each in views for body in each.run.bodies.values()]


def shown_values(view, field, raw):
    """Body name -> values by triangle, or by corner of the triangles, n x 3: of fields by vertex, and of
    stresses and strains recovered at the vertices."""
    values = view.result.values(view.run, field)
    found = {}
    for name, body in view.run.bodies.items():
        if field.by_vertex:
            found[name] = values[name][body.simplices]
        elif raw or not field.recoverable:
            found[name] = values[name]
        elif field.name == "von_mises":
            found[name] = averaged_von_mises(body)
        else:
            found[name] = averaged(body, values[name])
    return found


def colours_of(field, of_views):
    """Norm, colours and at which ends values are beyond the scale: a corner must not take all the colours.
    of_views: bodies and values by triangle or corner."""
    of_views = [({name: body for name, body in bodies.items() if not body.rigid},  # tools are grey
                 {name: each for name, each in named.items() if not bodies[name].rigid})
                for bodies, named in of_views]
    values = np.concatenate([each.ravel() for _, named in of_views for each in named.values()])
    values = values[np.isfinite(values)]  # contact surfaces are not everywhere
    low, high = values.min(), values.max()
    size = max(abs(low), abs(high))
    cut = False
    top = max(top_of(field, bodies, named) for bodies, named in of_views)
    if field.signed:
        cut = top < 0.7 * size
        low, high = (-top, top) if cut and top > 0 else (-size, size)
    else:
        cut = top < 0.7 * high
        high = top if cut and top > 0 else high
        low = min(0.0, low) if high - low > 0.5 * abs(high) else low
    if high - low <= ROUNDING * size or size == 0:
        margin = 0.1 * size or 1.0
        low, high = low - margin, high + margin
    colours = SIGNED_COLOURS if field.signed else PRESSURES if field.of_contact else COLOURS
    return Normalize(low, high), matplotlib.colormaps[colours], cut


def coloured(views, field_name, norm, colours, raw):
    """The field, its values of each view, their norm, colours, and whether some are beyond them."""
    if field_name == "none":
        return None, [None] * len(views), norm, colours, False
    field = views[0].result.fields(views[0].run)[field_name]
    values = [shown_values(each, field, raw) for each in views]
    natural = colours_of(field, [(each.run.bodies, value) for each, value in zip(views, values)])
    return field, values, norm or natural[0], colours or natural[1], natural[2] and norm is None


def add_scale(figure, axes, field, norm, colours, cut, shrink):
    figure.colorbar(ScalarMappable(norm, colours), ax=axes, label=labelled(field.words, field.unit),
                    shrink=shrink, extend=("both" if field.signed else "max") if cut else "neither")


def draw_bodies(axes, run, scale=1.0, values=None, norm=None, colours=None):
    """Deformed triangles; coloured by values (shown_values), or plain meshes where there are none."""
    for i, (name, body) in enumerate(run.bodies.items()):
        corners, owner, parts = shapes.pieces(body, scale)
        x, y = corners.reshape(-1, 2).T
        triangles = np.arange(len(x)).reshape(-1, 3)
        fine = len(triangles) > FINE
        style = {"cmap": colours, "norm": norm, "rasterized": fine}
        if values is None or body.rigid:
            axes.tripcolor(x, y, triangles,
                           facecolors=np.full(len(triangles), 0.35 if body.rigid else 0.25 if i % 2 else 0.1),
                           cmap="Greys", vmin=0, vmax=1, edgecolors="face", linewidth=0.1, rasterized=fine)
        elif values[name].ndim == 2:
            paint = np.einsum("tij,tj->ti", parts, values[name][owner])
            axes.tripcolor(x, y, triangles, paint.ravel(), shading="gouraud",
                           **{**style, "rasterized": True})
        else:
            axes.tripcolor(x, y, triangles, facecolors=values[name][owner], edgecolors="face",
                           linewidth=0 if fine else 0.1, antialiased=not fine, **style)
        draw_edges(axes, body, scale, 1.0 if values is None else 0.5, fine)


def draw_edges(axes, body, scale, strength, fine):
    """Sides of triangles, thin where they are short, that refined places are not dark; the boundary."""
    sides = shapes.sides(body, scale)
    length = np.hypot(*(sides[:, 1] - sides[:, 0]).T)
    box = np.ptp(body.points, axis=0).max()
    points = 250 * length / (box if box > 0 else 1)  # as long as they are in a picture of usual size
    seen = (points > 1.5) & (not body.rigid)
    axes.add_collection(LineCollection(sides[seen], colors=MESH, alpha=strength, rasterized=fine,
                                       linewidths=np.clip(0.03 * points[seen], 0.05, 0.35)), autolim=False)
    axes.add_collection(LineCollection(shapes.outline(body, scale), colors=INK, linewidths=0.6, zorder=2.5),
                        autolim=False)


def draw_as_meshed(axes, run):
    """Outlines of the bodies as meshed, dashed."""
    for body in run.bodies.values():
        axes.add_collection(LineCollection(shapes.outline(body, 0.0), colors=MUTED, linewidths=0.6,
                                           linestyles=[(0, (4, 3))], zorder=3), autolim=False)


def mark_extremes(axes, view, scale, field, values):
    """The place of the largest value, and of the smallest where values have two signs."""
    ends = [max] if not field.signed else [max, min]
    flat = np.concatenate([each.ravel() for each in values.values()])
    if not field.marked or not np.ptp(flat) > ROUNDING * np.abs(flat).max():
        return
    for end in ends:
        name = end(values, key=lambda each: getattr(values[each], end.__name__)())
        found, body = values[name], view.run.bodies[name]
        at = np.unravel_index(getattr(found, f"arg{end.__name__}")(), found.shape)
        points = shapes.placed(body, scale)
        corners = points[body.triangles[at[0]]]
        place = corners[at[1]] if len(at) == 2 else corners.mean(0)
        axes.plot(*place, marker="o", ms=5, mfc="none", mec=INK, mew=1, zorder=8, clip_on=True)
        left = place[0] > points[:, 0].mean()  # the words stay within the body
        words = axes.annotate(f"{found[at]:.4g}", place, (-6 if left else 6, 4), textcoords="offset points",
                              ha="right" if left else "left", fontsize=8, zorder=8, annotation_clip=True,
                              path_effects=[withStroke(linewidth=2, foreground="white")])
        words.set_in_layout(False)


def circle(axes, place):
    """About what is to be looked at."""
    axes.plot(*place, marker="o", ms=16, mfc="none", mec="#d00000", mew=1.8, zorder=9, clip_on=False)


def show_window(axes, window):
    axes.set_aspect("equal")
    axes.set_xlim(window[:2])
    axes.set_ylim(window[2:])


def add_heading(figure, views):
    words = time_words(views[0].result, views[0].step)
    figure.suptitle(f"{views[0].result.title}, {words}" if len(views) == 1 else words, x=0.02, ha="left",
                    fontsize=10.5)


def draw_whole(axes, view, scale, window, field, values, norm, colours):
    draw_bodies(axes, view.run, scale, values, norm, colours)
    draw_as_meshed(axes, view.run)
    if values is not None:
        mark_extremes(axes, view, scale, field, values)
    show_window(axes, window)
    unit = view.result.length_unit
    axes.set_xlabel(labelled(view.result.axes[0], unit))
    axes.set_ylabel(labelled(view.result.axes[1], unit))


def whole_window(views, scale, look=None):
    """What holds all bodies, deformed and as meshed, with a margin."""
    if views[0].result.space:
        return space.window_of([each.run for each in views], scale, look or contact_surface.Look())
    points = np.concatenate([p for body in bodies_of(views)
                             for p in (body.points, body.points + scale * body.displacement)])
    low, high = points.min(0), points.max(0)
    margin = 0.03 * (high - low).max()
    return low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin


def require_drawable(views, scale, window):
    """A scale and a window of any size are refused, before matplotlib is at a loss."""
    size = extent(bodies_of(views))
    most = abs(scale) * max(np.abs(body.displacement).max() for body in bodies_of(views)) / size
    if not most <= FAR:
        raise Wrong(f"--scale {scale:g}: displacements of {most:.3g} times the bodies, expected {FAR:g} "
                    "at most")
    for side in (window[1] - window[0], window[3] - window[2]):
        if not size / FAR <= side <= FAR * size:
            raise Wrong(f"--window: a side of {side:.3g}, expected {size / FAR:.3g} to {FAR * size:.3g}")


def strip_window(lines):
    """Of the magnified line in all columns: x, and y from what both sides do there."""
    low, high = min(line.window()[0] for line in lines), max(line.window()[1] for line in lines)
    ordinates = [each[(each[:, 0] >= low) & (each[:, 0] <= high), 1] for line in lines
                 for each in (line.nonmortar_trace, *line.mortar_trace)]
    ordinates = np.concatenate(ordinates)
    if not len(ordinates):
        ordinates = np.concatenate([line.nonmortar_trace[:, 1] for line in lines])
    middle, half = (ordinates.min() + ordinates.max()) / 2, 0.7 * np.ptp(ordinates)
    margin = 0.04 * (high - low)
    return low - margin, high + margin, middle, max(half, 0.02 * (high - low))


def draw_magnified(axes, view, line, window, values, norm, colours):
    """A strip about the line of contact, stretched across it; where the bodies penetrate it is hatched."""
    low, high, middle, half = window
    for name in (line.nonmortar, line.mortar):
        body = view.run.bodies[name]
        moved = np.abs(body.displacement).max()
        reach = abs(middle) + half + 2 * moved
        box = line.points.min(0) - reach, line.points.max(0) + reach
        near = ((body.points >= box[0]) & (body.points <= box[1])).all(1)
        triangles = np.flatnonzero(near[body.triangles].any(1))
        if len(triangles) * len(line.length) > 2_000_000:
            triangles = triangles[:0]  # too fine to be seen in the strip: the two lines do
        if not len(triangles):
            continue
        vertices, corners = np.unique(body.triangles[triangles], return_inverse=True)
        placed = line.placed(body.points[vertices], body.displacement[vertices])
        corners = corners.reshape(-1, 3)
        sides = np.abs(np.diff(placed[corners][:, [0, 1, 2, 0], 0], axis=1)).max(1)
        sound = sides < 0.5 * (high - low) + 4 * np.median(sides)  # none that the unrolled line tears apart
        if values is None:
            continue
        style = {"cmap": colours, "norm": norm}
        of_triangles = values[name][triangles[sound]]
        if of_triangles.ndim == 2:
            x, y = placed[corners[sound]].reshape(-1, 2).T
            axes.tripcolor(x, y, np.arange(len(x)).reshape(-1, 3), of_triangles.ravel(), shading="gouraud",
                           rasterized=True, **style)
            axes.triplot(*placed.T, corners[sound], color=MESH, lw=0.3)
        else:
            axes.tripcolor(*placed.T, corners[sound], facecolors=of_triangles, edgecolors=MESH,
                           linewidth=0.3, **style)
    hatch_penetration(axes, line)
    for edge in line.mortar_trace:
        axes.plot(*edge.T, color=MORTAR, lw=1.6, zorder=5, marker="s", ms=3.2, mfc="white")
    axes.plot(*line.nonmortar_trace.T, color=NONMORTAR, lw=1.6, zorder=6, marker="o", ms=4, mfc="white")
    axes.set_xlim(low, high)
    axes.set_ylim(middle - half, middle + half)
    axes.set_xlabel(labelled(line.name, view.result.length_unit))


def hatch_penetration(axes, line):
    if not len(line.mortar_trace):
        return
    across = line.mortar_trace.reshape(-1, 2)
    across = across[np.argsort(across[:, 0], kind="stable")]
    x = np.union1d(line.nonmortar_trace[:, 0], across[:, 0])
    x = x[(x >= max(line.nonmortar_trace[0, 0], across[0, 0])) & (x <= min(line.nonmortar_trace[-1, 0],
                                                                           across[-1, 0]))]
    if len(x) < 2 or (np.diff(line.nonmortar_trace[:, 0]) < 0).any():
        return
    ours, theirs = np.interp(x, *line.nonmortar_trace.T), np.interp(x, *across.T)
    overlap = line.up * (theirs - ours)
    if np.max(overlap) > ROUNDING * np.ptp(x):
        axes.fill_between(x, ours, theirs, where=overlap > 0, interpolate=True, facecolor="none",
                          edgecolor=INK, hatch="//////", linewidth=0, zorder=4)


def fields(views, field_name="von_mises", scale=None, window=None, norm=None, colours=None, strips=True,
           raw=False, look=None):
    """One column a view: the deformed bodies, under them their lines of contact magnified. norm, colours: in
    place of those that the values suggest. raw: stresses of the triangles, not recovered at the vertices.
    look: contact_surface.Look, in space."""
    if views[0].result.space:
        return space.fields(views, field_name, scale, window, norm, colours, strips, raw, look)
    field, values, norm, colours, cut = coloured(views, field_name, norm, colours, raw)
    scale = scale if scale is not None else natural_scale(bodies_of(views))
    # else each has a window of its own
    alike = all(list(each.run.bodies) == list(views[0].run.bodies) for each in views)
    windows = [window or whole_window(views if alike else [each], scale) for each in views]
    window = windows[0]
    require_drawable(views, scale, window)
    lines = [each.result.lines(each.run, min(scale, 1.0))[:3] if strips else [] for each in views]
    rows = max(map(len, lines))
    aspect = (window[3] - window[2]) / (window[1] - window[0])
    width = 4.2 if len(views) > 1 else min(5.6, max(3.6, 4.6 / aspect))
    heights = [min(max(width * aspect, 1.2), 9), *[0.42 * width] * rows]
    figure = plt.figure(figsize=(len(views) * width + 1.3, sum(heights) + 0.55 + 0.35 * rows),
                        layout="constrained")
    grid = figure.add_gridspec(1 + rows, len(views), height_ratios=heights)
    whole = []
    for i, (each, value) in enumerate(zip(views, values)):
        axes = figure.add_subplot(grid[0, i])
        whole.append(axes)
        draw_whole(axes, each, scale, windows[i], field, value, norm, colours)
        axes.set_title(title_of(each, views, scale, round(13 * width)), loc="left")
        if each.result.failed and (stuck := each.result.stuck(each.run)):
            # where the last good state is closest to what the step could not follow
            body = each.run.bodies[stuck[0]]
            circle(axes, shapes.placed(body, scale)[body.triangles[stuck[1]]].mean(0))
        for k, line in enumerate(lines[i]):
            below = figure.add_subplot(grid[1 + k, i])
            shared = strip_window([of_run[k] for of_run in lines if len(of_run) > k] if alike else [line])
            draw_magnified(below, each, line, shared, value, norm, colours)
            below.set_ylabel(labelled("across, magnified", each.result.length_unit))
            below.set_title(f"contact: {line.nonmortar} (nonmortar, circles), {line.mortar} (squares)",
                            loc="left", fontsize=8)
    if field is not None:
        add_scale(figure, whole, field, norm, colours, cut, 0.9)
    return figure


def title_of(view, views, scale, letters):
    name = view.result.title if len(views) == 1 else view.result.name
    words = "" if scale == 1 else f", deformation x{scale:g}"
    lines = [f"{name}, {time_words(view.result, view.step)}{words}"]
    if view.result.failed:
        lines.append(f"stopped early: {view.result.reason}")
        if stuck := view.result.stuck(view.run):
            lines.append(f"circle: {stuck[2]}")
    return "\n".join(textwrap.fill(line, letters) for line in lines)


import space  # noqa: E402: it uses this module
