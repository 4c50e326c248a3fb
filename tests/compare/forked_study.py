"""mortier study in forks of a process that has read all its modules:
a study of small runs takes 0.1 s instead of 2."""
import ctypes
import importlib.util
import os
import signal
import sys
import traceback

from call_sweep import CALLS
from support import PROGRAM, ROOT


def drawn(plan, series):
    """In place of pictures.draw, which takes most of the time and writes nothing:
    the same answer with empty pictures."""
    names = [f"{error.name}-size" for error in plan.errors]
    stems = sys.modules["pictures"].stems(names)
    return [*zip(names, stems)], {f"{stem}.svg": b"<svg/>" for stem in stems}


class ForkedStudy:
    """\"errors\" and \"calls\" are files in the folder. Faults (tests/faults) need LD_PRELOAD=CALLS and
    FAULT_FOLDER="" from the start of this process."""

    def __init__(self, folder):
        self.errors, self.shared = folder / "errors", folder / "calls"
        os.environ["MORTIER"] = PROGRAM
        spec = importlib.util.spec_from_file_location("mortier_study", ROOT / "study/__main__.py")
        self.program = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(self.program)
        self.program.require("matplotlib", "meshio", "analysis", "report", "folder", "sweep", "pictures")
        self.draw = sys.modules["pictures"].draw

    def run(self, folder, study, out, pictures=False, at=0, how=""):
        """Its exit code, what it told, the number of calls to the file system where they are counted."""
        faulty = "FAULT_FOLDER" in os.environ
        sys.modules["pictures"].draw = self.draw if pictures else drawn
        self.shared.write_bytes(bytes(8))
        if (child := os.fork()) == 0:
            code = 99
            try:
                os.chdir(folder)
                file = os.open(self.errors, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
                os.dup2(file, 1)
                os.dup2(file, 2)
                signal.alarm(120)
                sys.argv = ["study", study, "--out", out, "--jobs", "1", "--quiet"]
                if faulty:
                    os.environ.update(LD_PRELOAD=CALLS, FAULT_SHARED=str(self.shared),
                                      FAULT_FOLDER=str(folder), FAULT_AT=str(at), FAULT_HOW=how)
                    calls = ctypes.CDLL(CALLS)
                    calls.faults_begin(at, how.encode(), str(folder).encode(), str(self.shared).encode())
                code = self.program.main()
                if faulty:
                    calls.faults_begin(0, b"", b"", None)
            except BaseException:
                traceback.print_exc()
            finally:
                os._exit(code)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        return code, self.errors.read_bytes(), int.from_bytes(self.shared.read_bytes()[:4], sys.byteorder)
