#!/usr/bin/python3
"""The note's two figures and a third, as PNG and SVG, from two run folders of mortier.

    compare/figures.py MORTAR INTERPOLATION --out DIR [--overview FILE.png]

figure-1-mortar, figure-2-interpolation: deformed meshes with von Mises stress, both on one scale; under them
the contact line magnified. figure-3-contact-line: contact pressure and gap along Gamma_C, and the exact
pressure. --overview writes one small picture with both variants side by side.
`mortier plot` draws the same of any run.
"""
import sys
from pathlib import Path

import numpy as np

import results

sys.path.append(str(Path(__file__).resolve().parent.parent / "views"))
import curves  # noqa: E402
import images  # noqa: E402
import pictures  # noqa: E402
import runs  # noqa: E402
from matplotlib.colors import TwoSlopeNorm  # noqa: E402

EXACT = 10.0  # von Mises stress and contact pressure at T = 1 [Pa]
COLOURS = pictures.matplotlib.colormaps["RdYlBu_r"]


def stress_norm(views):
    """One scale for all figures, its middle colour at the exact value."""
    values = np.concatenate([body.von_mises for body in pictures.bodies_of(views)])
    margin = 1e-3 * EXACT
    return TwoSlopeNorm(EXACT, min(values.min(), EXACT - margin), max(values.max(), EXACT + margin))


def main():
    parser = results.argument_parser(__doc__)
    parser.add_argument("mortar")
    parser.add_argument("interpolation")
    parser.add_argument("--out", type=Path, default=Path("."), metavar="DIR")
    parser.add_argument("--overview", type=Path, metavar="FILE")
    arguments = parser.parse_args()
    try:
        views = [pictures.view(runs.read(folder)) for folder in (arguments.mortar, arguments.interpolation)]
    except results.ResultError as error:
        print(f"figures: {error}", file=sys.stderr)
        return 2
    arguments.out.mkdir(parents=True, exist_ok=True)
    style = {"norm": stress_norm(views), "colours": COLOURS, "raw": True}  # constant on triangles: the note's
    with pictures.plt.rc_context(pictures.STYLE):
        figures = {"figure-1-mortar": pictures.fields(views[:1], **style),
                   "figure-2-interpolation": pictures.fields(views[1:], **style),
                   "figure-3-contact-line": curves.contact(views, EXACT)}
        for name, figure in figures.items():
            box = images.laid_out(figure)
            for kind in ("png", "svg"):
                path = arguments.out / f"{name}.{kind}"
                path.write_bytes(images.picture(figure, kind, bbox_inches=box))
                print(path)
        if arguments.overview:
            arguments.overview.write_bytes(images.small(images.picture(pictures.fields(views, **style), "png",
                                                                       dpi=80)))
            print(arguments.overview)
    return 0


if __name__ == "__main__":
    sys.exit(main())
