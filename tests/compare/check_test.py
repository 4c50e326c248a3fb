"""mortier check: each fault that it knows, seeded into a sound scene (seeded/), is named with its place and
its remedy; sound scenes pass in silence."""
import json
import re
import unittest

from seeded import ELASTIC, FAULTS, SCENE, Case
from support import ROOT, InFolder, mortier


def catalogue():
    return json.loads(mortier("check", "--list", "--json").stdout)


class Check(InFolder):
    def check(self, case, *options):
        """Exit code and report of a case."""
        case.write(self.folder)
        done = mortier("check", "scene.toml", "--json", *options, cwd=self.folder, **case.limited())
        return done.returncode, json.loads(done.stdout)

    def test_sound_scenes_are_silent(self):
        for scene in (SCENE, ELASTIC):
            status, report = self.check(Case(scene))
            self.assertEqual((status, report["faults"]), (0, []))

    def test_shipped_scenes_are_silent(self):
        scenes = sorted((ROOT / "scenes").glob("*.toml"))
        self.assertTrue(scenes)
        for scene in scenes:
            with self.subTest(scene=scene.name):
                done = mortier("check", scene, "--json")
                self.assertEqual((done.returncode, json.loads(done.stdout)["faults"]), (0, []))

    def test_steps_that_an_error_chooses_have_none_of_the_faults_of_equal_ones(self):
        text = (ROOT / "scenes/compression.toml").read_text()
        text = text.replace("../shared-meshes", str(ROOT / "shared-meshes"))
        for key, line in (("every", "every = 50"), ("steps", "tolerance = 1e-3")):
            text = re.sub(rf"^{key} = .*$", line, text, flags=re.M)
        text = text.replace('ty = "-10*t"', 'ty = { time = [0, 0.123, 1], value = [0, -1.23, -10] }')
        self.assertNotIn("steps =", text)
        (self.folder / "scene.toml").write_text(text)
        done = mortier("check", self.folder / "scene.toml")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("0 errors, 0 warnings", done.stdout)
        self.assertIn("time: steps chosen by an error in time of 0.001, backward-euler", done.stdout)

    def test_each_seeded_fault_is_named(self):
        kinds = {kind["id"]: kind for kind in catalogue()}
        for identifier, place, scene, seed in FAULTS:
            with self.subTest(fault=identifier):
                case = Case(scene)
                seed(case)
                status, report = self.check(case)
                named = [f for f in report["faults"] if f["id"] == identifier]
                self.assertTrue(named, f"{identifier} is not among {json.dumps(report['faults'], indent=1)}")
                literal = place.startswith("scene.toml") or re.match(r"\w*\.mesh", place)
                expected = place if literal else case.line(place)
                self.assertTrue(any(expected in f["place"] for f in named), f"expected {expected}: {named}")
                self.assertEqual(named[0]["remedy"], kinds[identifier]["remedy"])
                self.assertEqual(named[0]["severity"], kinds[identifier]["severity"])
                errors = {f["id"] for f in report["faults"] if f["severity"] == "error"}
                self.assertEqual(status, 2 if errors - {"unheld-body"} else 3 if errors else 0)

    def test_every_kind_is_seeded(self):
        seeded = {identifier for identifier, *_ in FAULTS}
        self.assertEqual(seeded, {kind["id"] for kind in catalogue()})
        self.assertGreaterEqual(len(seeded), 40)

    def test_errors_are_those_of_run(self):
        """What check calls an error a run refuses with the same exit code; what it lets pass,
        a run begins."""
        severities = {kind["id"]: kind["severity"] for kind in catalogue()}
        for identifier, _, scene, seed in FAULTS:
            with self.subTest(fault=identifier):
                case = Case(scene)
                seed(case)
                status, _ = self.check(case)
                if severities[identifier] != "error":
                    continue
                self.mortier("run", "scene.toml", "--quiet", code=status, **case.limited())

    def test_run_warns_as_check_does(self):
        """The same warnings in the same words, each once."""
        quick = {"load-on-contact", "support-on-contact", "sliver", "initial-stress", "load-between-steps",
                 "body-alone",
                 "unused-label", "interpolation-unmatched", "poisson-negative", "large-displacement"}
        for identifier, _, scene, seed in FAULTS:
            if identifier not in quick:
                continue
            with self.subTest(fault=identifier):
                case = Case(scene)
                seed(case)
                _, report = self.check(case)
                expected = sorted(f"mortier: warning: {f['place']}: {f['message']}; {f['remedy']} [{f['id']}]"
                                  for f in report["faults"] if f["severity"] == "warning")
                errors = self.mortier("run", "scene.toml", "--quiet").stderr.splitlines()
                self.assertEqual(sorted(errors), expected)
                self.assertIn(f"[{identifier}]", "".join(errors))

    def test_allowed_faults_are_not_named(self):
        case = Case()
        case.replace("steps = 100", "steps = 5")
        case.scene += '[check]\nallow = ["few-steps-across-yield"]\n'
        self.assertEqual(self.check(case)[1]["faults"], [])

    def test_text_has_a_line_per_fault(self):
        case = Case()
        case.replace("steps = 100", "steps = 5")
        case.write(self.folder)
        text = self.mortier("check", "scene.toml").stdout
        self.assertRegex(text, r"scene\.toml:29: warning: body upper: .*; take more steps, or scheme = "
                               r"\"sdirk2\" \[few-steps-across-yield\]\n")
        self.assertIn("modelled   body upper: ", text)
        self.assertIn("left out   scene: inertia", text)
        self.assertRegex(text, r"0 errors, \d+ warnings?\n$")

    def test_documentation_lists_every_fault(self):
        text = (ROOT / "docs" / "check.md").read_text()
        rows = re.findall(r"^\| `([a-z-]+)` \| (\w+) \| (.*?) \| (.*?) \|$", text, re.M)
        self.assertEqual(rows, [(k["id"], k["severity"], k["what"], k["remedy"]) for k in catalogue()])

    def test_plan(self):
        def plan(case, *settings):
            return [tuple(item[key] for key in ("part", "modelled", "what", "why"))
                    for item in self.check(case, *settings)[1]["plan"]]

        viscoplastic = plan(Case(), "--set", "body.upper.material.projection=elasticity")
        self.assertIn(("body upper", True, "LU in every iteration in which it flows",
                       "projection elasticity makes its tangent unsymmetric where it flows"), viscoplastic)
        self.assertIn(("body lower", True, "Cholesky in every iteration in which it flows",
                       "projection frobenius makes its tangent symmetric"), viscoplastic)
        strong = plan(Case(), "--set", "body.material.yield_stress=15")
        self.assertTrue(any(part == "body upper" and not modelled and what.startswith("flow")
                            for part, modelled, what, _ in strong))
        elastic = plan(Case(ELASTIC), "--set", "time.steps=50")
        self.assertIn(("time", True, "one step", "nothing depends on time"), elastic)
        self.assertIn(("time", False, "the other 49 steps", "they are at rest"), elastic)
        growing = plan(Case(ELASTIC), "--set", "time.steps=50", "body.upper.boundary.ty=\"-t\"")
        self.assertIn(("time", True, "loads change"),
                      [(part, modelled, why) for part, modelled, _, why in growing])
        self.assertIn(("body upper", True, "linear: one Cholesky factor for the whole run", "it is elastic"),
                      elastic)


if __name__ == "__main__":
    unittest.main()
