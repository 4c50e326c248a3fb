"""What the tests of the Python module share; importing it makes `import mortier` that of the build."""
import os
import sys
from pathlib import Path

from support import PROGRAM, ROOT

PACKAGE = Path(os.environ.get("MORTIER_MODULE", Path(PROGRAM).parent / "python" / "mortier"))
SCENES = ROOT / "scenes"
sys.path.insert(0, str(PACKAGE.parent))
