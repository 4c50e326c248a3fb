"""A scene in both codes, or a run of it beside a result that was kept: table, place and picture of the
difference."""
import json
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import codes
import kept
import results
from compare import compare
from ending import Wrong, require, shown
from other_meshes import compare_elsewhere, read_vtu_of, same_meshes


class CodeFailed(Exception):
    """A code ended with an error, in its own words."""

    def __init__(self, words, code):
        super().__init__(words)
        self.code = code


def run(given):
    """Exit code: 0 they agree, 1 they differ."""
    other = against(given.against)
    if other is not None and other.code == "kept numbers" and not given.set:
        given.set = other.summary["settings"]
    scene = "./" + given.scene if given.scene.startswith("-") else given.scene
    with tempfile.TemporaryDirectory(prefix="mortier-compare-") as folder:
        folder = Path(folder)
        # FreeFEM takes the meshes of the scene, which an accuracy would refine, and the steps of our run.
        settings = [*given.set, "accuracy="] if other is None else given.set
        ours = called("mortier", codes.run_mortier, folder / "mortier", settings, scene)
        if other is None:
            chosen = "planned_steps" not in ours.summary
            other = called("FreeFEM", codes.run_freefem, folder / "freefem", settings, scene,
                           steps_of=folder / "mortier" if chosen else None)
        verdict = verdict_on(ours, other, given)
        print(verdict.table())
        place = largest(ours, other) if other.bodies and same_meshes(ours, other) else None
        if place:
            print(f"largest difference: {place}")
        drawn = None
        if place and (given.picture or not verdict.agrees):
            name = re.sub(r"[^\w.+-]", "_", Path(scene).stem)[:150]
            drawn = given.picture or Path(f"{name}.difference.png")
            draw(place, ours, drawn)
    words = "agrees" if verdict.agrees else "differs"
    print(f"{shown(given.scene)}: {words}" + (f"; {shown(drawn)}" if drawn else ""))
    return 0 if verdict.agrees else 1


def accept(given):
    """Keeps the result of the scene: its last step, scalars and histories; or its numbers alone."""
    settings = [*given.set, "output.every=0"]
    if kept.is_file(given.accept):
        kept.require_free(given.accept)
        with tempfile.TemporaryDirectory(prefix="mortier-accept-") as folder:
            run = called("mortier", codes.run_mortier, Path(folder) / "run", settings, given.scene)
            kept.write(given.accept, run, given.set, given.within)
        print(f"{shown(given.accept)}: kept, {Path(given.accept).stat().st_size / 1e3:.1f} kB, "
              f"{meshes_of(run.summary)}")
        return 0
    if given.within is not None:
        raise Wrong("--within: kept with the numbers of --accept FILE.json, not with a folder")
    command = [codes.MORTIER, "run", given.scene, "--quiet", "--out", given.accept, "--set", *settings]
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True, errors="replace")
    if done.returncode:
        raise CodeFailed(done.stderr, done.returncode)
    sys.stderr.write(done.stderr)  # warnings
    size = sum(path.stat().st_size for path in Path(given.accept).iterdir() if path.is_file())
    summary = json.loads((Path(given.accept) / "summary.json").read_text())
    print(f"{shown(given.accept)}: kept, {size / 1e3:.0f} kB, {meshes_of(summary)}")
    return 0


def meshes_of(summary):
    asked = summary.get("accuracy", {}).get("asked")
    return f"accuracy {asked:g}" if asked else "on the meshes of the scene, no accuracy asked for"


def called(code, solve, folder, settings, scene, **options):
    try:
        return solve(folder, settings, scene, cwd=os.getcwd(), **options)
    except codes.RunError as error:
        if not error.output and not error.code > 1:
            package = " (Debian package freefem++)" if code == "FreeFEM" else ""
            raise OSError(0, f"{shown(error)}{package}") from error
        # What a failed run has kept is deleted with the folder of the comparison.
        words = re.sub(rf"; the [^;]* is in {re.escape(str(folder))}[^\n]*",
                       "; mortier run keeps the last state", error.output or str(error))
        raise CodeFailed(words, error.code) from error


