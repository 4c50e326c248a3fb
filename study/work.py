"""One run of a study, wherever it is made: what it costs, what it claims and how far it is off."""
import shutil

import codes
import measure
import scene as scenes
import table
from problems import RunFailure


def reference_of(plan, case):
    """The finer run that a case is measured against; None where every error has an exact value."""
    if plan.reference is None or all(each.exact is not None for each in plan.errors):
        return None
    replaced = case.replaced(plan.reference)
    return replaced if "code" in plan.reference else replaced.replaced({"code": "mortier"})


def reference_run(plan, meshes, case, folder):
    """The outcome of a reference run, or the RunFailure that says why it has none."""
    try:
        return codes.run(case, plan.scene, meshes, folder)
    except RunFailure as error:
        return error


def row_of(plan, meshes, case, folder, truth, at_once):
    """The row of a case in study.csv, a reason in it where the run has no result.

    meshes: body -> files by level; truth: what reference_run gave, None where there is no reference;
    at_once: the runs that share a machine.
    """
    row = {"key": plan.key(case), **dict(case.values), "at_once": at_once}
    try:
        outcome = codes.run(case, plan.scene, meshes, folder, plan.timeout, plan.repeat)
        row |= {"triangles": outcome.triangles, "dofs": outcome.dofs, "time_steps": outcome.steps,
                "iterations": outcome.iterations, "wall_time[s]": f"{outcome.cost.wall_time:.4f}",
                "processor_time[s]": f"{outcome.cost.processor_time:.4f}",
                "memory[MiB]": f"{outcome.cost.memory:.1f}"}
        row |= claims(outcome.run)
        row |= errors(plan, meshes, case, outcome.run, truth)
        row |= {"status": table.DONE}
    except RunFailure as error:
        row |= failed(error)
    shutil.rmtree(folder, ignore_errors=True)
    return row


def failed(reason):
    """What a row says of a run without a result."""
    return {"status": table.FAILED, "reason": " ".join(str(reason).split())}


def errors(plan, meshes, case, run, truth):
    if isinstance(truth, RunFailure):
        raise RunFailure(f"the reference run failed: {truth}")
    document = scenes.load(plan.scene, codes.settings_of(case, meshes))
    ring = document.get("plane") == "axisymmetric"
    return {f"error {each.name}": repr(measure.error_of(each, run, truth and truth.run,
                                                        scenes.materials(run, document), plan.let,
                                                        float(run.scalars.get("time") or
                                                              document["time"]["end"]), ring))
            for each in plan.errors}


def claims(run):
    """What the run itself says of its error."""
    accuracy = run.summary.get("accuracy", {})
    said = {"estimate": accuracy.get("energy_error"), "bound": accuracy.get("bound", {}).get("energy_error")}
    return {name: "" if value is None else repr(value) for name, value in said.items()}
