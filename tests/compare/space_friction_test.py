"""Friction in space: forces that statics knows, in any direction; planes of symmetry; bodies that friction
alone holds; units."""
import csv
import json
import math
import unittest

from scene_parts import body, box, contact, timed
from support import InFolder

BLOCKS = ("dimension = 3\n"
          + body("upper", box([0.2, 0.2, 0], [0.8, 0.8, 0.3], [4, 4, 3]), 1000, more="UPPER\n")
          + body("lower", box([0, 0, -0.3], [1, 1, 0], [6, 6, 2]), 1000,
                 'label = "bottom", ux = 0, uy = 0, uz = 0')
          + contact(("upper", "bottom"), ("lower", "top"), sides=True, sliding="allow", more="FRICTION\n")
          + timed(10))
WEIGHT = 0.72
# A parabola that is pressed on half a block, then moved along the plane of symmetry.
HALVES = ("dimension = 3\n"
          + body("upper", box([-1, 0, 0], [1, 1, 1], [12, 6, 4]), 1, 'label = "front", uy = 0',
                 'label = "top", uz = "-0.1*min(t,1)", ux = "0.02*max(t-1,0)"')
          + body("lower", box([-1, 0, -1], [1, 1, 0], [10, 5, 4]), 1, 'label = "front", uy = 0',
                 'label = "bottom", ux = 0, uy = 0, uz = 0')
          + contact(("upper", "bottom"), ("lower", "top"), sides=True, gap="(x^2 + y^2)/2", friction=0.3)
          + timed(8, 2))


def dragged(angle, head="", friction="friction = 0.3"):
    along = [0.05 * math.cos(math.radians(angle)), 0.05 * math.sin(math.radians(angle))]
    return head + BLOCKS.replace("FRICTION", friction).replace(
        "UPPER", f'boundary = [ {{ label = "top", ux = "{along[0]!r}*t", uy = "{along[1]!r}*t", tz = -2 }} ]')


def on_a_slope(coefficient, angle, slope=25):
    x, y = (math.sin(math.radians(slope)) * of(math.radians(angle)) for of in (math.cos, math.sin))
    z = -math.cos(math.radians(slope))
    return BLOCKS.replace("FRICTION", f"friction = {coefficient}").replace(
        "UPPER", f'force = {{ x = "{x!r}*t", y = "{y!r}*t", z = {z!r} }}')


class SpaceFriction(InFolder):
    def solved(self, text, *options):
        self.write(text)
        self.mortier("run", "scene.toml", "--quiet", "--out", "out", *options)
        return json.loads(self.read("out/summary.json"))

    def nodes(self):
        rows = list(csv.DictReader(self.read("out/contact.csv").splitlines()))
        return [{name: float(value) for name, value in row.items()} for row in rows
                if row["step"] == rows[-1]["step"]]

    def test_a_block_slips_at_its_bound_in_any_direction(self):
        for angle, head, friction, bound in (
                (0, "", "friction = 0.3", 0.3*WEIGHT), (90, "", "friction = 0.3", 0.3*WEIGHT),
                (217, "", "friction = 0.3", 0.3*WEIGHT), (30, "", "shear_limit = 0.1", 0.036),
                (30, "", 'friction = 0.3\nvariant = "mortar"', 0.3*WEIGHT),
                (30, "degree = 2\n", "friction = 0.3", 0.3*WEIGHT)):
            with self.subTest(angle=angle, head=head, friction=friction):
                summary = self.solved(dragged(angle, head, friction))
                x, y, z = summary["interfaces"][0]["resultant"]
                self.assertAlmostEqual(z/WEIGHT, 1, delta=1e-12)
                self.assertAlmostEqual(math.hypot(x, y)/bound, 1, delta=1e-10)
                off = math.degrees(math.atan2(-y, -x)) - angle
                self.assertAlmostEqual(math.remainder(off, 360), 0, delta=1e-5)
                self.assertLess(summary["verification"]["friction"], 1e-12)
                self.assertTrue(all(node["slipping"] == 1 for node in self.nodes() if node["active"]))

    def test_what_friction_dissipates_is_what_its_force_does(self):
        once = self.solved(dragged(30))["interfaces"][0]["friction_work"]
        longer = dragged(30).replace("end = 1", "end = 2").replace("steps = 10", "steps = 20")
        more = self.solved(longer)["interfaces"][0]["friction_work"]
        self.assertAlmostEqual((more - once)/(0.3*WEIGHT*0.05), 1, delta=1e-6)

    def test_friction_alone_holds_a_block_on_a_slope(self):
        tangent = math.tan(math.radians(25))
        self.solved(on_a_slope(1.0005*tangent, 40))
        self.write(on_a_slope(0.9995*tangent, 40))
        ended = self.mortier("run", "scene.toml", "--quiet", "--out", "other", code=3)
        self.assertIn("contact and its friction cannot hold body upper: translation along (0.766, 0.6428, 0)",
                      ended.stderr)

    def test_in_a_plane_of_symmetry_friction_acts_along_it(self):
        summary = self.solved(HALVES)
        inside = [node for node in self.nodes() if node["y"] == 0 and node["active"]]
        self.assertGreater(len(inside), 2)
        for node in inside:
            self.assertEqual(node["friction_y"], 0)
            self.assertEqual(node["slip_y"], 0)
        slips = {node["slipping"] for node in self.nodes() if node["active"]}
        self.assertEqual(slips, {0, 1})
        self.assertEqual(summary.get("dependent_conditions", 0), 0)
        # What loads and supports do is stored or dissipated by friction, in each step to rounding.
        quantities = "".join(f'[[quantity]]\nname = "{kind}_{body}"\n{kind} = {{ body = "{body}" }}\n'
                             for kind in ("external_work", "stored_energy") for body in ("upper", "lower"))
        quantities += '[[quantity]]\nname = "slip"\nfriction_work = { body = "upper", label = "bottom" }\n'
        rows = HALVES.replace("friction = 0.3", 'friction = 0.3\nvariant = "weighted"')  # which do not yield
        values = {name: each["value"] for name, each
                  in self.solved(rows.replace("[time]", quantities + "[time]"))["quantities"].items()}
        self.assertAlmostEqual(
            (values["stored_energy_upper"] + values["stored_energy_lower"]
             + values["slip"])
            / (values["external_work_upper"] + values["external_work_lower"]), 1, delta=1e-12)
        self.assertGreater(values["slip"], 1e-3*values["stored_energy_upper"])

    def test_units_and_steps_of_the_error(self):
        one = self.solved(dragged(30))
        scaled = dragged(30).replace("young = 1000", "young = 1e9").replace("tz = -2", "tz = -2e6")
        other = self.solved(scaled)
        self.assertEqual(one["newton_iterations"], other["newton_iterations"])
        for a, b in zip(one["interfaces"][0]["resultant"], other["interfaces"][0]["resultant"]):
            self.assertAlmostEqual(a, b/1e6, delta=1e-12)
        chosen = self.solved(dragged(30).replace("steps = 10", "tolerance = 0.02"))
        self.assertLess(chosen["accuracy"]["time"], 0.02)


if __name__ == "__main__":
    unittest.main()
