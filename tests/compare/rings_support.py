"""What the tests of bodies of revolution share: a tube and a sphere, errors over whole rings."""
import numpy as np

from scene_parts import body, timed
from support import InFolder

import results
import study_support  # noqa: F401
import measure

INNER, OUTER = 1.0, 2.0

# A tube between plates.
TUBE = """\
plane = "axisymmetric"
degree = 2
[[body]]
name = "tube"
mesh = { shape = "rectangle", lower = [1, 0], upper = [2, 0.25], cells = [CELLS, 2], cut = "both" }
BODY
boundary = [ { label = 1, uy = 0 }, { label = 3, uy = 0 }, SIDES ]
[time]
end = END
steps = STEPS
[check]
allow = ["initial-load"]
"""

# A quarter of a hollow sphere: label 4 lies on the axis.
SPHERE = ('plane = "axisymmetric"\n'
          + body("sphere",
                 '{ shape = "annulus", inner = 1, outer = 2, span = "quarter", cells = [CELLS, CELLS], '
                 'cut = "both" }', "MATERIAL", "label = 3, uy = 0", "label = 1, pressure = 1") + timed()
          + '[check]\nallow = ["initial-load"]\n')

def tube(cells, body, sides, end=1, steps=1):
    return (TUBE.replace("CELLS", str(cells)).replace("BODY", body).replace("SIDES", sides)
            .replace("END", str(end)).replace("STEPS", str(steps)))


class OfRings(InFolder):
    def error(self, quantity, materials, **exact):
        """Of the last run, relative, over the whole ring."""
        names = [name for name in ("ux", "uy", "s11", "s22", "s12", "s33") if name in exact]
        truth = measure.Exact({"": {name: lambda x, y, t, f=exact[name]: f(x, y) + 0 * x for name in names}},
                              [], 1.0)
        return measure.field_error(quantity, results.read(self.folder / "out"), truth, materials, ring=True)

    def orders(self, cells, run, least, last):
        errors = [run(n) for n in cells]
        order = np.polyfit(np.log(cells), np.log(errors), 1)[0]
        self.assertGreaterEqual(-order, least, errors)
        self.assertLessEqual(errors[-1], last)
