"""Scenes in space in both codes: compression of two cubes, and a block above the middle of another."""
import tempfile
import unittest
from pathlib import Path

import support
from scene_parts import body, box, contact, timed
from both import compare_runs

CUBES = "scenes/cubes.toml"
ELASTIC = "body.material={young=100, poisson=0.3}"
PERZYNA = "body.material={young=3e4, poisson=0.3, viscosity=10, yield_stress=1}"

# Apart at first, and at one end at last; it overhangs at one side, and edges of it end inside triangles.
BLOCK = ("dimension = 3\n"
         + body("block", box([0.3, 0, 0.02], [1.1, 0.7, 0.9], [3, 3, 2]), 100, 'label = "front", uy = 0',
                'label = "top", ux = 0, uz = "0.1*t*(x - 0.8)"', 'label = "back", pressure = "2*t"',
                force={"z": "-z*t"})
         + body("floor", box([0, 0, -1], [1, 1, 0], [4, 3, 3]), "young = 50, poisson = 0.2",
                'label = "bottom", ux = 0, uy = 0, uz = 0', 'label = "front", uy = 0')
         + contact(("block", "bottom"), ("floor", "top")) + timed(4))
# A cube in the corner of a floor and a wall: two contacts on one body.
CORNER = ("dimension = 3\n"
          + body("cube", box([0, 0, 0], [1, 1, 1], 2),
                 "young = 100, poisson = 0.3, viscosity = 10, yield_stress = 1", 'label = "front", uy = 0',
                 'label = "top", tz = "-3*t"', 'label = "right", tx = "-t"')
          + body("floor", box([0, 0, -1], [1, 1, 0], 3), "young = 50, poisson = 0.2",
                 'label = "bottom", ux = 0, uy = 0, uz = 0')
          + body("wall", box([-1, 0, 0], [0, 1, 1], 3), "young = 70, poisson = 0.2",
                 'label = "left", ux = 0, uy = 0, uz = 0', 'label = "bottom", uz = 0')
          + contact(("cube", "bottom"), ("floor", "top")) + contact(("wall", "right"), ("cube", "left"))
          + timed(4))
WITHIN = 1e-9


class SpaceOracle(unittest.TestCase):
    def agree(self, scene, *settings):
        with self.subTest(scene=scene, settings=settings), tempfile.TemporaryDirectory() as folder:
            path = scene
            if "\n" in scene:
                path = str(Path(folder) / "scene.toml")
                Path(path).write_text(scene)
            row = compare_runs(Path(folder), settings, path, WITHIN)
            self.assertTrue(row["agree"], row["verdict"])

    def test_compression(self):
        for variant in ("weighted", "mortar", "interpolation"):
            for material, swap in ((ELASTIC, "false"), (PERZYNA, "false"), (PERZYNA, "true")):
                self.agree(CUBES, f"contact.variant={variant}", f"contact.swap={swap}", material,
                           "time.steps=4")

    def test_a_block_that_closes_a_gap(self):
        for variant in ("weighted", "mortar", "interpolation"):
            for swap in ("false", "true"):
                self.agree(BLOCK, f"contact.variant={variant}", f"contact.swap={swap}")

    def test_what_freefem_does_not_know_is_refused(self):
        for setting, message in (
                ("degree=2", "degree = 2"),
                ('body.material={young=100, poisson=0.3, law="maxwell", relaxation_time=1}', "material: law"),
                ('body.material={young=100, poisson=0.3, law="expression", rate11="s11", rate22="s22", '
                 'rate12="s12", rate33="s33", rate13="s13", rate23="s23"}', "material: law"),
                ("time.tolerance=0.01", "tolerance"),
                ('body.upper.mesh={shape="rectangle", cells=1, extrude=1, layers=1}', "expected"),
                ("contact.initial=close", 'initial = "close"'), ("contact.gap=0.1", "contact: gap"),
                ("body.temperature=1", "temperature"), ("body.initial_stress={s13=1}", "initial stress"),
                ('body.material={elasticity="general", stiffness=[[1,0,0,0,0,0],[0,1,0,0,0,0],[0,0,1,0,0,0],'
                 '[0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,1]]}', 'elasticity = "general"'),
                ("body.lower.boundary=[{label=1, un=0}, {label=4, ux=0}, {label=5, uy=0}]", ": un"),
                ("body.lower.point=[{at=[1, 1, -1], ux=0}]", "a support at a point"),
                ("time.scheme=sdirk2", "scheme = sdirk2")):
            with self.subTest(setting):
                done = support.mortier("freefem", CUBES, "--set", setting, cwd=support.ROOT)
                self.assertEqual(done.returncode, 2)
                self.assertIn(message, done.stderr)

    def test_averaged_volume(self):
        self.agree(BLOCK, "body.material.poisson=0.4999")
        self.agree(CORNER, "body.wall.volume=averaged")
        self.agree(CORNER, "body.volume=pointwise")

    def test_two_contacts(self):
        for variant in ("weighted", "mortar", "interpolation"):
            self.agree(CORNER, f"contact.variant={variant}")


if __name__ == "__main__":
    unittest.main()
