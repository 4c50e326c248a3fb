"""Work-precision plots: error against wall time, memory and degrees of freedom, the Pareto front marked."""
import io

import matplotlib.pyplot as plt
import numpy as np

from analysis import distinguishing, front, order, slope
from table import CLAIMS, COSTS

COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#555555", "#000000"]
MARKERS = "osD^vP*X"
AXES = {"wall_time": "wall time [s]", "memory": "peak memory [MiB]", "dofs": "degrees of freedom"}
CLAIM_LINES = dict(zip(CLAIMS, ((0, (4, 2)), (0, (1, 1.5)))))
FLOOR = 1e-16  # errors that are exactly zero are drawn here
STYLE = {"font.family": "DejaVu Sans", "font.size": 9, "axes.linewidth": 0.7, "legend.frameon": False,
         "legend.fontsize": 8, "svg.hashsalt": "mortier", "svg.fonttype": "path", "savefig.dpi": 160}


def stems(names):
    """A name for files from each name, no two alike, also where small and capital letters are one."""
    result = []
    for name in names:
        safe = "".join(c if c.isalnum() and c.isascii() else "-" for c in name)[:60]
        stem, again = safe, 1
        while stem.lower() in (each.lower() for each in result):
            again += 1
            stem = f"{safe}-{again}"
        result.append(stem)
    return result


def draw(plan, series):
    """Every plot that shows something: (title, name) of each, and NAME.svg and NAME.png as name -> bytes."""
    made, files = [], {}
    with plt.rc_context(STYLE):
        for error, stem in zip(plan.errors, stems([each.name for each in plan.errors])):
            for cost in AXES:
                if figure := work_precision(series, error, cost):
                    name = f"{stem}-{cost.replace('_', '-')}"
                    for kind in ("svg", "png"):
                        picture = io.BytesIO()
                        figure.savefig(picture, format=kind,
                                       metadata={"Date": None} if kind == "svg" else None)
                        files[f"{name}.{kind}"] = picture.getvalue()
                    plt.close(figure)
                    made.append((f"{error.name} against {AXES[cost]}", name))
    return made, files


def work_precision(series, measure, cost):
    """None where the cost is the same everywhere."""
    data, error = [], measure.name
    for each in series:
        x, y = each.values(COSTS[cost]), each.values(f"error {error}")
        use = np.isfinite(x) & np.isfinite(y) & (x > 0)
        if use.any():
            data.append((each, x[use], np.maximum(y[use], FLOOR)))
    if not data or max(x.max() for _, x, _ in data) < 1.05 * min(x.min() for _, x, _ in data):
        return None
    shown = distinguishing([each for each, _, _ in data])
    figure, axes = plt.subplots(figsize=(7.2, 4.8), layout="constrained")
    for i, (each, x, y) in enumerate(data):
        by_cost = np.argsort(x, kind="stable")
        label = each.label(shown)
        if found := order(each, error):
            label += f": order {found[0]:.2f} in {found[2]}"
        if found := slope(x, y):
            label += f", slope {found[0]:.2f}"
        axes.plot(x[by_cost], y[by_cost], color=COLOURS[i % len(COLOURS)],
                  marker=MARKERS[(i // 2) % len(MARKERS)],
                  ls="-" if i < len(COLOURS) else "--", lw=1.2, ms=5, mfc="white",
                  label=f" {label}" if label.startswith("_") else label)  # else the legend leaves it out
    for name in claimed(axes, data, cost) if measure.quantity == "energy" else ():
        axes.plot([], [], color="#777777", ls=CLAIM_LINES[name], lw=1.2, label=CLAIMS[name])
    points = np.array([point for _, x, y in data for point in zip(x, y)])
    best = points[front([tuple(point) for point in points])]
    axes.plot(*best.T, color="#999999", lw=5, alpha=0.35, zorder=0, solid_capstyle="round")
    axes.plot(*best.T, ls="", marker="o", ms=11, mfc="none", mec="#777777", label="Pareto front")
    axes.set(xscale="log", yscale="log", xlabel=AXES[cost], ylabel=f"relative error: {error}")
    axes.grid(color="#dddddd", lw=0.5, which="major")
    axes.set_axisbelow(True)
    legend = axes.legend(loc="upper left", bbox_to_anchor=(0, -0.14), borderaxespad=0)
    for each in (axes.yaxis.label, *legend.get_texts()):
        each.set_parse_math(False)  # names are shown as they are
    figure.set_size_inches(7.2, 4.6 + 0.17 * len(legend.get_texts()))
    return figure


def claimed(axes, data, cost):
    """Draws what the runs say of their own error. Returns the names of the lines that there are."""
    found = []
    for name, line in CLAIM_LINES.items():
        for i, (each, _, _) in enumerate(data):
            x, y = each.values(COSTS[cost]), each.values(name)
            use = np.flatnonzero((x > 0) & (y > FLOOR))
            use = use[np.argsort(x[use], kind="stable")]
            if len(use):
                axes.plot(x[use], y[use], color=COLOURS[i % len(COLOURS)], ls=line, lw=1.2)
                found.append(name)
    return list(dict.fromkeys(found))
