#include "contact/coupling.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <functional>
#include <iostream>
#include <random>

#include "unit/random_trace.h"
#include "unit/straight_lines.h"

namespace mortier::coupling_test {

constexpr CouplingKind kinds[] = {CouplingKind::interpolation, CouplingKind::mortar};

/// Rows along the y axis: C u = B u1 - A u2 of the components along the normal.
struct Scalar {
  std::vector<int> nodes;
  Matrix mass, B, A;
};

Scalar scalar(CouplingKind kind, const Trace& nonmortar, const Trace& mortar, int degree = 1) {
  const Coupling coupling =
      couple(kind, StraightLines(nonmortar, mortar, degree).refinement, distanceOfCurves);
  const auto alongY = [](const Matrix& C) {
    EXPECT_EQ(C(Eigen::all, Eigen::seq(0, Eigen::last, 2)).cwiseAbs().sum(), 0);
    return Matrix(C(Eigen::all, Eigen::seq(1, Eigen::last, 2)));
  };
  return {coupling.nodes, Matrix(coupling.mass), -alongY(Matrix(coupling.C1)), alongY(Matrix(coupling.C2))};
}

/// The accuracy asked of what the couplings reproduce, for values of order one.
constexpr double reproduced = 1e-14;

Vector asVector(const Trace& trace) {
  return Eigen::Map<const Vector>(trace.data(), static_cast<Eigen::Index>(trace.size()));
}

/// The piecewise linear function through (trace, values) at s.
double evaluate(const Trace& trace, const Vector& values, double s) {
  size_t i = 1;
  while (i + 1 < trace.size() && trace[i] < s) ++i;
  const double x = (s - trace[i - 1]) / (trace[i] - trace[i - 1]);
  return (1 - x) * values[i - 1] + x * values[i];
}

double rowSumError(const Matrix& A) {
  return (A.rowwise().sum().array() - 1).abs().maxCoeff();
}

// Worked out with fractions; it also stands in the header.
TEST(Coupling, threeAndThreeNodesGiveExactFractions) {
  const Trace nonmortar{0, 1.0 / 2, 1};
  const Trace mortar{0, 1.0 / 3, 1};
  const Scalar projection = scalar(CouplingKind::mortar, nonmortar, mortar);
  const Matrix W{{2, 1, 0}, {1, 4, 1}, {0, 1, 2}};
  const Matrix M{{56, 51, 1}, {16, 138, 62}, {0, 27, 81}};
  const Matrix A{{30, 9, -3}, {-4, 33, 7}, {2, -3, 37}};
  constexpr double rounding = 1e-15;
  EXPECT_EQ(projection.nodes, (std::vector<int>{0, 1, 2}));
  EXPECT_LE((projection.mass - W / 12).cwiseAbs().maxCoeff(), rounding);
  EXPECT_EQ(projection.B, Matrix::Identity(3, 3));
  EXPECT_LE((projection.A - A / 36).cwiseAbs().maxCoeff(), rounding);

  const Matrix interpolated{{1, 0, 0}, {0, 0.75, 0.25}, {0, 0, 1}};
  EXPECT_LE((scalar(CouplingKind::interpolation, nonmortar, mortar).A - interpolated).cwiseAbs().maxCoeff(),
            rounding);

  const Scalar means = scalar(CouplingKind::weighted, nonmortar, mortar);
  const Vector w = Vector{{3, 6, 3}} / 12;
  EXPECT_LE((means.mass - Matrix(w.asDiagonal())).cwiseAbs().maxCoeff(), rounding);
  EXPECT_LE((w.asDiagonal() * means.B - W / 12).cwiseAbs().maxCoeff(), rounding);
  EXPECT_LE((w.asDiagonal() * means.A - M / 432).cwiseAbs().maxCoeff(), rounding);
}

TEST(Coupling, reproducesConstantsAndLinearFunctions) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> elements(1, 60);
  double worst = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const double grading = trial % 2 == 0 ? 3 : 1000;
    const Trace nonmortar = randomTrace(random, elements(random), 0, 1, grading);
    const Trace mortar = randomTrace(random, elements(random), 0, 1, grading);
    for (const CouplingKind kind : kinds) {
      const Scalar coupling = scalar(kind, nonmortar, mortar);
      ASSERT_EQ(coupling.A.rows(), static_cast<Eigen::Index>(nonmortar.size()));
      const double linear = (coupling.A * asVector(mortar) - asVector(nonmortar)).cwiseAbs().maxCoeff();
      worst = std::max({worst, linear, rowSumError(coupling.A)});
      ASSERT_LE(rowSumError(coupling.A), reproduced);
      ASSERT_LE(linear, reproduced);
    }
  }
  std::cout << "constants and linear functions on 1000 random pairs: error at most " << worst << "\n";
}

