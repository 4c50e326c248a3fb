"""What stops a study, in one line: the file, the line, the key and what was expected."""


class StudyError(Exception):
    """A wrong input; nothing has been written."""


class RunFailure(Exception):
    """A run of the sweep that has no result; its message becomes the reason in the table."""
