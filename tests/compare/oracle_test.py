"""mortier and FreeFEM agree on the scenes; faults of the FreeFEM method that the compression test does not
see are caught."""
import shutil
import tempfile
import unittest
from pathlib import Path

import support
from both import compare_all, compare_runs
from cases import FEW, SCENES, UNKNOWN_TO_FREEFEM, SceneCase, scene_cases
from codes import RunError, run_freefem, run_mortier
from compare import compare
from shape_scenes import GEOMETRY_KEYS, PARTS_GEO

COMPRESSION = SceneCase("compression", "interpolation", changes=(*FEW, "time.steps=3"))


class Oracle(unittest.TestCase):
    def test_codes_agree(self):
        for row in compare_all(scene_cases()):
            with self.subTest(row["case"]):
                self.assertTrue(row["agree"], row["verdict"])

    def test_every_scene_is_compared_or_refused(self):
        scenes = {path.stem for path in (support.ROOT / "scenes").glob("*.toml")}
        self.assertEqual(scenes, {"compression"} | SCENES.keys() | UNKNOWN_TO_FREEFEM.keys())

    def test_bodies_that_are_regions_of_a_geometry(self):
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            (folder / "parts.geo").write_text(PARTS_GEO)
            (folder / "scene.toml").write_text(GEOMETRY_KEYS.replace("tx = -6", "tx = \"-6*y\""))
            row = compare_runs(folder, [], folder / "scene.toml")
        self.assertTrue(row["agree"], row["verdict"])

    def test_what_freefem_does_not_know_is_refused(self):
        for name, reason in UNKNOWN_TO_FREEFEM.items():
            self.refused(reason, name)
        self.refused("scheme = sdirk2, expected backward-euler", "open-close")

    def refused(self, reason, name, *arguments):
        with self.subTest(name, arguments=arguments):
            done = support.mortier("freefem", f"scenes/{name}.toml", *arguments, cwd=support.ROOT)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertRegex(done.stderr, rf"\Amortier: [^\n]*: {reason}[^\n]*\n\Z")