def against(places):
    """What is compared with: None for FreeFEM; a result; files NAME=FILE.vtu of another code."""
    if not places:
        return None
    files = [re.fullmatch(r"([\w-]+)=(.+\.vtu)", place, re.ASCII) for place in places]
    if all(files):
        bodies = {found[1]: read_vtu_of(Path(found[2])) for found in files}
        return results.Run("another code", Path(places[0]), bodies, None, {})
    if len(places) == 1 and kept.is_file(places[0]):
        return kept.read(places[0])
    if len(places) > 1 or "=" in places[0] and not os.path.isdir(places[0]):
        raise Wrong(f"--against {' '.join(places)}: expected one folder of a result, a FILE.json of "
                        "--accept, or BODY=FILE.vtu for each body")
    return results.read(places[0])


def verdict_on(ours, other, given):
    if other.code == "kept numbers":
        return kept.compare(ours, other, given.within)
    if other.code != "another code" and same_meshes(ours, other):
        return compare(ours, other, given.within)
    if given.within is None:
        raise Wrong(f"{' '.join(given.against)}: meshes other than the scene's, expected --within X, the "
                        "largest relative difference that is allowed")
    return compare_elsewhere(ours, other, given.within)


@dataclass
class Place:
    """Where a field differs most."""
    what: str  # displacement, stress
    body: str
    index: int  # of the vertex or triangle
    size: float  # of the difference, relative to the largest value
    at: np.ndarray  # x, y; z in space
    values: dict  # body -> the difference by vertex or triangle

    def __str__(self):
        element = "tetrahedron" if len(self.at) == 3 else "triangle"
        where = f"{'vertex' if self.what == 'displacement' else element} {self.index}"
        return (f"{self.what} of {self.body}, {where} at ({', '.join(f'{x:.6g}' for x in self.at)}): "
                f"{self.size:.3g} of the largest {self.what}")


def largest(ours, other):
    """The place of the largest difference of displacements or stresses, each relative to the largest value;
    None where they are the same."""
    places = []
    for what in ("displacement", "stress"):
        pairs = {name: (getattr(body, what), getattr(other.bodies[name], what))
                 for name, body in ours.bodies.items()}
        if any(a.shape != b.shape for a, b in pairs.values()):
            return None
        scale = max(np.abs(b).max() for _, b in pairs.values()) or 1.0
        sizes = {name: np.abs(a - b).max(1) / scale for name, (a, b) in pairs.items()}
        name = max(sizes, key=lambda each: sizes[each].max())
        index = int(sizes[name].argmax())
        body = ours.bodies[name]
        at = body.points[index] if what == "displacement" else body.points[body.simplices[index]].mean(0)
        places.append(Place(what, name, index, float(sizes[name][index]), at, sizes))
    found = max(places, key=lambda place: place.size)
    return found if found.size > 0 else None


def draw(place, run, path):
    require("matplotlib")
    import files
    import images
    import pictures
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    with pictures.plt.rc_context(pictures.STYLE):
        in_space = len(place.at) == 3
        figure, axes = pictures.plt.subplots(1, 1 if in_space else 2, squeeze=False, layout="constrained",
                                             figsize=(6.4 if in_space else 9.4, 4.4))
        axes, norm = axes[0], Normalize(0, place.size)
        colours = pictures.matplotlib.colormaps["viridis"]
        values = {name: each[run.bodies[name].simplices] if place.what == "displacement" else each
                  for name, each in place.values.items()}
        if in_space:
            pictures.space.draw_difference(axes[0], run, values, norm, colours, place.at)
        else:
            draw_in_plane(axes, run, values, norm, colours, place)
        figure.suptitle(f"difference of the {place.what}", x=0.02, ha="left", fontsize=10.5)
        figure.colorbar(ScalarMappable(norm, colours), ax=list(axes), label="of the largest value")
        files.put({path: images.picture(figure, path.suffix[1:])})
        pictures.plt.close(figure)


def draw_in_plane(axes, run, values, norm, colours, place):
    import pictures

    points = np.concatenate([body.points for body in run.bodies.values()])
    low, high = points.min(0), points.max(0)
    side = 0.16 * (high - low).max()
    corner = np.clip(place.at - side / 2, low, np.maximum(high - side, low))
    for each, (left, right) in zip(axes, ((low, high), (corner, corner + side))):
        pictures.draw_bodies(each, run, 0.0, values, norm, colours)
        pictures.circle(each, place.at)
        margin = 0.03 * (right - left).max()
        pictures.show_window(each, (left[0] - margin, right[0] + margin, left[1] - margin, right[1] + margin))
    axes[1].set_title(f"where it is largest: {place.body}", loc="left")
