"""What stops a picture or a report, in one line."""


class ViewError(Exception):
    """A wrong input; nothing has been written."""


def shown(text, most=2000):
    """A text as one line of visible characters; of a long one the middle is left out."""
    line = "".join(c if c.isprintable() else "?" for c in str(text))
    return line if len(line) <= most else f"{line[:most // 2]} ... {line[-most // 2:]}"
