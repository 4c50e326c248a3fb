#include "solver/complementarity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/enumerated_contact.h"
#include "unit/load_patterns.h"

namespace mortier::complementarity_test {

using Outcome = ContactSolution::Outcome;

ContactSolution solve(const RandomProblem& c, std::vector<char> active) {
  return solveContact(c.problem, c.slack, c.p0, c.balance, std::move(active));
}

void expectEnumerated(const RandomProblem& c, Randoms& random) {
  constexpr double tolerance = 1e-9;  // the matrices have condition numbers up to about 1e4
  const Eigen::Index n = c.slack.size();
  const auto exact = enumerate(c);
  ASSERT_TRUE(exact.has_value());
  for (const std::vector<char>& start : {std::vector<char>(n, 0), std::vector<char>(n, 1), random.set(n)}) {
    const ContactSolution solution = solve(c, start);
    ASSERT_EQ(solution.outcome, Outcome::solved);
    const double scale = 1 + exact->p.cwiseAbs().maxCoeff();
    ASSERT_LE((c.p0 + solution.change - exact->p).cwiseAbs().maxCoeff(), tolerance * scale);
    ASSERT_LE((solution.rigid - exact->z).lpNorm<Eigen::Infinity>(),
              tolerance * (1 + exact->z.lpNorm<Eigen::Infinity>()));
  }
}

TEST(Complementarity, agreesWithEnumerationOfAllActiveSets) {
  Randoms random(1);
  for (int n = 1; n <= 10; ++n)
    for (int trial = 0; trial < 12; ++trial) {
      RandomProblem c;
      c.problem.symmetric = trial % 3 == 0;
      c.problem.W =
          c.problem.symmetric ? symmetricPositive(random, n) : unsymmetricP(random, n, trial % 3 == 1);
      c.problem.G = Matrix(n, 0);
      c.slack = 2 * random.vector(n);
      c.p0 = random.vector(n).cwiseMax(0);
      expectEnumerated(c, random);
    }
}

// A P-matrix on which changing all wrong signs at once goes round for ever: {0, 1}, {1, 2}, {2, 0}, ...
TEST(Complementarity, cyclesAreBroken) {
  const Matrix W{{1, 2, 0}, {0, 1, 2}, {2, 0, 1}};
  const RandomProblem c{{W, false, Matrix(3, 0)}, Vector::Constant(3, -1), Vector::Zero(3), Vector(0)};
  const ContactSolution solution = solve(c, {1, 0, 0});
  ASSERT_EQ(solution.outcome, Outcome::solved);
  EXPECT_LE((solution.change.array() - 1.0 / 3).abs().maxCoeff(), 1e-15);
  EXPECT_LE(solution.pivots, 30);
}

// Nodes that touch without force: p and s both vanish.
TEST(Complementarity, zeroSlackWithoutForceIsNoTrouble) {
  constexpr double tolerance = 1e-11;
  Randoms random(2);
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 2 + random.below(9);
    RandomProblem c;
    c.problem.symmetric = trial % 2 == 0;
    c.problem.W =
        c.problem.symmetric ? symmetricPositive(random, n) : unsymmetricP(random, n, trial % 4 == 1);
    c.problem.G = Matrix(n, 0);
    c.p0 = random.vector(n).cwiseMax(0);
    Vector p = Vector::Zero(n);
    Vector s = Vector::Zero(n);
    for (int i = 0; i < n; ++i) {
      const int kind = random.below(3);
      if (kind == 1) p[i] = 1;
      if (kind == 2) s[i] = 1;
    }
    c.slack = s - c.problem.W * (p - c.p0);
    const ContactSolution solution = solve(c, random.set(n));
    ASSERT_EQ(solution.outcome, Outcome::solved);
    ASSERT_LE((c.p0 + solution.change - p).cwiseAbs().maxCoeff(),
              tolerance * c.problem.W.inverse().cwiseAbs().sum());
  }
}

