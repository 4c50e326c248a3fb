#include "solver/friction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "solver/friction_sets.h"
#include "unit/enumerated_friction.h"
#include "unit/half_plane_friction.h"
#include "unit/load_patterns.h"

namespace mortier::friction_test {

FrictionSets open(int n) {
  return {std::vector<char>(n, 0), std::vector<signed char>(n, 1)};
}

/// Cone, slip direction and gap of every node, over the largest force and motion.
double worstFault(const FrictionCase& c, const FrictionSolution& solution) {
  const Eigen::Index n = c.problem.normals();
  const Vector w = c.q + c.problem.W * solution.force;
  const double force = std::max(solution.force.lpNorm<Eigen::Infinity>(), 1e-300);
  const double motion = c.q.lpNorm<Eigen::Infinity>() +
                        c.problem.W.lpNorm<Eigen::Infinity>() * solution.force.lpNorm<Eigen::Infinity>();
  double worst = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double p = solution.force[i];
    const double t = solution.force[n + i];
    const double bound = c.problem.along.law.coefficient[i] * p + c.problem.along.law.limit[i];
    worst = std::max({worst, -p / force, -w[i] / motion, p / force * std::abs(w[i]) / motion,
                      (std::abs(t) - bound) / force,
                      std::abs(t * w[n + i] + bound * std::abs(w[n + i])) / force / motion});
  }
  return worst;
}

/// Problems of each kind that the tests try, MORTIER_RANDOM_FRICTION others where that is set.
int problems(int usual) {
  const char* asked = std::getenv("MORTIER_RANDOM_FRICTION");
  return asked != nullptr ? std::atoi(asked) : usual;
}

// Of two to five nodes, mu from 0 to 2: what the solver finds is one of all solutions, and the only one where
// there is one. The path finds one from nothing.
TEST(Friction, agreesWithEnumerationOfAllSets) {
  const int count = problems(300);
  for (const bool blocks : {false, true}) {
    Randoms random(blocks ? 11 : 12);
    int several = 0;
    int paths = 0;
    int longest = 0;
    for (int trial = 0; trial < count; ++trial) {
      const int n = 2 + trial % 4;
      const double mu = 2.0 * random.below(1001) / 1000;
      const FrictionCase c = blocks ? randomBlocks(random, n, mu) : randomFriction(random, n, mu);
      const std::vector<EnumeratedFriction> exact = enumerateFriction(c);
      ASSERT_FALSE(exact.empty());
      int indices = 0;
      for (const EnumeratedFriction& one : exact) indices += one.index;
      EXPECT_EQ(indices, 1) << exact.size() << " solutions, trial " << trial;
      several += exact.size() > 1 ? 1 : 0;
      const auto isExact = [&](const Vector& force) {
        return std::any_of(exact.begin(), exact.end(), [&](const EnumeratedFriction& one) {
          return one.index > 0 && (one.force - force).lpNorm<Eigen::Infinity>() <=
                                      1e-7 * (1 + one.force.lpNorm<Eigen::Infinity>());
        });
      };
      const FrictionSolution solution = solveFriction(c.problem, c.q, open(n));
      ASSERT_TRUE(solution.solved) << "trial " << trial;
      EXPECT_TRUE(isExact(solution.force)) << "trial " << trial << ", mu " << mu;
      EXPECT_LE(solution.residual, 1e-12);
      paths += solution.events > 0 ? 1 : 0;

      FrictionWork work;
      const FrictionSystem system(c.problem, c.q, {}, work);
      const auto sets = followPath(system, 0);
      ASSERT_EQ(sets.size(), 1u) << "trial " << trial << ", mu " << mu;
      const auto onPath = system.newton(sets[0]);
      ASSERT_TRUE(onPath.has_value());
      EXPECT_TRUE(isExact(onPath->force)) << "trial " << trial << ", mu " << mu;
      EXPECT_EQ(onPath->index, 1);
      longest = std::max(longest, work.events);

      const auto pivoted = lemke(c);
      ASSERT_TRUE(pivoted.has_value()) << "trial " << trial << ", mu " << mu;
      EXPECT_TRUE(isExact(*pivoted)) << "trial " << trial << ", mu " << mu;
    }
    std::cout << (blocks ? "blocks" : "any matrix") << ": " << several << " of " << count
              << " with several solutions, path taken in " << paths << ", longest " << longest << " events\n";
  }
}

