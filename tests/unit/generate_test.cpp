#include "mesh/generate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/error.h"
#include "mesh/boundary_line.h"
#include "unit/mesh_measures.h"

namespace mortier::generate_test {

constexpr Cut cuts[] = {Cut::rising, Cut::falling, Cut::both};

/// Every edge of one triangle only is labelled: no hole where blocks meet.
bool closedByLabels(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> count;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++count[std::minmax(t[k], t[(k + 1) % 3])];
  size_t single = 0;
  for (const auto& [edge, triangles] : count) single += triangles == 1 ? 1 : 0;
  return single == mesh.boundaryEdges.size();
}

TEST(CrissCross, hasTheNotesCounts) {
  const TriangleMesh upper = crissCrossMesh({{0, 0}, {1, 1}, 6, 6});
  const TriangleMesh lower = crissCrossMesh({{0, -1}, {1, 0}, 16, 16});
  EXPECT_EQ(upper.triangles.size() + lower.triangles.size(), 1168u);
  EXPECT_EQ(upper.vertices.size() + lower.vertices.size(), 630u);
}

TEST(CrissCross, numbersGridNodesThenCentres) {
  const TriangleMesh mesh = crissCrossMesh({{0, 0}, {3, 2}, 3, 2});
  EXPECT_EQ(mesh.vertices[3], Point(3, 0));
  EXPECT_EQ(mesh.vertices[4], Point(0, 1));
  EXPECT_EQ(mesh.vertices[12], Point(0.5, 0.5));
  EXPECT_EQ(mesh.vertices[17], Point(2.5, 1.5));
  EXPECT_EQ(mesh.triangles[0], (std::array<int, 3>{0, 1, 12}));
}

TEST(Rectangle, meetsItsSidesExactly) {
  const Point lower(-0.1, 0.7), upper(0.3, 1.1);
  for (const TriangleMesh& mesh :
       {rectangleMesh({lower, upper, 49, 10}), crissCrossMesh({lower, upper, 49, 10})}) {
    for (const Point& p : boundaryLine(mesh, 1).points) EXPECT_EQ(p.y(), lower.y());
    for (const Point& p : boundaryLine(mesh, 2).points) EXPECT_EQ(p.x(), upper.x());
    for (const Point& p : boundaryLine(mesh, 3).points) EXPECT_EQ(p.y(), upper.y());
    for (const Point& p : boundaryLine(mesh, 4).points) EXPECT_EQ(p.x(), lower.x());
    double area = 0;
    for (int t = 0; t < int(mesh.triangles.size()); ++t) area += doubleArea(mesh, t) / 2;
    EXPECT_NEAR(area, 0.16, 1e-14);
  }
}

TEST(Rectangle, refusesWhatIsNoRectangle) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Rectangle wrong[] = {{{0, 0}, {1, 1}, 0, 1},         {{0, 0}, {1, 1}, 1, -2},
                             {{0, 0}, {0, 1}, 1, 1},         {{0, 1}, {1, 0}, 1, 1},
                             {{0, nan}, {1, 1}, 1, 1},       {{0, 0}, {HUGE_VAL, 1}, 1, 1},
                             {{1, 1}, {1 + 1e-15, 2}, 9, 1}, {{0, 0}, {1, 1}, 2147483647, 2147483647}};
  for (const Rectangle& r : wrong) {
    EXPECT_THROW(rectangleMesh(r), InputError);
    EXPECT_THROW(crissCrossMesh(r), InputError);
  }
}

TEST(GradedRectangle, cellsGrowGeometricallyFromTheFocus) {
  Rectangle r{{-3, -1}, {1, 0}, 24, 7, Point(0, 0), {20, 5}};
  for (const Cut cut : cuts) {
    const TriangleMesh mesh = rectangleMesh(r, cut);
    EXPECT_NEAR(area(mesh), 4, 1e-14);
    EXPECT_TRUE(closedByLabels(mesh));
    const std::vector<Point> top = boundaryLine(mesh, 3).points;  // from right to left
    ASSERT_EQ(top.size(), 25u);
    EXPECT_EQ(top.front().x(), 1);
    EXPECT_EQ(top.back().x(), -3);
    const auto focus = std::find(top.begin(), top.end(), Point(0, 0));
    ASSERT_NE(focus, top.end());
    const auto size = [](auto p) { return p->x() - (p + 1)->x(); };
    // One ratio on each side, sizes at the focus alike, the farthest cell 20 times the nearest up to one
    // ratio.
    const double left = size(focus + 1) / size(focus);
    for (auto p = focus + 1; p + 2 < top.end(); ++p) EXPECT_NEAR(size(p + 1) / size(p), left, 1e-9);
    const double right = size(focus - 2) / size(focus - 1);
    for (auto p = top.begin(); p + 1 < focus; ++p) EXPECT_NEAR(size(p) / size(p + 1), right, 1e-9);
    EXPECT_NEAR(size(focus - 1) / size(focus), 1, 0.1);
    EXPECT_NEAR(std::log(size(top.end() - 2) / size(focus)), std::log(20), std::log(left));
    const std::vector<Point> side = boundaryLine(mesh, 2).points;
    EXPECT_NEAR(std::log((side[1].y() - side[0].y()) / (side[7].y() - side[6].y())), std::log(5),
                std::log(5) / 6);
  }
}

