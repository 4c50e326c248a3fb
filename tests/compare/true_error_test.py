"""The accuracy that a run promises against the true error, from far better solutions of the same scenes; and
what quadratic displacements are worth where bodies flow."""
import unittest

import accuracies

LEAST, MOST = 0.9, 1.3  # estimate over true error


class TrueError(unittest.TestCase):
    def test_it_is_below_what_was_asked_and_near_the_estimate(self):
        scenes = accuracies.cases()
        for name in ("pressed 1", "pressed 1e-06, swapped", "shrink fit 0.001", "shrink fit 1",
                     "shrink fit 1000, swapped", "ring stress pressure", "ring strain shear",
                     "flow square strain -4*t*x*x", "flow cylinder 0.75 1.0"):
            with self.subTest(name):
                scene, bodies, accuracy = scenes[name]
                unknowns, error, estimate, overhead, reached = accuracies.measured(scene, bodies, accuracy,
                                                                                   2, 4)
                print(f"{name}: {unknowns} unknowns, error {error:.3g} of {accuracy}, "
                      f"estimate over it {estimate / error:.2f}, overhead {overhead:.2f}")
                self.assertTrue(reached)
                self.assertLessEqual(error, accuracy)
                self.assertGreaterEqual(estimate / error, LEAST)
                self.assertLessEqual(estimate / error, MOST)
                self.assertLessEqual(overhead, 3)

    def test_pressures_that_the_other_body_does_not_resolve_count(self):
        # The body on top has one edge on the contact line: its stress is uniform, whatever presses it.
        scene, bodies, accuracy, degree = accuracies.random_case(31)
        _, error, estimate, _, reached = accuracies.measured(scene, bodies, accuracy, degree, 6)
        print(f"error {error:.3g} of {accuracy:.3g}, estimate over it {estimate / error:.2f}")
        self.assertTrue(reached)
        self.assertLessEqual(error, accuracy)
        self.assertGreaterEqual(estimate / error, LEAST)
        self.assertLessEqual(estimate / error, MOST)

    def test_quadratic_displacements_take_a_hundredth_of_the_unknowns_where_bodies_flow(self):
        found = accuracies.flow_orders({1: [4, 8, 16], 2: [3, 6, 12]}, 24)
        linear, linear_takes = accuracies.fitted(*found[1])
        quadratic, quadratic_takes = accuracies.fitted(*found[2])
        print(f"order in unknowns {linear:.2f} and {quadratic:.2f}, "
              f"unknowns for 1e-3 {linear_takes(1e-3):.3g} and {quadratic_takes(1e-3):.3g}")
        self.assertAlmostEqual(linear, -0.5, delta=0.1)
        self.assertLessEqual(quadratic, -0.8)  # -1 but for the front of the flow, where strains have a kink
        self.assertGreaterEqual(linear_takes(1e-3), 100 * quadratic_takes(1e-3))


if __name__ == "__main__":
    unittest.main()
