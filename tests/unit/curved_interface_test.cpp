// Interfaces that are not one straight line: broken lines, curves, closed curves.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

#include "unit/curved_lines.h"

namespace mortier::curved_interface_test {

using namespace curved;

TEST(CurvedInterface, forceAndMomentBalance) {
  constexpr double balance = 1e-12;
  std::mt19937 random(1);
  std::uniform_int_distribution<int> cells(6, 40);
  std::uniform_real_distribution<double> value(-1, 1);
  double worst = 0;
  for (int trial = 0; trial < 200; ++trial) {
    LinePair pair =
        pairOf(random, cells(random), cells(random), bow(2 * std::abs(value(random)), value(random)));
    if (trial % 4 == 1) pair = pairOf(random, cells(random), cells(random), wave(0.05 * value(random)));
    if (trial % 4 == 2) {  // shifted: it overlaps in part, at a distance
      pair = pairOf(random, cells(random), cells(random), bow(1));
      for (Point& x : pair.lower.vertices) x += Point(0.2 * value(random), -0.1);
    }
    if (trial % 4 == 3)  // a kink of any size in the middle of both
      for (TriangleMesh* mesh : {&pair.upper, &pair.lower})
        *mesh = mapped(random, cells(random), mesh == &pair.upper ? 0 : -0.5, mesh == &pair.upper ? 0.5 : 0,
                       [](const Point& x) { return Point(x.x(), x.y() + std::abs(x.x() - 0.5)); });
    for (const CouplingKind kind : kinds)
      for (const bool upperNonmortar : {true, false}) {
        const ContactInterface interface = pair.meet(kind, upperNonmortar, {.initial = InitialGap::close});
        worst = std::max(worst, imbalance(interface, upperNonmortar ? pair.upper : pair.lower,
                                          upperNonmortar ? pair.lower : pair.upper, random));
        ASSERT_LE(worst, balance) << "trial " << trial;
      }
  }
  std::cout << "force and moment of contact forces on 200 random pairs of curves: at most " << worst
            << " of the force\n";
}

// A ring in a hole: both lines closed, and the one of the hole closed against an arc.
TEST(CurvedInterface, closedLines) {
  constexpr double balance = 1e-12;
  std::mt19937 random(2);
  const auto ring = [](int cells, double inner, double outer, double begin) {
    TriangleMesh mesh = crissCrossMesh(
        {.lower = {0, inner}, .upper = {static_cast<double>(cells), outer}, .cellsX = cells, .cellsY = 2});
    for (Point& v : mesh.vertices) {
      const double phi = begin - 2 * pi * v.x() / cells;
      v = v.y() * Point(std::cos(phi), std::sin(phi));
    }
    // Its two ends are one.
    std::vector<int> twin(mesh.vertices.size());
    std::vector<Point> kept;
    for (size_t v = 0; v < mesh.vertices.size(); ++v) {
      size_t same = 0;
      while (same < kept.size() && (kept[same] - mesh.vertices[v]).norm() > 1e-9) ++same;
      if (same == kept.size()) kept.push_back(mesh.vertices[v]);
      twin[v] = static_cast<int>(same);
    }
    mesh.vertices = kept;
    for (auto& triangle : mesh.triangles)
      for (int& v : triangle) v = twin[v];
    std::vector<std::array<int, 2>> edges;
    std::vector<int> labels;
    for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
      if (mesh.boundaryLabels[e] == bottom || mesh.boundaryLabels[e] == top) {
        edges.push_back({twin[mesh.boundaryEdges[e][0]], twin[mesh.boundaryEdges[e][1]]});
        labels.push_back(mesh.boundaryLabels[e]);
      }
    mesh.boundaryEdges = edges;
    mesh.boundaryLabels = labels;
    validate(mesh);
    return mesh;
  };
  const double distance = 0.05;
  const LinePair pair{ring(48, 1 + distance, 2, 0.3), ring(37, 0.5, 1, 0)};
  for (const CouplingKind kind : kinds)
    for (const bool upperNonmortar : {true, false}) {
      const ContactInterface interface = pair.meet(kind, upperNonmortar);
      EXPECT_EQ(interface.rows(), upperNonmortar ? 48 : 37);
      EXPECT_NEAR(interface.overlap(), upperNonmortar ? 1.05 : 1.0, 0.01);
      EXPECT_LE((interface.initialDistance().array() - distance).abs().maxCoeff(), circleRounding);
      EXPECT_LE(imbalance(interface, upperNonmortar ? pair.upper : pair.lower,
                          upperNonmortar ? pair.lower : pair.upper, random),
                balance);
    }
  for (const double turned : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}) {
    const LinePair part{pair.upper, mapped(random, 9, -0.5, 0, bow(1.5, turned))};
    for (const CouplingKind kind : kinds)
      for (const bool upperNonmortar : {true, false}) {
        const ContactInterface interface = part.meet(kind, upperNonmortar);
        EXPECT_NEAR(interface.overlap(), 1, 0.1);
        EXPECT_LE(imbalance(interface, upperNonmortar ? part.upper : part.lower,
                            upperNonmortar ? part.lower : part.upper, random),
                  balance);
      }
  }
}

