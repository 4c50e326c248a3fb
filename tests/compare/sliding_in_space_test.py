"""Contact that follows the bodies (sliding = "finite") in space, end to end."""
import statistics
import unittest

import random_slides_space
from support import PROGRAM, InFolder

# A ball is pressed into a block, then moved along it.
BALL = """\
dimension = 3
[[body]]
name = "block"
mesh = { shape = "cuboid", lower = [0, LOWER, -0.5], upper = [3.6, 0.6, 0], cells = CELLS }
material = { young = 1000, poisson = 0.3 }
boundary = [ { label = 1, ux = 0, uy = 0, uz = 0 }, SYMMETRY ]
[[tool]]
name = "ball"
mesh = { shape = "ball", centre = [0.8, 0, 4], radius = 4, cells = 10, keep = [KEPT] }
at = [0.8, 0, 4]
MOTION
[[contact]]
sides = [ { body = "block", label = 3 }, { body = "ball", label = 7 } ]
sliding = "finite"
FRICTION
[[quantity]]
name = "turn"
displacement = { body = "ball" }
component = "rotation_y"
[[quantity]]
name = "drag"
reaction = { body = "ball" }
component = "x"
[[quantity]]
name = "press"
reaction = { body = "ball" }
component = "z"
[time]
end = 1
steps = STEPS
"""
HALF = {"LOWER": "0", "CELLS": "[36, 6, 3]", "SYMMETRY": "{ label = 5, uy = 0 }", "KEPT": '"y", "-z"'}
WHOLE = {"LOWER": "-0.6", "CELLS": "[28, 10, 2]", "SYMMETRY": "", "KEPT": ""}
DRAGGED = 'ux = "2*max(0, t - 0.2)/0.8"\nuz = "-0.02*min(5*t, 1)"\n'


class SlidingInSpace(InFolder):
    def run_ball(self, part, motion, friction, steps):
        text = BALL
        for name, value in {**part, "MOTION": motion, "FRICTION": friction, "STEPS": str(steps)}.items():
            text = text.replace(name, value)
        self.write(text.replace(", keep = []", "").replace(",  ]", " ]"))
        self.mortier("run", "scene.toml", "--quiet", "--out", "out")
        rows = self.rows_of("out/history.csv")
        self.assertLess(max(self.column(rows, "force_balance")), 1e-9)
        return rows

    def column(self, rows, name):
        return [float(next(row[key] for key in row if key.split("[")[0] == name)) for row in rows]

    def test_a_ball_dragged_over_twenty_elements_has_a_steady_force(self):
        for friction in ("", "friction = 0.3"):
            with self.subTest(friction=friction):
                rows = self.run_ball(HALF, DRAGGED, friction, 15)
                force = self.column(rows[6:], "press")
                mean = statistics.mean(force)
                most = max(abs(value - mean) for value in force)/abs(mean)
                print(f"force off its mean by {most}")
                self.assertLess(most, 0.01)

    def test_a_ball_that_is_free_to_turn_rolls(self):
        rows = self.run_ball(WHOLE, 'ux = "1.6*max(0, t - 0.2)/0.8"\nuz = -0.02\nmoment_y = 0\n',
                             "friction = 0.3", 8)
        turn, drag, press = (self.column(rows, name)[-1] for name in ("turn", "drag", "press"))
        self.assertAlmostEqual(turn, 1.6/4, delta=0.01*1.6/4)
        self.assertLess(abs(drag), 0.01*abs(press))

    def test_a_ball_spins_in_its_place(self):
        rows = self.run_ball(WHOLE, 'uz = -0.02\nrotation_z = "20*t"\n', "friction = 0.2", 3)
        force = self.column(rows[1:], "press")  # its mesh is that of a sphere, nearly
        self.assertLess(max(force) - min(force), 5e-3*abs(force[0]))

    def test_a_ball_touches_first_where_edges_are_on_top_of_each_other(self):
        for seed in (172, 297):
            with self.subTest(seed=seed):
                self.write(random_slides_space.scene(seed))
                self.mortier("run", "scene.toml", "--quiet", "--out", "out", "--set", "time.end=0.1",
                             "--set", "time.steps=1")

    def test_random_slides_end_certified_or_with_a_reason(self):
        for seed in (1, 3, 6, 7, 10):
            with self.subTest(seed=seed):
                shown, complaints = random_slides_space.examined(PROGRAM, seed)
                self.assertEqual(complaints, [], shown)


if __name__ == "__main__":
    unittest.main()
