"""Runs every case of a study that has no row yet, several at once."""
import concurrent.futures as futures
import shutil
import threading

import codes
import measure
import process
import scene as scenes
import table
from problems import RunFailure


class Runner:
    def __init__(self, plan, folder, jobs, say):
        self.plan, self.folder, self.jobs, self.say = plan, folder, jobs, say
        self.lock = threading.Lock()
        self.references = {}  # case -> results.Run, or the reason why there is none

    def run(self):
        """key -> row of every case."""
        known = table.read(self.folder.path / "study.csv")
        cases = self.plan.cases()
        self.rows = {key: known[key] for case in cases if (key := self.plan.key(case)) in known}
        open_cases = [case for case in cases if self.plan.key(case) not in self.rows]
        self.say(f"{len(cases)} runs, {len(self.rows)} of them done before; {self.jobs} at once")
        self.write()
        if not open_cases:
            return self.rows
        self.meshes = codes.make_meshes(self.plan, self.folder.passing("meshes"))
        needed = list(dict.fromkeys(self.reference_of(case)
                                    for case in open_cases)) if self.plan.reference is not None \
            else []
        self.each(needed, self.solve_reference)
        self.each(open_cases, self.solve)
        return self.rows

    def write(self):
        self.folder.put("study.csv", table.text(self.plan, self.rows).encode())

    def each(self, cases, work):
        with futures.ThreadPoolExecutor(self.jobs) as pool:
            tasks = [pool.submit(work, case) for case in cases]
            try:
                for task in futures.as_completed(tasks):
                    task.result()
            except BaseException:
                for task in tasks:
                    task.cancel()
                process.stop_all()
                raise

    def reference_of(self, case):
        replaced = case.replaced(self.plan.reference)
        return replaced if "code" in self.plan.reference else replaced.replaced({"code": "mortier"})

    def solve_reference(self, case):
        try:
            outcome = codes.run(case, self.plan.scene, self.meshes,
                                self.folder.passing("runs") / f"reference-{self.plan.key(case)}")
            self.references[case] = outcome.run
            self.say(f"reference  {case}: {outcome.cost.wall_time:.2f} s")
        except RunFailure as error:
            self.references[case] = error
            self.say(f"reference  {case}: failed: {error}")

    def solve(self, case):
        key = self.plan.key(case)
        row = {"key": key, **dict(case.values), "at_once": self.jobs}
        folder = self.folder.passing("runs") / key
        try:
            outcome = codes.run(case, self.plan.scene, self.meshes, folder, self.plan.timeout,
                                self.plan.repeat)
            row |= {"triangles": outcome.triangles, "dofs": outcome.dofs, "time_steps": outcome.steps,
                    "iterations": outcome.iterations, "wall_time[s]": f"{outcome.cost.wall_time:.4f}",
                    "processor_time[s]": f"{outcome.cost.processor_time:.4f}",
                    "memory[MiB]": f"{outcome.cost.memory:.1f}"}
            row |= claims(outcome.run)
            row |= self.errors(case, outcome.run)
            row |= {"status": table.DONE}
        except RunFailure as error:
            row |= {"status": table.FAILED, "reason": " ".join(str(error).split())}
        shutil.rmtree(folder, ignore_errors=True)
        with self.lock:
            self.rows[key] = row
            self.write()
            done = sum(1 for each in self.plan.cases() if self.plan.key(each) in self.rows)
        words = ", ".join(f"{name.removeprefix('error ')} {float(value):.2e}" for name, value in row.items()
                          if name.startswith("error "))
        self.say(f"{done:>4}/{len(self.plan.cases())}  {case}: "
                 + (f"{words}; {row['wall_time[s]']} s" if row["status"] == table.DONE
                    else f"failed: {row['reason']}"))

    def errors(self, case, run):
        settings = codes.settings_of(case, self.meshes)
        document = scenes.load(self.plan.scene, settings)
        truth = None
        if self.plan.reference is not None and any(each.exact is None for each in self.plan.errors):
            truth = self.references[self.reference_of(case)]
            if isinstance(truth, RunFailure):
                raise RunFailure(f"the reference run failed: {truth}")
        ring = document.get("plane") == "axisymmetric"
        return {f"error {each.name}": repr(measure.error_of(each, run, truth, scenes.materials(document),
                                                            self.plan.let, float(document["time"]["end"]),
                                                            ring))
                for each in self.plan.errors}


def claims(run):
    """What the run itself says of its error."""
    accuracy = run.summary.get("accuracy", {})
    said = {"estimate": accuracy.get("energy_error"), "bound": accuracy.get("bound", {}).get("energy_error")}
    return {name: "" if value is None else repr(value) for name, value in said.items()}
