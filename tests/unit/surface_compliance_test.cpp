// What conditions between two surfaces yield by (contact/pressure_compliance.h).
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "contact/interface.h"
#include "mesh/shape.h"

namespace mortier::surface_compliance_test {

enum : int { bottom = 1, top = 3 };
constexpr double compliance = 2e-6;
constexpr double rounding = 1e-13;

/// Two plates that touch at z = 0, with so many cells of length 1 along x and y.
struct Plates {
  Plates(const std::array<int, 2>& upperCells, const std::array<int, 2>& lowerCells, int degree = 1)
      : upper(cuboidMesh({{0, 0, 0}, {1, 1, 0.2}, {upperCells[0], upperCells[1], 1}})),
        lower(cuboidMesh({{0, 0, -0.2}, {1, 1, 0}, {lowerCells[0], lowerCells[1], 1}})),
        upperNodes(spaceNodes(upper, degree)),
        lowerNodes(spaceNodes(lower, degree)) {}

  [[nodiscard]] ContactInterface interface(CouplingKind kind = CouplingKind::weighted,
                                           const InterfaceOptions::Held& held = {}) const {
    InterfaceOptions options;
    options.mortarHeld = held;
    options.mortarCompliance = compliance;
    options.stabilised = true;
    return {{{0, bottom}, {1, top}, kind},
            SpaceContactMesh{upper, upperNodes},
            SpaceContactMesh{lower, lowerNodes},
            options};
  }

  TetrahedronMesh upper, lower;
  SpaceNodes upperNodes, lowerNodes;
};

/// Moves the vertices that are inside of the contact surface at random by parts of a cell.
void disturb(TetrahedronMesh& mesh, int cells, std::mt19937& random) {
  std::uniform_real_distribution<double> part(-0.3, 0.3);
  for (SpacePoint& x : mesh.vertices)
    if (std::min(x.head<2>().minCoeff(), (1 - x.head<2>().array()).minCoeff()) > 1e-9)
      x.head<2>() += Point(part(random), part(random)) / cells;
}

TEST(SurfaceCompliance, isSymmetricAndNonnegativeAndWithoutEffectOnUniformPressures) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 6; ++trial)
    for (const int degree : {1, 2}) {
      Plates plates({9, 11}, {2, 3});
      disturb(plates.upper, 11, random);
      disturb(plates.lower, 3, random);
      plates.upperNodes = spaceNodes(plates.upper, degree);
      plates.lowerNodes = spaceNodes(plates.lower, degree);
      const ContactInterface interface = plates.interface();
      const Matrix S(interface.compliance());
      const double size = S.cwiseAbs().maxCoeff();
      EXPECT_GT(size, 0);
      EXPECT_LE((S - S.transpose()).cwiseAbs().maxCoeff(), rounding * size);
      EXPECT_LE((S * interface.weights()).cwiseAbs().maxCoeff(),
                100 * rounding * size * interface.weights().maxCoeff());
      EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix>(S).eigenvalues()[0], -100 * rounding * size);
    }
}

// Whatever the shape of the cells, and where nothing of the mortar side moves.
TEST(SurfaceCompliance, isZeroWhereTheMortarSideIsAsFine) {
  EXPECT_EQ(0, Plates({8, 8}, {8, 8}).interface().compliance().nonZeros());
  EXPECT_EQ(0, Plates({8, 2}, {8, 2}).interface().compliance().nonZeros());
  EXPECT_EQ(0, Plates({6, 6}, {12, 12}).interface().compliance().nonZeros());
  EXPECT_EQ(0, Plates({8, 8}, {4, 4}, 2).interface().compliance().nonZeros());
  EXPECT_GT(Plates({8, 2}, {4, 2}).interface().compliance().nonZeros(), 0);
  const Plates coarse({8, 8}, {2, 2});
  EXPECT_GT(coarse.interface().compliance().nonZeros(), 0);
  EXPECT_EQ(0, coarse.interface(CouplingKind::interpolation).compliance().nonZeros());
  const auto all = [](int, const SpacePoint&) { return true; };
  EXPECT_EQ(0, coarse.interface(CouplingKind::weighted, all).compliance().nonZeros());
}

// The least of (|its projection to the mortar trace|^2 + p'S p E2/h2) over |pressure|^2, its root.
TEST(SurfaceCompliance, keepsTheInfSupConstant) {
  for (const int ratio : {2, 3, 4}) {
    constexpr int mortarCells = 3;
    const Plates plates({ratio * mortarCells, ratio * mortarCells}, {mortarCells, mortarCells});
    const Plates own({mortarCells, mortarCells}, {mortarCells, mortarCells});
    const ContactInterface interface = plates.interface();
    const ContactInterface trace = own.interface(CouplingKind::mortar);  // rows are its nodes
    Matrix C2(interface.rows(), trace.rows());
    for (int j = 0; j < trace.rows(); ++j) {
      const SpacePoint& x = own.upperNodes.places[trace.nonmortarNodes()[j]];
      for (const int node : interface.mortarNodes())
        if ((plates.lowerNodes.places[node] - x).norm() < 1e-12)
          C2.col(j) = Matrix(interface.C2()).col(3 * node + 2);
    }
    const Vector root = interface.weights().cwiseSqrt();
    const Matrix M = root.asDiagonal() * C2;
    const Matrix S = root.asDiagonal() * Matrix(interface.compliance()) * root.asDiagonal();
    const Matrix projection = M * Matrix(trace.mass()).llt().solve(M.transpose());
    const auto constant = [](const Matrix& Q) {
      return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Matrix>(Q).eigenvalues()[0]));
    };
    EXPECT_GE(constant(projection + S * mortarCells / compliance), 0.25);
    EXPECT_LE(constant(projection), 1e-6);
  }
}

// Linear pressures stay; those that alternate from node to node vanish inside.
TEST(SurfaceCompliance, pressuresAreMeansOverMortarCells) {
  constexpr int cells = 16;
  const Plates plates({cells, cells}, {4, 4});
  const ContactInterface interface = plates.interface();
  Vector linear(interface.rows());
  Vector alternating(interface.rows());
  for (int row = 0; row < interface.rows(); ++row) {
    const SpacePoint& x = plates.upperNodes.places[interface.nonmortarNodes()[row]];
    linear[row] = 3 + x.x() - 2 * x.y();
    alternating[row] = std::lround(cells * x.x()) % 2 == 0 ? 1 : -1;
  }
  const auto pressure = [&](const Vector& nodal) {
    return interface.contactPressure(interface.weights().cwiseProduct(nodal));
  };
  EXPECT_LE((pressure(linear) - linear).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LE(pressure(alternating).cwiseAbs().maxCoeff(), 0.5);
  EXPECT_GE(interface.pressureRoughness(interface.weights().cwiseProduct(linear + 0.3 * alternating)), 0.05);
}

// By how much nodal forces of a uniform pressure are off on the mortar side.
TEST(SurfaceCompliance, interpolationSaysItsPatchError) {
  const Plates plates({5, 4}, {3, 7});
  EXPECT_GT(plates.interface(CouplingKind::interpolation).patchError(), 0.05);
  EXPECT_EQ(0, plates.interface().patchError());
  EXPECT_LE(Plates({4, 4}, {4, 4}).interface(CouplingKind::interpolation).patchError(), 1e-12);
}

}  // namespace mortier::surface_compliance_test
