"""What pip calls (PEP 517): a wheel of what CMake builds, with nothing but the standard library."""
import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
VERSION = re.search(r"^project\(mortier VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1]
METADATA = f"""\
Metadata-Version: 2.1
Name: mortier
Version: {VERSION}
Summary: contact of elasto-viscoplastic bodies on nonmatching meshes
License: GPL-3.0-or-later
Requires-Python: >=3.10
Requires-Dist: numpy
Provides-Extra: plot
Requires-Dist: matplotlib; extra == "plot"
Requires-Dist: meshio; extra == "plot"
"""
SHARED = ("views", "compare")  # what draws pictures


def build_package(settings):
    """The folder of the package. --config-settings build=FOLDER: it is built there, with the options that the
    folder has."""
    build = ROOT / (settings or {}).get("build", "build-wheel")
    configure = ["-DMORTIER_PYTHON=ON", "-DMORTIER_TESTS=OFF", "-DMORTIER_BENCH=OFF",
                 f"-DPython_EXECUTABLE={sys.executable}"]
    if not (build / "CMakeCache.txt").exists():
        subprocess.run(["cmake", "-S", ROOT, "-B", build, *configure], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "mortier-python-package",
                    "--parallel", str(os.cpu_count())], check=True)
    return build / "python" / "mortier"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    package = build_package(config_settings)
    files = {f"mortier/{path.name}": path.read_bytes() for path in package.iterdir() if path.is_file()}
    for folder in SHARED:
        for path in (ROOT / folder).glob("*.py"):
            files[f"mortier/share/mortier/{folder}/{path.name}"] = path.read_bytes()
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"
    about = f"mortier-{VERSION}.dist-info"
    files[f"{about}/METADATA"] = METADATA.encode()
    files[f"{about}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: mortier\nRoot-Is-Purelib: false\n"
                               f"Tag: {tag}\n").encode()
    record = "".join(f"{name},sha256={digest(data)},{len(data)}\n" for name, data in files.items())
    files[f"{about}/RECORD"] = f"{record}{about}/RECORD,,\n".encode()
    name = f"mortier-{VERSION}-{tag}.whl"
    with zipfile.ZipFile(Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in files.items():
            wheel.writestr(path, data)
    return name


def digest(data):
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