// Lines with more rows are projected a part at a time; what far nodes have of each other is nothing.
TEST(Coupling, longLinesReproduceConstantsAndLinearFunctions) {
  std::mt19937 random(7);
  for (const double grading : {1.5, 3.0, 100.0}) {
    const Trace nonmortar = randomTrace(random, 700, 0, 1, grading);
    const Trace mortar = randomTrace(random, 900, 0, 1, grading);
    const Scalar coupling = scalar(CouplingKind::mortar, nonmortar, mortar);
    EXPECT_LE(rowSumError(coupling.A), reproduced);
    EXPECT_LE((coupling.A * asVector(mortar) - asVector(nonmortar)).cwiseAbs().maxCoeff(), reproduced);
    // The mass times the rows is of neighbours alone.
    const Matrix D = coupling.mass * coupling.A;
    double far = 0;
    for (Eigen::Index i = 0; i < D.rows(); ++i)
      for (Eigen::Index j = 0; j < D.cols(); ++j)
        if (mortar[std::min<size_t>(j + 1, 900)] < nonmortar[std::max<Eigen::Index>(i - 1, 0)] ||
            mortar[std::max<Eigen::Index>(j - 1, 0)] > nonmortar[std::min<size_t>(i + 1, 700)])
          far = std::max(far, std::abs(D(i, j)));
    EXPECT_LE(far, reproduced * D.maxCoeff());
  }
}

// D A = M: the projection of a mortar function differs from it by something orthogonal to the nonmortar
// functions.
TEST(Coupling, mortarIsTheProjection) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const Trace nonmortar = randomTrace(random, 7, 0, 1, 5);
    const Trace mortar = randomTrace(random, 10, 0, 1, 5);
    const Scalar coupling = scalar(CouplingKind::mortar, nonmortar, mortar);
    Vector v(mortar.size());
    for (double& x : v) x = value(random);
    const Vector projection = coupling.A * v;
    // Gauss's rule of two points on a refinement of its own.
    Trace ends = nonmortar;
    ends.insert(ends.end(), mortar.begin(), mortar.end());
    std::sort(ends.begin(), ends.end());
    Vector moments = Vector::Zero(projection.size());
    for (size_t k = 1; k < ends.size(); ++k)
      for (const double side : {-1.0, 1.0}) {
        const double length = ends[k] - ends[k - 1];
        const double s = (ends[k] + ends[k - 1] + side * length / std::sqrt(3.0)) / 2;
        const double error = evaluate(nonmortar, projection, s) - evaluate(mortar, v, s);
        for (Eigen::Index i = 0; i < moments.size(); ++i)
          moments[i] += length / 2 * error * evaluate(nonmortar, Vector::Unit(moments.size(), i), s);
      }
    ASSERT_LE(moments.cwiseAbs().maxCoeff(), reproduced);
  }
}

TEST(Coupling, interpolationTakesTheValuesAtTheNodes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int trial = 0; trial < 100; ++trial) {
    const Trace nonmortar = randomTrace(random, 17, 0, 1, 10);
    const Trace mortar = randomTrace(random, 11, -0.1, 0.8, 10);
    const Scalar coupling = scalar(CouplingKind::interpolation, nonmortar, mortar);
    Vector v(mortar.size());
    for (double& x : v) x = value(random);
    const Vector values = coupling.A * v;
    for (size_t i = 0; i < coupling.nodes.size(); ++i) {
      ASSERT_LE(nonmortar[coupling.nodes[i]], 0.8);
      ASSERT_NEAR(values[i], evaluate(mortar, v, nonmortar[coupling.nodes[i]]), reproduced);
    }
  }
}

