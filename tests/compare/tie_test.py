"""Ties: parts that are cut and tied against whole ones and exact solutions, tools that move a tied side, what
a tie refuses."""
import json
import math
import unittest

from scene_parts import body, box, contact, quantity, shape, tied, timed, tool
from support import InFolder

RINGS = ('plane = "strain"\ndegree = DEGREE\n'
         + body("inner", '{ shape = "annulus", inner = 1, outer = 1.5, span = "quarter", cells = [CELLS] }',
                1000, "label = 1, pressure = 10", "label = 3, uy = 0", "label = 4, ux = 0")
         + body("outer", '{ shape = "annulus", inner = 1.5, outer = 2, span = "quarter", cells = [OTHERS] }',
                1000, "label = 3, uy = 0", "label = 4, ux = 0")
         + tied(("inner", 2), ("outer", 1), more="VARIANT\n")
         + quantity("outside", "displacement", "outer", component="x", point=[2, 0]) + timed())

# A block on a plate, which a tool pushes and turns.
HEAD = ('plane = "strain"\n'
        + body("block", box([0, 0], [2, 1], [14, 7]),
               "young = 1000, poisson = 0.3, viscosity = 20, yield_stress = 0.5",
               "label = 1, ux = 0, uy = 0")
        + tool("head", shape="rectangle", lower=[0, 1], upper=[2, 1.5], at=[1, 1], moment="-t", fx="0.3*t",
               fy="-0.5*t") + tied(("block", 3), ("head", 1))
        + quantity("moment", "reaction", "block", 1, "moment")
        + quantity("push", "contact_force", "block", 3, "x")
        + quantity("turn", "displacement", "head", component="rotation") + timed(10))

# Two blocks, one on the other; CUT: as one, or in two that are tied.
SPACE = ('dimension = 3\ndegree = DEGREE\n[[body]]\nname = "lower"\n'
         'mesh = { shape = "cuboid", lower = [0, 0, 0], upper = [1, 1, TOP], cells = [4, 4, LAYERS] }\n'
         "material = { young = 1000, poisson = 0.3 }\n"
         'boundary = [ { label = "bottom", ux = 0, uy = 0, uz = 0 }LOADED ]\nCUT\n'
         + quantity("corner", "displacement", "LAST", component="x", point=[1, 1, 2]) + timed())
UPPER = (body("upper", box([0, 0, 1], [1, 1, 2], [5, 5, 5]), 1000, 'label = "top", tx = 1')
         + tied(("upper", "bottom"), ("lower", "top")))


# A soft layer on a plate under a punch: contact above, a tie below.
LAYER = ('plane = "strain"\n'
         + body("punch", box([0.6, 0.2], [1.4, 0.6], [11, 6]), 2e5, 'label = 3, ux = 0, ty = "-20*t"')
         + body("layer", box([0, 0], [2, 0.2], [40, 4]),
                "young = 1e3, poisson = 0.4, viscosity = 50, yield_stress = 30")
         + body("plate", box([0, -0.5], [2, 0], [26, 7]), 7e4, "label = 1, ux = 0, uy = 0")
         + contact(("layer", 3), ("punch", 1), friction=0.2)
         + contact(("layer", 1), ("plate", 3), kind="tied") + timed(4))


# A slider, a body or a tool, slides far on a layer, which is tied to a plate.
BODY = body("slider", box([0.4, 0.2], [1, 0.5], [7, 4]), 2e5,
            'label = 3, ux = "0.6*t", uy = "-0.004*min(5*t, 1)"')
TOOL = tool("slider", shape="rectangle", lower=[0.4, 0.2], upper=[1, 0.5], ux="0.6*t",
            uy="-0.004*min(5*t, 1)")
SLIDER = ('plane = "strain"\nPUSHED\n'
          + body("layer", box([0, 0], [2, 0.2], [40, 4]), "young = 1e3, poisson = 0.4")
          + body("plate", box([0, -0.5], [2, 0], [26, 7]), 7e4, more="HELD\n")
          + contact(("layer", 3), ("slider", 1), friction=0.2, sliding="finite")
          + contact(("layer", 1), ("plate", 3), kind="tied", more="SECOND\n") + timed(5))
BOTTOM = "boundary = [ { label = 1, ux = 0, uy = 0 } ]"
BASE = body("base", box([0, -0.8], [2, -0.5], [17, 4]), "young = 3e4, poisson = 0.2", more=f"{BOTTOM}\n")
BELOW = contact(("base", 3), ("plate", 1), kind="tied")


