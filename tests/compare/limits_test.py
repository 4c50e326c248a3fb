"""The table of docs/limits.md: what the program refuses of two keys together, and nothing else."""
import itertools
import re
import unittest

from scene_parts import body, box, contact, quantity, timed
from support import ROOT, InFolder, mortier

SCENE = (body("upper", box([0, 0], [1, 1], 3), 1000, "label = 4, ux = 0", "label = 3, ty = -1")
         + body("lower", box([0, -1], [1, 0], 4), 1000, "label = 4, ux = 0", "label = 1, uy = 0")
         + contact(("upper", 1), ("lower", 3), sides=True) + quantity("force", "reaction", "lower", 1, "y")
         + timed(2))
AXES = ('body.material={elasticity="orthotropic", young1=1000, young2=500, young3=500, poisson12=0.3, '
        'poisson13=0.3, poisson23=0.3, shear12=300%s}')
TOOL = ('tool=[{name="plate", shape="line", points=[[-1, 1], [2, 1]], fy=-1}]',
        "body.upper.boundary=[{label=4, ux=0}]",
        'contact=[{sides=[{body="upper", label=1}, {body="lower", label=3}]},'
        '{sides=[{body="upper", label=3}, {body="plate"}]}]')
CURVED = ('body.upper.mesh={shape="annulus", inner=1, outer=2, span="quarter", cells=[4, 2]}',
          'body.lower.mesh={shape="annulus", inner=2, outer=3, span="quarter", cells=[6, 2]}',
          "body.upper.boundary=[{label=3, uy=0}, {label=4, ux=0}]",
          "body.lower.boundary=[{label=3, uy=0}, {label=4, ux=0}, {label=2, pressure=1}]",
          'contact=[{sides=[{body="upper", label=2}, {body="lower", label=1}]}]',
          "quantity.force.reaction={body=\"lower\", label=3}")
SPACE = ("dimension=3",
         'body.upper.mesh={shape="cuboid", cells=2, lower=[0, 0, 0], upper=[1, 1, 1]}',
         'body.lower.mesh={shape="cuboid", cells=3, lower=[0, 0, -1], upper=[1, 1, 0]}',
         'body.upper.boundary=[{label="left", ux=0}, {label="front", uy=0}, {label="top", tz=-1}]',
         'body.lower.boundary=[{label="left", ux=0}, {label="front", uy=0}, {label="bottom", uz=0}]',
         'contact=[{sides=[{body="upper", label="bottom"}, {body="lower", label="top"}]}]',
         'quantity=[{name="force", reaction={body="lower", label="bottom"}, component="z"}]')
# Settings by the first cell of a row, in the plane and where they are others in space.
ROWS = {
    "flow (any law but elastic)": ("body.material.law=maxwell", "body.material.relaxation_time=1"),
    "`degree = 2`": ("degree=2",),
    '`plane = "axisymmetric"`': ("plane=axisymmetric",),
    "curved contact lines": CURVED,
    "`temperature`": ("body.material.expansion=1e-5", "body.temperature=10*t"),
    "`elasticity` with axes": (AXES % "",),
    "`friction`, `shear_limit`": ("contact.friction=0.3",),
    "rigid tools": TOOL,
    '`sliding = "finite"`': ("contact.sliding=finite",),
    '`kind = "tied"`': ('contact.kind="tied"', "body.upper.boundary=[{label=3, ty=-1}]",
                       "body.lower.boundary=[{label=1, ux=0, uy=0}]"),
    "`gap` that changes in time": ("contact.gap=-1e-4*t",),
    '`variant = "interpolation"`': ("contact.variant=interpolation",),
    '`scheme = "crank-nicolson"`': ("time.scheme=crank-nicolson",),
    '`method = "penalty-duality"`': ("solver.method=penalty-duality",),
    "plasticity (`viscosity = 0`)": ("body.material.law=viscoplastic", "body.material.viscosity=0",
                                     "body.material.yield_stress=0.5"),
    '`volume = "averaged"`': ("plane=strain", "body.volume=averaged"),
    "`body.region`, initial stress": ("body.initial_stress={s11=0, s22=-0.1, s12=0}",),
}
IN_SPACE = {"`elasticity` with axes": (AXES % ", shear13=300, shear23=300",),
            "curved contact lines": (),  # spheres: scenes/shells.toml
            '`kind = "tied"`': ('contact.kind="tied"',),
            "rigid tools": ('tool=[{name="plate", mesh={shape="cuboid", lower=[-1, -1, 1], upper=[2, 2, 2], '
                            'cells=1}, fz=-1}]',
                            'body.upper.boundary=[{label="left", ux=0}, {label="front", uy=0}]',
                            'contact=[{sides=[{body="upper", label="bottom"}, {body="lower", label="top"}]},'
                            '{sides=[{body="upper", label="top"}, {body="plate", label="bottom"}]}]'),
            '`volume = "averaged"`': ("body.volume=averaged",)}
COLUMNS = {
    "`accuracy.bound`": ("accuracy.bound=true",),
    "`accuracy.quantity`": ("accuracy.quantity=force", "accuracy.tolerance=0.1"),
    "`accuracy.energy`": ("accuracy.energy=0.1",),
    "`time.tolerance`": ("time.tolerance=0.01",),
    '`method = "penalty-duality"`': ("solver.method=penalty-duality",),
    "`dimension = 3`": SPACE,
    "FreeFEM": (),
}


def table():
    """Cells by the names of row and column."""
    lines = [line for line in (ROOT / "docs" / "limits.md").read_text().splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return {(row[0], column): cell for row in cells[2:] for column, cell in zip(cells[0][1:], row[1:])}


class Limits(InFolder):
    def test_the_table_has_all_of_them(self):
        self.assertEqual(set(table()), set(itertools.product(ROWS, COLUMNS)))

    def test_the_scene_is_supported(self):
        for column in COLUMNS:
            self.assertFalse(self.refused(column, ()), column)

    def test_the_table_is_that_of_the_program(self):
        for (row, column), cell in table().items():
            with self.subTest(f"{row}, {column}"):
                space = column == "`dimension = 3`"
                settings = IN_SPACE.get(row, ROWS[row]) if space else ROWS[row]
                self.assertEqual(self.refused(column, settings), cell == "no", cell)

    def refused(self, column, settings):
        """By an error, or, of bounds, by a reason why there is none."""
        self.write(SCENE)
        words = ("freefem", "scene.toml", "scene.edp") if column == "FreeFEM" else ("check", "scene.toml")
        changed = [word for setting in (*COLUMNS[column], *settings) for word in ("--set", setting)]
        done = mortier(*words, *changed, cwd=self.folder)
        self.assertIn(done.returncode, (0, 2), done.stderr)
        left_out = re.search(r"^left out   accuracy: a guaranteed bound", done.stdout, re.M)
        return done.returncode == 2 or left_out is not None


if __name__ == "__main__":
    unittest.main()
