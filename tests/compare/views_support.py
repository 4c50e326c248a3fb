"""What the tests of mortier plot and mortier report share;
the modules of views/ can be imported after this one."""
import contextlib
import importlib.util
import io
import os
import sys
from unittest import mock

from support import PROGRAM, ROOT, mortier

sys.path.insert(0, str(ROOT / "views"))
SPEC = importlib.util.spec_from_file_location("views_main", ROOT / "views" / "__main__.py")
MAIN = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(MAIN)


def solve(folder, name, *settings, scene="compression", code=0):
    done = mortier("run", ROOT / f"scenes/{scene}.toml", "--quiet", "--out", folder / name, "--set",
                   "time.steps=4", *settings)
    assert done.returncode == code, done.stderr


def view(folder, *words):
    """What mortier plot or report does, without a process of its own: exit code, standard output,
    standard error."""
    out, errors = io.StringIO(), io.StringIO()
    with contextlib.chdir(folder), mock.patch.dict(os.environ, MORTIER=PROGRAM), \
            mock.patch.object(sys, "argv", ["views", *map(str, words)]), \
            contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
        code = MAIN.main()
    return code, out.getvalue(), errors.getvalue()