# Fault, file, right words, wrong words, scene and what marks its case, what then differs (empty:
# or FreeFEM gives up).
FAULTS = [
    ("normals mirrored", "supports", "dx = dy; dy = -tx;", "dx = dy; dy = tx;", "turned", "as it stands",
     "displacement"),
    ("normal for tangent", "supports", "rollerAlong(r) == normal", "rollerAlong(r) == tangent", "turned",
     "sheared", ""),
    ("normals of sides on a circle", "supports", "cos(40*pi/180)", "2", "cut-ring", "as it stands",
     "displacement"),
    ("no circle at the end of a roller", "supports", "&& smooth(v, to, b)", "&& false", "cut-ring",
     "normal and", "displacement"),
    ("rollers do not move", "loop", "g0(nc + i) = rowValue(i);", "g0(nc + i) = 0;", "turned", "bent",
     "displacement"),
    ("one roller at a corner", "supports", "hold(v, dx, dy);\n", "hold(v, dx, dy); held(v) = 2;\n", "turned",
     "as it stands", ""),
    ("normal of a level line", "lines", "normalX(i) = side*dy/length; normalY(i) = -side*dx/length;",
     "normalX(i) = 0; normalY(i) = -side;", "sloped", "as it stands", ""),
    ("falling lines that rise", "lines", "dx = cx; dy = cy;", "dx = cx; dy = abs(cy);", "broken-line",
     "as it stands", ""),
    ("one normal for each element", "lines", "nHereX = (1 - xi)*dirX(e) + xi*dirX(e + 1)",
     "nHereX = dirX(e)", "ring", "mortar as it stands", "displacement"),
    ("normal of the chord at the end of a curve", "lines", "if (flat) {", "if (flat || i == 0) {", "ring",
     "mortar as it stands", "displacement"),
    ("direction of the nonmortar normal", "lines", "k1(i)/(k1(i) + kb) : 0.5;", "0 : 0;", "hertz",
     "mortar as it stands", "nodes"),
    ("direction of the mean normal", "lines", "k1(i)/(k1(i) + kb) : 0.5;", "0.5 : 0.5;", "hertz",
     "mortar as it stands", "displacement"),
    ("distance of the polygon", "lines", "- bulge(circle1, a, b, phi, nHereX, nHereY)", "", "hertz",
     "mortar as it stands", "displacement"),
    ("distance of the other polygon", "lines", "- bulge(circle2, c, d, psi, -nHereX, -nHereY)", "- 0.",
     "hertz", "sides swapped", "displacement"),
    ("points of no rule", "coupling", "[1., 0.830223896278567, 0.468848793470714, 0.]",
     "[1., 0.8, 0.4, 0.]", "hertz", "mortar as it stands", "displacement"),
    ("mortar point by the abscissa", "lines", "psi = 1 - partAlong(",
     "psi = (s2(e2 + 1) - s)/(s2(e2 + 1) - s2(e2)) + 0*partAlong(",
     "ring", "mortar as it stands", "displacement"),
    ("row functions end with the hats", "coupling", "row(e1 + 1) < 0 ? 1. : part, ", "part, ", "punch",
     "sides swapped", "displacement"),
    ("conditions at held ends", "coupling", "paired = paired && !(merged",
     "paired = paired || false && !(merged", "stack",
     "mortar held", ""),
    ("no conditions at held ends", "coupling", '(variant != "interpolation" || mortarHeld)', "true", "stack",
     "interpolation held", ""),
    ("given distance not read", "coupling", "g = givenGap(c, vn(rowAt(r)));", "g = R(r, last);", "sloped",
     "parted", "displacement"),
    ("distance projected", "coupling", "g += min(lift, ", "g += 0*min(lift, ", "hertz",
     "mortar as it stands", "displacement"),
    ("given distance not in the interpenetration", "coupling", "cutGap(cuts) += N1(k)*givenGap(c, node)",
     "cutGap(cuts) += 0*givenGap(c, node)", "sloped", "parted", "interpenetration"),
    ("held points do not move", "supports", "= w[](theirs(pointDof(pointCount)/2))",
     "= 0*w[](theirs(pointDof(pointCount)/2))", "stack", "interpolation held at points", "displacement"),
    ("the vertex furthest from a held point", "supports", "< (xv(nearest) - (a))^2",
     "> (xv(nearest) - (a))^2", "stack", "interpolation held at points", "displacement"),
    ("another rule for tractions", "supports", "qf1pElump", "qf1pE", "eccentric-punch", "as it stands",
     "displacement"),
    ("another rule for body forces", "supports", "qf2pT)(depth*(load))", "qf1pT)(depth*(load))", "turned",
     "bent", "displacement"),
    ("stress out of the plane in no yield condition", "bodies", "real ap = inStrain ? 1.5 : 0.5",
     "real ap = 0.5", "thick-cylinder", "mortar as it stands", "displacement"),
    ("stress out of the plane of its deviator only", "loop", '" " << (v - 2*P)/sqrt(6.)',
     '" " << -2*P/sqrt(6.)', "thick-cylinder", "mortar as it stands", "stress"),
    ("moduli of plane stress", "bodies", "if (inStrain) { eP[b] = eQ[b]; ", "if (inStrain) { ",
     "turned", "plane strain", "displacement"),
    ("pressure forgotten from step to step", "loop", "sr0 = sr; sv0 = sv;", "sr0 = sr;", "thick-cylinder",
     "mortar as it stands", ""),
    ("no strain around the axis", "strain", "Vh(i*nq + at) = shape/radius(at);", "Vh(i*nq + at) = 0;",
     "sphere", "mortar as it stands", ""),
    ("a section for a ring", "strain", "radius *= 2*pi;", "radius = 1;", "sphere", "mortar as it stands", ""),
    ("contact of a section", "coupling", "// along the line\n      if (ring) weight *= ",
     "// along the line\n      if (false) weight *= ", "sphere", "mortar as it stands", "displacement"),
    ("tractions on a section", "supports", "qfe = qf1pElump)(depth*(load)/3.)", "qfe = qf1pElump)((load)/3.)",
     "sloped", "a cone that flows", "displacement"),
    ("contact that pulls", "contact", "p(i) < -tinyForce", "false", "open-close", "as it stands", ""),
    ("tangent turned the other way", "rows", "second ? 0 - entryV(e) : entryV(e)",
     "second ? entryV(e) : 0 - entryV(e)", "sloped", "mortar friction", "friction"),
    ("slip from the beginning", "system", "tiedRow(i) ? 0. : Cu(i)", "0*Cu(i)", "sloped",
     "mortar friction", ""),
    ("bound of pressures for forces", "friction", "*rowLength(normalOf(row))", "*1", "stack",
     "mortar friction", ""),
    ("slip that goes on against t", "friction", "side*gd(i) < -tinySlip", "false", "sloped",
     "mortar friction", ""),
    ("half the flow of a user-defined law", "law", "ownPoint(b, q*nt + T, thetaScale*k)",
     "ownPoint(b, q*nt + T, thetaScale*k/2)", "turned", "user law of the strain", "displacement"),
    ("strain of the step for that of all", "own_law", "strainP(q) + sp0(q)*compP(q) + vp0(q)", "strainP(q)",
     "turned", "user law of the strain", "displacement"),
    ("contact where the step was guessed", "loop", "followTo(there);\n    its", "its", "sloped",
     "off the end, follows", ""),
    ("normals of the softer body", "lines", "k1 = softer ? 1. : 0.; k2 = softer ? 0. : 1.;",
     "k1 = softer ? 0. : 1.; k2 = softer ? 1. : 0.;", "sloped",
     "the upper one stiffer, follows", "displacement"),
    ("force of a tool without its arm", "supports", "push2*(ax - xv(a))*value2", "0*value2", "cone",
     "a force and a moment move", ""),
    ("third body as the second", "bodies", "eP[b] = young[b]", "eP[b] = young[min(b, 1)]", "stack",
     "as it stands", "displacement"),
]