// Two conditions that almost say the same: their forces share at will, but signs, gaps and the motion are
// right.
TEST(Complementarity, nearlyRepeatedConditionsAreHeldTogether) {
  constexpr double tolerance = 1e-9;
  Randoms random(3);
  for (const double difference : {1e-3, 1e-5, 1e-7})
    for (int trial = 0; trial < 50; ++trial) {
      const int n = 3 + random.below(7);
      const int dofs = n + 3;
      Matrix C = random.matrix(n, dofs);
      C.row(1) = C.row(0) + difference * C.row(1);
      const Vector g0 = random.vector(n);
      RandomProblem c;
      c.problem.W = C * C.transpose();
      c.problem.G = Matrix(n, 0);
      c.slack = g0;
      c.slack[1] = c.slack[0];
      c.p0 = Vector::Zero(n);
      const ContactSolution solution = solve(c, std::vector<char>(n, 1));
      ASSERT_EQ(solution.outcome, Outcome::solved);
      const Vector s = c.slack + c.problem.W * solution.change;
      const double force = 1 + solution.change.cwiseAbs().maxCoeff();
      EXPECT_GE(s.minCoeff(), -tolerance * force);
      EXPECT_GE(solution.change.minCoeff(), -tolerance * force);
      EXPECT_LE(std::abs(solution.change.dot(s)), tolerance * force * force);
    }
}

/// A problem whose bodies contact alone holds, with a solution p, s, z given beforehand.
RandomProblem balancedCase(Randoms& random, int n, int motions, bool symmetric) {
  RandomProblem c;
  c.problem.symmetric = symmetric;
  c.problem.W = symmetric ? symmetricPositive(random, n) : unsymmetricP(random, n, false);
  c.problem.G = random.matrix(n, motions);
  if (motions > 0) c.problem.G.col(0) = c.problem.G.col(0).cwiseAbs();
  c.p0 = random.vector(n).cwiseMax(0);
  Vector p = Vector::Zero(n);
  Vector s = Vector::Zero(n);
  for (int i = 0; i < n; ++i)
    (i <= motions || random.below(2) == 0 ? p : s)[i] = 0.1 + std::abs(random.normal());
  const Vector z = random.vector(motions);
  c.slack = s - c.problem.W * (p - c.p0) + c.problem.G * z;
  c.balance = c.problem.G.transpose() * (p - c.p0);
  return c;
}

TEST(Complementarity, rigidMotionsAgreeWithEnumeration) {
  Randoms random(4);
  for (int n = 4; n <= 10; n += 2)
    for (int motions = 1; motions <= 3; ++motions)
      for (int trial = 0; trial < 8; ++trial)
        expectEnumerated(balancedCase(random, n, motions, trial % 2 == 0), random);
}

TEST(Complementarity, rigidMotionsAreBalancedToRounding) {
  constexpr double rounding = 1e-13;
  Randoms random(5);
  for (int trial = 0; trial < 100; ++trial) {
    const RandomProblem c = balancedCase(random, 12, 1 + trial % 3, true);
    const ContactSolution solution = solve(c, std::vector<char>(12, 1));
    ASSERT_EQ(solution.outcome, Outcome::solved);
    const Vector rest = c.problem.G.transpose() * solution.change - c.balance;
    EXPECT_LE(
        rest.cwiseAbs().maxCoeff(),
        rounding * (c.problem.G.cwiseAbs().transpose() * (c.p0 + c.p0 + solution.change).cwiseAbs()).sum());
  }
}

// Contact pushes, it does not pull.
TEST(Complementarity, loadThatContactCannotBalanceIsReported) {
  Randoms random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const int n = 2 + random.below(8);
    RandomProblem c;
    c.problem.W = symmetricPositive(random, n);
    c.problem.G = random.matrix(n, 1).cwiseAbs();
    c.slack = random.vector(n);
    c.p0 = Vector::Zero(n);
    c.balance = Vector::Constant(1, -1);
    const ContactSolution away = solve(c, random.set(n));
    EXPECT_EQ(away.outcome, Outcome::unbalanced);
    EXPECT_LT(away.rigid[0], 0);  // s = s0 + W dp - G z grows without end
    c.balance[0] = 1;
    EXPECT_EQ(solve(c, random.set(n)).outcome, Outcome::solved);
    // A couple of forces with a moment that no push on these nodes has.
    c.problem.G = Matrix::Ones(n, 2);
    for (int i = 0; i < n; ++i) c.problem.G(i, 1) = static_cast<double>(i) / n;
    c.balance = Eigen::Vector2d(1, 1.5);
    EXPECT_EQ(solve(c, std::vector<char>(n, 1)).outcome, Outcome::unbalanced);
  }
}

