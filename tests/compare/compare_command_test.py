"""mortier compare: both codes, a result that was kept, other meshes, another code's files."""
import json
import os
import re
import stat
import subprocess
import textwrap
import unittest

import meshio
import numpy as np

from scene_parts import body, contact, shape, timed, tool
from support import PROGRAM, ROOT, OfTwoBlocks, mortier
from views_support import view
import results

ROLLERS_AND_TOOLS = ('plane = "strain"\nBELOW\n'
                     + body("middle",
                            shape("quadrilateral", cells=[7, 3], cut="both",
                                  corners=[[-0.85, 0], [0.83, 0], [0.86, 0.53], [-0.85, 0.53]]),
                            "young = 1000, poisson = 0.4999, viscosity = 1, yield_stress = 5",
                            "label = 2, un = 0") + contact(("middle", 1), ("below", 3), friction=1.5)
                     + contact(("middle", 3), ("above", 1), friction=1.5)
                     + tool("above", shape="polygon",
                            points=[[-1.15, 0.53], [1.15, 0.53], [1.15, 0.8], [-1.15, 0.8]], uy="-0.005*t")
                     + timed(2))
BELOW = {"tool": """[[tool]]
name = "below"
shape = "polygon"
points = [[-1.15, -0.3], [1.15, -0.3], [1.15, 0], [-1.15, 0]]
""", "block": """[[body]]
name = "below"
mesh = { shape = "rectangle", lower = [-1, -0.75], upper = [1, 0], cells = 3, cut = "both" }
material = { young = 100, poisson = 0 }
boundary = [{ label = 1, ux = 0, uy = 0 }]
"""}


