#include "linear/strip_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>
#include <random>

#include "linear/matrix_entries.h"
#include "unit/dense_reference.h"

namespace mortier {
namespace {

/// Matrices of springs of random stiffness between the nodes of grids, which the ground holds weakly, their
/// nodes in random order.
class Springs {
 public:
  void addGrid(int length, int width, bool closed) {
    const int first = count_;
    count_ += length * width;
    const auto at = [&](int i, int j) { return first + width * (i % length) + j; };
    for (int i = 0; i < length; ++i)
      for (int j = 0; j < width; ++j) {
        if (j + 1 < width) join(at(i, j), at(i, j + 1));
        if (i + 1 == length && !closed) continue;
        join(at(i, j), at(i + 1, j));
        if (j + 1 < width) join(at(i, j), at(i + 1, j + 1));
      }
  }

  [[nodiscard]] SparseSymmetric matrix() {
    std::vector<int> number(count_);
    std::iota(number.begin(), number.end(), 0);
    std::shuffle(number.begin(), number.end(), random_);
    std::vector<MatrixEntry> entries;
    const auto add = [&](int a, int b, double value) {
      entries.push_back({std::min(number[a], number[b]), std::max(number[a], number[b]), value});
    };
    for (const auto& [a, b, stiffness] : springs_) {
      add(a, a, stiffness);
      add(b, b, stiffness);
      add(a, b, -stiffness);
    }
    for (int i = 0; i < count_; ++i) add(i, i, 0.01);
    return assembled(count_, entries);
  }

 private:
  struct Spring {
    int a, b;
    double stiffness;
  };
  void join(int a, int b) {
    if (a != b) springs_.push_back({a, b, std::uniform_real_distribution<double>(0.5, 2)(random_)});
  }

  std::mt19937 random_{1};
  std::vector<Spring> springs_;
  int count_ = 0;
};

void agreesWithDenseElimination(const SparseSymmetric& matrix) {
  const Matrix K = dense(matrix.pattern, matrix.values);
  const auto solver = stripSolver(matrix.pattern);
  ASSERT_TRUE(solver->factorise(matrix.values));
  const Vector f = Vector::LinSpaced(K.rows(), -1, 2);
  Vector x = f;
  solver->condense(x);
  solver->expand(x);
  const Vector expected = K.llt().solve(f);
  EXPECT_LE((x - expected).norm(), 1e-11 * expected.norm());
}

TEST(StripSolver, agreesWithDenseEliminationOnStripsAndRings) {
  for (const int length : {1, 2, 7, 40, 150})
    for (const int width : {1, 2, 9})
      for (const bool closed : {false, true}) {
        Springs springs;
        springs.addGrid(length, width, closed);
        agreesWithDenseElimination(springs.matrix());
      }
}

TEST(StripSolver, agreesWithDenseEliminationOnSeveralPartsAndWideOnes) {
  Springs several;
  several.addGrid(30, 3, false);
  several.addGrid(1, 1, false);
  several.addGrid(20, 5, true);
  agreesWithDenseElimination(several.matrix());
  Springs wide;
  wide.addGrid(1, 400, false);
  wide.addGrid(40, 40, false);
  agreesWithDenseElimination(wide.matrix());
  std::mt19937 random(1);
  const System full(randomMatrix(random, 500, 2000, true), true);  // no strip at all
  agreesWithDenseElimination({full.pattern, full.values});
}

TEST(StripSolver, seesThatAMatrixIsNotPositiveDefinite) {
  Springs springs;
  springs.addGrid(30, 4, false);
  SparseSymmetric matrix = springs.matrix();
  const auto solver = stripSolver(matrix.pattern);
  EXPECT_TRUE(solver->factorise(matrix.values));
  matrix.values[matrix.pattern.columnStart[60]] *= -1;
  EXPECT_FALSE(solver->factorise(matrix.values));
}

TEST(MatrixEntries, ofOnePlaceAreAdded) {
  const auto [pattern, values] = assembled(3, {{2, 2, 1}, {0, 2, 3}, {1, 1, 2}, {0, 0, 5}, {0, 2, 4}});
  EXPECT_EQ(pattern.columnStart, (std::vector<int>{0, 2, 3, 4}));
  EXPECT_EQ(pattern.rows, (std::vector<int>{0, 2, 1, 2}));
  EXPECT_EQ(values, (std::vector<double>{5, 7, 2, 1}));
}

}  // namespace
}  // namespace mortier
