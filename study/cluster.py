"""Runs of a study on the workers of a dask scheduler (dask.distributed).

A worker needs mortier (in MORTIER or its PATH) and no files: what a run reads travels with the study. Each
run is a process `mortier study -` of the worker (remote.py), which ends early when the worker is killed or
the study is stopped.
"""
import logging

import remote
import work
from parcel import unpacked
from problems import RunFailure, StudyError

PATIENCE = 10  # seconds in which a scheduler answers
TRIES = 3  # of a run whose worker cannot make it, before it is a row with that reason


class Workers:
    """Runs on the workers of the scheduler at an address, as many at once as they have threads."""

    def __init__(self, address, say):
        """StudyError: no scheduler answers there."""
        import distributed

        logging.disable()  # this program says it in a line of its own
        self.address, self.say = address, say
        try:
            self.client = distributed.Client(address, timeout=PATIENCE)
        except (OSError, ValueError, TypeError, ImportError) as error:
            raise StudyError(f"--scheduler {address}: no scheduler answers, expected tcp://HOST:PORT of one"
                             ) from error

    def __str__(self):
        return f"on the workers of {self.address}"

    def run(self, plan, meshes, cases, reference_done, done):
        import distributed
        from distributed.scheduler import KilledWorker

        make, task = on_worker(), remote.Task(plan, meshes)
        with self.client as client:
            def submit(*words):
                return client.submit(*words, pure=False, retries=TRIES)
            if not client.scheduler_info()["workers"]:
                self.say("no worker yet: waits for one")
            files = submit(bytes, remote.files_of(plan, meshes, cases))
            references, futures = {None: None}, {}
            for case in cases:
                reference = work.reference_of(plan, case)
                if reference not in references:
                    references[reference] = submit(make, task.words(reference, True), files, None)
                    futures[references[reference]] = reference_done, reference
                futures[submit(make, task.words(case, False), files, references[reference])] = done, case
            for future in distributed.as_completed(list(futures)):
                then, case = futures.pop(future)
                error = future.exception()
                if future.status == "cancelled":
                    raise RunFailure(f"the scheduler at {self.address} is gone")
                if isinstance(error, KilledWorker):
                    error = "every worker that began it was killed or ran out of memory"
                if error is None:
                    then(case, unpacked(future.result()))
                elif then is reference_done:
                    then(case, RunFailure(str(error)))
                else:
                    then(case, {"key": plan.key(case), **dict(case.values), **work.failed(error)})


def on_worker():
    """make(task, files, truth): what a worker does. A function in a function is sent as it stands: a worker
    has no module of the study."""

    def make(task, files, truth):
        import os
        import pickle
        import select
        import socket
        import subprocess
        import tempfile

        from distributed import get_worker

        worker = get_worker()
        key, program = worker.get_current_task(), os.environ.get("MORTIER", "mortier")

        def is_wanted():
            state = worker.state.tasks.get(key)
            return state is not None and state.state in ("executing", "long-running")

        with tempfile.TemporaryFile() as answer, tempfile.TemporaryFile() as complaint:
            try:
                child = subprocess.Popen([program, "study", "-"], stdin=subprocess.PIPE, stdout=answer,
                                         stderr=complaint,
                                         env={**os.environ, "TMPDIR": worker.local_directory})
                rest = pickle.dumps((files, truth, worker.state.nthreads))
                child.stdin.write(task + len(rest).to_bytes(8, "little") + rest)
                child.stdin.flush()
                ended = os.pidfd_open(child.pid)
                while not select.select([ended], [], [], 1)[0] and is_wanted():
                    pass
                os.close(ended)
                child.stdin.close()
            except FileNotFoundError as error:
                raise RuntimeError(f"worker {socket.gethostname()}: {program}: {error.strerror}") from None
            except BrokenPipeError:
                pass  # it ended early, and says why
            if child.wait() != 0:
                complaint.seek(0)
                lines = complaint.read().decode(errors="replace").strip().splitlines()
                raise RuntimeError(f"worker {socket.gethostname()}: {(lines or [f'{program} failed'])[-1]}")
            answer.seek(0)
            return answer.read()
    return make