// Powers of four: square roots of the scaled matrix are scaled exactly as well.
TEST(Complementarity, unitsOfPowersOfFourChangeNoBit) {
  Randoms random(7);
  for (int trial = 0; trial < 60; ++trial) {
    const RandomProblem c = balancedCase(random, 8, trial % 3, trial % 2 == 0);
    const std::vector<char> start = random.set(8);
    const ContactSolution solution = solve(c, start);
    for (const double force : {0x1p-30, 0x1p+16})
      for (const double length : {0x1p-10, 0x1p+40}) {
        RandomProblem scaled = c;
        scaled.problem.W *= length / force;
        scaled.slack *= length;
        scaled.p0 *= force;
        scaled.balance *= force;
        const ContactSolution other = solve(scaled, start);
        EXPECT_EQ(other.pivots, solution.pivots);
        EXPECT_EQ(other.active, solution.active);
        EXPECT_EQ(other.change, force * solution.change);
        EXPECT_EQ(other.rigid, length * solution.rigid);
      }
  }
}

// W = B B' of a rank below the number of conditions, some of which no motion changes: the gaps are those of
// the problem in the motions, whatever the forces.
TEST(Complementarity, dependentConditionsAreSolved) {
  constexpr double tolerance = 1e-12;
  Randoms random(11);
  for (const bool symmetric : {true, false})
    for (int trial = 0; trial < 200; ++trial) {
      const int n = 4 + trial % 9;
      const int rank = 1 + trial % (n - 2);
      Matrix B = random.matrix(n, rank);
      B.row(1) = B.row(0);
      B.row(n - 1).setZero();
      // s0 = c - B u of motions within reach of the conditions that no motion changes
      const Vector c = random.vector(n).cwiseAbs().cwiseMax(n > 5 ? 0 : 0.1);
      const Vector u = 3 * random.vector(rank);
      RandomProblem problem{
          {B * B.transpose(), symmetric, Matrix(n, 0)}, c - B * u, Vector::Zero(n), Vector(0)};
      const ContactSolution solution = solve(problem, std::vector<char>(n, trial % 2 == 0 ? 1 : 0));
      ASSERT_EQ(solution.outcome, Outcome::solved) << trial;
      const Vector p = problem.p0 + solution.change;
      const Vector s = problem.slack + problem.problem.W * solution.change;
      const double size =
          problem.problem.W.cwiseAbs().maxCoeff() * p.maxCoeff() + problem.slack.cwiseAbs().maxCoeff();
      EXPECT_EQ(p[n - 1], 0);
      EXPECT_GE(p.minCoeff(), -tolerance * (1 + p.maxCoeff()));
      for (int i = 0; i + 1 < n; ++i) {
        EXPECT_GE(s[i], -tolerance * size) << trial;
        EXPECT_LE(std::abs(p[i] * s[i]), tolerance * size * (1 + p.maxCoeff())) << trial;
      }
    }
}

// Lines with many nodes under loads of all wave lengths, where changing all wrong signs at once goes round.
// Of thousands of patterns the worst takes 8 factorisations (docs/measurements.md).
TEST(Complementarity, anyLoadOnManyNodesTakesTheWorkOfAFewFactorisations) {
  constexpr int n = 160;
  constexpr int patternsOfALine = 60;
  constexpr double tolerance = 1e-9;
  std::mt19937 random(12);
  for (const patterns::Line line : patterns::allLines)
    for (const int motions : {0, 1}) {
      const ContactProblem problem{patterns::compliance(line, n), line != patterns::Line::unsymmetric,
                                   Matrix::Ones(n, motions)};
      for (int trial = 0; trial < patternsOfALine; ++trial) {
        const patterns::Pattern pattern = patterns::pattern(random, problem);
        const ContactSolution solution =
            solveContact(problem, pattern.slack, Vector::Zero(n), pattern.balance, pattern.active);
        SCOPED_TRACE(testing::Message() << "line " << static_cast<int>(line) << " trial " << trial);
        ASSERT_EQ(solution.outcome, Outcome::solved);
        EXPECT_LE(solution.work, 10);
        const Vector& p = solution.change;
        const Vector s = pattern.slack + problem.W * p - problem.G * solution.rigid;
        const double force = p.cwiseAbs().maxCoeff();
        const double length = problem.W.diagonal().maxCoeff() * force + pattern.slack.cwiseAbs().maxCoeff();
        EXPECT_GE(p.minCoeff(), -tolerance * force);
        EXPECT_GE(s.minCoeff(), -tolerance * length);
        EXPECT_LE(p.cwiseProduct(s).cwiseAbs().maxCoeff(), tolerance * force * length);
      }
    }
}

