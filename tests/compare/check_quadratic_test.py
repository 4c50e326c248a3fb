"""mortier check where displacements are quadratic, and where meshes and steps are refined until an accuracy
is reached: nothing that is true of linear triangles, or of meshes and steps as given, only."""
import json
import re
import unittest

from seeded import ELASTIC, FAULTS, SCENE, Case
from support import InFolder, mortier

DEGREE = ["degree=2"]
ACCURACY = ["degree=2", "accuracy.energy=0.05"]
# What the run will change by itself: faults of the meshes, and of steps where bodies flow.
OF_FIRST_MESHES = {"contact-size-ratio", "nonmortar-coarser", "datum-between-nodes"}
OF_EQUAL_STEPS = {"few-steps-across-yield", "yields-at-once", "viscosity-small", "kink-between-steps",
                  "load-between-steps", "output-large"}
# Not with quadratic displacements: no triangle is locked, an edge between held ones has a free middle.
OF_LINEAR_TRIANGLES = {"locked-triangle", "load-on-support", "flow-locks"}
# The scene says instead that these are refused beside an accuracy.
REFUSED = {"interpolation-unmatched", "contact-meets-support", "scheme-rings", "start"}


class CheckQuadratic(InFolder):
    def named(self, case, settings):
        case.write(self.folder)
        done = mortier("check", "scene.toml", "--json", "--set", *settings, cwd=self.folder, **case.limited())
        return {fault["id"] for fault in json.loads(done.stdout)["faults"]}

    def test_sound_scenes_are_silent(self):
        for scene in (SCENE, ELASTIC):
            for settings in (DEGREE, ACCURACY):
                self.assertEqual(self.named(Case(scene), settings), set())

    def test_seeded_faults_are_named_where_they_are_faults(self):
        for settings, gone in ((DEGREE, OF_LINEAR_TRIANGLES),
                               (ACCURACY, OF_LINEAR_TRIANGLES | OF_FIRST_MESHES | OF_EQUAL_STEPS | REFUSED)):
            for identifier, _, scene, seed in FAULTS:
                if identifier == "memory":  # seconds, and the same for both
                    continue
                with self.subTest(fault=identifier, settings=settings):
                    case = Case(scene)
                    seed(case)
                    self.assertEqual(identifier in self.named(case, settings), identifier not in gone)

    def test_a_traction_along_a_support_of_its_own_label_is_on_held_nodes(self):
        case = Case()
        case.replace("label = 4\nux = 0", "label = 4\nun = 0\ntx = \"t\"")
        for settings in (["degree=1"], DEGREE):
            self.assertIn("load-on-support", self.named(case, settings))

    def test_an_elastic_run_keeps_its_steps_beside_an_accuracy(self):
        case = Case(ELASTIC.replace("steps = 1", "steps = 10"))
        case.replace("ty = -10", 'ty = "t < 0.123 ? -t : -1"')
        self.assertIn("kink-between-steps", self.named(case, ACCURACY))

    def test_the_size_of_the_output_is_that_of_the_files(self):
        for degree in (1, 2):
            with self.subTest(degree=degree):
                case = Case(ELASTIC.replace("steps = 1", "steps = 1000000") + "[output]\nevery = 1\n")
                case.write(self.folder)
                asked = mortier("check", "scene.toml", "--set", f"degree={degree}", cwd=self.folder).stdout
                told = float(re.search(r"1000001 kept states, about ([\d.]+) GB", asked)[1]) * 1e9 / 1000001
                self.mortier("run", "scene.toml", "--out", "out", "--set", f"degree={degree}", "time.steps=1")
                files = sum((self.folder / f"out/{body}_000001.vtu").stat().st_size
                            for body in ("upper", "lower"))
                self.assertLess(abs(told / files - 1), 0.15, f"{told} for {files} bytes")

    def test_run_warns_as_check_does(self):
        for identifier in ("few-steps-across-yield", "load-between-steps", "large-displacement"):
            with self.subTest(fault=identifier):
                _, _, scene, seed = next(fault for fault in FAULTS if fault[0] == identifier)
                case = Case(scene)
                seed(case)
                expected = self.named(case, ["accuracy.energy=0.9", "accuracy.max_unknowns=2000"])
                run = mortier("run", "scene.toml", "--quiet", "--out", identifier, "--set",
                              "accuracy.energy=0.9", "accuracy.max_unknowns=2000", cwd=self.folder)
                warned = set(re.findall(r"^mortier: warning: .* \[([\w-]+)\]$", run.stderr, re.M))
                self.assertEqual(warned, expected, run.stderr)


if __name__ == "__main__":
    unittest.main()
