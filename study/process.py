"""One process, measured: wall time, processor time and peak memory."""
import os
import signal
import subprocess
import sys
import threading
from dataclasses import dataclass
from pathlib import Path

from problems import RunFailure

LAUNCH = [sys.executable, "-I", "-S", str(Path(__file__).resolve().parent / "launch.py")]
WORDS = 400  # of a failed process that are kept as its reason
running = set()  # process groups under way
stopping = threading.Event()  # set once, when the study itself is stopped
starts = threading.Lock()  # no process starts between the order to stop and the list of those to kill


class Stopped(Exception):
    """The study was stopped: the process has no result, and that is no failure of its own."""


@dataclass
class Cost:
    wall_time: float  # [s]
    processor_time: float  # [s]
    memory: float  # peak resident [MiB]


def measured(command, timeout=None, cwd=None, environment=None):
    """Runs a command to its end: its cost and its output. RunFailure with its reason when it fails, Stopped
    when the study is stopped."""
    command = [str(word) for word in command]
    read_end, write_end = os.pipe()
    try:
        with starts:
            if stopping.is_set():
                raise Stopped
            process = subprocess.Popen([*LAUNCH, str(write_end), *command], stdin=subprocess.PIPE,
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=cwd,
                                       env={**os.environ, **(environment or {})}, pass_fds=[write_end],
                                       start_new_session=True, text=True, errors="replace")
            running.add(process.pid)
    except BaseException:
        os.close(read_end)
        raise
    finally:
        os.close(write_end)
    late = threading.Event()

    def stop():
        late.set()
        os.killpg(process.pid, signal.SIGKILL)
    timer = threading.Timer(timeout, stop) if timeout else None
    if timer:
        timer.start()
    output = process.stdout.read()  # standard input stays open: its end would say that the study was killed
    process.wait()
    process.stdin.close()
    process.stdout.close()
    running.discard(process.pid)
    if timer:
        timer.cancel()
    with os.fdopen(read_end) as pipe:
        facts = pipe.read().split()
    if stopping.is_set():
        raise Stopped
    if late.is_set():
        raise RunFailure(f"stopped after {timeout:g} s")
    if len(facts) != 4 or facts[0] != "0":
        raise RunFailure(last_words(output)
                         or f"{command[0]} ended with code {facts[0] if facts else process.returncode}")
    return Cost(*map(float, facts[1:])), output


def stop_all():
    with starts:
        stopping.set()
    for pid in list(running):
        try:
            os.killpg(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass


def last_words(output):
    """The line that says what went wrong: the first error, otherwise the last line."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    errors = [line for line in lines if "error" in line.lower()]
    return (errors or lines[-1:] or [""])[0][:WORDS]
