"""Runs a scene in either code. One scene drives both: mortier writes it as a FreeFEM script.

Environment: MORTIER, the program (default build/mortier); FREEFEM, FreeFEM's (default FreeFem++-nw).
"""
import os
import subprocess
import time
from pathlib import Path

import results

ROOT = Path(__file__).resolve().parent.parent
MORTIER = os.environ.get("MORTIER", str(ROOT / "build" / "mortier"))
FREEFEM = os.environ.get("FREEFEM", "FreeFem++-nw")
COMPRESSION = "scenes/compression.toml"


class RunError(Exception):
    """A code that ended with an error; the message ends with its last words."""

    def __init__(self, message, code=1, output=""):
        super().__init__(message)
        self.code, self.output = code, output


def call(command, cwd=ROOT):
    """Runs a command in a folder; its output, and its wall time [s]."""
    begin = time.perf_counter()
    try:
        done = subprocess.run([str(word) for word in command], cwd=cwd, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, errors="replace")
    except OSError as error:
        raise RunError(f"{command[0]}: {error.strerror}") from error
    seconds = time.perf_counter() - begin
    if done.returncode != 0:
        words = "\n".join(done.stdout.strip().splitlines()[-8:])
        raise RunError(f"{' '.join(map(str, command))}\nended with code {done.returncode}:\n{words}",
                       done.returncode, done.stdout)
    return done.stdout, seconds


def run_mortier(folder, settings=(), scene=COMPRESSION, cwd=ROOT):
    """Solves a scene with mortier; settings are KEY=VALUE.
    Paths of the scene and in settings begin at cwd."""
    _, seconds = call([MORTIER, "run", scene, "--quiet", "--out", folder, *set_option(settings)], cwd)
    run = results.read_mortier(folder)
    run.wall_time = seconds
    return run


def run_freefem(folder, settings=(), scene=COMPRESSION, method="freefem", cwd=ROOT, steps_of=None):
    """Solves a scene with FreeFEM; another method than that of freefem/ is a folder like it. steps_of is a
    folder of mortier's results, whose steps are taken."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    script = folder / "scene.edp"
    steps = ["--steps-of", steps_of] if steps_of else []
    call([MORTIER, "freefem", scene, script, *steps, *set_option(settings)], cwd)
    if method != "freefem":
        script.write_text(script.read_text().replace('include "freefem/', f'include "{method}/'))
    _, seconds = call([FREEFEM, "-nw", "-nw", "-ne", "-v", "0", script, "-quiet", "-out", folder], cwd)
    run = results.read_freefem(folder)
    run.wall_time = seconds
    return run


def set_option(settings):
    return ["--set", *settings] if settings else []
