"""Contact keeps dense matrices over its nodes, but for long lines without friction: what a run needs is
reported before it, and refused where there is not so much."""
import re
import resource
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))

from scene_parts import body, box, contact, timed  # noqa: E402
from support import InFolder, mortier  # noqa: E402

SCENE = (body("upper", '"upper.mesh"', 1e3, "label = 4, ux = 0", 'label = 3, ty = "-sin(2*x)*t - 0.01*t"')
         + body("lower", '"lower.mesh"', 1e3, "label = 1, ux = 0, uy = 0")
         + contact(("upper", 1), ("lower", 3)) + timed())


class MemoryNeed(InFolder):
    def strips(self, cells, friction=""):
        self.mortier("mesh", "rectangle", "--cells", f"{cells},2", "--lower=0,0", "--upper", f"{cells},2",
                     "upper.mesh")
        self.mortier("mesh", "rectangle", "--cells", f"{cells * 9 // 10},2", "--lower=0,-2", "--upper",
                     f"{cells},0", "lower.mesh")
        self.write(SCENE.replace("[time]", friction + "[time]"))

    def test_a_thousand_contact_nodes(self):
        self.strips(1000)
        told = self.mortier("run", "scene.toml", "--out", "out").stdout
        peak = self.summary_of()["peak_memory_mib"]
        need = float(re.search(r"^memory +about (\d+) MiB", told, re.M).group(1))
        print(f"1,000 contact nodes: told {need:.0f} MiB, took {peak:.0f} MiB")
        self.assertLess(peak, 60)
        self.assertLess(abs(need - peak), peak / 2)
        self.assertEqual(self.summary_of()["contact_matrices"], "sparse")

    def test_two_thousand_contact_nodes(self):
        self.strips(2000)
        told = self.mortier("run", "scene.toml", "--out", "out").stdout
        peak = self.summary_of()["peak_memory_mib"]
        need = float(re.search(r"^memory +about (\d+) MiB", told, re.M).group(1))
        print(f"2,000 contact nodes: told {need:.0f} MiB, took {peak:.0f} MiB")
        self.assertLess(peak, 100)
        self.assertLess(abs(need - peak), peak / 2)
        check = self.mortier("check", "scene.toml").stdout
        self.assertIn("dense ones over the contact nodes would take", check)

    def test_two_dofs_a_node(self):
        # On a ring no line is parallel to an axis: both components of its nodes take part.
        self.mortier("mesh", "annulus", "--cut", "rising", "--cells", "700,8", "--inner", "1",
                     "--outer", "1.01", "upper.mesh")
        self.mortier("mesh", "annulus", "--cut", "rising", "--cells", "630,8", "--inner", "0.99",
                     "--outer", "1", "lower.mesh")
        loaded = 'boundary = [ { label = 2, pressure = "t", ut = 0 } ]'
        scene = re.sub("boundary = .*label = 3.*", loaded, SCENE)
        self.write(scene.replace("label = 3", "label = 2"))
        told = self.mortier("run", "scene.toml", "--out", "out").stdout
        peak = self.summary_of()["peak_memory_mib"]
        need = float(re.search(r"^memory +about (\d+) MiB", told, re.M).group(1))
        print(f"700 contact nodes on a circle: told {need:.0f} MiB, took {peak:.0f} MiB")
        self.assertLess(abs(need - peak), peak / 4)

    def test_what_cannot_fit_is_refused_with_the_number(self):
        self.strips(20_000, "friction = 0.3\n")
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))

        expected = (r"scene.toml:11: contact: the run needs about 45.8 GiB of memory, "
                    r"expected at most the \S+ GiB that are available; "
                    r"about 45.\d GiB of it for the dense matrices that friction needs\n")
        self.assertRegex(self.mortier("run", "scene.toml", "--out", "out", code=2, preexec_fn=limit).stderr,
                         expected)
        self.assertFalse((self.folder / "out").exists())
        check = mortier("check", "scene.toml", cwd=self.folder, preexec_fn=limit)
        self.assertEqual(check.returncode, 2, check.stderr)
        self.assertIn("needs about 45.8 GiB", check.stdout)

    def in_space(self, cells, **options):
        self.write("dimension = 3\ndegree = 2\n"
                   + body("cube", box([0, 0, 0], [1, 1, 1], cells), 1e3,
                          'label = "bottom", ux = 0, uy = 0, uz = 0', 'label = "top", tz = "-1 - x"')
                   + timed())
        return self.mortier("run", "scene.toml", "--out", "out", **options)

    def test_a_body_in_space(self):
        told = self.in_space(10).stdout
        peak = self.summary_of()["peak_memory_mib"]
        self.assertIn(", factors in single precision, corrected", told)
        need = float(re.search(r"^memory +about (\d+) MiB", told, re.M).group(1))
        print(f"27,000 unknowns in space: told {need:.0f} MiB, took {peak:.0f} MiB")
        self.assertLess(abs(need - peak), peak / 4)

    def test_what_cannot_fit_in_space_is_refused_without_contact_too(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))

        refused = self.in_space(25, code=2, preexec_fn=limit).stderr
        self.assertRegex(refused,
                         r"the run needs about \S+ GiB of memory, expected at most the 2 GiB that are")

    def test_friction_is_told_as_what_takes_the_memory(self):
        self.strips(400, "friction = 0.3\n")
        self.write(self.read("scene.toml").replace("-sin(2*x)*t - 0.01*t", "-t"))
        part = r"about (\d+) MiB of it for the dense matrices that friction needs"
        self.assertRegex(self.mortier("check", "scene.toml").stdout, part)
        self.assertRegex(self.mortier("run", "scene.toml", "--out", "out").stdout,
                         r"(?m)^memory +about \d+ MiB, " + part)


if __name__ == "__main__":
    unittest.main()
