#include "linear/condensing_solver.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>
#include <numeric>
#include <random>

#include "linear/elimination.h"
#include "unit/dense_reference.h"

namespace mortier::condensing_solver_test {

TEST(CondensingSolver, randomMatricesAgreeWithDenseElimination) {
  std::mt19937 random(1);
  for (const bool symmetric : {true, false})
    for (const int n : {1, 2, 3, 7, 20, 60, 200})
      for (const double links : {2.0, 4.0, 12.0}) {
        const System system(randomMatrix(random, n, links, symmetric), symmetric);
        for (const int count : {0, 1, n / 3, n - 1, n})
          for (const Engine& engine : engines)
            compare(engine, system, randomSubset(random, n, count), random);
      }
}

// One front of more pivots than the small kernels take.
TEST(CondensingSolver, fullMatricesAgreeWithDenseElimination) {
  std::mt19937 random(2);
  for (const bool symmetric : {true, false})
    for (const int n : {11, 12, 13, 95, 110}) {
      const System system(randomMatrix(random, n, 4 * n, symmetric), symmetric);
      for (const int count : {0, 5, n - 3})
        for (const Engine& engine : engines) compare(engine, system, randomSubset(random, n, count), random);
    }
}

// A diagonal of zeros: rows must change places, in the small kernel and in LAPACK's.
TEST(CondensingSolver, unsymmetricFrontsPivot) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1, 1);
  for (const int n : {4, 10, 40}) {
    Matrix K(n, n);
    for (double& entry : K.reshaped()) entry = value(random);
    K.diagonal().setZero();
    for (const int count : {0, n / 4})
      for (const Engine& engine : engines)
        compare(engine, System(K, false), randomSubset(random, n, count), random);
  }
}

/// A grid whose elimination tree is cut into many pieces; each node couples with its eight neighbours.
struct Grid {
  SparsePattern pattern;
  std::vector<double> values;

  Grid(std::mt19937& random, int side, bool symmetric) {
    std::uniform_real_distribution<double> value(-1, 1);
    pattern.size = side * side;
    pattern.symmetric = symmetric;
    pattern.columnStart = {0};
    for (int j = 0; j < pattern.size; ++j) {
      for (int i = symmetric ? j : 0; i < pattern.size; ++i)
        if (std::abs(i / side - j / side) <= 1 && std::abs(i % side - j % side) <= 1) {
          pattern.rows.push_back(i);
          values.push_back(i == j ? 9 : value(random));
        }
      pattern.columnStart.push_back(static_cast<int>(pattern.rows.size()));
    }
  }

  [[nodiscard]] Vector times(const Vector& x) const {
    Vector y = Vector::Zero(pattern.size);
    for (int j = 0; j < pattern.size; ++j)
      for (int k = pattern.columnStart[j]; k < pattern.columnStart[j + 1]; ++k) {
        y[pattern.rows[k]] += values[k] * x[j];
        if (pattern.symmetric && pattern.rows[k] != j) y[j] += values[k] * x[pattern.rows[k]];
      }
    return y;
  }
};

TEST(Elimination, ordersOfSeveralThreadsAreEqual) {
  constexpr int side = 120;  // worth a process
  std::mt19937 random(5);
  const Grid system(random, side, true);
  const std::vector<int> kept{0, 7, side};
  const std::vector<int> order = analyse(system.pattern, kept).order;
  Threads threads(3);
  std::vector<std::vector<int>> orders(6);
  threads.forEach(6, [&](int i) { orders[i] = analyse(system.pattern, kept).order; });
  for (const std::vector<int>& each : orders) EXPECT_EQ(each, order);
}

