"""mortier report: results as one HTML file that needs nothing else and no network.

The file holds data, a program and its looks (views/page), in space three.js as well. Text of the user's is in
the data only, where no HTML is read, and is shown as text; a policy in the page lets the browser run nothing
but these programs.
"""
import base64
import hashlib
import html
import json
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

import columns
import solids
import tables
import three
from coding import block, numbers, packed, thinned, without_noise
from contact_line import boundary_edges
from ending import shown
from files import MARK
from recovery import NormalStress
from runs import extent, natural_scale, top_of

PAGE = Path(__file__).resolve().parent / "page"
# one after the other, one function
PROGRAM = ("data.js", "values.js", "colours.js", "bodies.js", "charts.js", "controls.js", "pointer.js",
           "page.js")
IN_SPACE = ("data.js", "solids.js", "colours.js", "charts.js", "controls.js", "turning.js", "cutting.js",
            "page.js")
# of all kept steps together: beyond that steps are left out, so that the page stays small
TRIANGLES = 600_000
MANY = 200_000  # of the same: beyond that numbers have a digit less
HISTORY_ROWS = 1500  # of a longer history some are left out
SCENE_LETTERS = 200_000
VIRIDIS = ("440154 482173 433e85 38588c 2d708e 25858e 1e9b8a 2ab07f 52c569 86d549 c2df23 fde725").split()
YELLOW_RED = ("ffffcc ffeda0 fed976 feb24c fd8d3c fc4e2a e31a1c bd0026 800026").split()
RED_BLUE = ("053061 2166ac 4393c3 92c5de d1e5f0 f7f7f7 fddbc7 f4a582 d6604d b2182b 67001f").split()


def digits_of(name, many):
    """So many of the largest value of a field; one fewer where there are many numbers."""
    return 3 if name == "error" else 1 if name == "viscoplastic" else (5 if name[0] == "e" else 6) - many


def mesh_block(body):
    """Points, corners, region of each triangle; of the boundary edges both ends, their triangle and, where
    triangles are quadratic, the vertex in the middle (else the first end again)."""
    first = body.triangles[:, 0]
    edges, owner, side = boundary_edges(body.triangles, owners=True)
    middle = edges[:, 0] if body.elements is None else body.elements[owner, 3 + side]
    integers = (first, body.triangles[:, 1] - first, body.triangles[:, 2] - first, edges[:, 0], edges[:, 1],
                owner, middle - edges[:, 0], body.cells.get("region", np.zeros(len(body.triangles))))
    return block([*((x, 7) for x in body.points.T), *((each, None) for each in integers)])[0], len(edges)


def step_block(result, run, fields, later, many):
    """The arrays of every body, by vertex or by triangle, and of each field its ends."""
    values = {name: result.values(run, field) for name, field in fields.items()}
    bodies = {body: {name: values[name][body] for name in fields} for body in run.bodies}
    without_noise(list(bodies.values()))
    ranges = {}
    for name, field in fields.items():
        of_bodies = {body: each[name] for body, each in bodies.items()}
        found = np.concatenate(list(of_bodies.values()))
        ranges[name] = numbers((found.min(), found.max(), top_of(field, run.bodies, of_bodies)))
    return (*block([(each[name], digits_of(name, many)) for each in bodies.values()
                    for name in order_of(fields)], later), ranges)


def order_of(fields):
    """Of the arrays in a step; what the page can compute from others, and regions, are not among them."""
    return [name for name in fields if name not in ("u", "region", "von_mises")]


def run_data(result, share):
    """What the page knows of a run; share: of what fits into it."""
    run, fields, parts = solids.run_data(result, share) if result.space else plane_data(result, share)
    size = extent(run.bodies.values())
    listed = [{"name": name, "words": field.words, "unit": field.unit, "signed": field.signed,
               "vertex": result.space or field.by_vertex, "contact": field.of_contact}
              for name, field in fields.items()]
    listed.sort(key=lambda each: not each["contact"])  # contact is seen first
    return {"name": result.name, "title": result.title, "failed": result.reason if result.failed else None,
            "units": {"length": result.length_unit, "stress": result.stress_unit, "time": result.time_unit},
            "keptSteps": len(result.kept), "history": history_of(result, size), "extent": size,
            "scale": natural_scale(run.bodies.values()), "fields": listed, **parts, **words_of(result)}


def plane_data(result, share):
    """The run at the last step, its fields, and what the page knows of its bodies and contact lines; share:
    of TRIANGLES."""
    first = result.at(result.kept[-1][0])
    triangles = sum(len(body.triangles) for body in first.bodies.values())
    kept = thinned(result.kept, TRIANGLES * share / triangles)
    fields, bodies = result.fields(first), []
    for name, body in first.bodies.items():
        mesh, edges = mesh_block(body)
        bodies.append({"name": name, "vertices": len(body.points), "triangles": len(body.triangles),
                       "edges": edges, "mesh": mesh, "rigid": body.rigid})
    steps, lines, later, ranges, recovered = [], [], None, [], {}
    for step, time in reversed(kept):  # the page shows the last one first
        run = result.at(step)
        arrays, later, of_step = step_block(result, run, fields, later, len(kept) * triangles > MANY)
        steps.append({"step": step, "time": time, **arrays})
        ranges.append(of_step)
        for k, line in enumerate(result.lines(run)):
            if k == len(lines):
                lines.append({"nonmortar": line.nonmortar, "mortar": line.mortar, "name": line.name,
                              "x": numbers(line.abscissa, 7), "vertex": line.vertices.tolist(),
                              "length": float(line.lengths[-1]), "steps": []})
            jump = line.jump if line.jump is not None and len(line.jump[0]) * len(kept) < 200_000 else None
            if k not in recovered:
                recovered[k] = NormalStress(run.bodies[line.nonmortar], line)
            lines[k]["steps"].append({"pressure": numbers(line.pressure), "gap": numbers(line.gap),
                                      "body": numbers(recovered[k](run.bodies[line.nonmortar]), 4),
                                      **({"shear": numbers(line.shear), "slipping": line.slipping.tolist()}
                                         if line.shear is not None else {}),
                                      "jump": [numbers(each) for each in jump] if jump is not None else None})
    for backwards in (steps, ranges, *(line["steps"] for line in lines)):
        backwards.reverse()
    return first, fields, {"bodies": bodies, "order": order_of(fields), "steps": steps, "ranges": ranges,
                           "lines": lines}