TEST(GradedRectangle, refusesAFocusOutsideAndAGradingBelowOne) {
  const Rectangle wrong[] = {{{0, 0}, {1, 1}, 4, 4, Point(2, 0), {2, 2}},
                             {{0, 0}, {1, 1}, 4, 4, Point(NAN, 0), {2, 2}},
                             {{0, 0}, {1, 1}, 4, 4, Point(0, 0), {0.5, 1}},
                             {{0, 0}, {1, 1}, 4, 4, Point(0, 0), {1, 1e9}},
                             {{0, 0}, {1, 1}, 1, 4, Point(0.5, 0), {2, 2}}};
  for (const Rectangle& r : wrong) EXPECT_THROW(rectangleMesh(r), InputError);
}

TEST(Quadrilateral, isCooksMembrane) {
  for (const Cut cut : cuts) {
    const TriangleMesh mesh = quadrilateralMesh({{Point(0, 0), {48, 44}, {48, 60}, {0, 44}}, 8, 4}, cut);
    EXPECT_EQ(mesh.triangles.size(), cut == Cut::both ? 128u : 64u);
    EXPECT_NEAR(area(mesh), 1440, 1e-11);
    EXPECT_TRUE(closedByLabels(mesh));
    for (const Point& p : boundaryLine(mesh, 2).points) EXPECT_EQ(p.x(), 48);
    for (const Point& p : boundaryLine(mesh, 4).points) EXPECT_EQ(p.x(), 0);
  }
  EXPECT_THROW(quadrilateralMesh({{Point(0, 0), {0, 1}, {1, 1}, {1, 0}}}), InputError);
  EXPECT_THROW(quadrilateralMesh({{Point(0, 0), {1, 0}, {0.1, 0.1}, {0, 1}}}), InputError);
  EXPECT_THROW(quadrilateralMesh({{Point(0, 0), {1, NAN}, {1, 1}, {0, 1}}}), InputError);
  EXPECT_THROW(quadrilateralMesh({{Point(0, 0), {1, 0}, {1, 1}, {0, 1}}, 0, 1}), InputError);
}

// The vertex inside a cell is on both of its diagonals, whatever its shape.
TEST(CutByBoth, diagonalsMeetInTheNewVertex) {
  constexpr double rounding = 1e-14;
  for (const TriangleMesh& mesh :
       {annulusMesh({{1, -2}, 1, 2, 1, 5, 3}, Cut::both), halfDiscMesh({{0, 0}, 50, 10, 3}, Cut::both),
        quadrilateralMesh({{Point(0, 0), {48, 44}, {48, 60}, {0, 44}}, 3, 2}, Cut::both)})
    for (size_t t = 0; t < mesh.triangles.size(); t += 4) {
      const Point& centre = mesh.vertices[mesh.triangles[t][2]];
      for (const size_t side : {t, t + 1}) {
        const Point u = mesh.vertices[mesh.triangles[side][0]] - centre;
        const Point v = mesh.vertices[mesh.triangles[side + 2][0]] - centre;
        EXPECT_LE(std::abs(u.x() * v.y() - u.y() * v.x()), rounding * (u - v).squaredNorm());
        EXPECT_LT(u.dot(v), 0);
      }
    }
}

