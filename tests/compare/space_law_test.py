"""User-defined laws in space, as expressions of six components: beside the built-in laws that they repeat,
and beside plane strain."""
import functools
import unittest

import own_law_test
from scene_parts import body, shape, timed
from support import InFolder, mortier, set_option

CUBE = """\
dimension = 3
[[body]]
name = "cube"
mesh = {{ shape = "cuboid", cells = 2 }}
[body.material]
young = 100
poisson = 0.3
{law}
[[body.boundary]]
label = "bottom"
ux = 0
uy = 0
uz = 0
[[body.boundary]]
label = "top"
tx = "4*t"
ty = "2*t*x"
tz = "-6*min(t, 0.5)"
[time]
end = 1
steps = 4
"""


along_deviator = functools.partial(own_law_test.along_deviator,
                                   components=("11", "22", "12", "33", "13", "23"))
NORTON = along_deviator("1.5*r0/s0*(mises/s0)^(n - 1)", "s0 = 5, r0 = 0.1, n = 4")
PAIRS = {
    "norton": ('law = "norton"\nreference_stress = 5\nreference_rate = 0.1\nexponent = 4', NORTON),
    "maxwell": ('law = "maxwell"\nrelaxation_time = 0.3',
                along_deviator("1.3/(E*tau)", "E = 100, tau = 0.3")),
    "perzyna": ("viscosity = 1\nyield_stress = 2",
                along_deviator("max(0, 1 - Y/mises)/(2*eta)", "eta = 1, Y = 2")),
    "solid": ('law = "standard-solid"\nrelaxation_time = 0.3\nrelaxed_fraction = 0.4',
              along_deviator("1.3/(E*tau)", 'E = 100, tau = 0.3, g = 0.4, em = "(e11 + e22 + e33)/3", '
                             'em11 = em, em22 = em, em33 = em, em12 = 0, em13 = 0, em23 = 0'
                             .replace("= em,", '= "em",'), " - g/tau*(e{c} - em{c})")),
}