// Steps of a history: pushed, pulled along, pulled back, let go. Each begins with the sets of the one before;
// what slip there was is taken off q.
TEST(Friction, historiesNeedFewSolves) {
  constexpr int n = 60;
  constexpr int steps = 20;
  FrictionSets sets = open(n);
  double slip = 0;
  int solves = 0;
  int closed = 0;
  int stuck = 0;
  int slipping = 0;
  for (int step = 1; step <= 4 * steps; ++step) {
    const FrictionCase c = stepOfHistory(n, step, steps, slip);
    const FrictionSolution solution = solveFriction(c.problem, c.q, sets);
    ASSERT_TRUE(solution.solved) << "step " << step;
    EXPECT_LE(solution.residual, 1e-12);
    EXPECT_LE(worstFault(c, solution), 1e-12);
    EXPECT_EQ(solution.events, 0);
    sets = solution.sets;
    solves += solution.solves;
    for (const signed char slip_ : sets.slip) (slip_ == 0 ? stuck : slipping) += 1;
    closed = std::max(closed, static_cast<int>(std::count(sets.closed.begin(), sets.closed.end(), 1)));
  }
  EXPECT_LE(solves, 6 * 4 * steps);
  EXPECT_GT(closed, 0.6 * n);
  EXPECT_GT(stuck, n);
  EXPECT_GT(slipping, n);
}

// Similar half planes pressed by a parabola and pushed along by Q: t is mu times the difference of the
// pressures of Hertz under P and under P - Q/mu (Cattaneo 1938, Mindlin 1949), its stick zone sqrt(1 - Q/(mu
// P)) of the width.
TEST(Friction, isThatOfCattaneoAndMindlin) {
  constexpr double mu = 0.4;
  for (const auto& [n, tolerance] : {std::pair(60, 5e-3), {240, 5e-4}}) {
    const FrictionCase c = mindlinCase(n, mu);
    const FrictionSolution solution = solveFriction(c.problem, c.q, open(n));
    ASSERT_TRUE(solution.solved);
    const double P = solution.force.head(n).sum();
    const double Q = solution.force.tail(n).sum();
    const double a = std::sqrt(2 * P);
    const double middle = a * std::sqrt(1 - Q / (mu * P));
    const double h = 2 * halfOfMindlinsLine / n;
    double stick = 0;
    for (int i = 0; i < n; ++i)
      if (solution.sets.closed[i] != 0 && solution.sets.slip[i] == 0) stick = placeOfMindlin(n, i) + h / 2;
    const double wrong = (solution.force.tail(n) - mindlinTraction(n, mu, P, Q)).lpNorm<1>();
    std::cout << n << " elements: Q/(mu P) " << Q / (mu * P) << ", a " << a << ", stick " << stick / a
              << " (exact " << middle / a << "), traction off by " << wrong / Q << '\n';
    EXPECT_LE(std::abs(stick - middle), h);
    EXPECT_LE(wrong, tolerance * Q);
  }
}

// The path gives what Newton's method gives, in at most two events a node.
TEST(Friction, pathsOfManyNodesAreShort) {
  constexpr int n = 80;
  for (const double mu : {0.0, 0.2, 0.8}) {
    const FrictionCase c = halfPlane(n, mu, 0.3, 9, 1);
    const FrictionSolution solution = solveFriction(c.problem, c.q, open(n));
    ASSERT_TRUE(solution.solved);
    FrictionWork work;
    const FrictionSystem system(c.problem, c.q, {}, work);
    const auto sets = followPath(system, 0);
    ASSERT_EQ(sets.size(), 1u) << mu;
    const auto onPath = system.newton(sets[0]);
    ASSERT_TRUE(onPath.has_value());
    EXPECT_LE((onPath->force - solution.force).lpNorm<Eigen::Infinity>(),
              1e-10 * solution.force.lpNorm<Eigen::Infinity>());
    EXPECT_LE(work.events, 2 * n);
    EXPECT_GT(work.events, 0);
  }
}