TEST(Annulus, hasItsCirclesAndSides) {
  for (const Cut cut : cuts)
    for (const int quarters : {1, 2, 4}) {
      const int around = 12 * quarters;
      const TriangleMesh mesh = annulusMesh({{1, -2}, 1, 2, quarters, around, 6}, cut);
      EXPECT_TRUE(closedByLabels(mesh));
      // Regular polygons of both radii.
      EXPECT_NEAR(area(mesh), 0.5 * 3 * around * std::sin(M_PI / 2 * quarters / around), 1e-13);
      for (const int label : {1, 2})
        for (const Point& p : boundaryLine(mesh, label).points)
          EXPECT_NEAR((p - Point(1, -2)).norm(), label, 1e-15);
      EXPECT_EQ(boundaryLine(mesh, 1).closed, quarters == 4);
      EXPECT_LE(worstAspect(mesh), 2.2);
      if (quarters == 4) continue;
      for (const Point& p : boundaryLine(mesh, 3).points) EXPECT_EQ(p.y(), -2);
      for (const Point& p : boundaryLine(mesh, 4).points) EXPECT_EQ(quarters == 1 ? p.x() - 1 : p.y() + 2, 0);
    }
  for (const Annulus& wrong :
       {Annulus{{0, 0}, 0, 1, 4, 8, 2}, Annulus{{0, 0}, 2, 1, 4, 8, 2}, Annulus{{0, 0}, 1, HUGE_VAL, 4, 8, 2},
        Annulus{{0, 0}, 1, 2, 3, 8, 2}, Annulus{{0, 0}, 1, 2, 4, 2, 2}, Annulus{{NAN, 0}, 1, 2, 4, 8, 2}})
    EXPECT_THROW(annulusMesh(wrong), InputError);
}

TEST(HalfDisc, isRoundSymmetricAndFineAtItsLowestPoint) {
  const double R = 50;
  const Point lowest(20, -1);
  double before = 0;
  for (const int cells : {2, 4, 8, 16})
    for (const Cut cut : cuts) {
      const TriangleMesh mesh = halfDiscMesh({lowest, R, 10, cells}, cut);
      EXPECT_TRUE(closedByLabels(mesh));
      EXPECT_LE(worstAspect(mesh), cut == Cut::both ? 4.2 : 7);
      // No odd node on the arc: each has as many triangles as its neighbours.
      std::vector<int> triangles(mesh.vertices.size(), 0);
      for (const auto& corners : mesh.triangles)
        for (const int v : corners) ++triangles[v];
      const std::vector<int> arc = boundaryLine(mesh, 1).nodes;
      for (const int v : arc) EXPECT_EQ(triangles[v], cut == Cut::both ? 4 : 3) << mesh.vertices[v];
      for (const Point& p : mesh.vertices) {
        const Point mirrored(2 * lowest.x() - p.x(), p.y());
        EXPECT_TRUE(std::any_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const Point& other) {
          return (other - mirrored).norm() <= 1e-14 * R;
        })) << p;
      }
      for (const int label : {1, 3})
        for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
          for (const int v : mesh.boundaryEdges[e]) {
            if (mesh.boundaryLabels[e] != label) continue;
            EXPECT_NEAR((mesh.vertices[v] - lowest - Point(0, R)).norm(), R, 4e-14);
          }
      const std::vector<Point> contact = boundaryLine(mesh, 1).points;
      EXPECT_NEAR(contact.front().x(), lowest.x() - R * std::sqrt(0.5), 0.5 * R / cells);
      EXPECT_NE(std::find(contact.begin(), contact.end(), lowest), contact.end());
      double smallest = INFINITY;
      for (size_t i = 1; i < contact.size(); ++i)
        smallest = std::min(smallest, (contact[i] - contact[i - 1]).norm());
      EXPECT_LE(smallest, 10.1 / cells);
      EXPECT_GE(smallest, 7.0 / cells);
      for (const Point& p : boundaryLine(mesh, 2).points) EXPECT_EQ(p.y(), lowest.y() + R);
      // The area lacks what polygons lack: second order.
      const double lack = M_PI / 2 * R * R - area(mesh);
      EXPECT_GT(lack, 0);
      if (cut == Cut::both && cells > 4) {
        EXPECT_NEAR(before / lack, 4, 0.6);  // the number of rings is rounded
      }
      if (cut == Cut::both) before = lack;
    }
  for (const Cut cut : cuts) {
    const TriangleMesh half = halfDiscMesh({lowest, R, 10, 4}, cut);
    const TriangleMesh quarter = halfDiscMesh({lowest, R, 10, 4, true}, cut);
    EXPECT_TRUE(closedByLabels(quarter));
    EXPECT_EQ(2 * quarter.triangles.size(), half.triangles.size());
    EXPECT_NEAR(2 * area(quarter), area(half), 1e-12 * R * R);
    for (const Point& p : boundaryLine(quarter, 4).points) EXPECT_EQ(p.x(), lowest.x());
  }
  for (const HalfDisc& wrong :
       {HalfDisc{{0, 0}, 0, 0.1, 2}, HalfDisc{{0, 0}, 1, 0.5, 2}, HalfDisc{{0, 0}, 1, 0, 2},
        HalfDisc{{0, 0}, 1, 0.1, 0}, HalfDisc{{0, NAN}, 1, 0.1, 2}})
    EXPECT_THROW(halfDiscMesh(wrong), InputError);
}

}  // namespace mortier::generate_test
