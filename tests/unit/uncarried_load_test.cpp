#include "solver/uncarried_load.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/dense_templates.h"

namespace mortier::uncarried_load_test {

// A block of width 2 and height 2 h on a floor, by the nodes of its lower side: motions are translations
// along x and y and the rotation about the middle of that side. A condition n . u <= 0, out of the block, has
// n = -y.
ContactProblem blockOnFloor(double friction, int nodes) {
  ContactProblem problem;
  problem.G = Matrix::Zero(friction > 0 ? 2 * nodes : nodes, 3);
  for (int i = 0; i < nodes; ++i) {
    const double x = -1 + 2.0 * i / (nodes - 1);
    problem.G.row(i) << 0, -1, -x;
    if (friction > 0) problem.G.row(nodes + i) << 1, 0, 0;
    if (friction > 0) problem.along.node.push_back(i);
  }
  if (friction > 0) problem.along.law = {Vector::Constant(nodes, friction), Vector::Zero(nodes)};
  problem.W = Matrix::Identity(problem.G.rows(), problem.G.rows());
  return problem;
}

/// Weight 1, and a force along x at height h.
Vector pushed(double force, double h) {
  return Eigen::Vector3d(force, -1, -force * h);
}

TEST(UncarriedLoad, aBlockTipsAndSlidesAtTheLoadsOfStatics) {
  constexpr double aside = 1e-4;
  for (const int nodes : {2, 3, 17})
    for (const double friction : {0.3, 0.7, 2.0})
      for (const double h : {0.5, 1.0, 3.0}) {
        const ContactProblem problem = blockOnFloor(friction, nodes);
        const double most = std::min(friction, 1 / h);  // G' x = load: forces act on what is below
        for (const double sign : {1.0, -1.0}) {
          EXPECT_FALSE(uncarriedLoad(problem, pushed(sign * most * (1 - aside), h))) << friction << " " << h;
          const auto motion = uncarriedLoad(problem, pushed(sign * most * (1 + aside), h));
          ASSERT_TRUE(motion) << friction << " " << h;
          if (friction < 1 / h)
            EXPECT_GT(sign * (*motion)[0], 0);  // it slides
          else
            EXPECT_LT(sign * (*motion)[2], 0);  // over the corner at sign x
        }
      }
}

TEST(UncarriedLoad, theMotionIsDrivenAndNothingResistsIt) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  int uncarried = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const int motions = 1 + trial % 6;
    const int rows = 1 + trial % 11;
    const double scale = std::pow(10.0, trial % 21 - 10);  // of units
    ContactProblem problem;
    problem.G = Matrix::NullaryExpr(rows, motions, [&] { return normal(random); });
    const Vector load = scale * Vector::NullaryExpr(motions, [&] { return normal(random); });
    const auto z = uncarriedLoad(problem, load);
    if (!z) continue;
    ++uncarried;
    EXPECT_NEAR(z->dot(load), z->squaredNorm(), 1e-12 * load.squaredNorm());
    EXPECT_LE((problem.G * *z).maxCoeff(), 1e-9 * z->norm() * problem.G.norm());
  }
  EXPECT_GT(uncarried, 50);
  EXPECT_LT(uncarried, 250);
}

TEST(UncarriedLoad, loadsOfRandomForcesAreCarried) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> force(0, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const int nodes = 1 + trial % 40;
    ContactProblem problem;
    problem.G = Matrix::NullaryExpr(2 * nodes, 1 + trial % 6, [&] { return normal(random); });
    for (int i = 0; i < nodes; ++i) problem.along.node.push_back(i);
    problem.along.law = {Vector::Constant(nodes, 0.4), Vector::Constant(nodes, trial % 2)};
    Vector x(2 * nodes);
    for (int i = 0; i < nodes; ++i) {
      x[i] = force(random);
      x[nodes + i] = (2 * force(random) - 1) * (0.4 * x[i] + trial % 2);
    }
    EXPECT_FALSE(uncarriedLoad(problem, problem.G.transpose() * x)) << trial;
  }
}

TEST(UncarriedLoad, withoutRowsNothingIsCarriedAndNothingFallsWithoutLoad) {
  ContactProblem problem;
  problem.G = Matrix::Zero(3, 2);
  EXPECT_TRUE(uncarriedLoad(problem, Eigen::Vector2d(0, 1)));
  EXPECT_FALSE(uncarriedLoad(problem, Eigen::Vector2d(0, 0)));
  problem.G.resize(3, 0);
  EXPECT_FALSE(uncarriedLoad(problem, Vector(0)));
}

}  // namespace mortier::uncarried_load_test