def history_of(result, size):
    """What is drawn against time: of every column its name, words, unit and whether the scene adds it."""
    history = result.history
    rows = len(next(iter(history.values()), []))
    every = max(1, -(-rows // HISTORY_ROWS))
    chosen = sorted({*range(0, rows, every), rows - 1}) if rows else []
    asked = {row[0] for row in tables.quantities(result)}
    shown_ones = columns.drawn([history], size)
    path = columns.force_and_displacement(shown_ones)
    return {"every": every, "path": path,
            "time": numbers(history.get(f"time[{result.time_unit}]", np.zeros(0))[chosen]),
            "columns": [{"name": name, "words": columns.words_of(name), "unit": columns.unit_of(name),
                         "asked": columns.bare(name) in asked, "y": numbers(history[name][chosen])}
                        for name in shown_ones]}


def words_of(result):
    """Tables and text of the page."""
    summary = result.summary
    scene, settings = summary.get("scene_text"), summary.get("settings")
    return {"quantities": tables.quantities(result), "tables": tables.pairs(result),
            "grids": tables.grids(result),
            "scene": scene[:SCENE_LETTERS] if isinstance(scene, str) else None,
            "settings": [shown(each, 500) for each in settings] if isinstance(settings, list) else [],
            "path": shown(summary.get("scene", ""), 500)}


def plan_of(summary):
    """What mortier check says was modelled and left out;
    None where the scene is no longer that of the run."""
    path, text, settings = (summary.get(key) for key in ("scene", "scene_text", "settings"))
    program = os.environ.get("MORTIER")
    if not (program and isinstance(path, str) and isinstance(text, str) and isinstance(settings, list)):
        return None
    try:
        file = Path(path)
        if not file.is_file() or file.stat().st_size > 4 * SCENE_LETTERS or file.read_bytes().decode(
            errors="replace") != text:
            return None
        words = [program, "check", os.path.abspath(path), "--json",
                 *(["--set", *map(str, settings)] if settings else [])]
        done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=120,
                              check=False)
        return [[bool(each["modelled"]), *(shown(each[key], 500) for key in ("part", "what", "why"))]
                for each in json.loads(done.stdout)["plan"]]
    except (OSError, ValueError, KeyError, TypeError, subprocess.SubprocessError):
        return None


def page(results):
    space = results[0].space
    library = three.program() if space else None
    with ThreadPoolExecutor() as pool:  # geometries are meshed for the plans, which takes its time
        plans = [pool.submit(plan_of, result.summary) for result in results]
        runs = [run_data(result, 1 / len(results)) for result in results]
        runs = [{**run, "plan": plan.result()} for run, plan in zip(runs, plans)]
    # pictures for browsers that cannot turn bodies
    stills = f'<div id="stills">{"".join(run.pop("still") for run in runs)}</div>\n' if space else ""
    data = {"space": space, "runs": runs,
            "colours": {"plain": VIRIDIS, "signed": RED_BLUE, "contact": YELLOW_RED},
            "three": packed(library.encode()) if library else None}
    titles = list(dict.fromkeys(run["title"] for run in data["runs"]))
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    text = text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")  # no HTML in it
    parts = "".join((PAGE / name).read_text(encoding="utf-8") for name in (IN_SPACE if space else PROGRAM))
    program = (f'"use strict";\n(async () => {{\n{parts}}})().catch(error => {{\n'
               '  document.getElementById("page").prepend('
               "`This page cannot be drawn: ${error}. It needs a browser of 2023 or later.`);\n"
               "  throw error;\n});\n")
    looks = (PAGE / "page.css").read_text(encoding="utf-8")
    licence = f"<!--\n{three.LICENCE}-->\n" if library else ""
    programs = " ".join(f"'{digest(each)}'" for each in (program, library) if each)
    policy = f"default-src 'none'; script-src {programs}; style-src '{digest(looks)}'; img-src data:"
    return ("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            f"<meta name=\"generator\" content=\"{MARK}\">\n"
            f"<meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n"
            f"<title>{html.escape(', '.join(titles))}</title>\n<style>{looks}</style>\n</head>\n<body>\n"
            "<noscript>This page draws with JavaScript, which is switched off.</noscript>\n"
            f"<main id=\"page\"></main>\n{stills}"
            f"<script type=\"application/json\" id=\"data\">{text}</script>\n"
            f"<script>{program}</script>\n{licence}</body>\n</html>\n")


def digest(text):
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