// A beam on an edge that peels off: one node after the other would be let go, each with a solve.
TEST(Complementarity, contactPeelsOffInFewSets) {
  constexpr int n = 300;
  const ContactProblem problem{patterns::compliance(patterns::Line::thinBeam, n), true, Matrix(n, 0)};
  Vector load = Vector::Constant(n, -1);
  load.head(n / 2).setOnes();
  const ContactSolution solution =
      solveContact(problem, -problem.W * load, Vector::Zero(n), Vector(0), std::vector<char>(n, 1));
  EXPECT_EQ(solution.outcome, Outcome::solved);
  EXPECT_LE(solution.pivots, 40);
}

// A paraboloid on a half space, nodes on a grid: what is pressed together, further by a tenth and by a third.
TEST(Complementarity, surfacesCloseInFewSets) {
  constexpr int side = 31;
  constexpr int n = side * side;
  Matrix W(n, n);
  Vector distance(n);
  for (int i = 0; i < n; ++i) {
    const auto at = [](int k) -> Eigen::Vector2d { return Eigen::Vector2d(k / side, k % side) / (side - 1); };
    for (int j = 0; j < n; ++j)
      W(i, j) = 1 / std::max((at(i) - at(j)).norm(), 1 / (3.5 * (side - 1)));  // of a cell on itself
    distance[i] = at(i).squaredNorm() / 2;
  }
  const auto pressed = [&](double depth, const Vector& p0, std::vector<char> active) {
    const RandomProblem c{{W, true, Matrix(n, 0)}, (distance + W * p0).array() - depth, p0, Vector(0)};
    return solve(c, std::move(active));
  };
  const ContactSolution cold = pressed(0.05, Vector::Zero(n), std::vector<char>(n, 1));
  ASSERT_EQ(cold.outcome, Outcome::solved);
  EXPECT_LE(cold.pivots, 6);
  const ContactSolution warm = pressed(0.055, cold.change, cold.active);
  EXPECT_LE(warm.pivots, 4);
  const ContactSolution further = pressed(0.0715, cold.change + warm.change, warm.active);
  ASSERT_EQ(further.outcome, Outcome::solved);
  EXPECT_LE(further.pivots, 4);
}

// Not a P-matrix: pivoting goes round, and says that it was stopped and not that there is no solution.
TEST(Complementarity, workThatHasNoEndIsCutOff) {
  constexpr int n = 300;
  Randoms random(1);
  for (const double diagonal :
       {0, 10}) {  // small sets are cut off by the number of pivots, large ones by the work
    RandomProblem c{{random.matrix(n, n), false, Matrix(n, 0)}, random.vector(n), Vector::Zero(n), Vector(0)};
    c.problem.W.diagonal().array() += diagonal;
    const ContactSolution solution = solve(c, std::vector<char>(n, 1));
    EXPECT_EQ(solution.outcome, Outcome::capped);
    EXPECT_LE(solution.work, 1.5 * workLimit);
    if (diagonal > 0) {
      EXPECT_GT(solution.work, workLimit);
    }
  }
}

TEST(Complementarity, nothingToSolveIsSolved) {
  EXPECT_EQ(solveContact({Matrix(0, 0), true, Matrix(0, 0)}, Vector(0), Vector(0), Vector(0), {}).outcome,
            Outcome::solved);
}

}  // namespace mortier::complementarity_test