TEST(Coupling, matchingTracesGiveTheIdentity) {
  std::mt19937 random(4);
  for (const int elements : {1, 2, 9, 50}) {
    const Trace trace = randomTrace(random, elements, -2, 3, 20);
    for (const CouplingKind kind : kinds) {
      const Matrix A = scalar(kind, trace, trace).A;
      EXPECT_LE((A - Matrix::Identity(A.rows(), A.cols())).cwiseAbs().maxCoeff(), reproduced);
    }
  }
}

// Quadratic functions too, where both traces are quadratic; the means see them alike.
TEST(Coupling, quadraticTracesReproduceQuadraticFunctions) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> elements(1, 30);
  const auto valuesOn = [](const Trace& trace, auto f) {
    const SmoothPart part = straightPart(trace, 2);
    Vector values(part.traceNodes());
    for (int i = 0; i < values.size(); ++i) {
      const auto vertices = static_cast<int>(trace.size());
      values[i] = f((i < vertices ? part.points[i] : part.middlePoints[i - vertices]).x());
    }
    return values;
  };
  for (int trial = 0; trial < 100; ++trial) {
    const Trace nonmortar = randomTrace(random, elements(random), 0, 1, 20);
    const Trace mortar = randomTrace(random, elements(random), 0, 1, 20);
    for (const CouplingKind kind :
         {CouplingKind::interpolation, CouplingKind::mortar, CouplingKind::weighted})
      for (const int power : {0, 1, 2}) {
        const auto f = [&](double s) { return std::pow(s, power); };
        const Scalar coupling = scalar(kind, nonmortar, mortar, 2);
        const auto rows = kind == CouplingKind::weighted ? nonmortar.size() : 2 * nonmortar.size() - 1;
        ASSERT_EQ(coupling.nodes.size(), rows);
        ASSERT_EQ(coupling.A.rows(), static_cast<Eigen::Index>(rows));
        const Vector jump = coupling.B * valuesOn(nonmortar, f) - coupling.A * valuesOn(mortar, f);
        ASSERT_LE(jump.cwiseAbs().maxCoeff(), 10 * reproduced) << static_cast<int>(kind) << " " << power;
      }
  }
}

Trace evenTrace(double begin, double size, int elements) {
  Trace trace;
  for (int i = 0; i <= elements; ++i) trace.push_back(begin + i * size);
  return trace;
}

/// Distances whose least value is 0: smooth, with kinks, with a step.
using Drawn = std::function<double(double)>;

std::vector<Drawn> drawnDistances(double at) {
  return {[at](double s) { return (s - at) * (s - at); },
          [at](double s) { return std::abs(s - at); },
          [at](double s) { return std::max(0.0, s - at); },
          [at](double s) { return s < at         ? 1.0
                                  : s < at + 0.1 ? 1 - (s - at) / 0.1
                                                 : 0.0; },
          [at](double s) { return 1 - std::cos(40 * (s - at)); },
          [at](double s) { return std::min(1.0, 30 * std::abs(s - at)); }};
}

Vector distancesOf(CouplingKind kind, const Trace& nonmortar, const Trace& mortar, int degree,
                   const Drawn& drawn, bool stabilised = false) {
  const std::vector<char> none(nonmortar.size(), 0);
  return couple(kind, StraightLines(nonmortar, mortar, degree).refinement,
                [&](int, double s, const FacingPair&) { return drawn(s); }, {}, false, {},
                {stabilised, 1, none, none})
      .distance;
}

// Bodies that only touch do not press each other, whatever they look like: no row has a distance below the
// least one that its row function sees. The L2 projection of a convex distance would.
TEST(Coupling, noDistanceIsBelowTheLeastThatItsFunctionSees) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> elements(1, 30);
  std::uniform_real_distribution<double> place(0, 1);
  for (int trial = 0; trial < 100; ++trial) {
    const Trace nonmortar = randomTrace(random, elements(random), 0, 1, 10);
    const Trace mortar = randomTrace(random, elements(random), -0.1, 1.1, 10);
    for (const Drawn& drawn :
         drawnDistances(trial % 2 == 0 ? nonmortar[nonmortar.size() / 2] : place(random)))
      for (const CouplingKind kind :
           {CouplingKind::interpolation, CouplingKind::mortar, CouplingKind::weighted})
        for (const int degree : {1, 2})
          for (const bool stabilised : {false, true})
            ASSERT_GE(distancesOf(kind, nonmortar, mortar, degree, drawn, stabilised).minCoeff(), 0)
                << static_cast<int>(kind) << ", degree " << degree << (stabilised ? ", stabilised" : "");
  }
}

