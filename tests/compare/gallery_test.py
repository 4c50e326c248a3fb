"""The gallery: every scene has numbers that theory knows, a picture and a place in docs/gallery.md."""
import re
import unittest

from support import ROOT, InFolder
from codes import run_mortier
from results import read_csv
from gallery import GALLERY, PICTURES, draw, error, run_entry
import stated

PAGE = (ROOT / "docs" / "gallery.md").read_text()


def section(entry):
    """Of the page, the one that names the scene."""
    return re.search(rf"^## [^\n]*\n(?:(?!^## ).)*scenes/{entry.scene}\.toml.*?(?=^## |\Z)", PAGE,
                     re.M | re.S)[0]


class Gallery(InFolder):
    def test_numbers_are_those_of_theory(self):
        for entry in GALLERY:
            with self.subTest(entry.scene):
                run = run_entry(entry, self.folder)
                for number in entry.numbers:
                    measured = f"{number.quantity}: {number.measure(run):.9g}, theory {number.theory:.9g}"
                    self.assertLessEqual(error(number, run), number.tolerance, measured)
                    stated.check(self, section(entry), number.told, number.measure(run))
                self.assertLess(run.summary["verification"]["force_balance"], entry.balance)

    def test_a_wrong_model_misses(self):
        wrong = {"ring": "body.plate.material.young=52", "hertz": "body.block.material.young=60000",
                 "broken-line": "contact.variant=interpolation", "stack": "contact.variant=interpolation",
                 "bimetal": "body.upper.material.young=1e5",
                 "sloped": "contact.variant=interpolation", "turned": "contact.variant=interpolation",
                 "cut-ring": "body.lower.boundary.1.un=1e-5*t",
                 "cook": "body.panel.material.poisson=0.3", "exact-contact": "body.lower.material.young=1.1",
                 "edge": "body.lower.material.young=1.1",
                 "receding": "body.half-plane.material.young=1.2", "open-close": "body.material.young=101",
                 "punch": "body.punch.material.young=1", "eccentric-punch": "body.punch.material.young=1",
                 "thick-cylinder": "plane=stress", "sphere": "body.block.material.young=60000",
                 "ironing": "contact.sliding=allow", "roller": "contact.sliding=allow",
                 "wedge": "contact.friction=0.1", "press-fit": "body.ring.material.young=1100",
                 "hook": "contact.friction=0", "bolt": "body.sleeve.material.young=60e3",
                 "rail": "contact.stiffness=0.055", "rolling-ball": "tool.ball.ux=1.5*max(0, t - 0.2)/0.8",
                 "cubes": "body.material.viscosity=11", "ball": "body.block.material.young=1.2",
                 "tilted": "contact.variant=interpolation", "shells": "contact.gap=-0.0011*t",
                 "known-end": "body.lower.material.young=1.1", "round-punch": "body.block.material.young=1.1",
                 "cone": "tool.cone.points=[[0, 0], [10, 1.1], [0, 1.1]]"}
        self.assertEqual(set(wrong), {entry.scene for entry in GALLERY})
        for entry in GALLERY:
            with self.subTest(entry.scene):
                run = run_mortier(self.folder / "run", [wrong[entry.scene]], f"scenes/{entry.scene}.toml")
                for number in entry.numbers:
                    self.assertGreater(error(number, run), number.tolerance, number.quantity)

    def test_eccentric_punch_keeps_full_contact_up_to_half_its_half_width(self):
        run = run_mortier(self.folder / "run", [], "scenes/eccentric-punch.toml")
        for row in read_csv(run.folder / "contact.csv"):
            eccentricity = 0.6 * float(row["time"])
            if float(row["time"]) > 0 and eccentricity < 0.51:
                self.assertEqual(row["active"], "1", row)
            elif eccentricity > 0.54 and float(row["x"]) == -1:
                self.assertEqual(row["active"], "0", row)

    def test_every_scene_is_in_it(self):
        scenes = {path.stem for path in (ROOT / "scenes").glob("*.toml")}
        self.assertEqual(scenes - {"compression"}, {entry.scene for entry in GALLERY})

    def test_page_shows_every_scene(self):
        for entry in GALLERY:
            with self.subTest(entry.scene):
                told = section(entry)
                self.assertIn(f"images/gallery/{entry.scene}.png", told)
                for number in entry.numbers:
                    self.assertIn(f"**{number.theory:.12g}**", told)
                self.assertTrue((PICTURES / f"{entry.scene}.png").is_file())

    def test_pictures_are_drawn(self):
        entry = GALLERY[0]
        draw(entry, run_entry(entry, self.folder).folder, self.folder / "pictures")
        self.assertEqual((self.folder / "pictures" / f"{entry.scene}.png").read_bytes()[:4], b"\x89PNG")


if __name__ == "__main__":
    unittest.main()
