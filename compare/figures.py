#!/usr/bin/python3
"""The note's two figures and a third, as PNG and SVG, from two run folders of mortier.

    compare/figures.py MORTAR INTERPOLATION --out DIR [--overview FILE.png]

figure-1-mortar, figure-2-interpolation: deformed meshes with von Mises stress, both on one scale; under them
the contact line magnified. figure-3-contact-line: contact pressure and penetration along Gamma_C, and the exact
values.
--overview writes one small picture with both variants side by side.
"""
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.colors import TwoSlopeNorm  # noqa: E402
from matplotlib.patches import ConnectionPatch  # noqa: E402

import results  # noqa: E402

EXACT = 10.0  # von Mises stress and contact pressure at T = 1 [Pa]
COLOURS = matplotlib.colormaps["RdYlBu_r"]
INK, MUTED, MESH = "#222222", "#777777", "#77776a"
BLUE, ORANGE, GREEN, MAGENTA = "#6fa8dc", "#c8610a", "#0b7a3b", "#b0128a"
X_RANGE, Y_RANGE = (-0.06, 1.1), (-1.03, 1.03)  # of the pictures [m]
TITLES = {"mortar": "Projection (mortar)", "interpolation": "Interpolation"}
STYLE = {
    "font.family": "DejaVu Sans", "font.size": 9, "axes.titlesize": 11, "axes.labelsize": 9,
    "text.color": INK, "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK,
    "axes.edgecolor": MUTED, "axes.linewidth": 0.7, "xtick.labelsize": 8, "ytick.labelsize": 8,
    "legend.fontsize": 8, "legend.frameon": False, "savefig.dpi": 170,
    "svg.hashsalt": "mortier", "svg.fonttype": "path",
}


def deformed(body):
    return body.points + body.displacement


def stress_norm(runs):
    """One scale for all figures, its middle colour at the exact value."""
    values = np.concatenate([body.von_mises for run in runs for body in run.bodies.values()] + [[EXACT]])
    low, high = values.min(), values.max()
    margin = 1e-3 * EXACT
    return TwoSlopeNorm(EXACT, min(low, EXACT - margin), max(high, EXACT + margin))


def draw_bodies(axes, run, norm, edge=0.3):
    """Deformed triangles, coloured by von Mises stress."""
    for body in run.bodies.values():
        x, y = deformed(body).T
        axes.tripcolor(x, y, body.triangles, facecolors=body.von_mises, cmap=COLOURS, norm=norm,
                       edgecolors=MESH, linewidth=edge)


def draw_whole(axes, run, norm):
    draw_bodies(axes, run, norm)
    for y in (0, -1):  # as meshed
        axes.plot([0, 1, 1, 0, 0], [y, y, y + 1, y + 1, y], color=MUTED, lw=0.7, ls=(0, (4, 3)), zorder=3)
    axes.set_xlim(*X_RANGE)
    axes.set_ylim(*Y_RANGE)
    axes.set_xticks([0, 0.5, 1])
    axes.set_yticks([-1, -0.5, 0, 0.5, 1])
    axes.text(0.5, 0.97, stress_words(run), ha="center", va="top", fontsize=8.5, linespacing=1.5)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def draw_magnified(axes, run, norm, centre, half):
    """A strip about the deformed contact line, stretched upwards; what the bodies share is hatched."""
    draw_bodies(axes, run, norm)
    upper, lower = contact_lines(run)
    x = np.union1d(upper[:, 0], lower[:, 0])
    above, below = np.interp(x, *upper.T), np.interp(x, *lower.T)
    if np.max(below - above) > 1e-9:
        axes.fill_between(x, above, below, where=below > above, interpolate=True, facecolor="none",
                          edgecolor=INK, hatch="//////", linewidth=0, zorder=4)
    axes.plot(*lower.T, color=GREEN, lw=1.7, zorder=5, marker="s", ms=3.4, mfc="white", label="lower body")
    axes.plot(*upper.T, color=MAGENTA, lw=1.7, zorder=6, marker="o", ms=4.4, mfc="white", label="upper body")
    axes.set_xlim(*X_RANGE)
    axes.set_ylim(centre - half, centre + half)
    axes.set_xticks([0, 0.5, 1])
    axes.set_xlabel("x [m]")


