"""What a user reads: messages in the units of the scene and with the names of its labels, one value for one
time, no warnings that only follow from another fault."""
import json
import re
import unittest

from seeded import FAULTS, Case
from scene_parts import body, box, contact, quantity, timed
from support import InFolder, mortier

NAMES = {1: "bottom", 2: "right", 3: "top", 4: "left"}
FORBIDDEN = {
    "a unit that the scene has not": r"[\d)] (m|Pa|N/m|J/m|m\^2)(?![\w^/])",
    "a label without its name": r"\blabel [1-4]\b(?! \")",
    "more digits than anyone reads": r"\d\.\d{7,}|\d{9,}",
    "no number": r"\b-?(nan|inf)\b(?! at)",
    "another word for penetration": r"pass (each|through)|lie on each other",
    "a word that the key table knows better": r"\bslave\b|\bmaster\b"}
# id -> warnings that say nothing beside it
CONSEQUENCES = {"missing-label": {"no-load", "yields-at-once", "large-strain"},
                "data": {"yields-at-once", "large-strain", "large-displacement"},
                "contact-penetration": {"bodies-overlap"}, "contact-missing": {"body-alone"}}
PRESS = ('units = "mm, N, MPa"\ndegree = 2\n'
         + body("punch", box([-1, 0], [1, 2], 3), 'young = "210 GPa", poisson = 0.3',
                'label = 3, ux = 0, uy = "-0.001*t"')
         + body("block", box([-2, -2], [2, 0], [5, 3]), 'young = "70 GPa", poisson = 0.3',
                "label = 1, ux = 0, uy = 0") + contact(("punch", 1), ("block", 3), sides=True)
         + quantity("mises", "largest_mises", "punch") + quantity("other", "largest_mises", "block")
         + timed(3))


def named(case):
    """The case in mm, N, MPa and with names of the labels, in scene and meshes."""
    text = re.sub(r"label = ([1-4])\b", lambda found: f'label = "{NAMES[int(found[1])]}"', case.scene)
    case.scene = 'units = "mm, N, MPa"\n' + re.sub(r'mesh = \{ shape.*?\}', lambda found: found[0], text)


class Messages(InFolder):
    def test_of_all_seeded_faults(self):
        read = 0
        for identifier, _, scene, seed in FAULTS:
            case = Case(scene)
            seed(case)
            if "shape =" in case.scene:
                continue  # labels of shapes have no names
            named(case)
            case.write(self.folder)
            for mesh in ("upper", "lower", "third"):
                if f"{mesh}.mesh" not in case.raw:
                    with (self.folder / f"{mesh}.mesh").open("a") as file:
                        file.writelines(f"# label {number} = {name}\n" for number, name in NAMES.items())
            report = json.loads(mortier("check", "scene.toml", "--json", cwd=self.folder,
                                        **case.limited()).stdout)
            with self.subTest(fault=identifier):
                self.assertIn(identifier, {fault["id"] for fault in report["faults"]})
                for fault in report["faults"]:
                    read += 1
                    text = re.sub(r'(?<=[\w] = )"[^"]*"', "", fault["message"])  # what the scene says
                    for what, pattern in FORBIDDEN.items():
                        self.assertNotRegex(f"{text}; {fault['remedy']}", pattern, what)
                others = {fault["id"] for fault in report["faults"]}
                self.assertEqual(others & CONSEQUENCES.get(identifier, set()), set())
        self.assertGreater(read, 80)


class Values(InFolder):
    def test_one_largest_stress_for_one_time(self):
        """With quadratic triangles too: at the end, of the run, in the history and of the quantities."""
        summary = self.run_it(PRESS)
        peak = summary["peaks"]["von_mises"]
        self.assertEqual(peak["time"], 1)
        quantities = [each["value"] for each in summary["quantities"].values()]
        self.assertEqual({summary["final"]["von_mises_max"], max(quantities)}, {peak["value"]})
        header, *_, last = self.read("out/history.csv").splitlines()
        row = dict(zip(header.split(","), last.split(",")))
        self.assertEqual(float(row["von_mises_max[MPa]"]), peak["value"])


if __name__ == "__main__":
    unittest.main()
