"""Tools that turn by finite angles: contact follows them (sliding = "finite")."""
import json
import math
import unittest

from scene_parts import body, contact, quantity, shape, tool
from scene_parts import timed as end_after
from support import InFolder

import results  # noqa: E402

BLOCK = ('plane = "strain"\n'
         + body("block",
                '{ shape = "rectangle", lower = [LEFT, -1], upper = [RIGHT, 0], cells = [CELLS, 12], '
                'cut = "both" }', 1e3, "label = 1, ux = 0, uy = 0"))
DISC = tool("tool", shape="disc", centre=[0, 2], radius=2)
CONTACT = contact(("block", 3), ("tool",), sides=True, variant="weighted", sliding="finite")
ON_PLATE = CONTACT.replace('{ body = "tool" }', '{ body = "tool", label = 1 }')
QUANTITIES = "".join(quantity(f"{name}-{c}", name, "tool", component=c)
                     for name in ("reaction", "contact_force", "displacement")
                     for c in ("x", "y", "rotation" if name == "displacement" else "moment"))
# A block that is inclined by INCLINED, and a plate above it, upright as drawn.
INCLINED = math.radians(30)


def inclined(angle, cells):
    def corner(x, y):
        return [x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)]
    return body("block",
                shape("quadrilateral", corners=[corner(*x) for x in ((-1, -1), (1, -1), (1, 0), (-1, 0))],
                      cells=cells), "young = 1e3, poisson = 0", "label = 1, ux = 0, uy = 0")


PLATE = tool("tool", shape="rectangle", lower=[-1.6, 3], upper=[1.6, 4], at=[0, 3])


def timed(steps):
    return end_after(steps) + "[output]\nevery = 1\n"


