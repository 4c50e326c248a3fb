"""Curves of runs: pressure and gap along the line of contact, histories."""
import numpy as np

import columns
from columns import ROUNDING, labelled
from pictures import INK, add_heading, plt, space
from runs import extent

# colour, marker, width
OF_RUNS = [("#0072b2", "o", 2.6), ("#d55e00", "s", 1.4), ("#009e73", "^", 1.2), ("#cc79a7", "D", 1.0)]
OF_A_FAILED_RUN = ("iterations", "material_residual", "force_balance")


def contact(views, exact=None):
    """Pressure, with friction the shear stress too, and gap along the line of every interface, all views in
    one. exact: a pressure to draw beside them."""
    if views[0].result.space:
        return space.contact_map.contact(views)
    lines = [each.result.lines(each.run) for each in views]
    n = max(map(len, lines))
    if n == 0:
        return None
    rough = any(line.shear is not None for of_view in lines for line in of_view)
    figure, axes = plt.subplots(2, n, figsize=(1.2 + 5.2 * n, 5.6), sharex="col", squeeze=False,
                                layout="constrained")
    for i, (each, of_view) in enumerate(zip(views, lines)):
        colour, marker, width = OF_RUNS[i % len(OF_RUNS)]
        style = {"color": colour, "marker": marker, "ms": 4.5, "mfc": "white", "lw": width}
        for (above, below), line in zip(axes.T, of_view):
            above.plot(line.abscissa, line.pressure, label=label_of(each), **style)
            if line.shear is not None:
                above.plot(line.abscissa, line.shear, color=colour, lw=width, ls="--")
                above.plot(line.abscissa[line.slipping], line.shear[line.slipping], color=colour,
                           marker=marker, ms=4.5, ls="")
            below.plot(line.abscissa, line.gap, **{**style, "ls": ""})
            x, gap = line.jump or (line.abscissa, line.gap)
            below.plot(x, gap, color=colour, lw=width)
            if gap.min() < -ROUNDING * np.ptp(x):
                below.fill_between(x, 0, gap, where=gap < 0, color=colour, alpha=0.2, lw=0, interpolate=True)
            above.set_title(f"{line.nonmortar} on {line.mortar}", loc="left")
            below.set_xlabel(labelled(line.name, each.result.length_unit) + "; marks at the nonmortar nodes")
    for i, (above, below) in enumerate(axes.T):
        smallest = ROUNDING * max(of_view[i].lengths[-1] for of_view in lines if len(of_view) > i)
        low, high = below.get_ylim()
        if high - low < smallest:  # rounding is drawn as nothing
            below.set_ylim(-smallest, smallest)
        pressures = np.concatenate([of_view[i].pressure for of_view in lines if len(of_view) > i])
        low, high = pressures.min(), pressures.max()
        if high - low <= ROUNDING * high and not rough:
            above.set_ylim(0, 1.2 * high or 1)
        if exact is not None:
            above.axhline(exact, color=INK, lw=1.1, ls=(0, (5, 3)), label="exact")
        below.axhline(0, color=INK, lw=0.8)
        above.grid()
        below.grid()
    what = "pressure; dashed: shear stress,\nmarks where it slips" if rough else "contact pressure"
    axes[0, 0].set_ylabel(labelled(what, views[0].result.stress_unit))
    axes[1, 0].set_ylabel(labelled("gap; marks: weighted, at nodes", views[0].result.length_unit))
    add_heading(figure, views)
    if len(views) > 1 or exact is not None:
        add_legend(figure)
    return figure


def add_legend(figure):
    """In a strip of its own below all axes, where it covers nothing; in one row where that is wide enough."""
    entries = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels()):
            entries.setdefault(label, handle)
    for columns in (len(entries), 1):
        legend = figure.legend(entries.values(), entries.keys(), loc="lower left", ncols=columns,
                               borderaxespad=0.2)
        extent = legend.get_window_extent()
        if extent.width < figure.bbox.width or columns == 1:
            break
        legend.remove()
    height, strip = figure.get_figheight(), extent.height / figure.dpi + 0.06
    figure.set_figheight(height + strip)
    strip /= height + strip
    figure.get_layout_engine().set(rect=(0, strip, 1, 1 - strip))


def label_of(view):
    """matplotlib leaves out those that begin with a line."""
    name = view.result.name
    return (" " if name.startswith("_") else "") + name


def draw_path(axes, views, moved, force):
    """Force over displacement, from the state before the first step on."""
    for i, view in enumerate(views):
        x, y = (view.result.history.get(name, np.zeros(0)) for name in (moved, force))
        draw_curve(axes, i, np.append(0, x), np.append(0, y), label_of(view))
    axes.set_title(f"{columns.titled(force)} over displacement", loc="left", fontsize=9)
    axes.set_xlabel(columns.titled(moved))
    axes.grid()


def draw_curve(axes, i, x, y, label):
    colour, marker, width = OF_RUNS[i % len(OF_RUNS)]
    axes.plot(x, y, color=colour, lw=max(width, 1.2), marker=marker if len(x) < 60 else None, ms=3,
              label=label)


def history(views):
    """Columns of history.csv against time, those that a scene adds too, and force over displacement;
    of a failed run how hard its steps were as well."""
    also = OF_A_FAILED_RUN if any(each.result.failed for each in views) else ()
    size = max(extent(each.run.bodies.values()) for each in views)
    shown = columns.drawn([each.result.history for each in views], size, also)
    times = [each.result.history.get(f"time[{each.result.time_unit}]", np.zeros(0)) for each in views]
    if not shown or max(map(len, times)) < 2:
        return None
    path = columns.force_and_displacement(shown)
    rows = (len(shown) + bool(path) + 1) // 2
    figure, axes = plt.subplots(rows, 2, figsize=(9.2, 0.6 + 1.9 * rows), squeeze=False,
                                layout="constrained")
    for name, each in zip(shown, axes.flat):
        if each is not axes.flat[0]:
            each.sharex(axes.flat[0])
        for i, (view, time) in enumerate(zip(views, times)):
            values = view.result.history.get(name)
            if values is not None and len(values):
                draw_curve(each, i, time, values, label_of(view))
        if columns.bare(name) in ("material_residual", "force_balance") and all(
                (view.result.history[name] > 0).any() for view in views if name in view.result.history):
            each.set_yscale("log")
        each.set_title(columns.titled(name), loc="left", fontsize=9)
        each.grid()
    for each in list(axes.flat)[len(shown) + bool(path):]:
        each.set_axis_off()
    if path:
        draw_path(axes.flat[len(shown)], views, *path)
    for i, each in enumerate(axes.flat[:len(shown)]):
        last = i + 2 >= len(shown)  # of its column
        each.tick_params(labelbottom=last)
        if last:
            each.set_xlabel(labelled("time", views[0].result.time_unit))
    if len(views) > 1:
        add_legend(figure)
    return figure
