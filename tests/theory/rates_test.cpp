// Orders of convergence, fitted by least squares over sequences of meshes and steps, and printed.
#include <gtest/gtest.h>

#include <iostream>

#include "theory/half_open_contact.h"
#include "theory/scenes.h"

namespace mortier::rates_test {

using namespace scenes;

/// A fitted order may be off by this much: the sequences are not asymptotic yet.
constexpr double orderTolerance = 0.05;

void print(const char* what, const std::vector<double>& h, const std::vector<double>& errors) {
  std::cout << what << ": order " << fittedOrder(h, errors) << ", errors";
  for (const double error : errors) std::cout << " " << error;
  std::cout << "\n";
}

// 6 x 6 on 16 x 16 and its uniform refinements, nonmortar upper, elastic, stress (0, -10, 0): the stress
// error is of order one in the row of triangles along the interface whatever h is, so its energy norm falls
// as the square root of h.
TEST(Rates, interpolationLosesHalfAnOrderOnAConstantStress) {
  const Eigen::Vector3d exact = fromCartesian({0, -10, 0});
  const double known[] = {0.17202, 0.12075, 0.09835, 0.08507};
  std::vector<double> h;
  std::vector<double> errors;
  for (int refinement = 1; refinement <= 4; ++refinement) {
    const Model model = compression(6 * refinement, 16 * refinement, elasticMaterial(noteElasticity),
                                    CouplingKind::interpolation, upperBody);
    const auto [state, report] = run(model, 1, 1);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    double error = 0;
    double norm = 0;
    for (size_t b = 0; b < 2; ++b)
      for (int i = 0; i < model.bodies[b].points(); ++i) {
        error += model.bodies[b].weights()[i] *
                 complementaryEnergy(state.bodies[b].stress.col(i) - exact, noteElasticity);
        norm += model.bodies[b].weights()[i] * complementaryEnergy(exact, noteElasticity);
      }
    h.push_back(1.0 / (6 * refinement));
    errors.push_back(std::sqrt(error / norm));
    EXPECT_NEAR(errors.back(), known[refinement - 1], 0.51e-5);
  }
  print("interpolation, energy error on the elastic patch", h, errors);
  EXPECT_NEAR(fittedOrder(h, errors), 0.5, orderTolerance);
}

// Against the exact eps_22 at time 1; u2 on the top is twice that.
TEST(Rates, backwardEulerIsOfFirstOrder) {
  const std::pair<Projection, double> cases[] = {{Projection::elasticity, -0.19625029208256},
                                                 {Projection::frobenius, -0.19635531966083},
                                                 {Projection::compliance, -0.19892570562176}};
  for (const auto& [projection, eps22] : cases) {
    const Model model = compression(2, 3, perzynaMaterial(noteElasticity, noteLaw(projection)),
                                    CouplingKind::mortar, upperBody);
    std::vector<double> k;
    std::vector<double> errors;
    for (const int steps : {20, 40, 80, 160}) {
      const auto [state, report] = run(model, 1, steps);
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      const Range u2 =
          displacementRange(model.bodies[0], state.bodies[0], 1, [](const Point& x) { return x.y() == 1; });
      k.push_back(1.0 / steps);
      errors.push_back(u2.distance(2 * eps22));
    }
    print("backward Euler, u2 on top", k, errors);
    EXPECT_NEAR(fittedOrder(k, errors), 1, orderTolerance);
  }
}

}  // namespace mortier::rates_test