class FaultsOfTheMethod(support.InSharedFolder):
    """Each is seen by a scene, and not by the compression test."""

    def test_each_is_caught(self):
        for fault, file, right, wrong, scene, what, quantity in FAULTS:
            with self.subTest(fault):
                method = self.folder / "method"
                shutil.copytree(support.ROOT / "freefem", method, dirs_exist_ok=True)
                self.assertTrue(self.put(method, file, right, wrong))
                case = next(case for case in scene_cases() if case.name == scene and what in str(case))
                self.assertRegex(self.verdict(case, method),
                                 rf"\ADIFFER: .*{quantity}" if quantity else r"\A(DIFFER|FAILED): ")

    def test_the_compression_test_sees_none(self):
        """As many in one method as have places of their own."""
        left = [fault[1:4] for fault in FAULTS]
        while left:
            method = self.folder / f"method-{len(left)}"
            shutil.copytree(support.ROOT / "freefem", method)
            others = [each for each in left if not self.put(method, *each)]
            self.assertLess(len(others), len(left))
            self.assertEqual(self.verdict(COMPRESSION, method), "agree")
            left = others

    def put(self, method, file, right, wrong):
        """Whether the right words are there to be replaced."""
        path = method / f"{file}.idp"
        text = path.read_text()
        path.write_text(text.replace(right, wrong, 1))
        return right in text

    ours = {}  # runs of mortier, by case

    def verdict(self, case, method):
        """On FreeFEM's run with this method, in words."""
        if case not in self.ours:
            self.ours[case] = run_mortier(self.folder / f"mortier-{len(self.ours)}", case.settings,
                                          case.scene)
        try:
            return str(compare(self.ours[case], run_freefem(self.folder / "freefem", case.settings,
                                                            case.scene, method)))
        except RunError as error:
            return f"FAILED: {error}"


if __name__ == "__main__":
    unittest.main()
