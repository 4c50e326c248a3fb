"""GetFEM and CalculiX beside the codes of study/codes.py, which this module adds them to.

Environment: CCX, CalculiX's program.
"""
import json
import os
import re
import shutil
import sys
from pathlib import Path

import numpy as np

import codes
import results
import scene as scenes
from problems import RunFailure
from process import Cost, measured

HERE = Path(__file__).resolve().parent
PATH = os.pathsep.join(str(HERE.parents[1] / folder) for folder in ("study", "compare"))


def require_plain(case):
    """What the other codes do not know."""
    if case["tolerance"] or case["scheme"] not in (None, "backward-euler"):
        raise RunFailure("takes equal steps of backward Euler only")
    if case["accuracy"] or (case["degree"] or 1) > 1:
        raise RunFailure("takes linear triangles of the meshes as they are only")


def require_getfem():
    if not any((Path(path) / "getfem").is_dir() for path in (*sys.path, "/usr/lib/python3/dist-packages")):
        raise RunFailure("GetFEM is not installed (Debian package python3-getfem)")


def run_getfem(case, scene, settings, folder, timeout):
    require_plain(case)
    require_getfem()
    return run_peer("getfem_code.py", case, scene, settings, folder, timeout)


def run_calculix(case, scene, settings, folder, timeout):
    require_plain(case)
    if shutil.which(os.environ.get("CCX", "ccx")) is None:
        raise RunFailure("CalculiX is not installed (Debian package calculix-ccx)")
    return run_peer("calculix_code.py", case, scene, settings, folder, timeout)


def run_peer(program, case, scene, settings, folder, timeout):
    """A code that reads the scene itself; it writes its fields into arrays and says what its solver alone
    cost."""
    checked = folder / "checked.edp"  # where the scene is sound
    measured([codes.MORTIER, "freefem", scene, checked, *codes.set_option(settings)], timeout)
    document = scenes.load(scene, settings, checked)
    take_sides(document, checked.read_text())
    problem = folder / "problem.json"
    problem.write_text(json.dumps(document, default=str))
    cost, _ = measured([sys.executable, HERE / program, problem, folder / "result.npz"], timeout, cwd=folder,
                       environment={**codes.ONE_THREAD, "PYTHONPATH": PATH})
    return read_peer(folder, cost)


def read_peer(folder, cost):
    data = np.load(folder / "result.npz", allow_pickle=False)
    facts = json.loads(str(data["facts"]))
    bodies = {name: results.Body(data[f"{name}.displacement"], data[f"{name}.stress"], data[f"{name}.points"],
                                 data[f"{name}.triangles"]) for name in facts["bodies"]}
    contact = None
    if "contact.position" in data:
        contact = results.Contact(data["contact.vertex"], data["contact.position"], data["contact.gap"],
                                  data["contact.force"])
    run_ = results.Run(facts["code"], folder, bodies, contact, facts)
    for name, body in bodies.items():
        results.require_finite(folder, f"displacement of {name}", body.displacement)
        results.require_finite(folder, f"stress of {name}", body.stress)
    mises = np.concatenate([body.von_mises for body in bodies.values()])
    u = np.concatenate([body.displacement for body in bodies.values()])
    run_.scalars = {"von_mises_min": mises.min(), "von_mises_max": mises.max(),
                    "displacement_min_x": u[:, 0].min(), "displacement_min_y": u[:, 1].min(),
                    "displacement_max_x": u[:, 0].max(), "displacement_max_y": u[:, 1].max()}
    if contact is not None:
        run_.scalars["contact_force"] = float(contact.force.sum())
    if "wall_time" in facts:
        cost = Cost(facts["wall_time"], facts["processor_time"], facts["memory"])
    return codes.outcome_of(run_, cost, facts["steps"], facts["iterations"])


def take_sides(document, script):
    """The sides of every contact as the program decided them:
    it names them in the script that it wrote for FreeFEM."""
    rows = re.search(r"^int\[int, int\] contact = \[(.*)\];$", script, re.MULTILINE)
    for contact, row in zip(document["contact"], re.findall(r"\[([^\[\]]+)\]", rows[1])):
        first, first_label, second, second_label = map(int, row.split(","))
        contact.pop("sides", None)
        contact["nonmortar"] = {"body": document["body"][first - 1]["name"], "label": first_label}
        contact["mortar"] = {"body": document["body"][second - 1]["name"], "label": second_label}


codes.SOLVERS |= {"getfem": run_getfem, "calculix": run_calculix}
