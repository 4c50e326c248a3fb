// The note's compression test against its exact solution, which backward Euler turns into a finite sum, and
// against the figures by which interpolation is known to fail.
#include <gtest/gtest.h>

#include <iostream>

#include "theory/scenes.h"

namespace mortier::compression_test {

using namespace scenes;

const char* nameOf(Projection projection) {
  return projection == Projection::elasticity  ? "elasticity"
         : projection == Projection::frobenius ? "frobenius"
                                               : "compliance";
}

/// The strains (11, 22) at time 1 after N backward Euler steps under the stress (0, -10 t, 0), in extended
/// precision and by code of its own: eps = E^-1 sigma + sum k (sigma_n - P_B sigma_n)/(2 lambda).
struct Strains {
  long double eps11 = 0;
  long double eps22 = 0;
};

Strains summedByBackwardEuler(Projection projection, int steps) {
  using Real = long double;
  const Real young = 3e11L;
  const Real nu = 0.3L;
  const Real lambda = 10;
  // Weights of (11 + 22) and (11 - 22) in the norm of the projection.
  Real wp = 1;
  Real wq = 1;
  if (projection == Projection::elasticity) {
    wp = 1 / (1 - nu);
    wq = 1 / (1 + nu);
  } else if (projection == Projection::compliance) {
    wp = 1 - nu;
    wq = 1 + nu;
  }
  Real sum11 = 0;
  Real sum22 = 0;
  for (int n = 1; n <= steps; ++n) {
    const Real s = -10 * Real(n) / steps;
    // P_B (0, s): p/(1 + m/(2 wp)), q/(1 + 3 m/(2 wq)) with p + q = 0, p - q = 2 s; von Mises^2 = (p^2 + 3
    // q^2)/4.
    const auto p = [&](Real m) { return s / (1 + m / (2 * wp)); };
    const auto q = [&](Real m) { return -s / (1 + 3 * m / (2 * wq)); };
    const auto mises = [&](Real m) { return std::sqrt((p(m) * p(m) + 3 * q(m) * q(m)) / 4); };
    if (mises(0) <= 1) continue;
    Real low = 0;
    Real high = 1e3L;
    for (int k = 0; k < 120; ++k) (mises((low + high) / 2) > 1 ? low : high) = (low + high) / 2;
    sum11 += (0 - (p(high) + q(high)) / 2) / (2 * lambda * steps);
    sum22 += (s - (p(high) - q(high)) / 2) / (2 * lambda * steps);
  }
  return {nu * 10 / young + sum11, -10 / young + sum22};
}

struct Row {
  int steps;
  Projection projection;
  double eps22;
  double eps11;
};

constexpr Row table[] = {
    {1, Projection::elasticity, -0.4431112900, 0.0369740680},
    {1, Projection::frobenius, -0.4423453964, 0.0261891184},
    {1, Projection::compliance, -0.4452402083, 0.0115361619},
    {10, Projection::elasticity, -0.2185132334, 0.0295198657},
    {10, Projection::frobenius, -0.2185530985, 0.0203481756},
    {10, Projection::compliance, -0.2212285539, 0.0089208923},
    {20, Projection::elasticity, -0.2073550266, 0.0287569292},
    {20, Projection::frobenius, -0.2074345872, 0.0198154541},
    {20, Projection::compliance, -0.2100673888, 0.0086938336},
    {100, Projection::elasticity, -0.1984669285, 0.0280686451},
    {100, Projection::frobenius, -0.1985678783, 0.0193310316},
    {100, Projection::compliance, -0.2011523410, 0.0084836107},
};

TEST(Compression, tableAgreesWithTheSum) {
  constexpr double lastDigit = 0.51e-10;
  for (const Row& row : table) {
    const Strains sum = summedByBackwardEuler(row.projection, row.steps);
    EXPECT_NEAR(static_cast<double>(sum.eps22), row.eps22, lastDigit);
    EXPECT_NEAR(static_cast<double>(sum.eps11), row.eps11, lastDigit);
  }
}

// Upper 6 x 6, lower 16 x 16: the stress is (0, -10 t, 0) in every triangle, whichever side is nonmortar.
TEST(Compression, mortarGivesTheExactSum) {
  constexpr double stressTolerance = 1e-9;         // Pa; asked for
  constexpr double gapTolerance = 1e-14;           // m^2; asked for
  constexpr double displacementTolerance = 1e-12;  // m; far beyond the nine digits asked for
  double worstStress = 0;
  double worstGap = 0;
  double worstDisplacement = 0;
  for (const Row& row : table)
    for (const int nonmortar : {upperBody, lowerBody}) {
      const Model model = compression(6, 16, perzynaMaterial(noteElasticity, noteLaw(row.projection)),
                                      CouplingKind::mortar, nonmortar);
      const auto [state, report] = run(model, 1, row.steps);
      SCOPED_TRACE(std::string(nameOf(row.projection)) + ", N = " + std::to_string(row.steps) +
                   ", nonmortar " + model.bodies[nonmortar].name());
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      const double stress = vonMisesRange(state).distance(10);
      const double gap = interpenetration(model, state);
      const Strains sum = summedByBackwardEuler(row.projection, row.steps);
      const auto onTop = [](const Point& x) { return x.y() == 1; };
      const auto onTheRight = [](const Point& x) { return x.x() == 1; };
      const double u2 = displacementRange(model.bodies[0], state.bodies[0], 1, onTop)
                            .distance(static_cast<double>(2 * sum.eps22));
      const double u1 = std::max(displacementRange(model.bodies[0], state.bodies[0], 0, onTheRight)
                                     .distance(static_cast<double>(sum.eps11)),
                                 displacementRange(model.bodies[1], state.bodies[1], 0, onTheRight)
                                     .distance(static_cast<double>(sum.eps11)));
      EXPECT_LE(stress, stressTolerance);
      EXPECT_LE(gap, gapTolerance);
      EXPECT_LE(std::max(u1, u2), displacementTolerance);
      worstStress = std::max(worstStress, stress);
      worstGap = std::max(worstGap, gap);
      worstDisplacement = std::max({worstDisplacement, u1, u2});
    }
  std::cout << "24 mortar runs: |von Mises - 10| <= " << worstStress << ", interpenetration <= " << worstGap
            << ", |u - exact| <= " << worstDisplacement << "\n";
}

struct Failure {
  const char* name;
  int steps;  ///< 0: elastic
  int nonmortar;
  double misesMin;
  double misesMax;
  double interpenetration;
  double meanOnTop;  ///< arithmetic mean over the nodes of the top
};

// Meshes exchanged, upper 16 x 16, lower 6 x 6. The elastic interpenetrations were found by sampling the jump
// of the two traces at 4.8e6 points.
TEST(Compression, interpolationFailsByTheKnownFigures) {
  const Failure failures[] = {
      {"elastic, fine nonmortar", 0, upperBody, 9.744288303, 10.21449062, 2.01733e-15, -6.66687855658e-11},
      {"elastic, coarse nonmortar", 0, lowerBody, 4.722990348, 25.20456213, 2.02757e-12, -6.86387205709e-11},
      {"N = 10, fine nonmortar", 10, upperBody, 9.754709250, 10.217161958, 1.37760e-5, -0.437122793785},
      {"N = 7, coarse nonmortar", 7, lowerBody, 4.796329466, 24.685147869, 1.33697e-2, -0.471699768615},
  };
  constexpr double digits = 1e-8;          // relative; eight digits
  constexpr double digitsOfTheGap = 5e-6;  // as many as are given
  for (const Failure& known : failures) {
    SCOPED_TRACE(known.name);
    const auto material = known.steps == 0 ? elasticMaterial(noteElasticity)
                                           : perzynaMaterial(noteElasticity, noteLaw(Projection::frobenius));
    const Model model = compression(16, 6, material, CouplingKind::interpolation, known.nonmortar);
    const auto [state, report] = run(model, 1, std::max(known.steps, 1));
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    const Range mises = vonMisesRange(state);
    const double gap = interpenetration(model, state);
    const double mean = displacementRange(model.bodies[0], state.bodies[0], 1, [](const Point& x) {
                          return x.y() == 1;
                        }).mean();
    EXPECT_NEAR(mises.min / known.misesMin, 1, digits);
    EXPECT_NEAR(mises.max / known.misesMax, 1, digits);
    EXPECT_NEAR(gap / known.interpenetration, 1, digitsOfTheGap);
    EXPECT_NEAR(mean / known.meanOnTop, 1, digits);
    std::cout.precision(12);
    std::cout << known.name << ": von Mises " << mises.min << " .. " << mises.max << ", interpenetration "
              << gap << ", mean u2 on top " << mean << ", " << report.iterations << " iterations\n";
  }
}

}  // namespace mortier::compression_test
