"""Figures as files: PNG, SVG, and the steps of a run as a GIF."""
import contextlib
import io
import warnings

import numpy as np
from PIL import Image

import pictures
from files import MARK
from runs import natural_scale


def animation(results, field_name, scale, window, raw, look=None):
    """A GIF of the kept steps, all with the colours, scale and window that hold for the whole run."""
    steps = [[step for step, _ in result.kept] for result in results]
    count = max(map(len, steps))

    def views_at(i):
        chosen = [of_run[round(i * (len(of_run) - 1) / max(count - 1, 1))] for of_run in steps]
        return [pictures.view(result, step) for result, step in zip(results, chosen)]

    field, values, windows = None, [], []
    for i in range(count):
        views = views_at(i)
        if field_name != "none":
            field = views[0].result.fields(views[0].run)[field_name]
            values += [(each.run.bodies, pictures.shown_values(each, field, raw)) for each in views]
    scale = scale if scale is not None else natural_scale(pictures.bodies_of(views))
    for i in range(count):
        windows.append(pictures.whole_window(views_at(i), scale, look))
    low, high = np.min(windows, 0), np.max(windows, 0)
    window = window or (low[0], high[1], low[2], high[3])
    norm, colours = pictures.colours_of(field, values)[:2] if field else (None, None)
    frames = []
    for i in range(count):
        figure = pictures.fields(views_at(i), field_name, scale, window, norm, colours, strips=False,
                                 raw=raw, look=look)
        frames.append(picture(figure, "png", dpi=90, bbox_inches=None))  # all of one size
        pictures.plt.close(figure)
    return gif(frames)


def gif(frames):
    """Frames, PNG each, to one GIF: of three seconds or 12 frames a second,
    and two seconds for the last one."""
    opened = [Image.open(io.BytesIO(frame)).convert("RGB") for frame in frames]
    palette = opened[-1].quantize(255)
    first, *others = [each.quantize(palette=palette, dither=Image.Dither.NONE) for each in opened]
    out = io.BytesIO()
    first.save(out, "gif", save_all=True, append_images=others, loop=0, comment=MARK,
               duration=[max(1000 // 12, 3000 // len(frames))] * len(others) + [2000])
    return out.getvalue()


@contextlib.contextmanager
def boxes_for_unknown_letters():
    """Of which matplotlib would warn."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def laid_out(figure):
    """Lays a figure out, once for all formats. Returns the box [inch] that its pictures show."""
    with boxes_for_unknown_letters():
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
        return figure.get_tightbbox().padded(0.08)


def picture(figure, kind, **options):
    """The bytes of a figure."""
    data = io.BytesIO()
    options = {"bbox_inches": "tight", "pad_inches": 0.08, **options,
               "metadata": {"Date": None, "Creator": MARK} if kind == "svg" else {"Software": MARK}}
    with boxes_for_unknown_letters():
        figure.savefig(data, format=kind, **options)
    return data.getvalue()


def small(png, width=None):
    """The same picture with 255 colours, not wider than so many pixels."""
    out, image = io.BytesIO(), Image.open(io.BytesIO(png)).convert("RGB")
    if width and image.width > width:
        image = image.resize((width, round(image.height * width / image.width)), Image.Resampling.LANCZOS)
    image.quantize(255, Image.Quantize.MAXCOVERAGE, kmeans=2,
                   dither=Image.Dither.NONE).save(out, "png", optimize=True)
    return out.getvalue()
