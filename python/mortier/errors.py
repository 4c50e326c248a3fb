"""Errors with the line and the exit code of the program."""
from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mortier.run import Run


class Error(Exception):
    """What mortier raises; str() is one line, as on standard error."""

    exit_code = 1

    def __init__(self, line: str, run: Run | None = None) -> None:
        super().__init__(line)
        self.run = run  # what was reached, where a run began


class InputError(Error, ValueError):
    """A wrong scene, mesh or argument."""

    exit_code = 2


class ResultMissing(InputError, FileNotFoundError):
    """A scene or a result that is not there."""


class StepError(Error, RuntimeError):
    """A step that cannot be solved, or an accuracy that is not reached."""


class FreeMotion(Error, RuntimeError):
    """Nothing holds a body; the line names the motion."""

    exit_code = 3


class OutputError(Error, OSError):
    """A result that cannot be written."""
