"""mortier and FreeFEM agree on every pair of meshes, projection, variant and side."""
import unittest

from support import InFolder
from both import compare_all
from cases import PAIRS, PROJECTIONS, SIDES, VARIANTS, quick_cases
from codes import FREEFEM, call, run_freefem, run_mortier
from compare import compare
from results import read_freefem


class Comparison(InFolder):
    def test_quick_cases_cover_every_choice(self):
        for attribute, choices in (("pair", PAIRS), ("projection", PROJECTIONS), ("variant", VARIANTS),
                                   ("nonmortar", SIDES), ("steps", (20, 100))):
            with self.subTest(attribute):
                self.assertEqual({getattr(case, attribute) for case in quick_cases()}, set(choices))

    def test_codes_agree(self):
        for case, row in zip(quick_cases(), compare_all(quick_cases())):
            with self.subTest(str(case)):
                self.assertTrue(row["agree"], row["verdict"])

    def test_committed_script_solves_the_scene(self):
        call([FREEFEM, "-nw", "-nw", "-ne", "-v", "0", "freefem/compression.edp", "-quiet", "-steps", "20",
              "-variant", "interpolation", "-out", self.folder])
        settings = ["time.steps=20", "contact.variant=interpolation"]
        verdict = compare(run_mortier(self.folder / "mortier", settings), read_freefem(self.folder))
        self.assertTrue(verdict.agrees, str(verdict))

    def test_elastic_bodies_agree(self):
        settings = ["body.material={young=2e11, poisson=0.25}", "contact.variant=interpolation",
                    "time.steps=2"]
        verdict = compare(run_mortier(self.folder / "mortier", settings),
                          run_freefem(self.folder / "freefem", settings))
        # An elastic body has no projection; FreeFEM's data name one that does nothing.
        verdict.faults = [fault for fault in verdict.faults if not fault.startswith("projection")]
        self.assertTrue(verdict.agrees, str(verdict))


if __name__ == "__main__":
    unittest.main()
