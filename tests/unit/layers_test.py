"""The layers of cpp/ see each other in one direction only, and each library is seen where it is wrapped."""
import os
import re
import unittest
from pathlib import Path

ROOT = Path(os.environ.get("MORTIER_ROOT", Path(__file__).resolve().parents[2]))
CPP = ROOT / "cpp"
PYTHON = ROOT / "python"  # sees all of them, and none of them sees it

# What each layer may include of the others, bottom up.
SEES = {"base": set(), "mesh": {"base"}, "material": {"base"}, "linear": {"base"}}
SEES["fem"] = {"base", "mesh", "material", "linear"}
SEES["contact"] = {"base", "mesh"}
SEES["solver"] = {*SEES["fem"], "fem", "contact"}
SEES["time"] = {*SEES["solver"], "solver"}
SEES["bound"] = {*SEES["time"], "time"}
SEES["scene"] = {*SEES["time"], "time"}
SEES["plan"] = {*SEES["scene"], "scene"}
SEES["lint"] = {*SEES["plan"], "plan"}
SEES["adapt"] = {*SEES["plan"], "plan"}
SEES["report"] = {*SEES["bound"], "bound"}
SEES["commands"] = {*SEES["lint"], "lint", "adapt", "bound", "report"}
SEES["mumps"] = {"base", "linear"}  # beside all others: what main.cpp is linked with

# Headers of libraries, and the only files that include them.
LIBRARIES = {r"cholmod|umfpack|cblas|amd\.h|colamd|lapack":
             r"linear/\w+\.cpp|linear/(cholmod_common|blas)\.h",
             r"Eigen/.*(Sparse\w*(LU|QR|Cholesky)|Iterative|\w*Support)": r"(linear|contact)/\w+\.cpp",
             r"gmsh": r"mesh/\w+\.cpp", r"toml\+\+": r"scene/\w+\.cpp",
             r"nlohmann": r"(report|commands)/\w+\.cpp", r"CLI/": r"commands/\w+\.cpp|main\.cpp",
             r"pybind11|Python\.h": r"python/\w+\.(cpp|h)", r"mpi\.h|dmumps": r"mumps/\w+\.cpp"}


def includes(path):
    """(brackets, name) of every include of a file."""
    return re.findall(r"^\s*#\s*include\s*([<\"])([^>\"]+)[>\"]", path.read_text(), re.M)


def sources(folder=CPP):
    return sorted(path for path in folder.rglob("*") if path.suffix in (".h", ".cpp"))


class Layers(unittest.TestCase):
    def test_every_folder_is_a_layer(self):
        self.assertEqual({path.name for path in CPP.iterdir() if path.is_dir()}, set(SEES))

    def test_includes_go_down(self):
        seen = 0
        for path in sources():
            layer = path.parent.name
            for bracket, name in includes(path):
                if bracket == '"' and path.parent != CPP:
                    seen += 1
                    self.assertTrue((CPP / name).is_file(), f"{path}: \"{name}\" is not in cpp/")
                    self.assertIn(name.split("/")[0], {layer, *SEES[layer]}, f"{path} includes {name}")
        self.assertGreater(seen, 200)

    def test_the_python_module_is_above_all(self):
        seen = set()
        for path in sources(PYTHON):
            for bracket, name in includes(path):
                if bracket == '"':
                    own = (PYTHON / name).is_file()
                    self.assertTrue(own or (CPP / name).is_file(), f"{path}: \"{name}\" is not in cpp/")
                    seen |= set() if own else {name.split("/")[0]}
        self.assertIn("commands", seen)
        self.assertEqual(seen - set(SEES), set())

    def test_links_go_down(self):
        text = (ROOT / "CMakeLists.txt").read_text()
        links = {name: re.findall(r"mortier-(\w+)", layers)
                 for name, layers in re.findall(r"^mortier_layer\((\w+)([^)]*)\)", text, re.M)}
        self.assertEqual(set(links), set(SEES) - {"commands", "mumps"})
        for layer, linked in links.items():
            below = set()
            for each in linked:
                below |= {each, *SEES[each]}
            self.assertEqual(below, SEES[layer], layer)

    def test_libraries_are_seen_where_they_are_wrapped(self):
        for library, wrapped in LIBRARIES.items():
            users = [str(path.relative_to(CPP if CPP in path.parents else ROOT))
                     for path in [*sources(), *sources(PYTHON)]
                     for bracket, name in includes(path) if bracket == "<" and re.match(library, name)]
            self.assertTrue(users, library)
            for user in users:
                self.assertRegex(user, rf"^({wrapped})$", library)
        self.assertEqual({path.parent.name for path in sources() for _, name in includes(path)
                          if name == "linear/cholmod_common.h"}, {"linear"})


if __name__ == "__main__":
    unittest.main()
