#include "contact/pressure_compliance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <iostream>
#include <random>

#include "contact/coupling.h"
#include "contact/end_rows.h"
#include "unit/random_trace.h"
#include "unit/straight_lines.h"

namespace mortier::coupling_test {

constexpr double compliance = 2e-6;
constexpr double rounding = 1e-13;

Coupling coupled(CouplingKind kind, const Trace& nonmortar, const Trace& mortar, int degree = 1,
                 double of = compliance, bool applied = true) {
  const StraightLines lines(nonmortar, mortar, degree);
  return couple(
      kind, lines.refinement, distanceOfCurves, {}, false, {},
      {applied, of, std::vector<char>(nonmortar.size(), 0), std::vector<char>(nonmortar.size(), 0)});
}

Trace evenly(int elements) {
  Trace trace;
  for (int i = 0; i <= elements; ++i) trace.push_back(static_cast<double>(i) / elements);
  return trace;
}

// Of nodal forces of a uniform pressure nothing, of all others what loses energy.
TEST(PressureCompliance, isSymmetricAndNonnegativeAndWithoutEffectOnUniformPressures) {
  std::mt19937 random(7);
  for (int pair = 0; pair < 40; ++pair) {
    const Trace fine = randomTrace(random, 24, 0, 1, 3);
    const Trace coarse = randomTrace(random, 5, 0, 1, 3);
    for (const CouplingKind kind : {CouplingKind::mortar, CouplingKind::weighted})
      for (const int degree : {1, 2}) {
        const Coupling coupling = coupled(kind, fine, coarse, degree);
        const Matrix S(coupling.yielding.S);
        const Vector weights = forcesAtEnds(coupling.ends, coupling.mass * Vector::Ones(S.rows()));
        const double size = S.cwiseAbs().maxCoeff();
        EXPECT_GT(size, 0);
        EXPECT_LE((S - S.transpose()).cwiseAbs().maxCoeff(), rounding * size);
        EXPECT_LE((S * weights).cwiseAbs().maxCoeff(), 100 * rounding * size * weights.maxCoeff());
        EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix>(S).eigenvalues()[0], -100 * rounding * size);
      }
  }
}

// A force on one node of a fine side: c/E2 (h2/h1 - 1).
TEST(PressureCompliance, isWhatTheMortarMeshLacks) {
  for (const int ratio : {2, 4, 8}) {
    const Matrix S(coupled(CouplingKind::weighted, evenly(8 * ratio), evenly(8)).yielding.S);
    EXPECT_NEAR(S(4 * ratio, 4 * ratio), 0.4 * compliance * (ratio - 1), rounding);
  }
  EXPECT_EQ(coupled(CouplingKind::mortar, evenly(8), evenly(8)).yielding.S.nonZeros(), 0);
  EXPECT_EQ(coupled(CouplingKind::mortar, evenly(8), evenly(16)).yielding.S.nonZeros(), 0);
  EXPECT_EQ(coupled(CouplingKind::mortar, evenly(16), evenly(8), 1, 0).yielding.S.nonZeros(), 0);
  EXPECT_EQ(coupled(CouplingKind::interpolation, evenly(16), evenly(8)).yielding.S.nonZeros(), 0);
  EXPECT_EQ(coupled(CouplingKind::mortar, evenly(16), evenly(8), 1, compliance, false).yielding.S.nonZeros(),
            0);
}

// Pressures that alternate vanish in the means, linear ones stay.
TEST(PressureCompliance, meansKeepLinearPressures) {
  const Coupling coupling = coupled(CouplingKind::weighted, evenly(32), evenly(8));
  const Matrix means(coupling.yielding.means);
  Vector alternating(33);
  for (int i = 0; i < 33; ++i) alternating[i] = i % 2 == 0 ? 1 : -1;
  EXPECT_LE((means * alternating).segment(4, 25).cwiseAbs().maxCoeff(), rounding);
  const Vector linear = Vector::LinSpaced(33, 3, -1);
  EXPECT_LE((means * linear - linear).cwiseAbs().maxCoeff(), 1e-12);
}