# Half a ring on a plate, tied at one foot, the other one pressed into the plate.
ARCH = ('plane = "strain"\n'
        + body("arch", shape("annulus", inner=1, outer=2, span="half", cells=[24, 4]), 1000,
               "label = 4, uy = -0.3")
        + body("plate", box([-2, -1], [2, 0], [20, 6]), 1000, "label = 1, ux = 0, uy = 0")
        + tied(("arch", 3), ("plate", 3)) + timed())

# A column on a wider base: the corners between them are reentrant.
CORNERS = ('plane = "strain"\n'
           + body("column", '{ shape = "rectangle", lower = [0.5, GAP], upper = [1.5, 2], cells = [8, 16] }',
                  1000, "label = 3, ux = 0.01")
           + body("base", box([0, -1], [2, 0], [22, 11]), 1000, "label = 1, ux = 0, uy = 0")
           + tied(("column", 1), ("base", 3)) + quantity("above", "contact_force", "column", 1, "moment")
           + quantity("below", "contact_force", "base", 3, "moment")
           + quantity("peak", "largest_mises", "column") + timed())


class Ties(InFolder):
    def solved(self, text, *options, code=0):
        self.write(text)
        self.mortier("run", "scene.toml", "--quiet", "--out", "out", *options, code=code)
        summary = json.loads(self.read("out/summary.json"))
        self.assertEqual(summary["status"], "converged")
        return summary

    def values(self, summary):
        return {name: each["value"] for name, each in summary["quantities"].items()}

    def test_a_ring_that_is_cut_along_a_circle_is_lames(self):
        exact = 1.3/1000*10/3*(0.4*2 + 4/2)
        for degree, order, variant in ((1, 2, "mortar"), (1, 2, "interpolation"), (2, 1.9, "weighted")):
            errors = []
            for k in (1, 2, 4):
                text = RINGS.replace("CELLS", f"{8*k}, {3*k}").replace("OTHERS", f"{11*k}, {4*k}")
                summary = self.solved(text.replace("DEGREE", str(degree))
                                      .replace("VARIANT", f'variant = "{variant}"'))
                errors.append(abs(self.values(summary)["outside"]/exact - 1))
                self.assertLess(summary["ties"][0]["distance"], 8e-3/k**2)  # of the two polygons
            with self.subTest(degree=degree, variant=variant):
                self.assertLess(errors[2], errors[1]/2**order*1.1)
                self.assertLess(errors[1], errors[0]/2**order*1.1)
                self.assertLess(errors[2], 1e-3 if degree == 1 else 1e-6)

    def test_rollers_on_slopes_hold_ends_of_ties(self):
        def turned(x, y):
            return f"[{math.cos(0.5)*x - math.sin(0.5)*y}, {math.sin(0.5)*x + math.cos(0.5)*y}]"
        text = ""
        for name, y, cells, held in (("lower", 0, 5, "{ label = 1, un = 0 }"),
                                     ("upper", 1, 7, "{ label = 3, pressure = 1 }")):
            corners = ", ".join(turned(*each) for each in ((0, y), (1, y), (1, y + 1), (0, y + 1)))
            text += (f'[[body]]\nname = "{name}"\nmaterial = {{ young = 1000, poisson = 0.3 }}\n'
                     f'mesh = {{ shape = "quadrilateral", corners = [{corners}], cells = {cells} }}\n'
                     f"boundary = [ {held}, {{ label = 4, un = 0 }} ]\n")
        text += ('[[contact]]\nkind = "tied"\nsides = [{ body = "lower", label = 3 }, '
                 '{ body = "upper", label = 1 }]\n[time]\nend = 1\nsteps = 1\n')
        for degree in (1, 2):
            for swap in ("false", "true"):
                with self.subTest(degree=degree, swap=swap):
                    final = self.solved(text, "--set", f"degree={degree}", "--set",
                                        f"contact.swap={swap}")["final"]
                    self.assertAlmostEqual(final["von_mises_min"], 1, delta=1e-12)
                    self.assertAlmostEqual(final["von_mises_max"], 1, delta=1e-12)

    def test_a_tool_moves_the_side_that_is_tied_to_it(self):
        values = self.values(self.solved(HEAD))
        self.assertAlmostEqual(values["push"], 0.3, delta=1e-10)
        # of -t at (1, 1), and of the forces there
        self.assertAlmostEqual(values["moment"], 1 + 0.5 + 0.3, delta=1e-10)
        self.assertLess(values["turn"], -1e-3)

    def test_a_solid_that_is_cut_equals_the_whole_one(self):
        for degree in (1, 2):
            def text(top, layers, loaded, cut, last):
                return (SPACE.replace("DEGREE", str(degree)).replace("TOP", str(top))
                        .replace("LAYERS", str(layers)).replace("LOADED", loaded).replace("CUT", cut)
                        .replace("LAST", last))
            whole = self.values(self.solved(text(2, 8, ', { label = "top", tx = 1 }', "", "lower")))["corner"]
            cut = self.values(self.solved(text(1, 4, "", UPPER, "upper")))["corner"]
            self.assertLess(abs(cut/whole - 1), 0.04 if degree == 1 else 0.003)

    def test_both_sides_of_a_tie_that_is_apart_have_one_force(self):
        for gap in (0, 0.1):
            summary = self.solved(CORNERS.replace("GAP", str(gap)))
            values = self.values(summary)
            self.assertAlmostEqual(values["above"]/values["below"], -1, delta=1e-11)
            # by which the coarse mesh is off a finer one
            fine = self.values(self.solved(CORNERS.replace("GAP", str(gap)).replace("8, 16", "24, 48")
                                           .replace("22, 11", "44, 22")))
            error = summary["quantities"]["above"]["estimated_error"]
            self.assertLess(abs(values["above"] - fine["above"]), 2*error)
            self.assertLess(error, 0.3*abs(values["above"]))

    def test_a_peak_at_a_corner_between_tied_bodies_has_no_estimate(self):
        self.write(CORNERS.replace("GAP", "0"))
        for degree in (1, 2):
            told = self.mortier("run", "scene.toml", "--out", "out", "--set", f"degree={degree}").stdout
            self.assertRegex(told, r"peak .* \(no (estimate|limit): stresses (may be|are) unbounded there")
            self.assertNotIn("overlap by", told)  # what is left of the jump at the ends

    def test_an_overlap_beside_a_tie_is_found(self):
        self.write(ARCH)
        told = self.mortier("run", "scene.toml", "--quiet", "--out", "out", code=1).stderr
        self.assertRegex(told, r"overlap by 0\.3 at \(-1\.")

    def test_freefem_agrees_on_a_tie_beside_contact_with_friction(self):
        self.write(LAYER)
        for options in ((), ("--set", "contact.variant=mortar"), ("--set", "contact.variant=interpolation")):
            with self.subTest(options=options):
                self.mortier("compare", "scene.toml", *options)

    def test_freefem_agrees_on_ties_beside_contact_that_slides_far(self):
        for pushed, held, below in ((BODY, BOTTOM, ""), (TOOL, BOTTOM, ""), (BODY, BASE, BELOW)):
            with self.subTest(pushed=pushed, below=below):
                self.write(SLIDER.replace("PUSHED", pushed).replace("HELD", held).replace("SECOND", below))
                self.mortier("compare", "scene.toml")

    def test_what_a_tie_refuses(self):
        self.write(HEAD)
        for setting, message in (
                ("contact.friction=0.1", "friction = 0.1, expected none beside kind"),
                ('contact.sliding="finite"', 'sliding = "finite", expected none beside kind'),
                ("contact.gap=0.1", "gap = 0.1, expected none beside kind"),
                ('contact.initial="close"', 'initial = "close", expected none beside kind'),
                ('contact.kind="glued"', 'kind = "glued", expected one of unilateral, tied'),
                ("accuracy={energy=0.1, bound=true}", "expected none beside accuracy.bound")):
            with self.subTest(setting=setting):
                done = self.mortier("run", "scene.toml", "--set", setting, code=2)
                self.assertIn(message, done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1)

    def test_check_names_ties_that_are_far_apart_or_cover_little(self):
        self.write(HEAD.replace("lower = [0, 1]", "lower = [1.7, 1.8]").replace("upper = [2, 1.5]",
                                                                               "upper = [2.5, 2.5]"))
        told = self.mortier("check", "scene.toml").stdout
        self.assertRegex(told, r"the tie covers 0\.15 of the side of body block; .*\[contact-overlap\]")
        self.assertRegex(told, r"the sides of the tie are up to 0\.8 m apart, .*\[gap-large\]")
        self.write(HEAD)
        self.assertIn("0 errors, 0 warnings", self.mortier("check", "scene.toml").stdout)

    def test_tied_bodies_that_nothing_holds_are_told(self):
        self.write(RINGS.replace("DEGREE", "1").replace("CELLS", "8, 3").replace("OTHERS", "11, 4")
                   .replace("VARIANT", "").replace(", { label = 3, uy = 0 }", "")
                   .replace("{ label = 3, uy = 0 }, ", ""))
        done = self.mortier("run", "scene.toml", code=3)
        self.assertRegex(done.stderr, r"body inner: translation along \(0, (-?1)\), "
                                      r"body outer: translation along \(0, \1\)")


if __name__ == "__main__":
    unittest.main()