def zoom_lines(whole, strip, centre, half):
    """Marks the strip in the whole picture."""
    left, right = X_RANGE
    whole.add_patch(plt.Rectangle((left, centre - half), right - left, 2 * half, fill=False, ec=INK, lw=0.7,
                                  zorder=7, clip_on=False))
    for x in (left, right):
        strip.add_artist(ConnectionPatch((x, centre - half), (x, centre + half), "data", "data", axesA=whole,
                                         axesB=strip, color=MUTED, lw=0.6, ls=(0, (2, 2)), zorder=0))


def contact_lines(run):
    """Deformed traces of the upper and the lower body, from left to right."""
    return [deformed(run.bodies[name])[results.trace(run.bodies[name])] for name in ("upper", "lower")]


def window(runs):
    """Middle and half height of the magnified strip, the same for all figures."""
    y = np.concatenate([line[:, 1] for run in runs for line in contact_lines(run)])
    return (y.min() + y.max()) / 2, max(0.7 * np.ptp(y), 0.02)


def stress_words(run):
    low, high = run.scalars["von_mises_min"], run.scalars["von_mises_max"]
    values = f"{low:.4g} to {high:.4g} Pa" if high - low > 1e-6 else f"{EXACT:.4g} Pa everywhere"
    penetration = scientific(run.scalars["interpenetration"])
    return f"von Mises {values} (exact 10)\ninterpenetration {penetration} m$^2$"


def scientific(x):
    if x == 0 or 1e-3 <= abs(x) < 1e4:
        return f"{x:.3g}"
    mantissa, exponent = f"{x:.0e}".split("e")
    return f"{mantissa}$\\cdot$10$^{{{int(exponent)}}}$"


def columns_of_pictures(runs_drawn, runs, width, titles):
    """One column a run: the deformed meshes, under them the contact line; sizes in inches."""
    norm, (centre, half) = stress_norm(runs), window(runs)
    left, between, right, top, gap, strip_height, bottom = 0.7, 0.22, 0.95, 0.36, 0.62, 0.42 * width, 0.48
    height = width * (Y_RANGE[1] - Y_RANGE[0]) / (X_RANGE[1] - X_RANGE[0])
    upper = bottom + strip_height + gap
    n = len(runs_drawn)
    end = left + n * width + (n - 1) * between
    total = (end + right, upper + height + top)
    figure = plt.figure(figsize=total)

    def place(x, y, w, h):
        return figure.add_axes((x / total[0], y / total[1], w / total[0], h / total[1]))

    for i, (run, title) in enumerate(zip(runs_drawn, titles)):
        x = left + i * (width + between)
        whole, strip = place(x, upper, width, height), place(x, bottom, width, strip_height)
        draw_whole(whole, run, norm)
        draw_magnified(strip, run, norm, centre, half)
        zoom_lines(whole, strip, centre, half)
        whole.set_title(title, loc="left", x=0.07)
        if i == 0:
            whole.set_ylabel("y [m]")
            strip.set_ylabel("stretched")
        else:
            whole.tick_params(labelleft=False)
            strip.tick_params(labelleft=False)
        if i == n - 1:
            strip.legend(loc="lower right", ncols=2, bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2,
                         handlelength=1.6, columnspacing=1.2)
    colour_bar(figure, norm, place(end + 0.2, upper + 0.05 * height, 0.16, 0.9 * height))
    return figure


def colour_bar(figure, norm, axes):
    bar = figure.colorbar(matplotlib.cm.ScalarMappable(norm=norm, cmap=COLOURS), cax=axes)
    ticks = [norm.vmin, *[t for t in (7.5, 10, 15, 20) if norm.vmin + 0.8 < t < norm.vmax - 0.8], norm.vmax]
    bar.set_ticks(ticks, labels=[f"{t:.3g}" for t in ticks])
    bar.minorticks_off()
    bar.set_label("von Mises stress [Pa]", labelpad=2)
    bar.outline.set_linewidth(0.5)
    axes.axhline(EXACT, color=INK, lw=1)


