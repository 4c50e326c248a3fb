"""The file of a study: what is wrong with it is reported in one line, and nothing is overwritten."""
import unittest

from study_support import SPACE, StudyTest
from support import ROOT
import plan
from problems import StudyError

WRONG = [  # what is changed in SPACE, and the message that comes with exit code 2
    ("scene = ", "scen = ", "study.toml:2: unknown key scen, did you mean scene?"),
    ("compression.toml", "none.toml", "study.toml:2: scene = "),
    ("[mesh]", "[mesh", "study.toml:3: not TOML: "),
    ("[mesh]", "[[mesh]]", "study.toml:3: mesh = "),
    ("upper = { kind", "uper = { kind", "study.toml:4: mesh: uper, expected one of the bodies upper, lower"),
    ("cells = [3, 6, 12]", "cells = [3, 6]", "study.toml:3: mesh: upper: 2, lower: 3 levels, expected as "
                                             "many for each body"),
    ("cells = [3, 6, 12]", "cells = [3, 6, 0]", "study.toml:4: mesh upper: cells = [3, 6, 0], expected a "
                                                "list of N or"),
    ("cells = [3, 6, 12]", "cels = [3, 6, 12]", "study.toml:4: mesh upper: cells is missing"),
    ("kind = \"crisscross\", cells = [3", "kind = \"cross\", cells = [3",
     "study.toml:4: mesh upper: kind = \"cross\", expected one of"),
    ("lower = [0, 0]", "lower = [0, nan]", "study.toml:4: mesh upper: lower = [0, NaN], expected [X, Y]"),
    ("\"energy\"", "\"enrgy\"", "study.toml:7: error 0: quantity = \"enrgy\", expected one of energy, "
                                "displacement"),
    ("exact = {", "exct = {", "study.toml:8: error energy: unknown key exct, did you mean exact?"),
    ("exact = { s11 = \"0\", s22 = \"-10*t\", s12 = \"0\" }", "",
     "study.toml:6: error energy: exact is missing, expected exact or a table"),
    ("s22 = \"-10*t\"", "s22 = \"-10*s\"", "study.toml:8: exact: s22 = \"-10*s\", expected a number or an "
                                           "expression in x, y, t (unknown name s)"),
    ("s22 = \"-10*t\"", "s22 = \"__import__('os')\"", "study.toml:8: exact: s22 = "),
    ("s22 = \"-10*t\"", "s22 = \"(1\"", "study.toml:8: exact: s22 = \"(1\", expected"),
    ("s22 = \"-10*t\", ", "", "study.toml:8: exact: s22 is missing"),
    ("[[sweep]]\n", "[[sweep]]\nlevl = 1\n",
     "study.toml:10: sweep sweep 0: unknown axis levl, did you mean level?"),
    ("level = [0, 1, 2]", "level = [0, 1, 3]",
     "study.toml:11: sweep sweep 0: level = 3, expected a level below 3"),
    ("level = [0, 1, 2]", "level = []",
     "study.toml:11: sweep sweep 0: level = [], expected one value or more"),
    ("level = [0, 1, 2]", "steps = [1.5]",
     "study.toml:11: sweep sweep 0: steps = 1.5, expected integers >= 1"),
    ("level = [0, 1, 2]", "degree = [1, 3]", "study.toml:11: sweep sweep 0: degree = 3, expected 1 or 2"),
    ("level = [0, 1, 2]", "accuracy = 0", "study.toml:11: sweep sweep 0: accuracy = 0, expected numbers > 0"),
    ("level = [0, 1, 2]", "code = \"abaqus\"",
     "study.toml:11: sweep sweep 0: code = \"abaqus\", expected one of mortier"),
    ("level = [0, 1, 2]", "steps = 2\ntolerance = 1e-3",
     "study.toml:12: sweep sweep 0: steps and tolerance, expected one"),
    ("[[sweep]]", "[swep]", "study.toml:9: unknown key swep, did you mean sweep?"),
    ("[[sweep]]\n", "[[compare]]\nerror = \"u\"\n[[sweep]]\n",
     "study.toml:10: compare 0: error = \"u\", expected the name of an error"),
    ("[[sweep]]\n", "[[compare]]\nerror = \"energy\"\nat = 0\n[[sweep]]\n",
     "study.toml:11: compare 0: at = 0, expected a number > 0"),
    ("[[sweep]]\n", "repeat = 0\n[[sweep]]\n", "study.toml:9: error energy: unknown key repeat"),
]


class StudyPlan(StudyTest):
    def test_wrong_inputs(self):
        for old, new, message in WRONG:
            with self.subTest(new=new):
                self.assertIn(old, SPACE)
                self.path.write_text(SPACE.replace(old, new, 1))
                with self.assertRaises(StudyError) as caught:
                    plan.read(self.path)
                self.assertTrue(str(caught.exception).startswith(f"{self.folder}/{message}"),
                                f"\nexpected {message}\nis       {caught.exception}")
                self.assertNotIn("\n", str(caught.exception))

    def test_wrong_inputs_of_the_program(self):
        self.path.write_text(SPACE.replace("levl", "level").replace("cells = [3", "cells = [0"))
        none = self.folder / "none.toml"
        for arguments, message in (([self.path], f"mortier: {self.path}:4: mesh upper: cells = "),
                                   ([none], f"mortier: {none}: No such file"),
                                   ([self.folder], f"mortier: {self.folder}: Is a directory"),
                                   ([self.path, "--jobs", "0"], "--jobs: Value 0 not in range"),
                                   ([], "STUDY")):
            with self.subTest(arguments=arguments):
                errors = self.mortier("study", *arguments, code=2).stderr
                self.assertIn(message, errors)
                self.assertTrue(errors.startswith("mortier: "), errors)
                self.assertFalse(self.out.exists())

    def test_other_files_are_never_replaced(self):
        self.out.mkdir()
        self.write("mine", "out/thesis.txt")
        self.path.write_text(SPACE)
        self.study(code=2)
        self.assertEqual(self.names("out"), ["thesis.txt"])

    def test_another_scene_or_mesh_is_another_study(self):
        (self.folder / "scene.toml").write_text((ROOT / "scenes" / "compression.toml").read_text()
                                                .replace("../shared-meshes", str(self.folder)))
        meshes = ROOT / "shared-meshes"
        for name in ("upper-crisscross-6.mesh", "lower-crisscross-16.mesh"):
            (self.folder / name).write_text((meshes / name).read_text())
        self.path.write_text('scene = '
                             f'"scene.toml"\n{SPACE[SPACE.index("[[error]]"):SPACE.index("[[sweep]]")]}'
                             '[[sweep]]\nsteps = 2\n')

        def keys():
            done = plan.read(self.path)
            return [done.key(case) for case in done.cases()]
        first = keys()
        self.assertEqual(first, keys())
        for name in ("scene.toml", "lower-crisscross-16.mesh"):
            with open(self.folder / name, "a") as file:
                file.write("\n# other\n")
            self.assertNotEqual(first, keys())
            first = keys()


if __name__ == "__main__":
    unittest.main()
