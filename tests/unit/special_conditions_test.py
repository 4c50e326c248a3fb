"""Contact conditions without a force of their own are reported, with their number and the reason,
and only then."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "compare"))

from scenes import TWO_BLOCKS  # noqa: E402
from support import OfTwoBlocks  # noqa: E402

LEFT = "label = 4\nux = 0"
MERGED = "; 1 held end without a condition: merged into the next node"
LEFT_OUT = "; 1 held end without a condition: left out"
IDLE = "conditions  4 idle: both sides are held there\n"
DEPENDENT = "conditions  1 dependent on others: the contact forces are one choice of many\n"


UPPER_HELD = TWO_BLOCKS.replace("[[body.boundary]]",
                                "[[body.boundary]]\nlabel = 1\nuy = 0\n[[body.boundary]]", 1)


def lower_held(scene):
    return scene.replace("{ label = 1, uy = 0 }", "{ label = 1, uy = 0 }, { label = 3, uy = 0 }")


class SpecialConditions(OfTwoBlocks):
    def run_scene(self, scene, *settings):
        """The report of interface and conditions, and the numbers of the summary."""
        self.write(scene)
        log = self.mortier("run", "scene.toml", "--set", "time.steps=2", *settings).stdout
        summary = self.summary_of("out/scene")
        counts = (summary["interfaces"][0]["held_ends"], summary["idle_conditions"],
                  summary["dependent_conditions"])
        return log, counts

    def test_nothing_is_told_where_nothing_is_special(self):
        log, counts = self.run_scene(TWO_BLOCKS)
        self.assertEqual(counts, (0, 0, 0))
        self.assertNotIn("held end", log)
        self.assertNotIn("conditions", log)

    def test_held_ends(self):
        upper = TWO_BLOCKS.replace(LEFT, LEFT + "\nuy = 0", 1)
        both = upper.replace("{ label = 4, ux = 0 }", "{ label = 4, ux = 0, uy = 0 }")
        for scene, variant, count, text in [(upper, "mortar", 1, MERGED),
                                            (both, "interpolation", 1, LEFT_OUT),
                                            (upper, "interpolation", 0, None)]:
            with self.subTest(variant=variant, count=count):
                log, counts = self.run_scene(scene, f"contact.variant={variant}")
                self.assertEqual(counts, (count, 0, 0))
                if text:
                    self.assertIn(text, log)

    def test_conditions_that_nothing_can_change_are_idle(self):
        log, counts = self.run_scene(lower_held(UPPER_HELD))
        self.assertEqual(counts, (0, 4, 0))
        self.assertIn(IDLE, log)

    def test_conditions_that_depend_on_others(self):
        # Five nodes of a rigid nonmortar line see four that move.
        log, counts = self.run_scene(lower_held(TWO_BLOCKS), "contact.swap=true", "contact.variant=mortar")
        self.assertEqual(counts, (0, 0, 1))
        self.assertIn(DEPENDENT, log)


if __name__ == "__main__":
    unittest.main()