// The tree is the same, so is the order of every sum: no bit depends on the number of threads.
TEST(CondensingSolver, threadsChangeNothing) {
  constexpr int side = 90;
  std::mt19937 random(4);
  for (const bool symmetric : {true, false}) {
    const Grid system(random, side, symmetric);
    std::vector<int> kept(side);
    std::iota(kept.begin(), kept.end(), 0);
    const Vector solution = Vector::LinSpaced(side * side, -1, 2);
    const Vector force = system.times(solution);
    Matrix S;
    Vector x;
    for (const int count : {1, 2, 5}) {
      Threads threads(count);
      const auto solver = multifrontalSolver(system.pattern, kept);
      solver->use(threads);
      for (int repetition = 0; repetition < 3; ++repetition) {
        ASSERT_TRUE(solver->factorise(system.values));
        Vector y = force;
        solver->condense(y);
        y(kept) = solver->schurComplement().partialPivLu().solve(y(kept)).eval();
        solver->expand(y);
        if (S.size() == 0) {
          S = solver->schurComplement();
          x = y;
          EXPECT_LE((x - solution).cwiseAbs().maxCoeff(), tolerance);
        }
        EXPECT_TRUE(S == solver->schurComplement() && x == y) << count << " threads, symmetric " << symmetric;
      }
    }
  }
}

// Whatever the units: values and forces are scaled.
TEST(CondensingSolver, singlePrecisionIsCorrectedToRounding) {
  constexpr int side = 60;
  std::mt19937 random(9);
  Grid system(random, side, true);
  std::vector<int> kept(side);
  std::iota(kept.begin(), kept.end(), 0);
  const Vector solution = Vector::LinSpaced(side * side, -1, 2);
  const std::vector<double> values = system.values;
  for (const double unit : {1.0, 0x1p150, 0x1p-150}) {
    for (size_t k = 0; k < values.size(); ++k) system.values[k] = unit * values[k];
    const Vector force = system.times(solution);
    const auto solver = singleSolver(system.pattern, kept);
    ASSERT_TRUE(solver->factorise(system.values));
    Vector x = Vector::Zero(solution.size());
    std::vector<double> errors;
    for (int i = 0; i < 4; ++i) {
      Vector y = force - system.times(x);
      solver->condense(y);
      y(kept) = solver->schurComplement().partialPivLu().solve(y(kept)).eval();
      solver->expand(y);
      x += y;
      errors.push_back((x - solution).cwiseAbs().maxCoeff());
    }
    EXPECT_GT(errors.front(), 1e-9);  // single precision indeed
    EXPECT_LE(errors.front(), 1e-4);
    EXPECT_LE(errors.back(), tolerance);
  }
}

// And the solver is good again with the next values.
TEST(CondensingSolver, singularAndIndefiniteMatricesAreReported) {
  std::mt19937 random(6);
  for (const bool symmetric : {true, false})
    for (const int n : {2, 8, 40, 150}) {
      const Matrix good = randomMatrix(random, n, n < 50 ? 4.0 * n : 4.0, symmetric);
      const System system(good, symmetric);
      std::vector<std::vector<double>> bad;
      bad.emplace_back(system.values.size(), 0.0);
      Matrix K = good;  // the last row and column vanish
      K.row(n - 1).setZero();
      K.col(n - 1).setZero();
      const auto valuesOf = [&](const Matrix& matrix) {
        std::vector<double> values;
        for (int j = 0; j < n; ++j)
          for (int k = system.pattern.columnStart[j]; k < system.pattern.columnStart[j + 1]; ++k)
            values.push_back(matrix(system.pattern.rows[k], j));
        return values;
      };
      bad.push_back(valuesOf(K));
      if (symmetric) {
        K = good;
        K(n / 2, n / 2) *= -1;
        bad.push_back(valuesOf(K));
        bad.push_back(valuesOf(-good));
      }
      K = good;
      K(n / 2, n / 2) = std::numeric_limits<double>::quiet_NaN();
      for (const Engine& engine : engines) {
        const auto solver = engine.make(system.pattern, {});
        for (size_t k = 0; k < bad.size(); ++k)
          EXPECT_FALSE(solver->factorise(bad[k]))
              << engine.name << ", n " << n << ", symmetric " << symmetric << ", case " << k;
        // The libraries do not look for NaN.
        if (engine.make == multifrontalSolver) {
          EXPECT_FALSE(solver->factorise(valuesOf(K))) << "NaN, n " << n;
        }
        EXPECT_TRUE(solver->factorise(system.values));
        Vector x = good * Vector::Ones(n);
        solver->condense(x);
        solver->expand(x);
        EXPECT_LE((x.array() - 1).abs().maxCoeff(), tolerance);
      }
    }
}

}  // namespace mortier::condensing_solver_test