/// The least of |its projection to the mortar trace|^2 + p'S p E2/h2 over |pressure|^2, its root.
double stability(const Coupling& coupling, const Coupling& own, double h2) {
  const auto alongY = [](const Matrix& C) { return Matrix(C(Eigen::all, Eigen::seq(1, Eigen::last, 2))); };
  const Vector root = coupling.mass.diagonal().cwiseSqrt();
  const Matrix M = root.asDiagonal() * alongY(Matrix(coupling.C2));
  // Columns are the nodes of the trace; rows of the mass are in the order of the line, from the other end.
  const auto n = static_cast<Eigen::Index>(own.nodes.size());
  Matrix P(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) P(own.nodes[i], own.nodes[j]) = own.mass.coeff(i, j);
  const Matrix S = root.asDiagonal() * Matrix(coupling.yielding.S) * root.asDiagonal();
  const Matrix Q = M * P.llt().solve(M.transpose()) + S / (compliance * h2);
  return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Matrix>(Q).eigenvalues()[0]));
}

// Pressures of all rows, wherever the nodes of both sides lie.
TEST(PressureCompliance, keepsTheInfSupConstant) {
  for (const int degree : {1, 2})
    for (const double ratio : {1.1, 1.2, 1.35, 1.5, 1.7, 2.0, 3.0, 4.0, 8.0}) {
      double least = 1;
      double without = 1;
      for (int position = 0; position < 10; ++position) {
        const double shift = -0.5 + 0.1 * position;
        const double node = 1.0 / 24;  // distance of the nodes of the mortar trace
        const Trace nonmortar = evenly(static_cast<int>(std::lround(24 * ratio)));
        Trace mortar;
        for (int i = 0; i <= 24 / degree + 3; ++i) mortar.push_back((shift - 1 + i) * node * degree);
        Coupling coupling = coupled(CouplingKind::weighted, nonmortar, mortar, degree);
        const Coupling own = coupled(CouplingKind::mortar, mortar, mortar, degree, compliance, false);
        least = std::min(least, stability(coupling, own, node));
        coupling.yielding.S.setZero();
        without = std::min(without, stability(coupling, own, node));
      }
      std::cout << "degree " << degree << ", mortar nodes " << ratio
                << " times as far apart: inf-sup constant " << least << ", without S " << without << "\n";
      EXPECT_GE(least, 0.3);
      EXPECT_LE(without, 0.01);
    }
}

// A force on the row at an end acts at that end, whether the line or what it faces ends there.
TEST(EndRows, actWhereContactEnds) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 60; ++trial) {
    const Trace nonmortar = randomTrace(random, 3 + trial % 9, 0, 1, 5);
    const bool inside = trial % 2 == 1;  // the mortar line ends within an element of the nonmortar one
    const Trace mortar = randomTrace(random, 6, inside ? 0.05 : -0.1, inside ? 0.93 : 1.1, 3);
    for (const CouplingKind kind : {CouplingKind::mortar, CouplingKind::weighted})
      for (const int degree : {1, 2}) {
        const Coupling coupling = coupled(kind, nonmortar, mortar, degree);
        const auto n = coupling.nodes.size();
        if (n < 2 || rowDegree(kind, degree) == 2) continue;
        const Matrix C(coupling.C2);
        const auto placeOf = [&](Eigen::Index row) {  // of a force on the mortar nodes
          double place = 0;
          for (Eigen::Index k = 0; 2 * k < C.cols(); ++k) {
            const auto count = static_cast<Eigen::Index>(mortar.size());
            const double x = k < count ? mortar[k] : (mortar[k - count] + mortar[k - count + 1]) / 2;
            place += C(row, 2 * k + 1) * x;
          }
          return place;
        };
        const auto last = static_cast<Eigen::Index>(n) - 1;
        EXPECT_NEAR(placeOf(0), inside ? mortar.front() : 0, 1e-12);
        EXPECT_NEAR(placeOf(last), inside ? mortar.back() : 1, 1e-12);
        const Vector uniform = forcesAtEnds(coupling.ends, coupling.mass * Vector::Ones(C.rows()));
        EXPECT_GT(uniform.minCoeff(), 0);
        EXPECT_NEAR(uniform.sum(), inside ? mortar.back() - mortar.front() : 1, 1e-12);
      }
  }
}

}  // namespace mortier::coupling_test
