"""mortier report of results in space: one HTML file of tables and pictures, without a program."""
import base64
import html

import curves
import images
import numpy as np
import pictures
import report
import tables
from ending import shown

STEPS = 12  # of a run that are drawn, evenly
DOTS = 90  # on an inch


def page(results):
    titles = list(dict.fromkeys(result.title for result in results))
    looks = (report.PAGE / "page.css").read_text(encoding="utf-8") + "img{max-width:100%;background:#fff}"
    with pictures.plt.rc_context(pictures.STYLE):
        parts = [f"<h1>{text(', '.join(titles))}</h1>", *(part for each in results for part in of_run(each)),
                 *overview(results)]
    policy = f"default-src 'none'; style-src '{report.digest(looks)}'; img-src data:"
    return ("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            f"<meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            "<link rel=\"icon\" href=\"data:,\">\n"
            f"<title>{text(', '.join(titles))}</title>\n<style>{looks}</style>\n</head>\n<body>\n"
            "<main id=\"page\">\n" + "\n".join(parts) + "\n</main>\n</body>\n</html>\n")


def text(words):
    return html.escape(shown(words))


def table(rows):
    lines = "".join("<tr>" + "".join(f"<td>{text(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f'<div class="wide"><table>{lines}</table></div>'


def image(figure, words):
    data = images.small(images.picture(figure, "png", dpi=DOTS))
    pictures.plt.close(figure)
    return f'<p><img alt="{text(words)}" src="data:image/png;base64,{base64.b64encode(data).decode()}"></p>'


def of_run(result):
    yield f"<h2>{text(result.name)}</h2>"
    if result.failed:
        yield f'<p class="bad">stopped early: {text(result.reason)}</p>'
    if asked := tables.quantities(result):
        yield table([["quantity", "value", "unit", "at", "smallest", "largest", "error"], *asked])
    chosen = [result.kept[i] for i in
              sorted({round(i) for i in np.linspace(len(result.kept) - 1, 0, min(STEPS, len(result.kept)))})]
    if len(chosen) < len(result.kept):
        yield f'<p class="soft">{len(chosen)} of {len(result.kept)} kept steps are drawn.</p>'
    for step, time in reversed(chosen):  # the last one is seen first
        yield image(pictures.fields([pictures.view(result, step)]), f"deformed bodies at t = {time:g}")
    for title, rows in {**tables.pairs(result), **tables.grids(result)}.items():
        if rows:
            yield f"<h3>{text(title)}</h3>" + table(rows)
    words = report.words_of(result)
    if words["plan"]:
        yield "<h3>What was modelled and left out</h3>" + table(
            [["modelled" if modelled else "left out", *rest] for modelled, *rest in words["plan"]])
    if words["scene"] is not None:
        yield (f"<details><summary>scene {text(words['path'])}</summary>"
               f'<pre class="scene">{html.escape(words["scene"])}</pre></details>')


def overview(results):
    """Contact and histories of all runs, side by side."""
    views = [pictures.view(result) for result in results]
    for title, draw in (("Contact at the end", curves.contact), ("Histories", curves.history)):
        figure = draw(views)
        if figure is not None:
            yield f"<h2>{title}</h2>" + image(figure, title)
