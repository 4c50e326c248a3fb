#include "fem/body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <random>

#include "base/error.h"
#include "fem/element.h"
#include "material/stress.h"
#include "unit/dense_reference.h"
#include "unit/plate.h"

namespace mortier::body_test {

using namespace plate;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
Vector randomVector(Eigen::Index n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vector::NullaryExpr(n, [&](Eigen::Index) { return normal(random); });
}

TEST(Body, strainOfLinearDisplacementIsExact) {
  const Body plate = body();
  const Eigen::Matrix2d F{{0.3, -0.7}, {0.2, 0.9}};
  const Matrix strain =
      strainOf(plate, field(plate.mesh(), [&](const Point& x) { return Point(F * x + Point(3, -2)); }));
  const Eigen::Vector3d expected = fromCartesian({F(0, 0), F(1, 1), (F(0, 1) + F(1, 0)) / 2});
  constexpr double rounding = 64 * epsilon;  // of nodal values of order 4 over triangles of size 0.1
  EXPECT_LE((strain.colwise() - expected).cwiseAbs().maxCoeff(), rounding);
}

TEST(Body, translationIsStrainedByNothing) {
  const Body plate = body();
  const Vector u = field(plate.mesh(), [](const Point&) { return Point(1e6 / 3, -0.1); });
  EXPECT_EQ(strainOf(plate, u).cwiseAbs().maxCoeff(), 0);
}

TEST(Body, internalForceIsTheTransposeOfStrain) {
  const Body plate = body();
  std::mt19937 random(2);
  for (int trial = 0; trial < 10; ++trial) {
    const Vector u = randomVector(plate.dofs(), random);
    const Matrix stress = randomVector(3 * plate.points(), random).reshaped(3, plate.points());
    const Matrix strain = strainOf(plate, u);
    double work = 0;
    for (int i = 0; i < plate.points(); ++i) work += plate.weights()[i] * stress.col(i).dot(strain.col(i));
    EXPECT_NEAR(plate.internalForce(stress).dot(u), work, 1e-12);
  }
}

TEST(Body, weightsSumToTheArea) {
  const Body plate = body();
  double area = 0;
  for (const double weight : plate.weights()) area += weight;
  EXPECT_NEAR(area, 2, 1e-14);
}

/// K of a body over equations, all of it.
Matrix denseOf(const Body& plate, const Matrix& moduli) {
  std::vector<double> values;
  plate.tangent(moduli, values);
  return denseOf(plate.pattern(), values);
}

// The internal force of the stresses that a step from zero ends at, as a function of the displacement.
TEST(Body, tangentMatchesFiniteDifferenceOfInternalForce) {
  constexpr double h = 1e-6;
  constexpr double tolerance =
      1e-7;  // central differences: epsilon/h = 2e-10 times the stiffness; near yield a kink
  std::mt19937 random(3);
  for (const Projection projection :
       {Projection::frobenius, Projection::elasticity, Projection::compliance}) {
    const Body plate = body({{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}}, projection);
    EXPECT_EQ(plate.pattern().symmetric, projection == Projection::frobenius);
    const Matrix stress0 = Matrix::Zero(3, plate.points());
    Linearisation law{Matrix(3, plate.points()), Matrix(9, plate.points())};
    const auto solve = [&](const Vector& u) {
      const Matrix strain = strainOf(plate, u);
      Matrix stress = stress0;
      for (int iteration = 0; iteration < 30; ++iteration) {
        plate.material().linearise({0.1, stress0, strain}, stress, law, 0, plate.points());
        stress = law.predictor;
      }
      return plate.internalForce(stress);
    };
    const Vector u = 0.05 * randomVector(plate.dofs(), random);
    for (int trial = 0; trial < 5; ++trial) {
      Vector d = randomVector(plate.dofs(), random);
      for (int dof = 0; dof < plate.dofs(); ++dof)
        if (plate.equations()[dof] < 0) d[dof] = 0;
      const Vector difference = (solve(u + h * d) - solve(u - h * d)) / (2 * h);
      solve(u);
      Vector free(plate.freeDofs());
      Vector expected(plate.freeDofs());
      for (int dof = 0; dof < plate.dofs(); ++dof)
        if (plate.equations()[dof] >= 0) {
          free[plate.equations()[dof]] = d[dof];
          expected[plate.equations()[dof]] = difference[dof];
        }
      const Matrix K = denseOf(plate, law.moduli);
      EXPECT_LE((K * free - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff());
      if (plate.pattern().symmetric) {
        // The lower triangle of the moduli says the same.
        Matrix lower(6, plate.points());
        const int rows[] = {0, 1, 2, 4, 5, 8};
        for (int i = 0; i < 6; ++i) lower.row(i) = law.moduli.row(rows[i]);
        EXPECT_LE((denseOf(plate, lower) - K).cwiseAbs().maxCoeff(), 4 * epsilon * K.cwiseAbs().maxCoeff());
        Linearisation half{Matrix(3, plate.points()), Matrix(6, plate.points())};
        plate.material().linearise({0.1, stress0, strainOf(plate, u)}, law.predictor, half, 0,
                                   plate.points());
        Linearisation all{Matrix(3, plate.points()), Matrix(9, plate.points())};
        plate.material().linearise({0.1, stress0, strainOf(plate, u)}, law.predictor, all, 0, plate.points());
        for (int i = 0; i < 6; ++i) EXPECT_TRUE(half.moduli.row(i) == all.moduli.row(rows[i]));
        Matrix fromHalf = stress0;
        Matrix fromAll = stress0;
        plate.addStressOf(d, half, fromHalf, 0, plate.points());
        plate.addStressOf(d, all, fromAll, 0, plate.points());
        EXPECT_LE((fromHalf - fromAll).cwiseAbs().maxCoeff(), 16 * epsilon * fromAll.cwiseAbs().maxCoeff());
      }
      // And the stress that Newton's method adds for d.
      Matrix added = stress0;
      plate.addStressOf(d, law, added, 0, plate.points());
      const Vector f = plate.internalForce(added);
      for (int dof = 0; dof < plate.dofs(); ++dof) {
        if (plate.equations()[dof] < 0) continue;
        EXPECT_NEAR(f[dof], (K * free)[plate.equations()[dof]], 1e-11);
      }
    }
  }
}

TEST(Body, loadsSumToTheirResultants) {
  constexpr double rounding = 1e-14;
  const auto sumOf = [](const Conditions& conditions, int component, double t) {
    const Body plate = body(conditions);
    const Vector f = plate.load(t);
    double sum = 0;
    double moment = 0;
    for (int v = 0; v < plate.nodes(); ++v) {
      sum += f[2 * v + component];
      moment += f[2 * v + component] *
                (component == 0 ? -plate.mesh().vertices[v].y() : plate.mesh().vertices[v].x());
      EXPECT_EQ(f[2 * v + 1 - component], 0);
    }
    return Point(sum, moment);
  };
  const Function ramp = [](double, double, double t) { return -10 * t; };
  EXPECT_NEAR((sumOf({{}, {{top, 1, ramp}}, {}}, 1, 0.5) - Point(-10, -10)).norm(), 0, rounding);
  // x^2 on the top: 8/3, moment 4; cubics are not integrated exactly.
  const Function square = [](double x, double, double) { return x * x; };
  EXPECT_NEAR((sumOf({{}, {{top, 1, square}}, {}}, 1, 0) - Point(8.0 / 3, 4)).norm(), 0, rounding);
  // y on the right, along x: 1/2, moment -1/3.
  const Function height = [](double, double y, double) { return y; };
  EXPECT_NEAR((sumOf({{}, {{right, 0, height}}, {}}, 0, 0) - Point(0.5, -1.0 / 3)).norm(), 0, rounding);
  // A body force: 3 + x on an area of 2: 8, moment 6 + 8/3.
  const Function weight = [](double x, double, double) { return 3 + x; };
  EXPECT_NEAR((sumOf({{}, {}, {{1, weight}}}, 1, 0) - Point(8, 6 + 8.0 / 3)).norm(), 0, rounding);
}

TEST(Body, prescribedDisplacementsAreTakenInPlaceAndTime) {
  const Function value = [](double x, double, double t) { return 10 * t + x; };
  const Body plate = body({{{bottom, 1, value}}, {}, {}});
  Vector u = Vector::Constant(plate.dofs(), 99);
  plate.prescribe(2, u);
  for (int v = 0; v < plate.nodes(); ++v) {
    const Point& x = plate.mesh().vertices[v];
    EXPECT_EQ(u[2 * v], 99);
    EXPECT_EQ(u[2 * v + 1], x.y() == 0 ? 20 + x.x() : 99);
    EXPECT_EQ(plate.equations()[2 * v + 1] < 0, x.y() == 0);
  }
  EXPECT_THROW(body({{{7, 1, value}}, {}, {}}), InputError);
  EXPECT_THROW(body({{}, {{7, 1, value}}, {}}), InputError);
}

// B (u + small) of triangle i.
std::array<long double, 3> exactStrain(const Body& plate, const Vector& u, const Vector& small, int i) {
  using Long = long double;
  const auto& triangle = plate.mesh().triangles[i];
  const auto& x = plate.mesh().vertices;
  const auto gradients =
      LinearTriangle::tabulate({x[triangle[0]], x[triangle[1]], x[triangle[2]]}).gradients[0];
  Long gradient[2][2] = {{0, 0}, {0, 0}};
  for (int a = 1; a < 3; ++a)
    for (int c = 0; c < 2; ++c) {
      const Long du = (Long(u[2 * triangle[a] + c]) - u[2 * triangle[0] + c]) +
                      (Long(small[2 * triangle[a] + c]) - small[2 * triangle[0] + c]);
      for (int k = 0; k < 2; ++k) gradient[c][k] += gradients(k, a) * (std::numbers::sqrt2 / 2) * du;
    }
  return {gradient[0][0] + gradient[1][1], gradient[0][0] - gradient[1][1], gradient[0][1] + gradient[1][0]};
}

// Strains of order 1e-9 in displacements of order one, carried as a large and a small part. On cells of
// powers of two the gradients are exact, whatever the compiler contracts.
TEST(Body, strainResolvesSmallDifferencesOfLargeDisplacements) {
  const Body plate("square", crissCrossMesh({.cellsX = 4, .cellsY = 4}), elasticMaterial({1, 0.3}), {});
  std::mt19937 random(4);
  const Vector u = field(plate.mesh(), [&](const Point& x) {
    const Point noise = 1e-9 * randomVector(2, random);
    return Point(Point(-x.y(), x.x()) / 3 + Point(0.7, 0.1) + noise);
  });
  const Vector small = 1e-17 * randomVector(plate.dofs(), random);
  Matrix strain;
  strain.resize(3, plate.points());
  plate.strain({u, small}, nullptr, strain, 0, plate.points());
  double worst = 0;
  double effect = 0;
  const Matrix plain = strainOf(plate, u);
  for (int i = 0; i < plate.points(); ++i) {
    const auto exact = exactStrain(plate, u, small, i);
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, static_cast<double>(std::abs(strain(c, i) - exact[c])));
      effect = std::max(effect, std::abs(strain(c, i) - plain(c, i)));
    }
  }
  // Long double's own rounding: 5e-20 of gradients of order 10 times differences of order 0.1, several of
  // them.
  constexpr double tolerance = 1e-18;
  EXPECT_LE(worst, tolerance);
  EXPECT_GE(effect, 1e-17);
  std::cout << "strain against long double: " << worst << ", plain double rounds at " << epsilon << "\n";
}

// What is left of a strain of order one beside a shift that is almost it.
TEST(Body, strainBesideAShiftKeepsItsDigits) {
  const Body plate("square", crissCrossMesh({.cellsX = 4, .cellsY = 4}), elasticMaterial({1, 0.3}), {});
  std::mt19937 random(5);
  const Vector u = randomVector(plate.dofs(), random);
  const Vector small = 1e-17 * randomVector(plate.dofs(), random);
  const Matrix shift = strainOf(plate, u);
  Matrix strain(3, plate.points());
  plate.strain({u, small}, &shift, strain, 0, plate.points());
  double worst = 0;
  for (int i = 0; i < plate.points(); ++i) {
    const auto exact = exactStrain(plate, u, small, i);
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, static_cast<double>(std::abs(strain(c, i) - (exact[c] - shift(c, i)))));
  }
  constexpr double tolerance =
      2e-17;  // of long double: 5e-20 of gradients of order 10 times differences of order 1
  EXPECT_LE(worst, tolerance);
  EXPECT_GE(strain.cwiseAbs().maxCoeff(), 10 * tolerance);
}

}  // namespace mortier::body_test
