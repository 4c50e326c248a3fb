// Friction with two directions of slip a node.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <random>

#include "solver/closed_contact.h"
#include "solver/friction.h"
#include "unit/enumerated_friction.h"

namespace mortier::friction_in_space_test {
namespace {

struct SpaceCase {
  ContactProblem problem;
  Vector q;
};

FrictionSets open(int n) {
  return {std::vector<char>(n, 0), std::vector<signed char>(n, 1), std::vector<SlipDirection>(n)};
}

/// Of n nodes: compliances of random bodies, thin ones with a wide range of eigenvalues; mu, or a limit.
SpaceCase randomCase(std::mt19937& random, int n, double mu, double limit, bool thin) {
  std::normal_distribution<double> normal;
  const auto noise = [&] { return normal(random); };
  const Eigen::Index rows = 3 * n;
  Matrix A = Matrix::NullaryExpr(rows, rows, noise);
  if (thin)
    for (Eigen::Index j = 0; j < rows; ++j)
      A.col(j) *= std::pow(10, -3.0 * static_cast<double>(j) / static_cast<double>(rows));
  SpaceCase c;
  c.problem.W = A * A.transpose() / static_cast<double>(rows);
  c.problem.W.diagonal().array() += 1e-3;
  c.problem.G.resize(rows, 0);
  c.problem.along = {allNodes(n), {Vector::Constant(n, mu), Vector::Constant(n, limit)}, 2};
  c.q = Vector::NullaryExpr(rows, noise);
  c.q.head(n).array() -= 0.5;
  return c;
}

/// Cone, slip direction and gap of every node, over the largest force and motion.
double worstFault(const SpaceCase& c, const Vector& x) {
  const Eigen::Index n = c.problem.normals();
  const Vector w = c.q + c.problem.W * x;
  const double force = std::max(x.lpNorm<Eigen::Infinity>(), 1e-300);
  const double motion = c.q.lpNorm<Eigen::Infinity>() + c.problem.W.lpNorm<Eigen::Infinity>() * force;
  double worst = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Point t = x.segment<2>(n + 2 * i);
    const Point v = w.segment<2>(n + 2 * i);
    const double bound = c.problem.along.law.coefficient[i] * x[i] + c.problem.along.law.limit[i];
    worst = std::max({worst, -x[i] / force, -w[i] / motion, x[i] / force * std::abs(w[i]) / motion,
                      (t.norm() - bound) / force, std::abs(t.dot(v) + bound * v.norm()) / force / motion});
  }
  return worst;
}

TEST(FrictionInSpace, everyNodeObeysItsLaw) {
  std::mt19937 random(7);
  int solves = 0;
  int slipping = 0;
  int sticking = 0;
  constexpr int count = 1000;
  for (int trial = 0; trial < count; ++trial) {
    const int n = 1 + trial % 25;
    const double mu = trial % 3 == 0 ? 0 : 2.0 * (trial % 101) / 100;
    const SpaceCase c = randomCase(random, n, mu, trial % 3 == 0 ? 0.3 : 0, trial % 2 == 0);
    const FrictionSolution solution = solveFriction(c.problem, c.q, open(n));
    ASSERT_TRUE(solution.solved) << "trial " << trial << ", n " << n << ", mu " << mu;
    EXPECT_LE(solution.residual, 1e-12) << "trial " << trial;
    EXPECT_LE(worstFault(c, solution.force), 1e-12) << "trial " << trial;
    solves += solution.solves;
    for (int k = 0; k < n; ++k)
      if (solution.sets.closed[k] != 0) (solution.sets.slip[k] != 0 ? slipping : sticking) += 1;
  }
  EXPECT_LE(solves, 16 * count);
  EXPECT_GT(slipping, count);
  EXPECT_GT(sticking, count);
  std::cout << solves << " solves of " << count << " problems\n";
}

TEST(FrictionInSpace, directionsOfSlipAreNoOnesOwn) {
  std::mt19937 random(8);
  constexpr int n = 8;
  for (int trial = 0; trial < 20; ++trial) {
    const SpaceCase c = randomCase(random, n, 0.4, 0, false);
    Matrix turn = Matrix::Identity(3 * n, 3 * n);
    for (int k = 0; k < n; ++k)
      turn.block<2, 2>(n + 2 * k, n + 2 * k) = Eigen::Rotation2Dd(0.3 + k).toRotationMatrix();
    SpaceCase turned = c;
    turned.problem.W = turn * c.problem.W * turn.transpose();
    turned.q = turn * c.q;
    const Vector x = solveFriction(c.problem, c.q, open(n)).force;
    const Vector y = solveFriction(turned.problem, turned.q, open(n)).force;
    EXPECT_LE((turn * x - y).lpNorm<Eigen::Infinity>(), 1e-11 * x.lpNorm<Eigen::Infinity>());
  }
}

// Where the second directions do nothing.
TEST(FrictionInSpace, isThatOfThePlaneAlongOneDirection) {
  Randoms random(9);
  for (int trial = 0; trial < 50; ++trial) {
    const int n = 2 + trial % 6;
    const FrictionCase plane = randomFriction(random, n, 0.3);
    SpaceCase c;
    c.problem = plane.problem;
    c.problem.along.components = 2;
    c.problem.W = Matrix::Identity(3 * n, 3 * n);
    c.problem.G.resize(3 * n, 0);
    c.q = Vector::Zero(3 * n);
    std::vector<Eigen::Index> of;
    for (int i = 0; i < n; ++i) of.push_back(i);
    for (int i = 0; i < n; ++i) of.push_back(n + 2 * i);
    c.problem.W(of, of) = plane.problem.W;
    c.q(of) = plane.q;
    for (const double across : {1.0, 0.0}) {  // no free motion changes the slip across in the second case
      for (int i = 0; i < n; ++i) c.problem.W(n + 2 * i + 1, n + 2 * i + 1) = across;
      const FrictionSolution one =
          solveFriction(plane.problem, plane.q, {std::vector<char>(n, 0), std::vector<signed char>(n, 1)});
      const FrictionSolution other = solveFriction(c.problem, c.q, open(n));
      ASSERT_TRUE(one.solved && other.solved);
      EXPECT_LE((other.force(of) - one.force).lpNorm<Eigen::Infinity>(),
                1e-10 * one.force.lpNorm<Eigen::Infinity>())
          << "trial " << trial;
      for (int i = 0; i < n; ++i) EXPECT_EQ(other.force[n + 2 * i + 1], 0);
    }
  }
}

TEST(FrictionInSpace, linearResponseIsTheDerivative) {
  std::mt19937 random(10);
  constexpr int n = 10;
  constexpr double h = 1e-6;
  for (int trial = 0; trial < 20; ++trial) {
    const SpaceCase c = randomCase(random, n, 0.3, 0, false);
    const FrictionSolution at = solveFriction(c.problem, c.q, open(n));
    std::normal_distribution<double> normal;
    const Vector change = Vector::NullaryExpr(3 * n, [&] { return normal(random); });
    const FrictionSolution ahead = solveFriction(c.problem, c.q + h * change, at.sets);
    const FrictionSolution behind = solveFriction(c.problem, c.q - h * change, at.sets);
    if (ahead.sets.closed != behind.sets.closed || ahead.sets.slip != behind.sets.slip) continue;
    const Vector difference = (ahead.force - behind.force) / (2 * h);
    const Vector response = ClosedContact(c.problem, at.sets, false).solve(change, Vector()).change;
    EXPECT_LE((response - difference).lpNorm<Eigen::Infinity>(), 1e-6 * difference.lpNorm<Eigen::Infinity>());
    // The transposed problem has the transposed response.
    const Vector adjoint = ClosedContact(c.problem, at.sets, true).solve(change, Vector()).change;
    const Vector other = Vector::NullaryExpr(3 * n, [&] { return normal(random); });
    const Vector ofOther = ClosedContact(c.problem, at.sets, false).solve(other, Vector()).change;
    EXPECT_NEAR(change.dot(ofOther), adjoint.dot(other), 1e-9 * change.norm() * ofOther.norm());
  }
}

/// Bodies that do not strain, piled up, each on a few points of the one below: three conditions a point, six
/// motions a body. W = H H', q = H v of any motions v: a solution exists (Cadoux 2009), its forces are not
/// the only ones where points are more than three.
SpaceCase pile(std::mt19937& random, int bodies, int points, double mu) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> mass(0.1, 10);
  const int n = bodies * points;
  Matrix H = Matrix::Zero(3 * n, 6 * bodies);
  for (int b = 0; b < bodies; ++b) {
    const double scale = 1 / std::sqrt(mass(random));
    for (int k = b * points; k < std::min((b + 2) * points, n); ++k) {  // below it, and the next body on it
      const bool below = k < (b + 1) * points;
      std::mt19937 ofPoint(static_cast<unsigned>(1000 * bodies + k));
      const auto noise = [&] { return normal(ofPoint); };
      const SpacePoint axis = SpacePoint(0.3 * noise(), 0.3 * noise(), 1).normalized();
      const SpacePoint first = axis.unitOrthogonal();
      const SpacePoint arm(noise(), noise(), below ? -1 : 1);
      const std::array<SpacePoint, 3> directions{axis, first, axis.cross(first)};
      for (int c = 0; c < 3; ++c) {
        const Eigen::Index row = c == 0 ? k : n + 2 * k + c - 1;
        const double sign = below ? scale : -scale;
        H.block<1, 3>(row, 6 * b) = sign * directions[c].transpose();
        H.block<1, 3>(row, 6 * b + 3) = sign * arm.cross(directions[c]).transpose();
      }
    }
  }
  SpaceCase c;
  c.problem.W = H * H.transpose();
  c.problem.G.resize(3 * n, 0);
  c.problem.along = {allNodes(n), {Vector::Constant(n, mu), Vector::Zero(n)}, 2};
  Vector v = Vector::NullaryExpr(6 * bodies, [&] { return normal(random); });
  for (int b = 0; b < bodies; ++b) v[6 * b + 2] -= 2;  // they fall
  c.q = H * v;
  return c;
}

// Where conditions outnumber motions sets differ by forces that balance each other.
TEST(FrictionInSpace, pilesOfRigidBodiesHaveForces) {
  std::mt19937 random(11);
  int pressed = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const SpaceCase c = pile(random, 1 + trial % 3, 3 + trial % 4, 0.1 + 0.2 * (trial % 5));
    const auto n = static_cast<int>(c.problem.normals());
    const FrictionSolution solution = solveFriction(c.problem, c.q, open(n));
    ASSERT_TRUE(solution.solved) << "trial " << trial;
    EXPECT_LE(worstFault(c, solution.force), 1e-10) << "trial " << trial;
    pressed += solution.force.head(n).maxCoeff() > 0 ? 1 : 0;
  }
  EXPECT_GE(pressed, 50);
}

}  // namespace
}  // namespace mortier::friction_in_space_test
