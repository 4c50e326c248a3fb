"""Runs every case of a study that has no row yet, several at once."""
import concurrent.futures as futures

import codes
import process
import table
import work
from problems import RunFailure


class Runner:
    def __init__(self, plan, folder, place, say):
        """place: where the runs are made: Here, or cluster.Workers."""
        self.plan, self.folder, self.place, self.say = plan, folder, place, say

    def run(self):
        """key -> row of every case."""
        known = table.read(self.folder.path / "study.csv")
        self.cases = self.plan.cases()
        self.rows = {key: known[key] for case in self.cases if (key := self.plan.key(case)) in known}
        open_cases = [case for case in self.cases if self.plan.key(case) not in self.rows]
        self.say(f"{len(self.cases)} runs, {len(self.rows)} of them done before; {self.place}")
        self.write()
        if open_cases:
            meshes = codes.make_meshes(self.plan, self.folder.passing("meshes"))
            self.place.run(self.plan, meshes, open_cases, self.reference_done, self.done)
        return self.rows

    def write(self):
        self.folder.put("study.csv", table.text(self.plan, self.rows).encode())

    def reference_done(self, case, outcome):
        self.say(f"reference  {case}: " + (f"failed: {outcome}" if isinstance(outcome, RunFailure)
                                           else f"{outcome.cost.wall_time:.2f} s"))

    def done(self, case, row):
        self.rows[row["key"]] = row
        self.write()
        words = ", ".join(f"{name.removeprefix('error ')} {float(value):.2e}" for name, value in row.items()
                          if name.startswith("error "))
        self.say(f"{len(self.rows):>4}/{len(self.cases)}  {case}: "
                 + (f"{words}; {row['wall_time[s]']} s" if row["status"] == table.DONE
                    else f"failed: {row['reason']}"))


class Here:
    """Runs on this machine, `jobs` at once."""

    def __init__(self, folder, jobs):
        self.folder, self.jobs = folder, jobs

    def __str__(self):
        return f"{self.jobs} at once"

    def run(self, plan, meshes, cases, reference_done, done):
        references = {None: None}
        runs = self.folder.passing("runs")

        def reference(case):
            return work.reference_run(plan, meshes, case, runs / f"reference-{plan.key(case)}")

        def row(case):
            return work.row_of(plan, meshes, case, runs / plan.key(case),
                               references[work.reference_of(plan, case)], self.jobs)

        def keep_reference(case, outcome):
            references[case] = outcome
            reference_done(case, outcome)
        needed = dict.fromkeys(work.reference_of(plan, case) for case in cases)
        self.each([case for case in needed if case is not None], reference, keep_reference)
        self.each(cases, row, done)

    def each(self, cases, make, done):
        with futures.ThreadPoolExecutor(self.jobs) as pool:
            tasks = {pool.submit(make, case): case for case in cases}
            try:
                for task in futures.as_completed(tasks):
                    done(tasks[task], task.result())
            except BaseException:
                for task in tasks:
                    task.cancel()
                process.stop_all()
                raise
