// Interfaces that are not one straight line: broken lines, curves, closed curves.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

#include "contact/interface.h"
#include "mesh/generate.h"
#include "unit/messages.h"

namespace mortier {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int bottom = 1;
constexpr int top = 3;
constexpr double circleRounding = 1e-13;  // of a radius of one
constexpr CouplingKind kinds[] = {CouplingKind::mortar, CouplingKind::interpolation};

/// Cells of random width over [0, 1] x [lower, upper], mapped.
template <class Map>
TriangleMesh mapped(std::mt19937& random, int cells, double lower, double upper, Map map) {
  std::uniform_real_distribution<double> width(1, 2);
  std::vector<double> x{0};
  for (int i = 0; i < cells; ++i) x.push_back(x.back() + width(random));
  TriangleMesh mesh = crissCrossMesh(
      {.lower = {0, lower}, .upper = {static_cast<double>(cells), upper}, .cellsX = cells, .cellsY = 2});
  for (Point& v : mesh.vertices) {
    const int cell = std::min(static_cast<int>(v.x()), cells - 1);
    v = map(Point((x[cell] + (v.x() - cell) * (x[cell + 1] - x[cell])) / x.back(), v.y()));
  }
  validate(mesh);
  return mesh;
}

/// Two bodies that meet on y = 0 before they are mapped; the upper one is nonmortar or the lower one.
struct Pair {
  TriangleMesh upper;
  TriangleMesh lower;

