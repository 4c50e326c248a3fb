"""Scenes in space: what is exact, what is refused, files and messages."""
import signal
import subprocess
import time
import unittest

import meshio
import numpy as np

from scene_parts import body, box, contact, quantity, timed
from support import PROGRAM, ROOT, InFolder, mortier, values
from results import read_csv

# The note's compression test of two cubes; the stress is (0, 0, -10 t) and flows from t = 0.1 on.
CUBES = ("dimension = 3\n"
         + body("upper", box([0, 0, 0], [1, 1, 1], 2),
                "young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1", 'label = "left", ux = 0',
                'label = "front", uy = 0', 'label = "top", tz = "-10*t"')
         + body("lower", box([0, 0, -1], [1, 1, 0], 3),
                "young = 3e11, poisson = 0.3, viscosity = 10, yield_stress = 1", 'label = "left", ux = 0',
                'label = "front", uy = 0', 'label = "bottom", uz = 0')
         + contact(("upper", "bottom"), ("lower", "top"))
         + quantity("top", "displacement", "upper", "top", "z")
         + quantity("corner", "displacement", "upper", component="z", point=[1, 1, 1])
         + quantity("floor", "reaction", "lower", "bottom", "z")
         + quantity("pressed", "contact_force", "lower", "top", "z")
         + quantity("pressure", "largest_pressure", "upper", "bottom")
         + quantity("stored", "stored_energy", "upper") + timed(20))
# By backward Euler: the rate along z is (2/3 s - 2/3)/(2 lambda) beyond the yield stress 1.
TOP = -2 * sum(0.05 * 2 / 3 * (0.5 * n - 1) / 20 for n in range(3, 21))
SOFT = ["body.material={young=100, poisson=0.3}"]


