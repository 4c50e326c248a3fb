"""What stops a study, in one line: the file, the line, the key and what was expected."""
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parent.parent / "compare"))

from ending import Failure, Wrong, shown  # noqa: E402, F401


class StudyError(Wrong):
    """A wrong input; nothing has been written."""


class RunFailure(Failure):
    """A run of the sweep that has no result; its message becomes the reason in the table."""
