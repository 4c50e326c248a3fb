"""volume = "automatic": which bodies have their volumetric strain averaged, what says so, and what stays."""
import json
import unittest

from scene_parts import body, box, contact, timed
from support import InFolder, script, warned

SCENE = ('plane = "strain"\n'
         + body("upper", box([0, 0], [1, 0.5], [5, 3], cut="rising"), 100,
                'label = 3, ux = 0, uy = "-0.02*t"')
         + body("lower", box([0, -1], [2, 0], [8, 4], cut="rising"), 100, "label = 1, uy = 0",
                "label = 4, ux = 0") + contact(("upper", 1), ("lower", 3)) + timed(3))
RUBBER = "body.lower.material.poisson=0.4999"
FLOWS = "body.lower.material={young=100, poisson=0.3, viscosity=1, yield_stress=1}"
AVERAGED = "volumetric strain averaged"
WARNINGS = {"poisson-limit", "flow-locks"}


class Volume(InFolder):
    def setUp(self):
        super().setUp()
        self.write(SCENE)

    def checked(self, *settings):
        """Bodies that are averaged, those that would be but for a bound, and warnings of either kind."""
        report = json.loads(self.mortier("check", "scene.toml", "--json", "--set", *settings).stdout)
        items = [item for item in report["plan"] if item["what"].startswith(AVERAGED)]
        return ([item["part"] for item in items if item["modelled"]],
                [item["part"] for item in items if not item["modelled"]],
                [fault["id"] for fault in report["faults"] if fault["id"] in WARNINGS])

    def test_bodies_that_need_it_have_it(self):
        lower = ["body lower"]
        own = ('body.lower.material={young=100, poisson=0.3, law="expression", rate11="s11", rate22="s22", '
               'rate12="s12", rate33="s33"}')
        region = 'body.lower.region=[{label=1, material={young=100, poisson=0.4999}}]'
        for settings, averaged in (
                ([RUBBER], lower), ([FLOWS], lower), ([RUBBER, "degree=2"], lower), ([FLOWS, "degree=2"], []),
                ([RUBBER, "plane=axisymmetric"], lower), ([FLOWS, "plane=axisymmetric"], lower),
                ([RUBBER, "plane=stress"], []), ([FLOWS, "plane=stress"], []), ([own], []), ([region], lower),
                ([RUBBER, "body.lower.mesh.cut=both"], lower), ([FLOWS, "body.lower.mesh.cut=both"], lower),
                ([FLOWS, "body.lower.mesh.cut=both", "plane=axisymmetric"], lower),
                (["body.lower.material.poisson=0.44"], []), (["body.lower.material.poisson=0.45"], lower),
                (["body.lower.material.poisson=0.49"], lower),
                (["body.lower.material.poisson=0.49", "degree=2"], []),
                (["body.material.poisson=0.499"], ["body upper", *lower])):
            with self.subTest(settings):
                self.assertEqual(self.checked(*settings), (averaged, [], []))

    def test_what_a_scene_says_stays(self):
        for settings, warning in ((RUBBER, "poisson-limit"), (FLOWS, "flow-locks")):
            self.assertEqual(self.checked(settings, "body.volume=pointwise"), ([], [], [warning]))
        self.assertEqual(self.checked("body.upper.volume=averaged"), (["body upper"], [], []))

    def test_it_is_the_averaged_one_and_the_log_says_so(self):
        results = {}
        for volume in ("automatic", "averaged", "pointwise"):
            done = self.mortier("run", "scene.toml", "--out", volume, "--set", RUBBER, FLOWS,
                                f"body.lower.volume={volume}")
            results[volume] = self.read(f"{volume}/history.csv")
            self.assertEqual("material   lower " + AVERAGED in done.stdout, volume != "pointwise")
            self.assertNotIn("upper " + AVERAGED, done.stdout)
            self.assertEqual("flow-locks" in warned(done.stderr), volume == "pointwise")
        self.assertEqual(results["automatic"], results["averaged"])
        self.assertNotEqual(results["automatic"], results["pointwise"])

    def test_bounds_are_of_plain_elements(self):
        bound = ("accuracy.bound=true", RUBBER)
        self.assertEqual(self.checked(*bound), ([], ["body lower"], ["poisson-limit"]))
        done = self.mortier("run", "scene.toml", "--out", "out", "--set", *bound)
        self.assertIn("poisson-limit", warned(done.stderr))
        self.assertNotIn(AVERAGED, done.stdout)
        self.mortier("run", "scene.toml", "--out", "plain", "--set", *bound, "body.volume=pointwise")
        self.assertEqual(self.read("out/history.csv"), self.read("plain/history.csv"))
        told = self.mortier("run", "scene.toml", "--set", *bound, "body.lower.volume=averaged", code=2).stderr
        self.assertIn("volume = \"averaged\", expected pointwise beside accuracy.bound", told)


if __name__ == "__main__":
    unittest.main()
