// Random elastic scenes must agree with a solution found by trial of all active sets.
#include <gtest/gtest.h>

#include <iostream>
#include <limits>

#include "theory/random_scene.h"

namespace mortier::random_scenes_test {

using namespace scenes;

TEST(RandomScenes, agreeWithTrialOfAllActiveSets) {
  constexpr int count = 3000;
  constexpr double tolerance = 1e-9;
  double worstForce = 0;
  double worstDisplacement = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const RandomScene scene(seed);
    const Model model = scene.model();
    const auto exact = scene.solve(model.interfaces[0]);
    ASSERT_TRUE(exact.has_value());
    const auto [state, report] = run(model, 1, 1);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    if (report.status != Status::converged) continue;
    Vector u(exact->u.size());
    u << state.bodies[0].displacement, state.bodies[1].displacement;
    const double force = (state.contactForce[0] - exact->p).cwiseAbs().maxCoeff() /
                         std::max(exact->scale, std::numeric_limits<double>::min());
    const double displacement = (u - exact->u).cwiseAbs().maxCoeff() / (1 + u.cwiseAbs().maxCoeff());
    EXPECT_LE(force, tolerance);
    EXPECT_LE(displacement, tolerance);
    worstForce = std::max(worstForce, force);
    worstDisplacement = std::max(worstDisplacement, displacement);
  }
  std::cout << count << " random scenes: forces agree to " << worstForce << ", displacements to "
            << worstDisplacement << "\n";
}

}  // namespace mortier::random_scenes_test
