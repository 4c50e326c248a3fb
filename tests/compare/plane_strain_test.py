"""plane = "strain" from the scene to the results: what it writes, says and refuses."""
import unittest

import meshio
import numpy as np

from support import OfTwoBlocks

YOUNG, POISSON = 100.0, 0.3


class PlaneStrain(OfTwoBlocks):
    def setUp(self):
        super().setUp()
        self.mixed = ["plane=strain", "time.steps=7", "body.material.young=100",
                      "body.upper.material.poisson=0.3",
                      "body.lower.material={young=100, poisson=0.3}", "contact.variant=interpolation"]

    def fields(self, *settings):
        """Of the last step, by body."""
        self.mortier("run", "scene.toml", "--out", "out", "--set", *settings)
        return {name: meshio.read(self.folder / "out" / f"{name}_000007.vtu") for name in ("upper", "lower")}

    def test_fields_have_s33(self):
        bodies = self.fields(*self.mixed)
        for name, mesh in bodies.items():
            with self.subTest(name):
                s11, s22, s12, s33 = mesh.cell_data["stress"][0].T
                e11, e22, _, e33 = mesh.cell_data["viscoplastic_strain"][0].T
                mean = (s11 + s22 + s33) / 3
                deviator = (s11 - mean)**2 + (s22 - mean)**2 + (s33 - mean)**2 + 2 * s12**2
                np.testing.assert_allclose(mesh.cell_data["von_mises"][0], np.sqrt(1.5 * deviator),
                                           rtol=1e-12)
                # eps33 = 0 of the elastic and the viscoplastic strain together, and flow keeps the volume.
                np.testing.assert_allclose((s33 - POISSON * (s11 + s22)) / YOUNG, -e33, atol=1e-12)
                np.testing.assert_allclose(e11 + e22 + e33, 0, atol=1e-12)
                self.assertEqual(bool(np.abs(e33).max() > 1e-3), name == "upper")

    def test_elastic_s33_is_poisson_times_the_rest(self):
        bodies = self.fields("plane=strain", "time.steps=7", "body.material={young=2e5, poisson=0.2}")
        for mesh in bodies.values():
            s11, s22, _, s33 = mesh.cell_data["stress"][0].T
            np.testing.assert_allclose(s33, 0.2 * (s11 + s22), atol=1e-12)
            self.assertEqual(np.abs(mesh.cell_data["viscoplastic_strain"][0]).max(), 0)

    def test_plane_is_named(self):
        for plane in ("stress", "strain"):
            out = self.mortier("run", "scene.toml", "--out", "out", "--set", f"plane={plane}").stdout
            self.assertIn(f"; plane {plane}\n", out)
            self.assertNotIn(f"plane {'strain' if plane == 'stress' else 'stress'}", out)
            self.assertEqual(self.summary_of()["plane"], plane)
        plan = self.mortier("check", "scene.toml", "--set", "plane=strain",
                            "body.upper.material.projection=elasticity").stdout
        self.assertIn("plane strain", plan)
        self.assertNotIn("plane stress", plan)
        self.assertNotIn("unsymmetric", plan)

    def test_projections_are_one(self):
        written = set()
        for projection in ("elasticity", "frobenius", "compliance"):
            self.fields(*self.mixed, f"body.upper.material.projection={projection}")
            written.add((self.folder / "out/upper_000007.vtu").read_bytes())
        self.assertEqual(len(written), 1)

    def test_bodies_of_two_laws_of_flow(self):
        """One that comes down from elasticity by a power of the overstress, on one whose law has a corner."""
        power = ('body.upper.material={young=3e11, poisson=0.3, law="viscoplastic", yield_stress=1, '
                 'reference_stress=1, reference_rate=0.05, exponent=4, kinematic_hardening=20, '
                 'isotropic_hardening=30}')
        corner = "body.lower.material={young=3e11, poisson=0.3, viscosity=10, yield_stress=1}"
        for scheme in ("backward-euler", "sdirk2", "crank-nicolson"):
            with self.subTest(scheme):
                summary = self.run_it(None, "plane=strain", "time.steps=20", f"time.scheme={scheme}", power,
                                      corner)
                self.assertLess(summary["newton_iterations"], 300)

    def test_what_is_refused(self):
        self.reject("--set plane=plain: plane = \"plain\", expected one of stress, strain",
                    "run", "scene.toml", "--set", "plane=plain", "--out", "out")
        self.reject("--set body.upper.initial_stress.s33=1: body upper: s33 = 1, expected plane = "
                    "\"strain\" beside it",
                    "run", "scene.toml", "--set", "body.upper.initial_stress.s33=1", "--out", "out")

    def test_initial_stress_across_the_plane(self):
        # -2 everywhere in the plane and -1.5 across it; the load holds it, nothing moves.
        settings = ["plane=strain", "time.steps=7", "body.material={young=100, poisson=0.3}",
                    "body.upper.boundary.3.ty=-2",
                    "body.upper.initial_stress={s22=-2, s33=-1.5}", "body.lower.initial_stress={s22=-2}"]
        bodies = self.fields(*settings)
        for name, s33 in (("upper", -1.5), ("lower", -0.6)):
            stress, triangles = bodies[name].cell_data["stress"][0], bodies[name].cells_dict["triangle"]
            np.testing.assert_allclose(stress, [[0, -2, 0, s33]] * len(triangles), atol=1e-12)
            self.assertLess(np.abs(bodies[name].point_data["displacement"]).max(), 1e-12)


if __name__ == "__main__":
    unittest.main()