// Small whole numbers and symmetry: two things happen at one place of the path.
TEST(Friction, tiesAreNoTrouble) {
  Randoms random(5);
  for (int trial = 0; trial < problems(200); ++trial) {
    const int n = 2 + trial % 4;
    Matrix W = Matrix::Identity(2 * n, 2 * n) * 4;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        if (i != j) W(i, j) = W(n + i, n + j) = trial % 2;
    Vector q(2 * n);
    for (int i = 0; i < n; ++i) {
      q[i] = random.below(4) - 3;
      q[n + i] = random.below(5) - 2;
    }
    const FrictionCase c = frictionCase(W, 0.5 * random.below(4), q);
    const FrictionSolution solution = solveFriction(c.problem, c.q, open(n));
    ASSERT_TRUE(solution.solved) << trial;
    EXPECT_LE(worstFault(c, solution), 1e-12);
  }
}

// Tresca's law is an inequality of its own: where mu is 0 and c is not, forces stay below c, pressed or not.
TEST(Friction, fixedBoundsHold) {
  Randoms random(6);
  for (int trial = 0; trial < problems(200); ++trial) {
    const int n = 2 + trial % 5;
    FrictionCase c = randomFriction(random, n, 0);
    c.problem.along.law.limit = random.vector(n).cwiseAbs();
    if (trial % 3 == 0) c.problem.along.law.coefficient.setConstant(0.3);
    const FrictionSolution solution = solveFriction(c.problem, c.q, open(n));
    ASSERT_TRUE(solution.solved) << trial;
    EXPECT_LE(worstFault(c, solution), 1e-12) << trial;
  }
}

// A body that nothing but a limit of the shear stress holds along the line, and that expands: nearly all of
// it slips, to either side. Changes of one condition at a time would take some 2^n solves.
TEST(Friction, shearLimitsAloneHoldABody) {
  constexpr int n = 17;
  Randoms random(10);
  int paths = 0;
  for (int trial = 0; trial < problems(60); ++trial) {
    FrictionCase c = randomFriction(random, n, 0);
    const double stiffness = 1 / c.problem.W.diagonal().maxCoeff();
    c.q.head(n).setConstant(1);
    c.q.tail(n) += Vector::LinSpaced(n, -1, 1);
    c.problem.along.law.limit = stiffness / (100 * n) * (Vector::Ones(n) + random.vector(n).cwiseAbs());
    Matrix G = Matrix::Zero(2 * n, 1);
    G.bottomRows(n).setOnes();
    c.problem.G = G;
    const FrictionSolution solution = solveFriction(c.problem, c.q, open(n), Vector::Zero(1));
    ASSERT_TRUE(solution.solved) << trial;
    EXPECT_LE(std::abs(solution.force.tail(n).sum()), 1e-6 * c.problem.along.law.limit.sum());
    paths += solution.events > 0 ? 1 : 0;
    EXPECT_LE(solution.events, 5 * n);

    FrictionWork work;
    const Vector q = c.q;
    const FrictionSystem system(c.problem, q, {Vector::Zero(1), solution.rigid, 1e-9 * stiffness}, work);
    const auto sets = followPath(system, 0);
    ASSERT_EQ(sets.size(), 1u) << trial;
    const auto onPath = system.newton(sets[0]);
    ASSERT_TRUE(onPath.has_value());
    c.q -= G * solution.rigid;
    EXPECT_LE(worstFault(c, solution), 1e-12) << trial;
    EXPECT_LE(worstFault(c, *onPath), 1e-12) << trial;
  }
  std::cout << "path taken in " << paths << '\n';
  EXPECT_GT(paths, 0);
}

// In other units the same sets come in the same number of solves.
TEST(Friction, unitsDoNotMatter) {
  Randoms random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const FrictionCase c = randomBlocks(random, 5, 1);
    FrictionCase other = c;
    other.problem.W *= std::ldexp(1.0, -40);
    other.q *= std::ldexp(1.0, 12);
    const FrictionSolution one = solveFriction(c.problem, c.q, open(5));
    const FrictionSolution two = solveFriction(other.problem, other.q, open(5));
    ASSERT_TRUE(one.solved && two.solved);
    EXPECT_TRUE(one.sets == two.sets);
    EXPECT_EQ(one.solves, two.solves);
    EXPECT_EQ(std::ldexp(1.0, 52) * one.force, two.force);
  }
}

