// Orders of convergence, fitted by least squares over sequences of meshes and steps, and printed.
#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <iostream>

#include "theory/half_open_contact.h"
#include "theory/scenes.h"

namespace mortier {
namespace {

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

TEST(Rates, mortarIsOfFirstOrderWhereContactEnds) {
  constexpr double leastOrder = 0.95;              // tends to 1
  constexpr double forceTolerance = 1e-4;          // of order h^2
  constexpr double contactForce = 0.769126488659;  // 2/3 1.1^(3/2)
  const std::array<std::pair<int, int>, 4> meshes{{{8, 12}, {16, 24}, {32, 49}, {64, 97}}};
  for (const double contrast : {1.0, 1e3, 1e6})
    for (const int nonmortar : {upperBody, lowerBody}) {
      const std::array<HalfOpenContact, 2> exact{HalfOpenContact({1, 0.3}, false),
                                                 HalfOpenContact({contrast, 0.2}, true)};
      std::vector<double> h;
      std::array<std::vector<double>, 2> errors;
      double force = 0;
      for (const auto& [upperCells, lowerCells] : meshes) {
        const Model model = contactModel(exact[0].body(upperCells), exact[1].body(lowerCells),
                                         CouplingKind::mortar, nonmortar);
        const auto [state, report] = run(model, 1, 1);
        ASSERT_EQ(report.status, Status::converged) << report.reason;
        h.push_back(1.0 / upperCells);
        for (size_t b = 0; b < 2; ++b) {
          double error = 0;
          double norm = 0;
          exact[b].addEnergies(model.bodies[b], state.bodies[b].stress, error, norm);
          errors[b].push_back(std::sqrt(error / norm));
        }
        force = state.contactForce[0].sum();
        // Contact ends at x = 0.
        const ContactInterface& interface = model.interfaces[0];
        double end = 1;
        for (int i = 0; i < interface.rows(); ++i)
          if (state.contactForce[0][i] > 0)
            end = std::min(end, model.bodies[nonmortar].mesh().vertices[interface.nonmortarNodes()[i]].x());
        EXPECT_LE(std::abs(end), 2.0 / std::min(upperCells, lowerCells));
      }
      std::cout << "contrast " << contrast << ", nonmortar " << (nonmortar == upperBody ? "coarse" : "fine")
                << ", contact force on the finest meshes " << force << " (exact " << contactForce << ")\n";
      for (size_t b = 0; b < 2; ++b) {
        print(b == upperBody ? "  energy error, upper body" : "  energy error, lower body", h, errors[b]);
        EXPECT_GE(fittedOrder(h, errors[b]), leastOrder);
      }
      EXPECT_NEAR(force, contactForce, forceTolerance);
    }
}

}  // namespace
}  // namespace mortier
