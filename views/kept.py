"""The numbers of a run as a small text file, to be kept under version control: what the scene asks for, the
scalars of the last step and the largest values of the run, with the settings and the tolerance."""
import json
import tempfile
from numbers import Real
from pathlib import Path

import results
from compare import FORCE, Difference, Verdict, quantity_differences, scalar_differences
from ending import Wrong

BY = "mortier compare --accept"
DIGITS = 10
NOISE = 1e-12  # of the largest value of a kind: what is less is rounding, which changes with the machine
PEAKS = {"von_mises": "largest von Mises", "contact_force": "largest force",
         "displacement": "largest displacement"}
LEFT_OUT = ("interpenetration", "active_nodes")  # rounding, and what an edge of the mesh decides


def is_file(place):
    return Path(place).suffix == ".json"


def require_free(path):
    """Only files of this kind are replaced."""
    if Path(path).exists():
        try:
            read(path)
        except results.ResultError as error:
            raise Wrong(f"{path}: in the way: not written by mortier compare --accept") from error


def write(path, run, settings, within):
    path = Path(path)
    peaks = {name: run.summary["peaks"][name]["value"] for name in PEAKS}
    sizes = sizes_of(peaks)

    def rounded(value, size):
        if size is None:  # a count, or a time
            return value
        return 0.0 if abs(value) <= NOISE * size else float(f"{value:.{DIGITS}g}")

    quantities = run.summary.get("quantities", {})
    kept = {"by": BY, "version": run.summary.get("versions", {}).get("mortier", ""),
            "scene": Path(run.summary["scene"]).name, "settings": settings, "within": within,
            **{kind: run.summary[kind] for kind in ("triangles", "tetrahedra") if kind in run.summary},
            "quantities": {name: {"value": rounded(each["value"], size_of(each, quantities)),
                                  "unit": each["unit"]} for name, each in quantities.items()},
            "final": {name: rounded(value, sizes.get(name, peaks["displacement"]))
                      for name, value in run.scalars.items() if name not in LEFT_OUT},
            "peaks": {name: rounded(value, 0) for name, value in peaks.items()}}
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, suffix=".tmp", delete=False) as file:
        file.write(json.dumps(kept, indent=1, ensure_ascii=False) + "\n")
    Path(file.name).chmod(0o644)
    Path(file.name).replace(path)


def size_of(quantity, quantities):
    """The largest value of its unit."""
    return max(abs(each["value"]) for each in quantities.values() if each["unit"] == quantity["unit"])


def sizes_of(peaks):
    stresses = ("von_mises_min", "von_mises_max")
    return {**dict.fromkeys(stresses, peaks["von_mises"]), "contact_force": peaks["contact_force"],
            "steps": None, "time": None}


def read(path):
    """As results.Run without fields. ResultError: no such file."""
    path = Path(path)
    kept = results.read_json(path)
    if not isinstance(kept, dict) or kept.get("by") != BY:
        raise results.ResultError(f"{path}: expected a file of mortier compare --accept")

    def table(name, of=Real):
        found = kept.get(name)
        if not isinstance(found, dict) or not all(isinstance(each, of) for each in found.values()):
            raise results.ResultError(f"{path}: {name}, expected a table of mortier compare --accept")
        return found

    final, peaks, quantities = table("final"), table("peaks"), table("quantities", dict)
    settings, within = kept.get("settings"), kept.get("within")
    if not {*PEAKS} <= peaks.keys() or not isinstance(settings, list) or \
            not all(isinstance(each, str) for each in settings) or \
            not (within is None or isinstance(within, Real) and within > 0) or \
            not all(isinstance(each.get("value"), Real) and isinstance(each.get("unit"), str)
                    for each in quantities.values()):
        raise results.ResultError(f"{path}: changed since mortier compare --accept wrote it")
    summary = {**kept, "peaks": {name: {"value": value} for name, value in peaks.items()}}
    return results.Run("kept numbers", path, {}, None, summary, scalars=final)


def compare(ours, kept, within):
    """The verdict on a run and numbers that were kept; counts of steps are for tolerances of rounding."""
    within = within if within is not None else kept.summary["within"]
    peaks = {name: each["value"] for name, each in kept.summary["peaks"].items()}
    missing = [f"{name}: in one of them alone" for name in
               {*ours.summary.get("quantities", {})} ^ {*kept.summary["quantities"]}]
    scalars = {name: value for name, value in ours.scalars.items() if name in kept.scalars}
    found = quantity_differences(ours, kept, within)
    found += scalar_differences(scalars, kept.scalars, peaks["displacement"], peaks["von_mises"],
                                peaks["contact_force"], within=within)
    for name in PEAKS:
        a, b = ours.summary["peaks"][name]["value"], peaks[name]
        found.append(Difference(PEAKS[name], abs(a - b) / (b or 1.0) if a != b else 0.0,
                                FORCE if within is None else within, a, b))
    return Verdict(found, sorted(missing))