class Space(InFolder):
    def setUp(self):
        super().setUp()
        self.write(CUBES)

    def run_scene(self, *settings):
        summary = self.run_it(None, *settings)
        return summary, values(summary)

    def test_compression_is_exact(self):
        for settings in (["contact.variant=weighted"], ["contact.variant=mortar"], ["contact.swap=true"],
                         ["degree=2"]):
            with self.subTest(settings):
                swapped = "contact.swap=true" in settings
                if swapped:
                    settings.append("quantity.pressure.largest_pressure.body=lower")
                    settings.append("quantity.pressure.largest_pressure.label=top")
                summary, values = self.run_scene(*settings)
                for name, exact in {"top": TOP, "corner": TOP, "floor": 10, "pressed": -10, "pressure": 10,
                                    "stored": 100 / 2 / 3e11}.items():
                    self.assertAlmostEqual(values[name] / exact, 1, delta=2e-6, msg=name)
                self.assertEqual(summary["plane"], "space")
                nodes = summary["interfaces"][0]["nonmortar_nodes"]
                self.assertEqual(summary["final"]["active_nodes"], nodes)
                cells = meshio.read(self.folder / "out" / "upper_000020.vtu").cell_data
                stress = cells["stress"][0]
                np.testing.assert_allclose(stress, np.tile([0, 0, -10, 0, 0, 0], (len(stress), 1)), atol=2e-5)

    def test_files_name_the_third_component(self):
        self.run_scene(*SOFT, "output.every=10")
        history = read_csv(self.folder / "out" / "history.csv")
        self.assertAlmostEqual(float(history[-1]["contact_resultant_z[N]"]), 10, delta=1e-9)
        self.assertIn("penetration[m^3]", history[0])
        contact = read_csv(self.folder / "out" / "contact.csv")
        self.assertEqual({row["z"] for row in contact}, {"0"})
        self.assertEqual(len(contact), 3 * 9)
        mesh = meshio.read(self.folder / "out" / "lower_000020.vtu")
        self.assertEqual(mesh.cells[0].type, "tetra")
        self.assertEqual(len(mesh.cells[0].data), 6 * 27)
        # u = (nu, nu, 1) times -s/E z within a body of one stress
        np.testing.assert_allclose(mesh.point_data["displacement"][:, 2],
                                   -0.1 * (mesh.points[:, 2] + 1), atol=1e-12)

    def test_data_hold_z(self):
        # A body force that a varying traction balances: s33 = -(1 - z^2)/2 t along the column.
        self.write("dimension = 3\ndegree = 2\n"
                   + body("column", box([0, 0, 0], [1, 1, 1], [1, 1, 6]), "young = 1, poisson = 0",
                          'label = "bottom", uz = 0', 'label = "left", ux = 0', 'label = "front", uy = 0',
                          force={"z": "-z*t"}) + quantity("floor", "reaction", "column", 1, "z")
                   + quantity("top", "displacement", "column", 3, "z") + timed())
        _, values = self.run_scene()
        self.assertAlmostEqual(values["floor"], 0.5, delta=1e-12)
        self.assertAlmostEqual(values["top"], -1 / 3, delta=1e-12)

    def test_what_is_of_the_plane_is_refused(self):
        for setting, message in (
                ("plane=strain", "plane = \"strain\", expected none with dimension = 3"),
                ("accuracy={energy=0.1, bound=true}", "bound = true, expected none with dimension = 3"),
                ('accuracy={quantity="floor", tolerance=0.1}', 'quantity = "floor", expected'),
                ("solver.method=penalty-duality", "penalty-duality"),
                ('body.upper.boundary.left.ut=0', "ut = 0, expected none with dimension = 3"),
                ("dimension=4", "dimension = 4, expected 2 or 3"),
                ("body.upper.boundary.top.tz=w", "expected an expression in x, y, z, t"),
                ("quantity.corner.displacement.point=[1, 1]", "expected three numbers, [x, y, z]"),
                ("quantity.corner.displacement.point=[2, 1, 1]", "expected a point of body upper"),
                ("body.upper.boundary.left.label=nowhere", "expected one of back, bottom, front"),
                ("body.upper.mesh.cells=0", "cells = 0, expected N or [NX, NY, NZ]"),
                ('body.upper.mesh={shape="rectangle", cells=2}', "expected cuboid, cylinder, ball")):
            with self.subTest(setting):
                said = self.mortier("run", "scene.toml", "--out", "out", "--set", setting, code=2).stderr
                self.assertIn(message, said)
                checked = mortier("check", "scene.toml", "--set", setting, cwd=self.folder)
                self.assertEqual(checked.returncode, 2)
                self.assertIn(message, checked.stdout)
        self.assertFalse((self.folder / "out").exists())

    def test_what_is_of_space_is_refused_in_the_plane(self):
        self.write(CUBES.replace("dimension = 3\n", ""))
        said = self.mortier("run", "scene.toml", code=2).stderr
        self.assertIn("expected", said)
        self.write(body("plate", box([0, 0], [1, 1], 2), 1, "label = 1, ux = 0, uy = 0",
                        'label = 3, ty = "-1"') + timed())
        for setting, message in (("body.plate.boundary.3.tz=1", "tz = 1, expected it with dimension = 3"),
                                 ("body.plate.boundary.3.ty=z", "expected an expression in x, y, t"),
                                 ("body.plate.mesh.shape=cuboid", "dimension = 3"),
                                 ("body.plate.force={z=1}", "z = 1, expected it with dimension = 3 only")):
            with self.subTest(setting):
                self.assertIn(message, self.mortier("run", "scene.toml", "--set", setting, code=2).stderr)

    def test_displacements_that_contradict_each_other_are_named(self):
        said = self.mortier("run", "scene.toml", "--set", "body.lower.boundary.left.uz=0.1", code=2).stderr
        self.assertRegex(said, r"uz = .* expected the 0(.1)? that label \S+ prescribes there")

    def test_a_value_that_is_not_finite_is_named_with_its_place(self):
        said = self.mortier("run", "scene.toml", "--set", "body.upper.boundary.top.tz=1/(z-1)", code=2).stderr
        self.assertRegex(said, r"expected a finite number, is .* at x = .*, y = .*, z = 1, t = 0")

    def test_meshes_are_described_and_converted(self):
        mesh = ROOT / "shared-meshes" / "upper-cube-3.mesh"
        said = self.mortier("mesh", "info", mesh).stdout
        self.assertRegex(said, r"vertices +64\ntetrahedra 162\nvolume +1\n")
        self.assertRegex(said, r"label 3 +18 triangles, area 1, top: x 0 \.\. 1, y 0 \.\. 1, z 1\n")
        self.assertRegex(said, r"region \d+ +162 tetrahedra")
        self.mortier("mesh", "convert", mesh, "copy.mesh")
        copy = self.mortier("mesh", "info", "copy.mesh").stdout
        self.assertEqual(copy.split("\n")[1:], said.split("\n")[1:])
        self.assertIn("expected", self.mortier("mesh", "info", "scene.toml", code=2).stderr)

    def test_check_says_what_a_run_models(self):
        said = self.mortier("check", "scene.toml").stdout
        self.assertIn("bodies in space", said)
        self.assertIn("0 errors", said)

    def test_laws_are_tried_at_the_stresses_of_the_data(self):
        self.write(CUBES)
        self.assertIn("stresses up to 10 Pa", self.mortier("law", "scene.toml").stdout)
        driven = ("--set", "body.upper.boundary.top.tz=", "body.upper.boundary.top.uz=-1e-9*z*t")
        self.assertIn("stresses up to 300 Pa", self.mortier("law", "scene.toml", *driven).stdout)

    def test_laws_are_tried_at_the_stresses_of_each_kind_of_datum(self):
        """Of cubes of size 1 and Young's modulus 100."""
        self.write(CUBES)
        still = ["body.upper.boundary.top.tz=0", *SOFT]
        for settings, stress in (
                (["body.upper.force={z='-2.5*z*t'}"], 2.5),  # times the size
                (["body.material.expansion=1e-3", "body.upper.temperature='10*(1 + z)*t'"], 2),
                (["body.upper.point=[{at=[1, 1, 1], uz='-0.04*t'}]"], 4),  # over the size, times E
                (["contact.gap='0.01 - 0.03*x*t'"], 3),  # what it changes by
                (["body.upper.boundary.top.tz='-6*x*t'"], 6)):
            with self.subTest(settings):
                words = [word for each in still + settings for word in ("--set", each)]
                said = self.mortier("law", "scene.toml", *words).stdout
                self.assertIn(f"stresses up to {stress} Pa", said)
        self.reject("scene.toml: no datum of the scene asks for a stress, expected --stress", "law",
                    "scene.toml", *[word for each in still for word in ("--set", each)])

    def test_studies_refuse_errors_of_fields_before_they_run(self):
        self.write(CUBES)
        study = ('scene = "scene.toml"\n[[error]]\nquantity = "energy"\n[reference]\nsteps = 4\n'
                 "[[sweep]]\nsteps = [1, 2]\n")
        self.write(study, "study.toml")
        self.reject('study.toml:3: error 0: quantity = "energy", expected one of von_mises_min,', "study",
                    "study.toml", "--quiet", "--out", "studied")
        self.write(study.replace("energy", "displacement_min_z"), "study.toml")
        self.mortier("study", "study.toml", "--quiet", "--jobs", "1", "--out", "studied")

    def test_linear_tetrahedra_that_lock_are_named(self):
        for settings, fault in ((["body.lower.material={young=1, poisson=0.4999}"], "poisson-limit"),
                                ([], "flow-locks")):
            with self.subTest(fault):
                every = [word for each in settings for word in ("--set", each)]
                checked = self.mortier("check", "scene.toml", *every).stdout
                self.assertNotIn(fault, checked)
                self.assertIn("volumetric strain averaged over patches of tetrahedra", checked)
                every += ["--set", "body.volume=pointwise"]
                checked = self.mortier("check", "scene.toml", *every).stdout
                self.assertIn(fault, checked)
                self.assertRegex(checked, "linear tetrahedra (lock|is nearly incompressible)")
                done = self.mortier("run", "scene.toml", "--out", "out", "--quiet", *every)
                self.assertIn(fault, done.stderr)
                checked = self.mortier("check", "scene.toml", "--set", "degree=2", *every).stdout
                self.assertNotIn(fault, checked)

    def test_quadratic_tetrahedra_are_not_averaged(self):
        said = self.mortier("run", "scene.toml", "--set", "degree=2", "body.upper.volume=averaged",
                            code=2).stderr
        self.assertIn('volume = "averaged", expected pointwise with degree = 2: quadratic tetrahedra do not '
                      "lock", said)
        checked = self.mortier("check", "scene.toml", "--set", "degree=2").stdout
        self.assertNotIn("volumetric strain averaged", checked)

    def test_a_run_is_resumed_to_the_last_bit(self):
        settings = ["--set", "body.material={young=100, poisson=0.3, viscosity=1, yield_stress=1}",
                    "time.steps=400"]
        command = ["run", "scene.toml", "--quiet", "--checkpoint", "0", *settings]
        self.mortier(*command, "--out", "whole")
        with subprocess.Popen([PROGRAM, *command, "--out", "out"], cwd=self.folder,
                              stderr=subprocess.DEVNULL) as run:
            while run.poll() is None and not list(self.folder.glob("out.tmp-*/checkpoint")):
                time.sleep(0.01)
            run.send_signal(signal.SIGINT)
        self.assertEqual(run.returncode, 1)
        self.mortier("run", "--restart", "out", "--quiet")
        self.assertEqual(self.read("out/history.csv"), self.read("whole/history.csv"))
        self.assertEqual(self.read("out/contact.csv"), self.read("whole/contact.csv"))