class SpaceLaw(InFolder):
    def history(self, text, *settings):
        self.summary = self.run_it(text, *settings)
        return self.rows_of("out/history.csv")

    def compare(self, rows, others, columns, within):
        self.assertEqual(len(rows), len(others))
        for column, of in columns.items():
            mine = [float(row[column]) for row in rows]
            theirs = [float(row[of]) for row in others]
            off = max(abs(a - b) for a, b in zip(mine, theirs)) / max(map(abs, theirs))
            self.assertLess(off, within, column)

    def test_equals_the_built_in_law(self):
        columns = {name: name for name in ("von_mises_max[Pa]", "displacement_max[m]", "elastic_energy[J]")}
        for name, (built_in, own) in PAIRS.items():
            averaged = "body.volume=averaged"  # with the built-in laws it is so by itself
            for settings in (("time.scheme=crank-nicolson", averaged), ("degree=2",),
                             ("time.scheme=sdirk2", "time.tolerance=1e-2", averaged)):
                with self.subTest(name, settings=settings):
                    expected = self.history(CUBE.format(law=built_in), *settings)
                    self.compare(self.history(CUBE.format(law=own), *settings), expected, columns, 1e-8)

    def test_an_extruded_block_is_that_of_plane_strain(self):
        """A law without isotropy in the plane, on a block that is held at both ends."""
        rates = {"11": "0.02*s11 + 0.01*s12 - 0.01*s33", "22": "0.01*s22*abs(s22) - 0.01*s33",
                 "12": "0.03*s12 + 0.005*s11", "33": "0.02*s33 - 0.005*(s11 + s22)"}
        def block(head, kind, rates, *loads, more):
            law = ", ".join(f'rate{c} = "{rate}"' for c, rate in rates.items())
            return (f"{head}\n" + body("block", shape(kind, cells=2),
                                       f'young = 100, poisson = 0.3, law = "expression", {law}', *loads,
                                       more=more) + timed(6, scheme="sdirk2"))

        # Tractions all around, and supports at points that only take the rigid motion away.
        plane = self.history(block(
            'plane = "strain"', "rectangle", rates, 'label = 2, tx = "3*t", ty = "1*t"',
            'label = 3, tx = "1*t", ty = "-4*t"', 'label = 1, tx = "-1*t", ty = "4*t"',
            'label = 4, tx = "-3*t", ty = "-1*t"',
            more="[[body.point]]\nat = [0, 0]\nux = 0\nuy = 0\n[[body.point]]\nat = [1, 0]\nuy = 0\n"))
        # y of the plane is z of the cuboid, and its y is z of the plane: 33 is 22, 12 is 13.
        turn = {"11": "11", "22": "33", "12": "13", "33": "22"}
        turned = {}
        for c, rate in rates.items():
            for a, b in turn.items():
                rate = rate.replace(f"s{a}", f"S{b}")
            turned[turn[c]] = rate.replace("S", "s")
        turned.update({"12": "0.02*s12", "23": "0.02*s23"})
        space = self.history(block(
            "dimension = 3", "cuboid", turned, 'label = 2, tx = "3*t", tz = "1*t"',
            'label = 3, tx = "1*t", tz = "-4*t"', 'label = 1, tx = "-1*t", tz = "4*t"',
            'label = 4, tx = "-3*t", tz = "-1*t"', "label = 5, uy = 0", "label = 6, uy = 0",
            more="[[body.point]]\nat = [0, 0, 0]\nux = 0\nuz = 0\n"
                 "[[body.point]]\nat = [1, 0, 0]\nuz = 0\n"))
        self.compare(space, plane, {"von_mises_max[Pa]": "von_mises_max[Pa]",
                                    "displacement_max[m]": "displacement_max[m]",
                                    "elastic_energy[J]": "elastic_energy[J/m]"}, 1e-9)

    def test_all_components_count(self):
        """Shears across the plane flow by rates of their own."""
        creep = CUBE.format(law="\n".join(['law = "expression"'] + [
            f'rate{c} = "{rate}"' for c, rate in (("11", "0*s11"), ("22", 0), ("12", 0), ("33", 0),
                                                  ("13", "a*s13"), ("23", "b*s23"))] + [
            "parameters = { a = 0.01, b = 0 }"]).replace('"0"', "0")).replace(
                'tx = "4*t"\nty = "2*t*x"\ntz = "-6*min(t, 0.5)"', 'tx = 4\nty = 4')
        ends = []
        for settings in (("a=0", "b=0"), ("a=0.01", "b=0"), ("a=0", "b=0.01"), ("a=0.01", "b=0.01")):
            words = [f"body.cube.material.parameters.{each}" for each in settings]
            ends.append(float(self.history(creep, *words)[-1]["displacement_max[m]"]))
        # The cube is as stiff along y as along x but for its diagonals.
        self.assertGreater(ends[1], 1.02 * ends[0])
        self.assertGreater(ends[2], 1.02 * ends[0])
        self.assertGreater(ends[3], max(ends[1:3]))

    def test_mortier_law(self):
        def told(law, *arguments, code=0):
            self.write(CUBE.format(law=law))
            done = mortier("law", "scene.toml", *arguments, cwd=self.folder)
            self.assertEqual((done.returncode, done.stderr), (code, ""))
            self.assertIn("in space, stresses up to", done.stdout)
            return {line.split()[0]: line for line in done.stdout.splitlines() if line.startswith("  ")}
        for name, (built_in, own) in PAIRS.items():
            with self.subTest(name):
                for law in (built_in, own):
                    lines = told(law, "--stress", "50")
                    self.assertNotIn("WRONG", "".join(lines.values()))
                    self.assertLess(float(lines["tangent"].split()[1]), 1e-6)
                    self.assertLess(float(lines["isotropy"].split()[1]), 1e-10)
        lipschitz = float(told(PAIRS["maxwell"][1])["Lipschitz"].split()[1])
        self.assertAlmostEqual(lipschitz * 0.3, 1, delta=2e-3)
        # A shear across the plane is part of what is tried: of axes that turn, and of energy.
        for shear, factor in (("13", 2), ("23", 0)):
            wrong = NORTON.replace(f'rate{shear} = "', f'rate{shear} = "{factor}*')
            self.assertIn("WRONG", told(wrong, code=1)["isotropy"])
        heats = NORTON.replace('rate13 = "', 'rate13 = "-').replace("isotropic = true", "")
        self.assertIn("it makes energy", told(heats, code=1)["dissipation"])
        steep = along_deviator("sinh(mises/s0)", "s0 = 0.1")
        self.assertRegex(told(steep, "--stress", "1e3", code=1)["rate"],
                         "the least without at s11 = .*, s12 = .*, s33 = .*, s13 = .*, s23 = ")

    def test_what_is_wrong_is_named(self):
        def refuse(message, law, *settings):
            self.write(CUBE.format(law=law))
            self.reject(message, "run", "scene.toml", "--quiet", "--out", "out",
                        *set_option(settings))
        for c in ("33", "13", "23"):
            lines = "\n".join(line for line in NORTON.splitlines() if not line.startswith(f"rate{c}"))
            refuse(f"scene.toml:5: body cube: rate{c} is missing, expected an expression", lines)
        refuse("scene.toml:10: body cube: rate11", NORTON.replace('rate11 = "', 'rate11 = "s31 + '))
        refuse("scene.toml:16: body cube: parameters.s13, expected another name",
               NORTON.replace("n = 4", "n = 4, s13 = 1"))
        refuse('scene.toml:10: body cube: law = "expression", expected a rate that is a number without '
               "stress and strain, is not one in component 23",
               NORTON.replace('rate23 = "', 'rate23 = "0*log(-1) + '))
        self.write(CUBE.format(law=NORTON).replace("dimension = 3", 'plane = "strain"').replace(
            'shape = "cuboid"', 'shape = "rectangle"'))
        self.reject("scene.toml:14: body cube: rate13 =", "run", "scene.toml")
        self.assertIn("expected it with dimension = 3 only", mortier(
            "run", "scene.toml", cwd=self.folder).stderr)


if __name__ == "__main__":
    unittest.main()