  [[nodiscard]] ContactInterface meet(CouplingKind kind, bool upperNonmortar,
                                      const InterfaceOptions& options = {}) const {
    const ContactSide upperSide{0, bottom};
    const ContactSide lowerSide{1, top};
    if (upperNonmortar) return {{upperSide, lowerSide, kind}, upper, lower, options};
    return {{lowerSide, upperSide, kind}, lower, upper, options};
  }
};

template <class Map>
Pair pairOf(std::mt19937& random, int upperCells, int lowerCells, Map map) {
  return {mapped(random, upperCells, 0, 0.5, map), mapped(random, lowerCells, -0.5, 0, map)};
}

/// A bow of the given angle and radius 1 about the origin, the upper body outside.
auto bow(double angle, double turned = 0) {
  return [=](const Point& x) {
    const double phi = turned - angle * (x.x() - 0.5);
    return Point((1 + x.y()) * std::sin(-phi), (1 + x.y()) * std::cos(phi));
  };
}

auto wave(double height) {
  return [=](const Point& x) { return Point(x.x(), x.y() + height * std::sin(2 * pi * x.x())); };
}

/// Force and moment of the rows, for random p, over the sum of |p|.
double imbalance(const ContactInterface& interface, const TriangleMesh& nonmortar, const TriangleMesh& mortar,
                 std::mt19937& random) {
  std::uniform_real_distribution<double> value(0, 1);
  double worst = 0;
  for (int trial = 0; trial < 5; ++trial) {
    const Vector p =
        Vector::NullaryExpr(interface.rows(), [&](Eigen::Index) { return std::pow(value(random), 4); });
    Vector f1 = Vector::Zero(2 * nonmortar.vertices.size());
    Vector f2 = Vector::Zero(2 * mortar.vertices.size());
    interface.subtractForces(p, f1, f2);
    Point force = Point::Zero();
    double moment = 0;
    for (const auto& [mesh, f] : {std::pair(&nonmortar, &f1), std::pair(&mortar, &f2)})
      for (size_t v = 0; v < mesh->vertices.size(); ++v) {
        force += f->segment<2>(2 * v);
        moment += mesh->vertices[v].x() * (*f)[2 * v + 1] - mesh->vertices[v].y() * (*f)[2 * v];
      }
    worst = std::max({worst, force.norm() / p.sum(), std::abs(moment) / p.sum()});
  }
  return worst;
}

TEST(CurvedInterface, forceAndMomentBalance) {
  constexpr double balance = 1e-12;
  std::mt19937 random(1);
  std::uniform_int_distribution<int> cells(6, 40);
  std::uniform_real_distribution<double> value(-1, 1);
  double worst = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Pair pair = pairOf(random, cells(random), cells(random), bow(2 * std::abs(value(random)), value(random)));
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
  const Pair pair{ring(48, 1 + distance, 2, 0.3), ring(37, 0.5, 1, 0)};
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
    const Pair part{pair.upper, mapped(random, 9, -0.5, 0, bow(1.5, turned))};
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

// Two arcs about one centre: the distance is the difference of the radii, not that of the polygons.
TEST(CurvedInterface, distanceAlongTheNormal) {
  std::mt19937 random(5);
  const double distance = 0.125;
  const TriangleMesh upper = mapped(random, 60, 0, 0.5, bow(2));
  const TriangleMesh lower = mapped(random, 47, -0.5 - distance, -distance, bow(2));
  for (const CouplingKind kind : kinds)
    for (const bool upperNonmortar : {true, false}) {
      const ContactInterface interface = Pair{upper, lower}.meet(kind, upperNonmortar);
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
TEST(CurvedInterface, distanceOfTwoCircles) {
  std::mt19937 random(8);
  const double moved = 0.01;
  Pair pair = pairOf(random, 60, 47, bow(1));
  for (Point& x : pair.lower.vertices) x.y() -= moved;
  for (const bool upperNonmortar : {true, false}) {
    const ContactInterface interface = pair.meet(CouplingKind::interpolation, upperNonmortar);
    const TriangleMesh& mesh = upperNonmortar ? pair.upper : pair.lower;
    for (int i = 0; i < interface.rows(); ++i) {
      const Point& x = mesh.vertices[interface.nonmortarNodes()[i]];
      const Point seen = x + interface.initialDistance()[i] * interface.normals()[i];
      EXPECT_NEAR((seen - Point(0, upperNonmortar ? -moved : 0)).norm(), 1, circleRounding);
    }
    const ContactInterface mortar = pair.meet(CouplingKind::mortar, upperNonmortar);
    const double shared = std::min(interface.rows(), mortar.rows());
    EXPECT_NEAR(mortar.initialDistance().sum() / shared, interface.initialDistance().sum() / shared,
                1e-4 * moved);
  }
}

/// A half disc on a wall, or on another half disc that is mirrored below it.
Pair discOn(double wall, double otherRadius) {
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
TEST(CurvedInterface, directionDoesNotDependOnTheSide) {
  std::mt19937 random(9);
  for (const double radius : {0.0, 1.0, 3.0})
    for (const CouplingKind kind : kinds)
      for (const bool upperNonmortar : {true, false})
        for (const double wall : {0.0, 0.01}) {
          const Pair pair = discOn(wall, radius);
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
TEST(CurvedInterface, initialGap) {
  std::mt19937 random(6);
  const Pair circle = pairOf(random, 12, 17, bow(2));
  EXPECT_EQ(circle.meet(CouplingKind::mortar, true, {.initial = InitialGap::reject})
                .initialDistance()
                .cwiseAbs()
                .maxCoeff(),
            0);
  const Pair pair = pairOf(random, 12, 17, wave(0.05));
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
  const ContactInterface given =
      pair.meet(CouplingKind::mortar, true, {.gap = [](const Point& x) { return 0.5 * x.x() * x.x(); }});
  for (int i = 0; i < given.rows(); ++i) {
    const double x = pair.upper.vertices[given.nonmortarNodes()[i]].x();
    EXPECT_EQ(given.initialDistance()[i], 0.5 * x * x);
  }
}

// The closures of Gamma_C and of the Dirichlet boundary meet.
TEST(CurvedInterface, heldEndsAreMerged) {
  std::mt19937 random(7);
  const Pair pair = pairOf(random, 6, 9, [](const Point& x) { return x; });
  const auto onLeft = [](const TriangleMesh& mesh) {
    return [&mesh](int v, const Point&) { return mesh.vertices[v].x() == 0; };
  };
  const InterfaceOptions held{.nonmortarHeld = onLeft(pair.upper), .mortarHeld = onLeft(pair.lower)};
  const InterfaceOptions rigid{.nonmortarHeld = [](int, const Point&) { return true; }};
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

}  // namespace
}  // namespace mortier
