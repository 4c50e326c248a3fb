// Directions of contact and distances of lines that are bent: along the normals, of circles and not of their
// polygons, the same from either side.
#include <gtest/gtest.h>

#include "unit/curved_lines.h"
#include "unit/messages.h"

namespace mortier::curved_distance_test {

using namespace curved;

// Two arcs about one centre: the distance is the difference of the radii, not that of the polygons.
TEST(CurvedDistance, distanceAlongTheNormal) {
  std::mt19937 random(5);
  const double distance = 0.125;
  const TriangleMesh upper = mapped(random, 60, 0, 0.5, bow(2));
  const TriangleMesh lower = mapped(random, 47, -0.5 - distance, -distance, bow(2));
  for (const CouplingKind kind : kinds)
    for (const bool upperNonmortar : {true, false}) {
      const ContactInterface interface = LinePair{upper, lower}.meet(kind, upperNonmortar);
      EXPECT_LE((interface.initialDistance().array() - distance).abs().maxCoeff(), circleRounding);
      EXPECT_EQ(interface.sagitta(), 0);
      // The lower body grows by as much.
      Vector u = Vector::Zero(2 * lower.vertices.size());
      for (size_t v = 0; v < lower.vertices.size(); ++v)
        u.segment<2>(2 * v) = distance * lower.vertices[v].normalized();
      const Vector still = Vector::Zero(2 * upper.vertices.size());
      const Vector gap = upperNonmortar ? interface.gap(still, u) : interface.gap(u, still);
      EXPECT_LE(gap.cwiseAbs().maxCoeff(), 2e-3);
    }
}

// Arcs of two circles with other centres: along every direction the distance of the circles, at the nodes for
// interpolation and in the mean for mortar.
TEST(CurvedDistance, distanceOfTwoCircles) {
  std::mt19937 random(8);
  const double moved = 0.01;
  LinePair pair = pairOf(random, 60, 47, bow(1));
  for (Point& x : pair.lower.vertices) x.y() -= moved;
  for (const bool upperNonmortar : {true, false}) {
    const ContactInterface interface = pair.meet(CouplingKind::interpolation, upperNonmortar);
    const TriangleMesh& mesh = upperNonmortar ? pair.upper : pair.lower;
    for (int i = 0; i < interface.rows(); ++i) {
      const Point& x = mesh.vertices[interface.nonmortarNodes()[i]];
      const Point seen = x + interface.initialDistance()[i] * interface.normals()[i].head<2>();
      EXPECT_NEAR((seen - Point(0, upperNonmortar ? -moved : 0)).norm(), 1, circleRounding);
    }
    const ContactInterface mortar = pair.meet(CouplingKind::mortar, upperNonmortar);
    const double shared = std::min(interface.rows(), mortar.rows());
    EXPECT_NEAR(mortar.initialDistance().sum() / shared, interface.initialDistance().sum() / shared,
                1e-4 * moved);
  }
}

/// A half disc on a wall, or on another half disc that is mirrored below it.
LinePair discOn(double wall, double otherRadius) {
  TriangleMesh disc = halfDiscMesh({.lowest = {0, 0}, .radius = 1, .core = 0.3, .cells = 7});
  TriangleMesh below = crissCrossMesh({.lower = {-1, -1}, .upper = {1, 0}, .cellsX = 23, .cellsY = 4});
  if (otherRadius > 0) {
    below = halfDiscMesh({.lowest = {0, 0}, .radius = otherRadius, .core = 0.3 * otherRadius, .cells = 5});
    for (Point& x : below.vertices) x = -x;
    for (int& label : below.boundaryLabels) label = label == bottom ? top : label == top ? bottom : label;
  }
  for (Point& x : below.vertices) x.y() -= wall;
  return {disc, below};
}

// The direction is that of Hertz's theory whichever side is nonmortar: exact against a wall, to second order
// in the distance from the centre against another circle.
TEST(CurvedDistance, directionDoesNotDependOnTheSide) {
  std::mt19937 random(9);
  for (const double radius : {0.0, 1.0, 3.0})
    for (const CouplingKind kind : kinds)
      for (const bool upperNonmortar : {true, false})
        for (const double wall : {0.0, 0.01}) {
          const LinePair pair = discOn(wall, radius);
          const ContactInterface interface = pair.meet(kind, upperNonmortar);
          EXPECT_LE(imbalance(interface, upperNonmortar ? pair.upper : pair.lower,
                              upperNonmortar ? pair.lower : pair.upper, random),
                    1e-12);
          for (int i = 0; i < interface.rows(); ++i) {
            const Point& x =
                (upperNonmortar ? pair.upper : pair.lower).vertices[interface.nonmortarNodes()[i]];
            if (std::abs(x.x()) > 0.3) continue;
            const double tilt = interface.normals()[i].x();
            if (radius == 0)
              EXPECT_LE(std::abs(tilt), 1e-15);
            else  // along one normal alone it would be x over the radius; gaps tilt it too
              EXPECT_LE(std::abs(tilt), 2 * std::pow(std::abs(x.x()), 3) + 2 * wall * std::abs(x.x()) + 1e-15)
                  << x.x();
          }
        }
}

// Meshes of one curve overlap and part by the sag of their elements; those of one circle touch.
TEST(CurvedDistance, initialGap) {
  std::mt19937 random(6);
  const LinePair circle = pairOf(random, 12, 17, bow(2));
  EXPECT_EQ(circle.meet(CouplingKind::mortar, true, {.initial = InitialGap::reject})
                .initialDistance()
                .cwiseAbs()
                .maxCoeff(),
            0);
  const LinePair pair = pairOf(random, 12, 17, wave(0.05));
  const auto message = [&](const InterfaceOptions& options) {
    return messageOf([&] { return pair.meet(CouplingKind::mortar, true, options); });
  };
  const ContactInterface asMeshed = pair.meet(CouplingKind::mortar, true);
  EXPECT_LT(asMeshed.initialDistance().minCoeff(), 0);
  EXPECT_LT(-asMeshed.initialDistance().minCoeff(), 2 * asMeshed.sagitta());
  EXPECT_EQ(pair.meet(CouplingKind::mortar, true, {.initial = InitialGap::close}).sagitta(), 0);
  EXPECT_EQ(pair.meet(CouplingKind::mortar, true, {.initial = InitialGap::close})
                .initialDistance()
                .cwiseAbs()
                .maxCoeff(),
            0);
  EXPECT_NE(message({.initial = InitialGap::reject}).find("penetrate each other by 0.00"), std::string::npos)
      << message({.initial = InitialGap::reject});
  const ContactInterface given = pair.meet(
      CouplingKind::mortar, true, {.gap = [](const SpacePoint& x, double) { return 0.5 * x.x() * x.x(); }});
  for (int i = 0; i < given.rows(); ++i) {
    const double x = pair.upper.vertices[given.nonmortarNodes()[i]].x();
    EXPECT_EQ(given.initialDistance()[i], 0.5 * x * x);
  }
}

}  // namespace mortier::curved_distance_test
