"""Runs a case in one of the codes; whatever the code,
the answer is a results.Run (compare/results.py) with points.

Environment: MORTIER, the program; FREEFEM (FreeFem++-nw).
"""
import os
import re
import shutil
import statistics
from dataclasses import dataclass
from pathlib import Path

import scene as scenes
from axes import AXES
from problems import RunFailure
from process import Cost, measured
import results  # problems.py says where it is

MORTIER = os.environ.get("MORTIER", str(Path(__file__).resolve().parents[1] / "build" / "mortier"))
FREEFEM = os.environ.get("FREEFEM", "FreeFem++-nw")
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}


@dataclass
class Outcome:
    run: results.Run
    cost: Cost
    triangles: int
    dofs: int
    steps: int
    iterations: int  # linear solves


def settings_of(case, meshes):
    """KEY=VALUE for the scene; meshes: body -> list of files by level."""
    settings = []
    for axis, value in case.values:
        key = AXES.get(axis, (axis, None))[0]
        if key is not None:
            settings.append(f"{key}={str(value).lower() if isinstance(value, bool) else value}")
    if meshes:
        level = case["level"] or 0
        settings += [f"body.{body}.mesh={files[level]}" for body, files in meshes.items()]
    return settings


def run(case, scene, meshes, folder, timeout=None, repeat=1):
    """The outcome of a case; its cost is the median of the repeats. RunFailure with the reason otherwise."""
    folder = folder.resolve()  # some codes run inside it
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    settings = settings_of(case, meshes)
    costs = []
    try:
        for _ in range(repeat):
            outcome = SOLVERS[case.code](case, scene, settings, folder, timeout)
            costs.append(outcome.cost)
    except results.ResultError as error:
        raise RunFailure(str(error)) from error
    median = statistics.median
    outcome.cost = Cost(median(c.wall_time for c in costs), median(c.processor_time for c in costs),
                        median(c.memory for c in costs))
    return outcome


def set_option(settings):
    return ["--set", *settings] if settings else []


def run_mortier(case, scene, settings, folder, timeout):
    out = folder / "result"
    threads = str(case["threads"] or 1)
    cost, _ = measured([MORTIER, "run", scene, "--quiet", "--threads", threads, "--out", out,
                        *set_option(settings)],
                       timeout, environment={"OPENBLAS_NUM_THREADS": threads})
    run_ = results.read_mortier(out)
    summary = run_.summary
    return Outcome(run_, cost, summary.get("tetrahedra", summary.get("triangles")), summary["dofs"],
                   summary["steps"], summary["newton_iterations"])


def run_freefem(case, scene, settings, folder, timeout):
    if case["tolerance"]:
        raise RunFailure("the FreeFEM script takes equal steps only")
    accuracy = ["-accuracy", repr(case["accuracy"])] if case["accuracy"] else []
    settings = [each for each in settings if not each.startswith("accuracy.")]
    script = folder / "scene.edp"
    measured([MORTIER, "freefem", scene, script, *set_option(settings)], timeout)
    if accuracy:
        if case["degree"] != 2:
            raise RunFailure("the FreeFEM script adapts meshes of degree 2 only")
        script.write_text(adapted(script.read_text()))
    if shutil.which(FREEFEM) is None:
        raise RunFailure(f"{FREEFEM} is not installed (Debian package freefem++)")
    out = folder / "result"
    cost, _ = measured([FREEFEM, "-nw", "-nw", "-ne", "-v", "0", script, "-quiet", "-out", out, *accuracy],
                       timeout, environment=ONE_THREAD)
    run_ = results.read_freefem(out)
    document = scenes.load(scene, settings, script)
    for body in document["body"] if accuracy else ():
        body["mesh"] = out / f"{body['name']}.mesh"
    add_points(run_, document)
    return outcome_of(run_, cost, run_.summary["steps"], run_.summary["newton_iterations"])


def adapted(script):
    """The data of a script for FreeFEM with the file that adapts meshes in place of those of the method."""
    files = re.findall(r'^include "(.*)";?$', script, re.MULTILINE)
    return script[:script.index('include "')] + f'include "{Path(files[0]).parent}/adapted.idp"\n'


def add_points(run_, document):
    for body in document["body"]:
        mesh, ours = scenes.Mesh(body["mesh"]), run_.bodies[body["name"]]
        ours.points, ours.triangles = mesh.points, mesh.triangles
        if ours.stress_at_points is not None:
            ours.points, ours.elements = mesh.with_middles()


def outcome_of(run_, cost, steps, iterations):
    triangles = sum(len(body.simplices) for body in run_.bodies.values())
    dofs = sum(2 * len(body.points) for body in run_.bodies.values())
    return Outcome(run_, cost, triangles, dofs, steps, iterations)


SOLVERS = {"mortier": run_mortier, "freefem": run_freefem}  # those of bench/peer_codes add themselves


def make_meshes(plan, folder):
    """Writes the generated meshes; body -> files by level. A generator that refuses is a RunFailure."""
    files = {}
    for body, levels in plan.meshes.items():
        files[body] = []
        for i, level in enumerate(levels):
            if isinstance(level, Path):
                files[body].append(level.resolve())
                continue
            path = (folder / f"{re.sub('[^A-Za-z0-9_-]', '_', body)}-{i}.mesh").resolve()
            cells = level["cells"]
            cells = f"{cells[0]},{cells[1]}" if isinstance(cells, list) else str(cells)
            corners = [",".join(map(repr, level[corner])) for corner in ("lower", "upper")]
            measured([MORTIER, "mesh", level["kind"], "--cells", cells, f"--lower={corners[0]}",
                      f"--upper={corners[1]}", path])
            files[body].append(path)
    return files
