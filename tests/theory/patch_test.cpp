// The patch test: two bodies under a constant stress. Mortar reproduces it on any meshes, interpolation does
// not.
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "theory/shaken_square.h"

namespace mortier::patch_test {

using namespace scenes;

/// Relative to the stress; rounding times the condition of a few hundred unknowns.
constexpr double reproduced = 1e-12;

/// Non-nested cells a side.
struct Counts {
  int upper;
  int lower;
};
constexpr Counts counts[] = {{5, 7}, {7, 5}, {4, 13}, {13, 4}, {1, 3}};

/// A shaken square with its nodes drawn towards x = 0.
TriangleMesh nonuniformSquare(double lowerY, int cells, unsigned seed) {
  TriangleMesh mesh = shakenSquare(lowerY, cells, seed);
  for (Point& x : mesh.vertices) x.x() = (x.x() + x.x() * x.x()) / 2;
  validate(mesh);
  return mesh;
}

Eigen::Matrix2d rotation(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return Eigen::Matrix2d{{std::cos(angle), -std::sin(angle)}, {std::sin(angle), std::cos(angle)}};
}

/// A scene turned by an angle: stress -1 along the normal of the contact line, nothing else. Rollers cannot
/// be turned, so the exact displacement is prescribed below and above, in proportion to time; it may slip
/// along the line.
struct Patch {
  double degrees = 0;
  Elasticity upper{1, 0.3};
  Elasticity lower{1, 0.3};

  [[nodiscard]] Eigen::Vector3d stress() const {
    const Eigen::Matrix2d R = rotation(degrees);
    const Eigen::Matrix2d s = R * Eigen::Vector2d(0, -1).asDiagonal() * R.transpose();
    return fromCartesian({s(0, 0), s(1, 1), s(0, 1)});
  }

  [[nodiscard]] Body body(const char* name, TriangleMesh mesh, const Elasticity& elasticity, int held) const {
    const Eigen::Matrix2d R = rotation(degrees);
    for (Point& x : mesh.vertices) x = R * x;
    const Eigen::Vector2d strain(elasticity.poisson / elasticity.young, -1 / elasticity.young);
    const Eigen::Matrix2d gradient = R * strain.asDiagonal() * R.transpose();
    const auto displacement = [&](int component) {
      return [gradient, component](double x, double y, double t) {
        return t * gradient.row(component).dot(Point(x, y));
      };
    };
    return {name,
            std::move(mesh),
            elasticMaterial(elasticity),
            {{{held, 0, displacement(0)}, {held, 1, displacement(1)}}, {}, {}}};
  }

  /// The largest error of a stress component in any triangle.
  [[nodiscard]] double error(Counts cells, CouplingKind coupling, int nonmortar) const {
    const Model model =
        contactModel(body("upper", nonuniformSquare(0, cells.upper, 1), upper, top),
                     body("lower", nonuniformSquare(-1, cells.lower, 2), lower, bottom), coupling, nonmortar);
    const auto [state, report] = run(model, 1, 1);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    EXPECT_EQ(report.iterations, 1);
    double largest = 0;
    for (const BodyState& result : state.bodies)
      largest = std::max(largest, (result.stress.colwise() - stress()).cwiseAbs().maxCoeff());
    return largest;
  }
};

TEST(Patch, mortarPassesOnNonuniformMeshes) {
  double worst = 0;
  for (const Counts& cells : counts)
    for (const int nonmortar : {upperBody, lowerBody}) {
      const double error = Patch{}.error(cells, CouplingKind::mortar, nonmortar);
      EXPECT_LE(error, reproduced) << cells.upper << " on " << cells.lower << ", nonmortar " << nonmortar;
      worst = std::max(worst, error);
    }
  std::cout << "mortar on nonuniform meshes: stress error at most " << worst << "\n";
}

TEST(Patch, mortarPassesOnSlopes) {
  double worst = 0;
  for (const int nonmortar : {upperBody, lowerBody})
    for (int degrees = 0; degrees < 90; ++degrees) {
      const double error = Patch{static_cast<double>(degrees)}.error({5, 7}, CouplingKind::mortar, nonmortar);
      EXPECT_LE(error, reproduced) << degrees << " degrees, nonmortar " << nonmortar;
      worst = std::max(worst, error);
    }
  std::cout << "mortar on slopes of 0 to 89 degrees: stress error at most " << worst << "\n";
}

TEST(Patch, mortarPassesBetweenUnequalBodies) {
  constexpr double contrastTolerance =
      1e-11;  // the soft body's displacements round in the stiff one's stresses
  for (const double contrast : {1e-3, 1e3})
    for (const int nonmortar : {upperBody, lowerBody})
      for (const double degrees : {0.0, 29.0})
        EXPECT_LE(Patch({degrees, {1, 0.3}, {contrast, 0.1}}).error({7, 5}, CouplingKind::mortar, nonmortar),
                  contrastTolerance)
            << contrast << ", " << degrees << " degrees, nonmortar " << nonmortar;
}

// The free sides and rollers of the note's test, with its moduli.
TEST(Patch, mortarPassesWithRollers) {
  const Function load = [](double, double, double t) { return -10 * t; };
  const auto material = elasticMaterial(noteElasticity);
  for (const Counts& cells : counts)
    for (const int nonmortar : {upperBody, lowerBody}) {
      Body upper("upper", nonuniformSquare(0, cells.upper, 3), material,
                 {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
      Body lower("lower", nonuniformSquare(-1, cells.lower, 4), material,
                 {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
      const Model model = contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, nonmortar);
      const auto [state, report] = run(model, 1, 1);
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      EXPECT_EQ(report.iterations, 1);
      EXPECT_LE(vonMisesRange(state).distance(10), 10 * reproduced);
      // The pressure is constant as well.
      EXPECT_LE((model.interfaces[0].contactPressure(state.contactForce[0]).array() - 10).abs().maxCoeff(),
                10 * reproduced);
    }
}

// By half the stress and more where the nonmortar side is the coarse one, visibly where it is the fine one.
TEST(Patch, interpolationFails) {
  constexpr double coarse = 0.5;
  constexpr double fine = 5e-3;
  for (const Counts& cells : {Counts{5, 7}, Counts{7, 5}, Counts{4, 13}, Counts{13, 4}})
    for (const int nonmortar : {upperBody, lowerBody}) {
      const double error = Patch{}.error(cells, CouplingKind::interpolation, nonmortar);
      EXPECT_GE(error, (cells.upper < cells.lower) == (nonmortar == upperBody) ? coarse : fine);
      std::cout << "interpolation, " << cells.upper << " on " << cells.lower << ", nonmortar "
                << (nonmortar == upperBody ? "upper" : "lower") << ": stress error " << error << "\n";
    }
}

}  // namespace mortier::patch_test
