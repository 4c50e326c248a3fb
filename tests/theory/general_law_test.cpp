// A law of the general form eps' = E^-1 s' + G(s, eps) that the program does not have, from the mesh to the
// end of a march: any symmetric elliptic E, and G = (s - K eps)/eta, which depends on the total strain.
#include <gtest/gtest.h>

#include <unsupported/Eigen/MatrixFunctions>

#include "fem/body.h"
#include "material/stress.h"
#include "mesh/generate.h"
#include "theory/scenes.h"
#include "time/march.h"
#include "unit/relaxing_law.h"

namespace mortier::general_law_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using scenes::square;

constexpr double eta = 2;

struct Solid {
  Matrix3d E, K;

  /// One step of backward Euler from a stress and a strain to another strain, in the basis p, q, r:
  ///   (E^-1 + k/eta) s1 = E^-1 s0 + eps1 - eps0 + k/eta K eps1.
  [[nodiscard]] Vector3d next(const Vector3d& s0, const Vector3d& eps0, const Vector3d& eps1,
                              double k) const {
    const Matrix3d C = E.inverse();
    return (C + k / eta * Matrix3d::Identity()).inverse() * (C * s0 + eps1 - eps0 + k / eta * K * eps1);
  }
};

Solid solid() {
  std::mt19937 random(12);
  Solid result{elliptic<3>(random), elliptic<3>(random)};
  result.K(1, 2) += 0.3;
  return result;
}

/// Of a strain e11, e22, 2 e12, which is the same everywhere.
Vector3d strainAt(double t) {
  const Vector3d cartesian(0.2 * std::sin(3 * t), -0.1 * t, 0.3 * t * t);
  return {(cartesian[0] + cartesian[1]) / std::sqrt(2), (cartesian[0] - cartesian[1]) / std::sqrt(2),
          cartesian[2] / std::sqrt(2)};
}

// A square whose boundary is moved by u = eps x.
TEST(GeneralLaw, aSquareUnderAGivenStrainHasTheStressOfThePoint) {
  constexpr int steps = 7;
  const Solid law = solid();
  const auto u1 = [](double x, double y, double t) { return 0.2 * std::sin(3 * t) * x + 0.15 * t * t * y; };
  const auto u2 = [](double x, double y, double t) { return 0.15 * t * t * x - 0.1 * t * y; };
  Conditions conditions;
  for (const int label : {1, 2, 3, 4}) {
    conditions.displacements.push_back({label, alongX, u1});
    conditions.displacements.push_back({label, alongY, u2});
  }
  Model model;
  model.bodies.emplace_back("square", square(0, 3),
                            pointMaterial(Relaxing<3>(law.E, law.K, eta), {"relaxing", "", {}}), conditions);
  State state = initialState(model);
  Vector3d stress = Vector3d::Zero();
  const RunReport run =
      march(model, state, {.end = 1, .steps = steps}, {}, [&](const State& now, const StepReport& report) {
        if (report.step == 0) return;
        const double k = 1.0 / steps;
        stress = law.next(stress, strainAt(now.time - k), strainAt(now.time), k);
        EXPECT_LE((now.bodies[0].stress.colwise() - Vector(stress)).cwiseAbs().maxCoeff(),
                  1e-9 * stress.norm());
      });
  EXPECT_EQ(run.status, Status::converged) << run.reason;
  EXPECT_GT(stress.norm(), 0.01);
}

// Pressed by a load that stays, two blocks in contact creep: with E and K that do not couple shear,
//   eps' = (s - K eps)/eta,   eps(t) = K^-1 s + exp(-K t/eta) (E^-1 - K^-1) s.
TEST(GeneralLaw, blocksInContactCreepAsTheExponentialSays) {
  constexpr double pressure = 0.3;
  Solid law = solid();
  for (Matrix3d* A : {&law.E, &law.K}) A->row(2).head<2>().setZero(), A->col(2).head<2>().setZero();
  const auto material = pointMaterial(Relaxing<3>(law.E, law.K, eta), {"relaxing", "", {}});
  Body upper("upper", square(0, 2), material,
             {{{scenes::left, alongX, scenes::constant(0)}},
              {{scenes::top, alongY, scenes::constant(-pressure)}},
              {}});
  Body lower(
      "lower", square(-1, 3), material,
      {{{scenes::left, alongX, scenes::constant(0)}, {scenes::bottom, alongY, scenes::constant(0)}}, {}, {}});
  const Model model =
      scenes::contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, scenes::upperBody);
  const Vector3d s = fromCartesian(Vector3d(0, -pressure, 0));
  const Vector3d rest = law.K.inverse() * s;
  const Vector3d exact = rest + Matrix3d(-law.K / eta).exp() * (law.E.inverse() * s - rest);
  std::vector<double> errors;
  for (const int steps : {40, 80}) {
    State state = initialState(model);
    // The load acts at once: E^-1 s is there before it creeps.
    const RunReport first =
        march(model, state, {.end = 1e-9, .steps = 1}, {}, [](const State&, const StepReport&) {});
    ASSERT_EQ(first.status, Status::converged) << first.reason;
    MarchMemory memory;
    const RunReport run =
        march(model, state, memory, {.end = 1, .steps = steps}, {}, [](const State&, const StepReport&) {});
    ASSERT_EQ(run.status, Status::converged) << run.reason;
    EXPECT_LE((state.bodies[0].stress.colwise() - Vector(s)).cwiseAbs().maxCoeff(), 1e-9);
    const scenes::Range top = scenes::displacementRange(model.bodies[0], state.bodies[0], 1,
                                                        [](const Point& x) { return x.y() == 1; });
    EXPECT_LE(top.max - top.min, 1e-9);
    const double strain = (exact[0] - exact[1]) / std::sqrt(2);
    errors.push_back(std::abs(top.mean() / 2 - strain) / std::abs(strain));
  }
  EXPECT_LE(errors[0], 0.02);
  EXPECT_NEAR(errors[0] / errors[1], 2, 0.2);  // backward Euler
}

}  // namespace mortier::general_law_test
