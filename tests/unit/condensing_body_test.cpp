// The condensing solvers on the stiffness of bodies.
#include <gtest/gtest.h>

#include <iostream>
#include <random>

#include "fem/body.h"
#include "material/perzyna.h"
#include "mesh/generate.h"
#include "unit/dense_reference.h"

namespace mortier::condensing_body_test {

std::vector<double> stiffness(const Body& body, std::mt19937& random, bool symmetric) {
  std::uniform_real_distribution<double> value(0, 1);
  Matrix moduli(9, body.points());
  for (int i = 0; i < body.points(); ++i) {
    Eigen::Matrix3d D = Eigen::Vector3d(1.4, 0.8, 0.8).asDiagonal();
    D.diagonal().array() *= 0.5 + value(random);
    for (int c = 0; c < 3; ++c) {
      D(c, (c + 1) % 3) = 0.2 * (value(random) - 0.5);
      D((c + 1) % 3, c) = symmetric ? D(c, (c + 1) % 3) : 0.2 * (value(random) - 0.5);
    }
    Eigen::Map<Eigen::Matrix3d>(&moduli(0, i)) = D;
  }
  std::vector<double> values;
  body.tangent(moduli, values);
  return values;
}

Body square(int cells, bool symmetric) {
  const Function zero = [](double, double, double) { return 0.0; };
  Conditions conditions{{{1, 1, zero}, {4, 0, zero}}, {}, {}};
  const Projection projection = symmetric ? Projection::frobenius : Projection::elasticity;
  return {"square", crissCrossMesh({.cellsX = cells, .cellsY = cells}),
          perzynaMaterial({1, 0.3}, {1, 1, projection}), std::move(conditions)};
}

std::vector<int> topEquations(const Body& body) {
  std::vector<int> kept;
  for (int v = 0; v < body.nodes(); ++v)
    for (int c = 0; c < 2; ++c)
      if (body.mesh().vertices[v].y() == 1 && body.equations()[2 * v + c] >= 0)
        kept.push_back(body.equations()[2 * v + c]);
  return kept;
}

TEST(CondensingSolver, stiffnessOfABodyAgreesWithDenseElimination) {
  std::mt19937 random(4);
  for (const bool symmetric : {true, false}) {
    const Body body = square(6, symmetric);
    System system(Matrix::Identity(1, 1), symmetric);
    system.pattern = body.pattern();
    system.values = stiffness(body, random, symmetric);
    for (const Engine& engine : engines) {
      compare(engine, system, topEquations(body), random);
      compare(engine, system, {}, random);
    }
  }
}

TEST(CondensingSolver, enginesAgreeOnALargerBody) {
  constexpr double agreement = 1e-12;
  std::mt19937 random(5);
  for (const bool symmetric : {true, false}) {
    const Body body = square(20, symmetric);
    const std::vector<double> values = stiffness(body, random, symmetric);
    const std::vector<int> kept = topEquations(body);
    Matrix S[2];
    Vector x[2];
    Vector f(body.freeDofs());
    std::normal_distribution<double> normal;
    for (double& value : f) value = normal(random);
    for (int k = 0; k < 2; ++k) {
      const auto solver = engines[k].make(body.pattern(), kept);
      ASSERT_TRUE(solver->factorise(values));
      S[k] = solver->schurComplement();
      x[k] = f;
      solver->condense(x[k]);
      x[k](kept) = S[k].partialPivLu().solve(Vector(x[k](kept))).eval();
      solver->expand(x[k]);
    }
    const double schur = (S[0] - S[1]).cwiseAbs().maxCoeff() / S[1].cwiseAbs().maxCoeff();
    const double solution = (x[0] - x[1]).cwiseAbs().maxCoeff() / x[1].cwiseAbs().maxCoeff();
    EXPECT_LE(schur, agreement);
    EXPECT_LE(solution, agreement);
    std::cout << "20 x 20, " << (symmetric ? "symmetric" : "unsymmetric") << ": Schur complements differ by "
              << schur << ", solutions by " << solution << "\n";
  }
}

// A body that only its kept equations hold has a regular interior, and a Schur complement that knows its free
// motions.
TEST(CondensingSolver, bodyHeldByItsKeptEquationsIsRegular) {
  std::mt19937 random(7);
  const Body body("free", crissCrossMesh({.cellsX = 5, .cellsY = 5}), elasticMaterial({1, 0.3}), {});
  const std::vector<int> kept = topEquations(body);
  Vector translation = Vector::Zero(static_cast<Eigen::Index>(kept.size()));
  for (Eigen::Index k = 0; k < translation.size(); k += 2) translation[k] = 1;
  for (const Engine& engine : engines) {
    const auto solver = engine.make(body.pattern(), kept);
    ASSERT_TRUE(solver->factorise(stiffness(body, random, true)));
    EXPECT_LE((solver->schurComplement() * translation).cwiseAbs().maxCoeff(), tolerance);
  }
}

}  // namespace mortier::condensing_body_test