# A column under a load that varies, on a wider block.
ADAPTED = ("dimension = 3\n"
           + body("upper", box([0, 0, 0], [1, 1, 1], 2), 1, 'label = "left", ux = 0',
                  'label = "front", uy = 0', 'label = "top", tz = "-t*(1+x)/100"')
           + body("lower", box([0, 0, -1], [1.5, 1, 0], [3, 2, 2]), 3, 'label = "left", ux = 0',
                  'label = "front", uy = 0', 'label = "bottom", uz = 0')
           + contact(("upper", "bottom"), ("lower", "top"), sides=True)
           + quantity("floor", "reaction", "lower", "bottom", "z") + timed())


class Accuracy(InFolder):
    def setUp(self):
        super().setUp()
        self.write(ADAPTED)

    def run_to(self, accuracy, *arguments, code=0):
        done = self.mortier("run", "scene.toml", "--out", "out", "--accuracy", str(accuracy), *arguments,
                            code=code)
        return done, self.summary_of()

    def test_is_reached_and_told(self):
        done, summary = self.run_to(0.2)
        accuracy, rounds = summary["accuracy"], summary["rounds"]
        self.assertTrue(accuracy["reached"])
        self.assertEqual(accuracy["asked"], 0.2)
        self.assertEqual(accuracy["time"], 0)
        self.assertLessEqual(accuracy["mesh"], 0.2)
        self.assertEqual(accuracy["mesh"], rounds[-1]["mesh"])
        self.assertGreater(rounds[-1]["tetrahedra"], 2*rounds[0]["tetrahedra"])
        self.assertEqual(rounds[-1]["tetrahedra"], summary["tetrahedra"])
        self.assertEqual(rounds[-1]["unknowns"], summary["free_dofs"])
        self.assertIn("round tetrahedra  unknowns", done.stdout)
        self.assertAlmostEqual(summary["quantities"]["floor"]["value"], 0.015, delta=1e-11)
        # The meshes of the result: what is in its fields, with labels and their areas.
        for name, area in (("upper", 1), ("lower", 1.5)):
            said = self.mortier("mesh", "info", f"out/{name}.mesh").stdout
            self.assertRegex(said, rf"label 3 +\d+ triangles, area {area}, top")
            self.assertIn(f"volume     {area}", said)
        # The nonmortar side is chosen on the first meshes; the last ones may have another finer side.
        def again_with(*settings):
            self.mortier("run", "scene.toml", "--out", "again", "--quiet", *settings)
            return self.summary_of("again")

        def nonmortar(of):
            return of["interfaces"][0]["nonmortar"]
        self.assertEqual(nonmortar(again_with()), nonmortar(summary))
        last = ["--set", 'body.upper.mesh="out/upper.mesh"', "--set", 'body.lower.mesh="out/lower.mesh"']
        again = again_with(*last)
        if nonmortar(again) != nonmortar(summary):
            again = again_with(*last, "--set", "contact.swap=true")
        self.assertEqual(again["dofs"], summary["dofs"])
        self.assertAlmostEqual(again["accuracy"]["energy_error"]/accuracy["energy_error"], 1, delta=1e-6)

    def test_is_given_up_at_the_most_unknowns(self):
        done, summary = self.run_to(0.01, "--max-unknowns", "3000", code=1)
        self.assertIn("accuracy 0.01 not reached: a further round would have more unknowns", done.stderr)
        self.assertFalse(summary["accuracy"]["reached"])
        self.assertLessEqual(summary["dofs"], 3000)
        self.assertGreater(len(summary["rounds"]), 1)

    def test_steps_of_flowing_bodies_are_chosen_by_their_error(self):
        _, summary = self.run_to(0.3, "--set", "body.upper.material={young=1, poisson=0.3, viscosity=0.01, "
                                 "yield_stress=0.01}", "--set", "time.steps=5", "--set", "degree=2")
        accuracy = summary["accuracy"]
        self.assertTrue(accuracy["reached"])
        self.assertGreater(summary["steps"], 5)
        self.assertTrue(0 < accuracy["time"] <= 0.25*0.3, accuracy["time"])
        self.assertFalse(any("steps" in each for each in accuracy["not_reliable"]))

    def test_checks_and_views_know_the_rounds(self):
        self.run_to(0.3)
        said = self.mortier("check", "scene.toml", "--accuracy", "0.3").stdout
        self.assertIn("rounds on meshes that are refined", said)
        self.mortier("report", "out", "--out", "report.html")
        self.assertIn("Rounds of refinement", self.read("report.html"))


if __name__ == "__main__":
    unittest.main()
