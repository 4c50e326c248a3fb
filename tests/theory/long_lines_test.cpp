// Contact without dense matrices over its conditions against contact with them.
#include <gtest/gtest.h>

#include <iostream>

#include "theory/random_line.h"
#include "theory/random_scene.h"

namespace mortier {
namespace {

using namespace scenes;

/// Of an elastic step, which is one linear solve; others are solved to SolverOptions::tolerance of the
/// stress, and contact forces of thin layers make more of that.
constexpr double tolerance = 1e-10;
constexpr double toleranceOfLaws = 1e-6;

TEST(LongLines, randomLinesAgreeWithDenseMatrices) {
  constexpr int count = 150;
  double force = 0;
  double displacement = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    const RandomLine line = randomLine(seed, 12);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + line.words);
    const Difference difference = denseAndSparse(line);
    EXPECT_TRUE(difference.sameEnd);
    EXPECT_LE(difference.force, line.elastic ? tolerance : toleranceOfLaws);
    EXPECT_LE(difference.displacement, line.elastic ? tolerance : toleranceOfLaws);
    if (!line.elastic) continue;
    force = std::max(force, difference.force);
    displacement = std::max(displacement, difference.displacement);
  }
  std::cout << count << " random lines, elastic ones: forces agree to " << force << ", displacements to "
            << displacement << "\n";
}

TEST(LongLines, randomScenesAgreeWithTrialOfAllActiveSets) {
  constexpr int count = 500;
  SolverOptions options;
  options.denseEntries = 0;
  double worst = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const RandomScene scene(seed);
    const Model model = scene.model();
    const auto exact = scene.solve(model.interfaces[0]);
    ASSERT_TRUE(exact.has_value());
    const auto [state, report] = run(model, 1, 1, options);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    const double force = (state.contactForce[0] - exact->p).cwiseAbs().maxCoeff() /
                         std::max(exact->scale, std::numeric_limits<double>::min());
    EXPECT_LE(force, 1e-9);
    worst = std::max(worst, force);
  }
  std::cout << count << " random scenes: forces agree to " << worst << "\n";
}

}  // namespace
}  // namespace mortier
