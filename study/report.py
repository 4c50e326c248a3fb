"""report.html: one file with all numbers and pictures in it."""
import base64
import html
import os
import platform

import analysis
import table
from problems import shown

STYLE = """body{font:15px/1.5 system-ui,sans-serif;color:#222;max-width:62em;margin:2em auto;padding:0 1em}
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em}img{max-width:100%;height:auto}
table{border-collapse:collapse;font-size:12.5px;display:block;overflow-x:auto;white-space:nowrap}
td,th{padding:2px 9px;text-align:right;border-bottom:1px solid #ddd}
td:first-child,th:first-child{text-align:left}
th{background:#f5f5f5}tr.failed td{color:#a11}td.reason{text-align:left;white-space:normal;min-width:20em}
pre{background:#f7f7f7;padding:.8em;overflow-x:auto;font-size:12.5px}small{color:#666}"""


def cells(values, tag="td", kind=""):
    row = "".join(f"<{tag}>{html.escape(shown(value))}</{tag}>" for value in values)
    return f"<tr{f' class={kind}' if kind else ''}>{row}</tr>"


def short(column, value):
    if (column.startswith("error ") or column in table.CLAIMS) and value:
        return f"{float(value):.3e}"
    return value


def machine():
    name = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo") as file:
            name = next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        pass
    return f"{name}, {os.cpu_count()} processors"


def order_rows(plan, series):
    shown = analysis.distinguishing(series)
    for each in series:
        for error in plan.errors:
            if found := analysis.order(each, error.name):
                yield each.label(shown), error.name, f"{found[0]:.3f}", found[2], found[1]


def page(plan, rows, series, levels, pictures, files):
    """pictures: (title, name); files: their bytes by name."""
    failed = [row for row in rows if row["status"] != table.DONE]
    parts = [f"<!DOCTYPE html><html lang=en><meta charset=utf-8><title>{html.escape(plan.title)}</title>"
             f"<style>{STYLE}</style><h1>{html.escape(plan.title)}</h1>"
             f"<p><small>{html.escape(shown(plan.path.name))}, scene "
             f"{html.escape(shown(plan.scene.name))}; {len(rows)} runs, {len(failed)} without a result; "
             f"{html.escape(machine())}, up to "
             f"{html.escape(shown(max((str(row.get('at_once', 1)) for row in rows), default=1)))} runs at "
             f"once, each figure the median of {plan.repeat}.</small></p>"]
    if plan.comparisons:
        lines = [line for found in analysis.comparisons(plan, series)
                 for line in analysis.comparison_text(*found)]
        parts.append("<h2>Cost at equal error</h2><pre>" + html.escape("\n".join(lines)) + "</pre>")
    for title, name in pictures:
        picture = base64.b64encode(files[f"{name}.svg"]).decode()
        parts.append(f"<h2>{html.escape(title)}</h2><img alt=\"{html.escape(title)}\" "
                     f"src=\"data:image/svg+xml;base64,{picture}\">")
    parts.append("<h2>Fitted orders</h2><table>" + cells(("series", "error", "order", "in", "runs"), "th"))
    parts += [cells(row) for row in order_rows(plan, [*series, *levels])]
    columns = [c for c in table.columns(plan) if c not in ("key", "at_once")]
    parts.append("</table><p><small>Least squares in logarithms; h is taken as dofs^(-1/2); relative "
                 f"errors below {analysis.ROUNDING:g} are left out.</small></p><h2>Runs</h2><table>"
                 + cells(columns, "th"))
    for row in rows:
        parts.append(cells((short(c, row.get(c, "")) for c in columns),
                           kind="failed" if row["status"] != table.DONE else ""))
    parts.append("</table></html>\n")
    return "".join(parts)
