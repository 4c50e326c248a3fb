"""What stops a study, in one line: the file, the line, the key and what was expected."""


class StudyError(Exception):
    """A wrong input; nothing has been written."""


class RunFailure(Exception):
    """A run of the sweep that has no result; its message becomes the reason in the table."""


def shown(text, most=2000):
    """A text as one line of visible characters; of a long one the middle is left out."""
    line = "".join(c if c.isprintable() else "?" for c in str(text))
    return line if len(line) <= most else f"{line[:most // 2]} ... {line[-most // 2:]}"