class TurningTools(InFolder):
    def history(self, *names):
        """Columns by their names, without units."""
        rows = results.read_csv(self.folder / "out/history.csv")
        keys = {key.split("[")[0]: key for key in rows[0]}
        return [[float(row[keys[name]]) for row in rows] for name in names]

    def block(self, left=-1, right=1, cells=40):
        return BLOCK.replace("LEFT", str(left)).replace("RIGHT", str(right)).replace("CELLS", str(cells))

    def test_a_disc_that_spins_in_its_place(self):
        """One full turn after it is pressed: without friction nothing changes, with it all nodes slip."""
        motion = 'uy = "-0.02*min(4*t, 1)"\nrotation = "-2*pi*max(t - 0.25, 0)/0.75"\n'
        for friction in (0, 0.3):
            summary = self.run_it(self.block() + DISC + motion + CONTACT + f"friction = {friction}\n"
                                 + QUANTITIES + timed(16))
            x, y, moment, turned = self.history("contact_force-x", "contact_force-y",
                                                "contact_force-moment", "displacement-rotation")
            self.assertAlmostEqual(turned[-1], -2 * math.pi, delta=1e-12)
            for step in range(4, 16):
                if friction == 0:
                    self.assertAlmostEqual(y[step] / y[3], 1, delta=1e-10)
                    self.assertAlmostEqual(x[step] / y[step], 0, delta=1e-10)
                else:  # the surface of the tool goes to the left; its normals are inclined by a/R at most
                    self.assertAlmostEqual(x[step] / y[step], friction, delta=0.02 * friction)
            self.assertAlmostEqual((self.history("reaction-moment")[0][-1] + moment[-1]) / y[-1], 0,
                                   delta=1e-10)
            self.assertLess(summary["verification"]["force_balance"], 1e-9)
        pressed = [row for row in results.read_csv(self.folder / "out/contact.csv")
                   if float(row["time"]) > 0.3 and float(row["force"]) > 0]
        self.assertGreater(len(pressed), 12 * 5)
        for row in pressed:
            self.assertAlmostEqual(abs(float(row["friction"])) / float(row["force"]), 0.3, delta=1e-10)
        # every friction force has the radius as its arm, but for the sagitta of the outline
        force = sum(float(row["force"]) for row in pressed if float(row["time"]) == 1)
        self.assertAlmostEqual(abs(moment[-1]) / (2 * 0.3 * force), 1, delta=1e-4)

    def test_patch_under_a_plate_that_has_turned(self):
        """Turned onto the slope in the air, then pressed along its normal: constant pressure."""
        depth, s, c = 0.01, math.sin(INCLINED), math.cos(INCLINED)
        motion = (f'rotation = "{INCLINED!r}*min(2*t, 1)"\n'
                  f'ux = "{depth * s!r}*max(2*t - 1, 0)"\n'
                  f'uy = "-3*min(2*t, 1) - {depth * c!r}*max(2*t - 1, 0)"\n')
        for degree in (1, 2):
            for rows in ("variant=mortar", "variant=weighted", "stabilised=true"):
                with self.subTest(degree=degree, rows=rows):
                    summary = self.run_it(f"degree = {degree}\n" + inclined(INCLINED, [5, 4]) + PLATE + motion
                                          + ON_PLATE + timed(8), f"contact.{rows}")
                    folder = self.folder / "out"
                    run = results.mortier_run(folder, summary,
                                              results.contact_tables(folder),
                                              results.kept_steps(folder)[-1][0])
                    self.assertLess(abs(run.contact.pressure / (1e3 * depth) - 1).max(), 1e-10)
                    plate = run.bodies["tool"]
                    for place, moved in zip(plate.points, plate.displacement):
                        x, y = place - [0, 3]
                        expected = [depth * s + x * c - y * s, -depth * c + x * s + y * c]
                        self.assertLess(max(abs(place + moved - expected)), 1e-12)

    def test_a_plate_that_a_force_presses_turns_until_it_lies_flat(self):
        angle = math.radians(10)
        motion = 'fy = "-1e-4*t"\nmoment = 0\nux = 0\n'
        plate = PLATE.replace("[-1.6, 3]", "[-1.6, 0.31]").replace("[0, 3]", "[0, 0.31]")
        summary = self.run_it(inclined(angle, [6, 4]) + plate + motion + ON_PLATE + QUANTITIES + timed(4))
        turned, moment, force = self.history("displacement-rotation", "contact_force-moment",
                                             "contact_force-y")
        self.assertAlmostEqual(turned[-1], angle, delta=1e-6)
        self.assertAlmostEqual(force[-1], 1e-4, delta=1e-13)
        self.assertAlmostEqual(moment[-1], 0, delta=1e-13)
        self.assertLess(summary["verification"]["force_balance"], 1e-9)

    def test_a_disc_that_rolls(self):
        """Contact turns it by way over radius, but for the creep of a surface that is strained; turned by
        that angle it needs hardly any force to go on, held it slides."""
        way = "3*max(t - 0.2, 0)/0.8"

        def rolled(turns):
            self.run_it(self.block(-1.5, 4.5, 80) + DISC + f'ux = "{way}"\nuy = "-0.01*min(5*t, 1)"\n' + turns
                       + CONTACT + "friction = 0.3\n" + QUANTITIES + timed(40))
            x, y, turned = self.history("contact_force-x", "contact_force-y", "displacement-rotation")
            return x[-1] / y[-1], turned[-1] / -1.5

        drag, free = rolled("moment = 0\n")
        self.assertLess(abs(drag), 1e-3)
        self.assertAlmostEqual(free, 1, delta=0.01)
        self.assertLess(abs(rolled(f'rotation = "-{free!r}*{way}/2"\n')[0]), 0.02)
        self.assertGreater(abs(rolled("")[0]), 0.29)

    def test_stopped_and_resumed(self):
        self.write(self.block(-1.5, 1.5, 40) + DISC + 'uy = "-0.01-0.005*sin(9*t)"\nmoment = "0.1*sin(7*t)"\n'
                   'ux = "t"\n' + CONTACT + "friction = 0.3\n" + QUANTITIES + timed(60))
        self.resume([], 5, ("history.csv", "contact.csv", "tool_000060.vtu", "block_000060.vtu"))

    def test_check_names_what_is_not_small(self):
        for motion, sliding, kinds in (
                ('rotation = "0.1*t"\n', "refuse", ["contact-slides", "large-rotation"]),
                ('rotation = "0.1*t"\n', "finite", []),
                ('rotation = "0.08*t"\n', "refuse", ["contact-slides"]),
                ('rotation = "0.01*t"\n', "refuse", []),
                ('uy = "-0.06*t"\n', "finite", ["large-strain"]),
                ('uy = "-0.04*t"\n', "finite", [])):
            with self.subTest(motion=motion, sliding=sliding):
                self.write(self.block() + DISC + motion + CONTACT.replace("finite", sliding) + timed(1))
                done = self.mortier("check", "scene.toml", "--json")
                self.assertEqual([fault["id"] for fault in json.loads(done.stdout)["faults"]], kinds)
                slips = " and slips" if sliding == "refuse" else ""
                left_out = f"inertia, friction, finite strains{slips} ("
                self.assertIn(left_out, self.mortier("check", "scene.toml").stdout)

    def test_a_beam_that_a_tool_bends_is_not_strained_by_its_way(self):
        """A tip that moves by more than 5 % of the height of a beam."""
        beam = self.block(0, 10, 100).replace("label = 1, ux = 0", "label = 4, ux = 0")
        self.write(beam + DISC.replace("[0, 2]", "[9, 2]") + 'uy = "-0.2*t"\n' + CONTACT + timed(1))
        self.assertEqual(json.loads(self.mortier("check", "scene.toml", "--json").stdout)["faults"], [])

    def test_all_contacts_of_it_follow_or_none(self):
        other = BLOCK.replace("block", "other").replace("LEFT", "2")
        other = other.replace("RIGHT", "3").replace("CELLS", "4")
        other = other[other.index("[[body]]"):]
        self.write(self.block() + other + DISC + 'rotation = "t"\n' + CONTACT
                   + CONTACT.replace("block", "other").replace('sliding = "finite"\n', "") + timed(1))
        self.reject("scene.toml:12: tool tool: it turns, and only some of its contacts", "run", "scene.toml")


if __name__ == "__main__":
    unittest.main()
