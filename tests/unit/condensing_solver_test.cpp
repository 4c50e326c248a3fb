#include "linear/condensing_solver.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <numeric>
#include <random>

#include "fem/body.h"
#include "material/perzyna.h"
#include "mesh/generate.h"

namespace mortier {
namespace {

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

Matrix dense(const SparsePattern& pattern, const std::vector<double>& values) {
  Matrix K = Matrix::Zero(pattern.size, pattern.size);
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.columnStart[j]; k < pattern.columnStart[j + 1]; ++k) {
      K(pattern.rows[k], j) = values[k];
      if (pattern.symmetric) K(j, pattern.rows[k]) = values[k];
    }
  return K;
}

/// About `links` neighbours a row; diagonally dominant by a little, so positive definite where symmetric.
Matrix randomMatrix(std::mt19937& random, int n, double links, bool symmetric) {
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

std::vector<int> randomSubset(std::mt19937& random, int n, int count) {
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  std::shuffle(all.begin(), all.end(), random);
  all.resize(count);
  return all;
}

std::vector<int> others(int n, const std::vector<int>& kept) {
  std::vector<int> result;
  for (int i = 0; i < n; ++i)
    if (std::find(kept.begin(), kept.end(), i) == kept.end()) result.push_back(i);
  return result;
}

/// Schur complement, condensation and solution against dense elimination.
void compare(const Engine& engine, const System& system, const std::vector<int>& kept, std::mt19937& random) {
  SCOPED_TRACE(std::string(engine.name) + ", " + std::to_string(system.pattern.size) + " equations, " +
               std::to_string(kept.size()) + " kept, " +
               (system.pattern.symmetric ? "symmetric" : "unsymmetric"));
  const auto solver = engine.make(system.pattern, kept);
  ASSERT_TRUE(solver->factorise(system.values));
  const Matrix K = dense(system.pattern, system.values);
  const std::vector<int> interior = others(system.pattern.size, kept);
  const Matrix Kbb = K(interior, interior);
  const Eigen::PartialPivLU<Matrix> lu(Kbb.size() > 0 ? Kbb : Matrix::Identity(1, 1));
  const auto solveInterior = [&](const Matrix& right) {
    return interior.empty() ? right : Matrix(lu.solve(right));
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
    for (const Engine& engine : engines) compare(engine, System(K, false), {}, random);
  }
}

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

}  // namespace
}  // namespace mortier