// A wedge that holds or lets go: three solutions, of which the middle one has the index -1. Begun at its
// sets, the solver does not end there.
TEST(Friction, solutionsOfNegativeIndexAreLeft) {
  Randoms random(8);
  int met = 0;
  for (int trial = 0; trial < 4000 && met < 3; ++trial) {
    const FrictionCase c = randomFriction(random, 2, 2);
    const std::vector<EnumeratedFriction> exact = enumerateFriction(c);
    for (const EnumeratedFriction& one : exact) {
      if (one.index > 0) continue;
      FrictionSets sets = open(2);
      for (int i = 0; i < 2; ++i) {
        const double p = one.force[i];
        const double t = one.force[2 + i];
        if (!(p > 1e-9 * one.force.maxCoeff())) continue;
        sets.closed[i] = 1;
        sets.slip[i] = std::abs(std::abs(t) - 2 * p) < 1e-9 * p ? (t > 0 ? 1 : -1) : 0;
      }
      FrictionWork work;
      const auto there = FrictionSystem(c.problem, c.q, {}, work).newton(sets);
      ASSERT_TRUE(there.has_value());
      EXPECT_EQ(there->index, -1);
      const FrictionSolution solution = solveFriction(c.problem, c.q, sets);
      ASSERT_TRUE(solution.solved);
      EXPECT_EQ(solution.index, 1);
      ++met;
    }
  }
  EXPECT_EQ(met, 3);
}

// A node on a spring at a slope, W = [1, c; c, 1], mu c > 1, drawn off by a and along by b > 2a: it lets go,
// or it is jammed and sticks; between the two it slips, with det A = 1 - mu c < 0.
TEST(Friction, wedgeHoldsOrLetsGo) {
  constexpr double c = 0.8;
  constexpr double mu = 2;
  const FrictionCase wedge = frictionCase(Matrix{{1, c}, {c, 1}}, mu, Vector{{1, 3}});
  const FrictionSolution taken = solveFriction(wedge.problem, wedge.q, open(1));
  ASSERT_TRUE(taken.solved);
  EXPECT_EQ(taken.force, (Vector{{0, 0}}));
  const std::vector<FrictionSolution> all = solutionsOnPath(wedge.problem, wedge.q, {}, taken);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].sets.closed[0], 0);
  EXPECT_EQ(all[0].index, 1);
  EXPECT_EQ(all[1].index, -1);
  EXPECT_NEAR(all[1].force[0], 1 / (mu * c - 1), 1e-14);
  EXPECT_NEAR(all[1].force[1], -mu / (mu * c - 1), 1e-14);
  EXPECT_EQ(all[2].index, 1);
  EXPECT_EQ(all[2].sets.slip[0], 0);
  EXPECT_NEAR(all[2].force[0], (3 * c - 1) / (1 - c * c), 1e-14);
  EXPECT_NEAR(all[2].force[1], (c - 3) / (1 - c * c), 1e-14);
  for (const FrictionSolution& each : all) EXPECT_LE(each.residual, 1e-14);
  // From the jammed state the solver stays there, and has met no sets with det A < 0.
  const FrictionSolution jammed = solveFriction(wedge.problem, wedge.q, {{1}, {0}});
  EXPECT_EQ(jammed.sets.slip[0], 0);
  EXPECT_FALSE(jammed.ambiguous);
  const FrictionSolution slipping = solveFriction(wedge.problem, wedge.q, {{1}, {-1}});
  EXPECT_TRUE(slipping.ambiguous);
  EXPECT_EQ(slipping.index, 1);
}

