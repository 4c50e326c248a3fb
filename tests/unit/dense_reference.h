// Condensing solvers against dense elimination.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <numeric>
#include <random>
#include <string>

#include "linear/condensing_solver.h"

namespace mortier {

/// Relative to the size of what is computed; the random matrices have condition numbers up to about 1e3.
constexpr double tolerance = 1e-11;

struct Engine {
  const char* name;
  std::unique_ptr<CondensingSolver> (*make)(const SparsePattern&, const std::vector<int>&);
};

constexpr Engine engines[] = {{"multifrontal", multifrontalSolver}, {"suitesparse", suiteSparseSolver}};

struct System {
  SparsePattern pattern;
  std::vector<double> values;

  /// From all of a matrix, zeros left out but for their mirror images.
  System(const Matrix& K, bool symmetric) {
    pattern.size = static_cast<int>(K.rows());
    pattern.symmetric = symmetric;
    pattern.columnStart = {0};
    for (int j = 0; j < pattern.size; ++j) {
      for (int i = symmetric ? j : 0; i < pattern.size; ++i)
        if (i == j || K(i, j) != 0 || K(j, i) != 0) {
          pattern.rows.push_back(i);
          values.push_back(K(i, j));
        }
      pattern.columnStart.push_back(static_cast<int>(pattern.rows.size()));
    }
  }
};

inline Matrix denseOf(const SparsePattern& pattern, const std::vector<double>& values) {
  Matrix K = Matrix::Zero(pattern.size, pattern.size);
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.columnStart[j]; k < pattern.columnStart[j + 1]; ++k) {
      K(pattern.rows[k], j) = values[k];
      if (pattern.symmetric) K(j, pattern.rows[k]) = values[k];
    }
  return K;
}

/// About `links` neighbours a row; diagonally dominant by a little, so positive definite where symmetric.
inline Matrix randomMatrix(std::mt19937& random, int n, double links, bool symmetric) {
  std::uniform_real_distribution<double> value(-1, 1);
  std::uniform_int_distribution<int> index(0, n - 1);
  Matrix K = Matrix::Zero(n, n);
  for (int k = 0; k < n * links / 2; ++k) {
    const int i = index(random);
    const int j = index(random);
    K(i, j) = value(random);
    K(j, i) = symmetric ? K(i, j) : value(random);
  }
  for (int i = 0; i < n; ++i) {
    K(i, i) = 0;
    K(i, i) = 0.05 + std::max(K.row(i).cwiseAbs().sum(), K.col(i).cwiseAbs().sum());
  }
  return K;
}

inline std::vector<int> randomSubset(std::mt19937& random, int n, int count) {
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  std::shuffle(all.begin(), all.end(), random);
  all.resize(count);
  return all;
}

inline std::vector<int> others(int n, const std::vector<int>& kept) {
  std::vector<int> result;
  for (int i = 0; i < n; ++i)
    if (std::find(kept.begin(), kept.end(), i) == kept.end()) result.push_back(i);
  return result;
}

/// Schur complement, condensation and solution against dense elimination.
inline void compare(const Engine& engine, const System& system, const std::vector<int>& kept,
                    std::mt19937& random) {
  SCOPED_TRACE(std::string(engine.name) + ", " + std::to_string(system.pattern.size) + " equations, " +
               std::to_string(kept.size()) + " kept, " +
               (system.pattern.symmetric ? "symmetric" : "unsymmetric"));
  const auto solver = engine.make(system.pattern, kept);
  ASSERT_TRUE(solver->factorise(system.values));
  const Matrix K = denseOf(system.pattern, system.values);
  const std::vector<int> interior = others(system.pattern.size, kept);
  const Matrix Kbb = K(interior, interior);
  const Eigen::PartialPivLU<Matrix> lu(Kbb.size() > 0 ? Kbb : Matrix::Identity(1, 1));
  const auto solveInterior = [&](const Matrix& right) {
    return right.size() == 0 ? right : Matrix(lu.solve(right));
  };
  const Matrix S = K(kept, kept) - K(kept, interior) * solveInterior(Matrix(K(interior, kept)));
  ASSERT_EQ(solver->schurComplement().rows(), S.rows());
  const double scale = K.cwiseAbs().maxCoeff();
  EXPECT_LE((solver->schurComplement() - S).lpNorm<Eigen::Infinity>(), tolerance * scale);

  std::normal_distribution<double> normal;
  Vector x(system.pattern.size);
  for (double& value : x) value = normal(random);
  const Vector f = K * x;
  Vector y = f;
  solver->condense(y);
  if (!kept.empty()) {
    const Vector condensed = Vector(f(kept)) - K(kept, interior) * Vector(solveInterior(Vector(f(interior))));
    EXPECT_LE((Vector(y(kept)) - condensed).cwiseAbs().maxCoeff(), tolerance * f.cwiseAbs().maxCoeff());
    y(kept) = x(kept);
  }
  solver->expand(y);
  EXPECT_LE((y - x).cwiseAbs().maxCoeff(), tolerance * x.cwiseAbs().maxCoeff());
}

}  // namespace mortier