// ... while the distances of bodies that are drawn into each other, and linear ones, are what they are.
TEST(Coupling, linearDistancesAreKept) {
  std::mt19937 random(12);
  std::uniform_int_distribution<int> elements(1, 30);
  for (int trial = 0; trial < 100; ++trial) {
    const Trace nonmortar = randomTrace(random, elements(random), 0, 1, 100);
    const Trace mortar = randomTrace(random, elements(random), 0, 1, 100);
    for (const CouplingKind kind : kinds) {
      const Vector distance = distancesOf(kind, nonmortar, mortar, 1, [](double s) { return 0.25 - s; });
      ASSERT_LE((distance.array() - 0.25 + asVector(nonmortar).array()).abs().maxCoeff(), reproduced);
    }
  }
}

// Only the nodes that face the mortar side have a row, and constants survive at its end, however small the
// piece.
TEST(Coupling, partialOverlapReproducesConstants) {
  const Trace nonmortar{0, 0.25, 0.5, 0.75, 1};
  struct Case {
    Trace mortar;
    std::vector<int> nodes;
  };
  std::vector<Case> cases{{{0.3, 0.6, 1.5}, {2, 3, 4}},
                          {{-1, 0.1, 0.6}, {0, 1, 2}},
                          {{0.2, 0.3}, {1}},
                          {{-1, 2}, {0, 1, 2, 3, 4}}};
  for (double piece = 1e-1; piece > 0.5e-9; piece /= 10) {
    cases.push_back({{1 - piece, 1.3, 2}, {4}});  // faces the end only
    cases.push_back({{-1, -0.3, piece}, {0}});
    cases.push_back({{-1, 0.1, 0.4, 0.5 + piece}, {0, 1, 2}});  // ends just behind a node
    cases.push_back({{0.5 - piece, 0.6, 1}, {2, 3, 4}});
    cases.push_back({{0.5 - piece / 2, 0.5 + piece / 2}, {2}});
  }
  for (const auto& [mortar, nodes] : cases)
    for (const CouplingKind kind : kinds) {
      const Scalar coupling = scalar(kind, nonmortar, mortar);
      ASSERT_EQ(coupling.nodes, nodes);
      EXPECT_LE(rowSumError(coupling.A), reproduced) << mortar.front() << " to " << mortar.back();
      EXPECT_LE(coupling.A.cwiseAbs().maxCoeff(), 2) << mortar.front() << " to " << mortar.back();
    }
  EXPECT_TRUE(scalar(CouplingKind::mortar, nonmortar, {0.3, 0.4}).nodes.empty());
  EXPECT_TRUE(scalar(CouplingKind::mortar, nonmortar, {1.1, 2}).nodes.empty());
}

TEST(Coupling, nodesCloserThanRoundingDoNoHarm) {
  constexpr double close = 1e-13;
  const Trace nonmortar{0, 0.25, 0.5, 0.75, 1};
  for (const double shift : {-close, close}) {
    const Trace inside{0, 0.25 + shift, 0.5 - shift, 0.75 + shift, 1};
    const Trace ends{shift, 0.25, 0.5 + shift, 0.75, 1 - shift};
    for (const CouplingKind kind : kinds)
      for (const Trace& mortar : {inside, ends}) {
        const Scalar coupling = scalar(kind, nonmortar, mortar);
        ASSERT_EQ(coupling.A.rows(), 5);
        EXPECT_LE(rowSumError(coupling.A), reproduced);
        EXPECT_LE((coupling.A - Matrix::Identity(5, 5)).cwiseAbs().maxCoeff(), 20 * close);
      }
  }
}

}  // namespace mortier::coupling_test