def figure_contact(runs):
    """Contact pressure and penetration along Gamma_C."""
    figure, (pressure, penetration) = plt.subplots(2, 1, figsize=(6.2, 6), sharex=True, layout="constrained")
    looks = {"mortar": (BLUE, "o", 3.4), "interpolation": (ORANGE, "s", 1.6)}
    for run in runs:
        variant = run.summary["contact"]
        colour, marker, width = looks[variant]
        position, (x, u) = run.contact.position[:, 0], results.jump(run)
        order = np.argsort(position)
        style = {"color": colour, "marker": marker, "ms": 5, "mfc": "white"}
        pressure.plot(position[order], run.contact.pressure[order], lw=width, label=variant, **style)
        penetration.plot(x, 1e3 * u, color=colour, lw=width)
        penetration.plot(position, 1e3 * np.interp(position, x, u), ls="", **style)
        penetration.plot([], [], lw=width, label=f"{variant}: integral of the positive part "
                         f"{scientific(run.scalars['interpenetration'])} m$^2$", **style)
        if np.max(u) > 1e-9:
            penetration.fill_between(x, 0, 1e3 * u, where=u > 0, interpolate=True, color=colour, alpha=0.18,
                                     lw=0)
    pressure.axhline(EXACT, color=INK, lw=1.1, ls=(0, (5, 3)), label="exact")
    penetration.axhline(0, color=INK, lw=1.1, ls=(0, (5, 3)), label="exact: none")
    pressure.set_ylabel("contact pressure [Pa]")
    penetration.set_ylabel("penetration $u^1.n^1 + u^2.n^2$ [mm]")
    penetration.set_xlabel("x along $\\Gamma_C$ [m]; markers at the nonmortar nodes")
    pressure.set_title("Contact pressure and penetration along $\\Gamma_C$, t = 1 s", loc="left")
    for axes, share, columns in ((pressure, 0.16, 3), (penetration, 0.36, 1)):
        low, high = axes.get_ylim()
        axes.set_ylim(low, high + share * (high - low))  # room for the legend
        axes.legend(loc="upper left", ncols=columns)
        axes.grid(color="#dddddd", lw=0.6)
        axes.set_axisbelow(True)
        axes.margins(x=0.02)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
    return figure


def save(figure, folder, name):
    for kind in ("png", "svg"):
        path = folder / f"{name}.{kind}"
        figure.savefig(path, metadata={"Date": None} if kind == "svg" else None)
        print(path)
    plt.close(figure)


def main():
    parser = results.argument_parser(__doc__)
    parser.add_argument("mortar")
    parser.add_argument("interpolation")
    parser.add_argument("--out", type=Path, default=Path("."), metavar="DIR")
    parser.add_argument("--overview", type=Path, metavar="FILE")
    arguments = parser.parse_args()
    try:
        runs = [results.read_mortier(folder) for folder in (arguments.mortar, arguments.interpolation)]
    except results.ResultError as error:
        print(f"figures: {error}", file=sys.stderr)
        return 2
    plt.rcParams.update(STYLE)
    arguments.out.mkdir(parents=True, exist_ok=True)
    for run, name in zip(runs, ("figure-1-mortar", "figure-2-interpolation")):
        title = f"{TITLES[run.summary['contact']]}: deformed to scale, t = 1 s"
        save(columns_of_pictures([run], runs, 3.6, [title]), arguments.out, name)
    save(figure_contact(runs), arguments.out, "figure-3-contact-line")
    if arguments.overview:
        figure = columns_of_pictures(runs, runs, 3.0, [TITLES[run.summary["contact"]] for run in runs])
        figure.savefig(arguments.overview, dpi=95, pil_kwargs={"optimize": True})
        print(arguments.overview)
    return 0


if __name__ == "__main__":
    sys.exit(main())
