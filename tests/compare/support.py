"""What the tests of this folder share. Run by ctest, or alone: MORTIER=build/mortier /usr/bin/python3 FILE"""
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(os.environ.get("MORTIER_ROOT", Path(__file__).resolve().parents[2]))
COMPARE = ROOT / "compare"
sys.path.insert(0, str(COMPARE))


def script(name, *arguments):
    """Runs a script of compare/: exit code and output."""
    done = subprocess.run([sys.executable, str(COMPARE / name), *map(str, arguments)], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout
