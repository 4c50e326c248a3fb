"""How the commands of mortier that are written in Python end: one line on what stopped them,
and the exit code."""
import importlib
import logging
import signal
import sys


class Wrong(Exception):
    """A wrong input; nothing has been written."""


class Failure(Exception):
    """What was asked cannot be done; the message is the reason."""


def shown(text, most=2000):
    """A text as one line of visible characters; of a long one the middle is left out."""
    line = "".join(c if c.isprintable() else "?" for c in str(text))
    return line if len(line) <= most else f"{line[:most // 2]} ... {line[-most // 2:]}"


def complain(text, code):
    print(f"mortier: {shown(text)}", file=sys.stderr)
    return code


def require(*modules):
    """Debian's packages of Python modules; another Python may lack them."""
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # it warns where there is no home for its cache
    for module in modules:
        try:
            importlib.import_module(module)
        except ImportError as error:
            raise Failure(
                f"the Python module {module} is missing (Debian package python3-{module})") from error
    if "matplotlib" in modules:
        importlib.import_module("matplotlib").use("Agg")  # files are drawn, whatever the reader's screen


def interrupt(*_):
    raise KeyboardInterrupt


def code_of(command, where, expected, kept, place=""):
    """The exit code of command(), 0 where it returns none.
    Messages but those on a wrong input begin with `where`.

    expected: what the input should be, where it is nested too deeply; kept: what is left by a command that is
    interrupted; place: what cannot be written, where the system does not name it.
    """
    signal.signal(signal.SIGTERM, interrupt)
    try:
        return command() or 0
    except Wrong as error:
        return complain(error, 2)
    except Failure as error:
        return complain(f"{where}: {error}", 1)
    except OSError as error:
        named = error.filename or place
        return complain(f"{where}: {named}{': ' if named else ''}{error.strerror or error}", 1)
    except RecursionError:
        return complain(f"{where}: nested too deeply, expected {expected}", 2)
    except MemoryError:
        return complain(f"{where}: out of memory", 1)
    except KeyboardInterrupt:
        return complain(f"{where}: interrupted; {kept}", 1)
    except Exception as error:  # a fault of this program
        return complain(f"{where}: {type(error).__name__}: {error}; please report this", 1)
