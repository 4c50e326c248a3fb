// Each ingredient of a strict bound, broken: what is checked of the finished fields sees it.
#include <gtest/gtest.h>

#include "bound/checks.h"
#include "bound/lift.h"
#include "bound/pressures.h"
#include "mesh/generate.h"
#include "theory/scenes.h"

namespace mortier::strictness_test {

using namespace scenes;

constexpr double little = 1e-6;  // of the largest, far above rounding

/// A square under a uniform stress, and what is known at its sides.
struct Stressed {
  TriangleMesh mesh = square(0, 2);
  Sides sides{mesh};
  std::vector<BodyLoad> forces = std::vector<BodyLoad>(mesh.triangles.size(), BodyLoad::Zero());
  std::vector<KnownTraction> known = std::vector<KnownTraction>(sides.count());
  SideMoments moments;
  Stressed() {
    const Stress s(0.3, -1, 0.2);
    for (const Side& side : sides.all()) {
      const Point along = mesh.vertices[side.vertices[1]] - mesh.vertices[side.vertices[0]];
      const Point n(along.y(), -along.x());
      const Point half = Point(s[0] * n.x() + s[2] * n.y(), s[2] * n.x() + s[1] * n.y()) / 2;
      moments.push_back({half, half});
    }
    for (int e = 0; e < sides.count(); ++e) known[e] = {2, {Point(1, 0), Point(0, 1)}, moments[e]};
  }
  [[nodiscard]] std::string broken() const {
    const Imbalance imbalance = imbalanceOf(mesh, sides, moments, forces, known);
    return Strictness{imbalance.worst / imbalance.largest}.broken();
  }
  [[nodiscard]] int sideOf(bool inside) const {
    int e = 0;
    while ((sides.all()[e].triangles[1] >= 0) != inside) ++e;
    return e;
  }
};

TEST(Strictness, seesATriangleThatIsNotInEquilibrium) {
  const std::string expected = "stresses are not in equilibrium to rounding";
  EXPECT_EQ(Stressed().broken(), "");
  for (int end = 0; end < 2; ++end) {
    Stressed force;
    force.moments[force.sideOf(true)][end].x() += little;
    EXPECT_EQ(force.broken(), expected);
  }
  Stressed couple;  // along a side, at both ends against each other: no force is left
  const int e = couple.sideOf(true);
  const Side& side = couple.sides.all()[e];
  const Point along = couple.mesh.vertices[side.vertices[1]] - couple.mesh.vertices[side.vertices[0]];
  const Point across(-along.y(), along.x());
  couple.moments[e][0] += little * across;
  couple.moments[e][1] -= little * across;
  EXPECT_EQ(couple.broken(), expected);
  Stressed weight;
  weight.forces[3].y() -= little * 100;  // of a small triangle
  EXPECT_EQ(weight.broken(), expected);
  Stressed load;
  load.known[load.sideOf(false)].moments[1].x() += little;
  EXPECT_EQ(load.broken(), expected);
}

TEST(Strictness, seesTractionsThatAreNotThoseOfAPressureOnBothSides) {
  MatchedPiece piece;
  piece.normal = {0, -1};
  piece.length = 0.5;
  const std::array<double, 2> pressure{2, 3};
  const auto moments = momentsOfLinear(pressure, piece.length);
  const std::array<Point, 2> above{Point(0, moments[0]), Point(0, moments[1])};
  const std::array<Point, 2> below{Point(0, -moments[0]), Point(0, -moments[1])};
  const auto broken = [&](const std::array<Point, 2>& a, const std::array<Point, 2>& b) {
    return Strictness{0, mismatchOf(piece, pressure, a, b)}.broken();
  };
  const std::string expected = "tractions on both sides of a contact line are not those of a pressure";
  EXPECT_EQ(broken(above, below), "");
  for (int end = 0; end < 2; ++end)
    for (int component = 0; component < 2; ++component) {
      std::array<Point, 2> off = above;
      off[end][component] += little;
      EXPECT_EQ(broken(off, below), expected);
      std::array<Point, 2> opposite = below;
      opposite[end][component] -= little;
      EXPECT_EQ(broken(above, opposite), expected);
      EXPECT_EQ(broken(off, opposite), expected);  // equal and opposite, but not this pressure, or shear
    }
}

TEST(Strictness, seesANegativePressure) {
  MatchedPiece piece;
  piece.rows = {0, 1};
  piece.values = {{{1, 0}, {0, 1}}};
  Vector spread(2);
  spread << 1, 0;
  const auto broken = [&] {
    const auto p = pressureOn(piece, {spread});
    return Strictness{0, 0, std::min(p[0], p[1])}.broken();
  };
  EXPECT_EQ(broken(), "");
  spread[1] = -1e-300;
  EXPECT_EQ(broken(), "a contact pressure is negative");
}

TEST(Strictness, seesPenetrationThatALiftHasLeft) {
  const Model model = compression(3, 5, elasticMaterial({1, 0.3}), CouplingKind::interpolation, upperBody);
  const MatchedMeshes meshes = matchedMeshes(model);
  const State state = run(model, 0.01, 1).state;
  std::vector<LoadedBody> bodies;
  for (int b = 0; b < 2; ++b) bodies.emplace_back(model, state, meshes.bodies[b], b);
  std::vector<Vector> displacements;
  for (const LoadedBody& body : bodies) displacements.push_back(body.place().displacement);
  const auto broken = [&] {
    return Strictness{0, 0, 0, leastGapOf(model, meshes.pieces, displacements)}.broken();
  };
  const std::string expected = "the lifted displacement penetrates";
  EXPECT_EQ(broken(), expected);  // as interpolation does
  const std::vector<std::array<double, 2>> pressures(meshes.pieces.size(), {0.1, 0.1});
  displacements = lift(bodies, model, meshes.pieces, pressures).displacements;
  EXPECT_EQ(broken(), "");
  const int vertex = meshes.pieces[2].vertices[1][0];
  const double size = displacements[1].cwiseAbs().maxCoeff();
  displacements[1][2 * vertex + 1] += size;
  EXPECT_EQ(broken(), expected);
}

}  // namespace mortier::strictness_test