// A mortar line that reaches beyond both ends of the nonmortar one faces all of it.
TEST(CurvedInterface, aLineThatIsLongerFacesAllOfTheOther) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const LinePair pair{mapped(random, 13, 0, 0.5, bow(0.8)), mapped(random, 10, -0.5, 0, bow(1.1))};
    for (const CouplingKind kind : kinds) {
      const ContactInterface interface = pair.meet(kind, true);
      EXPECT_EQ(interface.rows(), 14);
      EXPECT_NEAR(interface.overlap(), 1, 1e-12);
    }
  }
}

// The weights of the two directions at a node make the normals of a circle exact, wherever its nodes are.
TEST(CurvedInterface, normalsOfACircleAreExact) {
  constexpr double rounding = 1e-13;
  std::mt19937 random(3);
  for (const int cells : {8, 16, 64})
    for (int trial = 0; trial < 20; ++trial) {
      const std::vector<SmoothPart> parts =
          smoothParts(boundaryLine(mapped(random, cells, 0, 0.5, bow(2)), bottom));
      ASSERT_EQ(parts.size(), 1u);
      for (size_t i = 0; i < parts[0].nodes.size(); ++i)
        EXPECT_LE((parts[0].normals[i] + parts[0].points[i].normalized()).norm(), rounding);
    }
}

// Octagons that are a millimetre apart have straight sides: their vertices lie on circles, but they are
// polygons.
TEST(CurvedInterface, anOctagonIsNoCircle) {
  constexpr double rounding = 1e-12;
  constexpr double half = M_PI / 8;
  for (const int edges : {8, 16}) {
    const TriangleMesh pin = annulusMesh({{0, 0}, 0.5, 1, 4, edges, 2});
    const TriangleMesh hole = annulusMesh({{0, 0}, 1.001, 2, 4, edges, 2});
    const ContactInterface interface({{0, 2}, {1, 1}, CouplingKind::mortar}, pin, hole);
    const bool octagon = edges == 8;
    EXPECT_EQ(interface.rows(), 16);  // two at each corner
    EXPECT_NEAR(interface.polygonTurn(), octagon ? 2 * half : 0, rounding);
    const double expected = 0.001 * (octagon ? std::cos(half) : 1);
    EXPECT_LE((interface.initialDistance().array() - expected).abs().maxCoeff(), 1e-3 * expected) << edges;
  }
}

TEST(CurvedInterface, cornersCutTheLine) {
  std::mt19937 random(4);
  const auto cornersOf = [&](auto map, int cells) {
    return smoothParts(boundaryLine(mapped(random, cells, 0, 0.5, map), bottom)).size() - 1;
  };
  // Regular cells put nodes on the corners.
  const auto broken = [](double slope) {
    return [=](const Point& x) {
      return Point(x.x(), x.y() + slope * std::max({0.0, 1.0 / 3 - x.x(), x.x() - 2.0 / 3}));
    };
  };
  const auto regular = [&](auto map, int cells) {
    TriangleMesh mesh = crissCrossMesh({.lower = {0, 0}, .upper = {1, 0.5}, .cellsX = cells, .cellsY = 2});
    for (Point& v : mesh.vertices) v = map(v);
    return smoothParts(boundaryLine(mesh, bottom));
  };
  for (const double slope : {-2.0, -1.0, -0.1, -0.02, 0.02, 0.1, 1.0})
    for (const int cells : {6, 30}) {
      const std::vector<SmoothPart> parts = regular(broken(slope), cells);
      EXPECT_EQ(parts.size(), 3u) << slope << ", " << cells;
      for (const SmoothPart& part : parts) EXPECT_TRUE(part.straight);
    }
  for (const int cells : {4, 10, 100}) EXPECT_EQ(cornersOf(bow(2), cells), 0u);
  EXPECT_EQ(cornersOf(bow(0.01), 2), 0u);
  EXPECT_EQ(cornersOf(wave(0.05), 40), 0u);
}

// The closures of Gamma_C and of the Dirichlet boundary meet.
TEST(CurvedInterface, heldEndsAreMerged) {
  std::mt19937 random(7);
  const LinePair pair = pairOf(random, 6, 9, [](const Point& x) { return x; });
  const auto onLeft = [](const TriangleMesh& mesh) {
    return [&mesh](int v, const SpacePoint&) { return mesh.vertices[v].x() == 0; };
  };
  const InterfaceOptions held{.nonmortarHeld = onLeft(pair.upper), .mortarHeld = onLeft(pair.lower)};
  const InterfaceOptions rigid{.nonmortarHeld = [](int, const SpacePoint&) { return true; }};
  for (const CouplingKind kind : kinds) {
    const ContactInterface interface = pair.meet(kind, true, held);
    EXPECT_EQ(interface.rows(), 6);
    for (const int v : interface.nonmortarNodes()) EXPECT_GT(pair.upper.vertices[v].x(), 0);
    EXPECT_LE(imbalance(interface, pair.upper, pair.lower, random), 1e-14);
    EXPECT_EQ(pair.meet(kind, true, rigid).rows(), 7);
    // A uniform pressure is still one of its pressures.
    const Vector p = interface.mass() * Vector::Constant(6, 3.0);
    EXPECT_NEAR(kind == CouplingKind::mortar ? p.sum() : 3.0, 3.0, 1e-14);
  }
  EXPECT_EQ(pair.meet(CouplingKind::interpolation, true, {.nonmortarHeld = onLeft(pair.upper)}).rows(), 7);
  EXPECT_EQ(pair.meet(CouplingKind::mortar, true, {.nonmortarHeld = onLeft(pair.upper)}).rows(), 6);
}

}  // namespace mortier::curved_interface_test