// What the path meets beyond its first solution are solutions, each once; it meets most that there are. Where
// several were met, some sets have det A < 0.
TEST(Friction, otherSolutionsAreFound) {
  Randoms random(12);
  int several = 0;
  int complete = 0;
  for (int trial = 0; trial < problems(20000) && several < 60; ++trial) {
    const int n = 2 + trial % 4;
    const double mu = 1 + 1.0 * random.below(1001) / 1000;
    const FrictionCase c = randomFriction(random, n, mu);
    const FrictionSolution taken = solveFriction(c.problem, c.q, open(n));
    ASSERT_TRUE(taken.solved);
    const std::vector<FrictionSolution> all = solutionsOnPath(c.problem, c.q, {}, taken);
    const std::vector<EnumeratedFriction> exact = enumerateFriction(c);
    for (const FrictionSolution& one : all) {
      EXPECT_EQ(std::count_if(exact.begin(), exact.end(),
                              [&](const EnumeratedFriction& other) {
                                return other.index == one.index &&
                                       (one.force - other.force).lpNorm<Eigen::Infinity>() <=
                                           1e-7 * (1 + other.force.lpNorm<Eigen::Infinity>());
                              }),
                1)
          << "trial " << trial;
      EXPECT_LE(one.residual, 1e-12);
    }
    if (exact.size() == 1) continue;
    ++several;
    complete += all.size() == exact.size() ? 1 : 0;
  }
  std::cout << "all solutions found in " << complete << " of " << several << " with several\n";
  EXPECT_GE(several, 40);
  EXPECT_GE(complete, 0.7 * several);
}

// Nothing moves a condition: across the line it carries no force, whatever its gap; along the line the bound,
// if its supports slip.
TEST(Friction, idleConditionsFollowTheirSupports) {
  Matrix W = Matrix::Identity(4, 4);
  W(1, 1) = W(2, 2) = 0;
  const FrictionCase c = frictionCase(W, 0.5, Vector{{-1, -1, 2, 3}});
  const FrictionSolution solution = solveFriction(c.problem, c.q, {{1, 1}, {0, 0}});
  ASSERT_TRUE(solution.solved);
  EXPECT_EQ(solution.force, (Vector{{1, 0, -0.5, 0}}));
}

// Conditions that come twice, and the four of a node in a rigid corner of any angle: the forces are one
// choice of many, which share the load.
TEST(Friction, dependentConditionsShareTheLoad) {
  const Matrix B{{1, 0}, {1, 0}, {0, 1}, {0, 1}};
  const FrictionCase twice = frictionCase(B * B.transpose(), 0.5, Vector{{-1, -1, 0.1, 0.1}});
  const FrictionSolution solution = solveFriction(twice.problem, twice.q, {{1, 1}, {0, 0}});
  ASSERT_TRUE(solution.solved);
  EXPECT_TRUE(solution.singular);
  EXPECT_LE(worstFault(twice, solution), 1e-12);
  EXPECT_NEAR(solution.force[0], 0.5, 1e-7);

  Randoms random(9);
  for (int trial = 0; trial < problems(300); ++trial) {
    const int n = 2 + trial % 3;  // of which the first two are the corner's
    const double angle = 0.3 + 0.02 * (trial % 120);
    const double mu = 0.01 * (trial % 80);
    Matrix C = Matrix::Zero(2 * n, 2 * n - 2);
    C.row(0) << 1, 0, Vector::Zero(2 * n - 4).transpose();
    C.row(1) << std::cos(angle), std::sin(angle), Vector::Zero(2 * n - 4).transpose();
    C.row(n) << 0, 1, Vector::Zero(2 * n - 4).transpose();
    C.row(n + 1) << -std::sin(angle), std::cos(angle), Vector::Zero(2 * n - 4).transpose();
    for (int i = 2; i < n; ++i) C(i, 2 * i - 2) = C(n + i, 2 * i - 1) = 1;
    const Vector root = random.vector((2 * n - 2) * (2 * n - 2));
    const Eigen::Map<const Matrix> R(root.data(), 2 * n - 2, 2 * n - 2);
    const Matrix S = R * R.transpose() + 0.1 * Matrix::Identity(2 * n - 2, 2 * n - 2);
    Vector u = random.vector(2 * n - 2);
    const FrictionCase c = frictionCase(C * S * C.transpose(), mu, C * u);
    const FrictionSolution held = solveFriction(c.problem, c.q, open(n));
    ASSERT_TRUE(held.solved) << "trial " << trial;
    EXPECT_LE(worstFault(c, held), 1e-9) << "trial " << trial;
  }
}

}  // namespace mortier::friction_test