class Compare(OfTwoBlocks):
    def compare(self, *words, code=0):
        """The lines of standard output, or with an exit code of 2 the one of standard error."""
        found, told, errors = view(self.folder, "compare", "scene.toml", *words)
        self.assertEqual(found, code, told + errors)
        self.assertEqual(len(errors.splitlines()), 1 if code == 2 else 0, errors)
        return errors if code == 2 else told.splitlines()

    def beyond(self, lines):
        return [line.split("  ")[0] for line in lines if line.endswith("<-- beyond")]

    def test_both_codes_agree(self):
        before = self.names()
        lines = self.compare()
        self.assertEqual(lines[-1], "scene.toml: agrees")
        self.assertRegex(lines[-2], r"largest difference: \w+ of (upper|lower), .* of the largest")
        self.assertEqual(self.names(), before)

    def test_a_code_with_other_data_differs(self):
        wrapper = self.folder / "other-freefem"
        wrapper.write_text('#!/bin/sh\nfor word; do\n'
                           'case $word in *.edp) sed -i "s/E1 = 3e+11/E1 = 3.001e+11/" "$word";; esac\ndone\n'
                           'exec FreeFem++-nw "$@"\n')
        wrapper.chmod(wrapper.stat().st_mode | stat.S_IXUSR)
        done = mortier("compare", "scene.toml", "--set", "body.upper.material.viscosity=1e12",
                       cwd=self.folder, env={**os.environ, "FREEFEM": str(wrapper)})
        self.assertEqual((done.returncode, done.stderr), (1, ""))
        lines = done.stdout.splitlines()
        self.assertIn("displacement upper", self.beyond(lines))
        self.assertEqual(lines[-1], "scene.toml: differs; scene.difference.png")
        self.assertTrue((self.folder / "scene.difference.png").read_bytes().startswith(b"\x89PNG"))

    def test_where_rollers_meet_tools_with_friction(self):
        """A side held along a normal that is no axis, between a tool and a block, and between two tools: at
        their ends more conditions hold a node than it has displacements."""
        for below, chosen in (("block", False), ("tool", True)):
            with self.subTest(below=below):
                self.write(ROLLERS_AND_TOOLS.replace("BELOW", BELOW[below]))
                lines = self.compare()
                self.assertEqual(lines[-1], "scene.toml: agrees")
                names = [line.split("  ")[0] for line in lines]
                self.assertIn("stress middle", names)
                self.assertEqual("contact force" in names, not chosen, "nodal forces are one choice of many")

    def test_a_corner_on_a_slope_is_refused(self):
        """FreeFEM's method has no contact at corners."""
        self.write(ROLLERS_AND_TOOLS.replace("BELOW", BELOW["block"])
                   .replace("[-0.85, 0.53]", "[-0.85, 0.46]"))
        self.assertIn("contact: a corner or an end of a line that touches the other one",
                      self.compare(code=2))

    def test_a_missing_code(self):
        done = mortier("compare", "scene.toml", cwd=self.folder,
                       env={**os.environ, "FREEFEM": "no-such-code"})
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("no-such-code: No such file or directory (Debian package freefem++)", done.stderr)

    def test_a_run_that_fails_names_no_folder_that_is_deleted(self):
        done = mortier("compare", ROOT / "scenes/compression.toml", "--set", "contact.variant=interpolation",
                       "solver.max_iterations=2", "time.steps=20", cwd=self.folder)
        last = done.stderr.splitlines()[-1]
        self.assertEqual(done.returncode, 1)
        self.assertIn("did not converge in 2 iterations", last)
        self.assertTrue(last.endswith("; mortier run keeps the last state"), last)
        self.assertNotIn("mortier-compare-", done.stderr)

    def test_a_kept_result(self):
        self.compare("--accept", "kept/scene")
        self.assertEqual(self.compare("--against", "kept/scene")[-1], "scene.toml: agrees")
        changed = ("--against", "kept/scene", "--set", "body.upper.material.viscosity=10.01")
        lines = self.compare(*changed, code=1)
        self.assertIn("displacement upper", self.beyond(lines))
        lines = self.compare(*changed, "--within", "0.01", "--picture", "d.svg")
        self.assertEqual(lines[-1], "scene.toml: agrees; d.svg")

    def test_numbers_as_a_small_file(self):
        """With the settings of the run and the tolerance; the same bytes again; no numbers of rounding."""
        self.write(self.read("scene.toml") + '[[quantity]]\nname = "foot"\n'
                   'reaction = { body = "lower", label = 1 }\ncomponent = "y"\n')
        given = ("--set", 'body.upper.boundary.3.ty="-9*t"', "--within", "1e-3")
        self.assertIn("kept, ", self.compare("--accept", "kept/scene.json", *given)[-1])
        text = self.read("kept/scene.json")
        self.assertLess(len(text), 1500)
        kept = json.loads(text)
        self.assertEqual(kept["quantities"], {"foot": {"value": 9.0, "unit": "N/m"}})
        self.assertEqual(kept["settings"], ['body.upper.boundary.3.ty="-9*t"'])
        self.compare("--accept", "kept/scene.json", *given)
        self.assertEqual(self.read("kept/scene.json"), text)
        lines = self.compare("--against", "kept/scene.json")  # with the settings and the tolerance
        self.assertEqual(lines[-1], "scene.toml: agrees")
        self.assertTrue(all(line.split()[-1] == "1e-03" for line in lines[1:-1]), lines)
        for factor, code in ((1.0005, 0), (1.002, 1)):
            kept["quantities"]["foot"]["value"] = 9 * factor
            self.write(json.dumps(kept), "kept/changed.json")
            lines = self.compare("--against", "kept/changed.json", code=code)
            self.assertEqual(self.beyond(lines), ["foot"] if code else [])
        lines = self.compare("--against", "kept/scene.json", "--set", "time.end=2", code=1)
        self.assertIn("foot", self.beyond(lines))
        kept["quantities"]["other"] = kept["quantities"]["foot"]
        self.write(json.dumps(kept), "kept/changed.json")
        self.assertIn("other: in one of them alone", self.compare("--against", "kept/changed.json", code=1))

    def test_files_of_numbers_that_are_none(self):
        self.compare("--accept", "scene.json")
        sound = json.loads(self.read("scene.json"))
        changes = [{"by": "x"}, {"settings": [3]}, {"within": -1}, {"final": {"time": "x"}}, {"peaks": {}},
                   {"quantities": {"a": {"value": None, "unit": ""}}}, {"final": 3}]
        for text in ("", "{", "[]", *(json.dumps({**sound, **change}) for change in changes)):
            with self.subTest(text[:200]):
                self.write(text, "changed.json")
                self.assertIn("changed.json: ", self.compare("--against", "changed.json", code=2))
                self.assertIn("changed.json: in the way", self.compare("--accept", "changed.json", code=2))
                self.assertEqual(self.read("changed.json"), text)
        self.compare("--against", "nowhere.json", code=2)

    def test_the_example_for_ci(self):
        """The script of the workflow, as a shell runs it."""
        text = (ROOT / "examples" / "check-results.yml").read_text()
        script = textwrap.dedent(re.search(r"- name: Compare\n        run: \|\n(.*)", text, re.S)[1])
        (self.folder / "bin").mkdir()
        (self.folder / "bin" / "mortier").symlink_to(PROGRAM)
        self.compare("--accept", "scene.json")

        def run():
            path = {**os.environ, "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}"}
            return subprocess.run(["sh", "-e", "-c", script], cwd=self.folder, env=path,
                                  capture_output=True, text=True)

        self.assertEqual(run().returncode, 0)
        self.write(self.read("scene.toml").replace("-10*t", "-11*t"))
        done = run()
        self.assertEqual(done.returncode, 1)
        self.assertIn("scene.toml: differs", done.stdout)

    def test_a_picture_never_takes_the_place_of_a_file_of_others(self):
        self.compare("--accept", "kept")
        (self.folder / "scene.difference.png").write_text("mine")
        done = mortier("compare", "scene.toml", "--against", "kept", "--set",
                       "body.upper.material.viscosity=11", cwd=self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("scene.difference.png: in the way", done.stderr)
        self.assertEqual(self.read("scene.difference.png"), "mine")

    def test_quantities(self):
        self.write(self.read("scene.toml") + '[[quantity]]\nname = "foot"\n'
                   'reaction = { body = "lower", label = 1 }\ncomponent = "y"\n')
        self.compare("--accept", "kept")
        self.assertTrue(any(line.startswith("foot ") for line in self.compare("--against", "kept")))
        lines = self.compare("--against", "kept", "--set", 'body.upper.boundary.3.ty="-11*t"', code=1)
        self.assertIn("foot", self.beyond(lines))

    def test_another_mesh(self):
        """The stress is constant: meshes do not matter."""
        self.compare("--accept", "kept")
        self.mortier("mesh", "crisscross", "--cells", "5", "fine.mesh")
        other = ("--against", "kept", "--set", "body.upper.mesh=fine.mesh")
        self.assertIn("expected --within X", self.compare(*other, code=2))
        self.assertEqual(self.compare(*other, "--within", "1e-9")[-1], "scene.toml: agrees")
        other += ("--set", 'body.upper.boundary.3.ty="-10.1*t"')
        lines = self.compare(*other, "--within", "1e-3", code=1)
        self.assertIn("stress upper", self.beyond(lines))
        self.mortier("mesh", "crisscross", "--cells", "5", "--upper", "1.2,1", "wide.mesh")
        lines = self.compare("--against", "kept", "--set", "body.upper.mesh=wide.mesh", "--within", "1",
                             code=1)
        self.assertRegex("\n".join(lines), r"body upper: 1\d % of its area lies outside of the other mesh")

    def test_another_code_on_quadrangles(self):
        """The exact fields, written as another code would."""
        self.compare("--accept", "kept")
        body = results.read_mortier(self.folder / "kept").bodies["upper"]
        affine = np.column_stack([np.ones(len(body.points)), body.points])
        linear, *_ = np.linalg.lstsq(affine, body.displacement, rcond=None)
        x, y = np.meshgrid(np.linspace(0, 1, 8), np.linspace(0, 1, 5))
        points = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()])
        first = (np.arange(4)[:, None] * 8 + np.arange(7)).ravel()
        cells = [("quad", np.column_stack([first, first + 1, first + 9, first + 8]))]
        displacement = np.column_stack([np.ones(len(points)), points[:, :2]]) @ linear
        for factor, code in ((1.0, 0), (1.01, 1)):
            stress = np.tile([0, -10 * factor, 0, 0, 0, 0], (28, 1))
            meshio.write(self.folder / "other.vtu",
                         meshio.Mesh(points, cells, {"displacement": displacement}, {"stress": [stress]}))
            lines = self.compare("--against", "upper=other.vtu", "--within", "1e-6", code=code)
            self.assertEqual(self.beyond(lines), ["stress upper"] if code else [])
        self.assertTrue(any(line.startswith("displacement upper") for line in lines))

    def test_wrong_input_is_one_line(self):
        (self.folder / "text.vtu").write_text("no XML")
        cases = [
            (["--against", "nowhere"], "nowhere: no such folder"),
            (["--against", "upper=text.vtu", "--within", "1"], "text.vtu: cannot be read"),
            (["--against", "upper=none.vtu", "--within", "1"], "none.vtu: cannot be read"),
            (["--within", "0.1"], "--within: for --against only"),
            (["--against", ".", "--within", "nan"], "nan: expected a number"),
            (["--accept", "kept", "--within", "1"], "--within: kept with the numbers of --accept FILE.json"),
            (["--accept", "kept", "--against", "kept"], "--accept: keeps a result"),
            (["--picture", "a.pdf"], "--picture a.pdf: expected a file NAME.png or NAME.svg"),
            (["--set", "time.steps=-1"], "--set time.steps=-1"),
            (["--set", "nix=1"], "--set nix=1")]
        for words, expected in cases:
            with self.subTest(words=words):
                before = self.names()
                self.assertIn(expected, self.compare(*words, code=2))
                self.assertEqual(self.names(), before)

    def test_a_scene_that_nothing_holds(self):
        self.write(self.read("scene.toml").replace("ux = 0\n", "tx = 0\n", 1))
        done = mortier("compare", "scene.toml", cwd=self.folder)
        self.assertEqual(done.returncode, 3)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)


if __name__ == "__main__":
    unittest.main()
