#include "mesh/triangle_mesh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/digits.h"
#include "base/error.h"
#include "base/formatted.h"
#include "mesh/box_of.h"
#include "mesh/element_sides.h"

namespace mortier {
namespace {

// Doubled area over the squared longest edge; below it the sign of the area is not to be trusted.
constexpr double degenerateRatio = 1e-12;

// Squared edge lengths [m^2] whose products with the ratio above neither underflow nor overflow.
constexpr double smallestSquare = 1e-280, largestSquare = 1e280;

std::string text(double value) {
  char digits[32];
  return std::string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

std::string numbers(const std::array<int, 3>& t) {
  return std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1);
}

std::string numbers(const std::array<int, 2>& e) {
  return std::to_string(e[0] + 1) + " " + std::to_string(e[1] + 1);
}

double longestEdgeSquared(const TriangleMesh& mesh, int t) {
  const auto& [a, b, c] = mesh.triangles[t];
  const Point &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
  return std::max({(q - p).squaredNorm(), (r - q).squaredNorm(), (p - r).squaredNorm()});
}

class Validator {
 public:
  Validator(TriangleMesh& mesh, const FaultPlace& place) : mesh_(mesh), place_(place) {}

  void run() {
    checkSizes();
    checkVertices();
    checkTriangles();
    checkNoneUnused();
    sides_ = sortedSides(mesh_);
    forEachPlace(sides_, [this](std::span<const ElementSide<2>> edge) { checkSharing(edge); });
    checkAndOrientLabelledEdges();
  }

 private:
  // Whether the triangle runs from the smaller to the larger vertex.
  bool rises(const ElementSide<2>& side) const {
    return mesh_.triangles[side.element()][side.corner()] == side.vertices[0];
  }

  [[noreturn]] void fail(MeshPart part, int index, const std::string& what,
                         const std::string& id = {}) const {
    throw InputError((place_ ? place_(part, index) : mesh_.name) + ": " + what, id);
  }

  void checkSizes() const {
    if (mesh_.regions.size() != mesh_.triangles.size() ||
        mesh_.boundaryLabels.size() != mesh_.boundaryEdges.size())
      fail(MeshPart::whole, 0, "numbers of labels, expected one for each triangle and each boundary edge");
    if (mesh_.triangles.empty()) fail(MeshPart::whole, 0, "0 triangles, expected 1 or more");
  }

  void checkVertices() const {
    for (int v = 0; v < int(mesh_.vertices.size()); ++v) {
      const Point& p = mesh_.vertices[v];
      if (p.allFinite()) continue;
      fail(MeshPart::vertex, v,
           "vertex " + std::to_string(v + 1) + " at (" + text(p.x()) + ", " + text(p.y()) +
               "), expected finite coordinates");
    }
  }

  bool isVertex(int v) const { return v >= 0 && v < int(mesh_.vertices.size()); }

  std::string range() const { return "expected vertices from 1 to " + std::to_string(mesh_.vertices.size()); }

  void checkTriangles() const {
    for (int t = 0; t < int(mesh_.triangles.size()); ++t) {
      const auto& v = mesh_.triangles[t];
      const auto failHere = [&](const std::string& what, const std::string& id = {}) {
        fail(MeshPart::triangle, t, "triangle " + std::to_string(t + 1) + " (" + numbers(v) + ")" + what, id);
      };
      if (!isVertex(v[0]) || !isVertex(v[1]) || !isVertex(v[2])) failHere(", " + range());
      const double square = longestEdgeSquared(mesh_, t);
      const double area = doubleArea(mesh_, t);
      if (square > 0 && !(square > smallestSquare && square < largestSquare))
        failHere(": longest edge " + text(std::sqrt(square)) + ", expected between 1e-140 and 1e140");
      if (area > degenerateRatio * square) continue;
      if (area < -degenerateRatio * square)
        failHere(" is clockwise, expected counterclockwise", "clockwise-triangle");
      failHere(" is degenerate: area " + digits(area / 2, 4) + ", longest edge " +
                   digits(std::sqrt(square), 4) + ", expected three corners that are not in line",
               "degenerate-triangle");
    }
  }

  void checkNoneUnused() const {
    std::vector<char> used(mesh_.vertices.size(), 0);
    for (const auto& t : mesh_.triangles) used[t[0]] = used[t[1]] = used[t[2]] = 1;
    const auto unused = std::find(used.begin(), used.end(), 0);
    if (unused == used.end()) return;
    const int v = int(unused - used.begin());
    fail(MeshPart::vertex, v,
         "vertex " + std::to_string(v + 1) + " is unused, expected a corner of a triangle", "unused-vertex");
  }

  void checkSharing(std::span<const ElementSide<2>> sides) const {
    if (sides.size() < 2) return;
    const size_t several = std::min<size_t>(sides.size(), 3);
    if (several == 2 && rises(sides[0]) != rises(sides[1])) return;
    for (size_t i = 0; i < several; ++i) {
      for (size_t j = i + 1; j < several; ++j) failIfRepeated(sides[i].element(), sides[j].element());
    }
    const int t0 = sides[0].element(), t1 = sides[1].element();
    const std::string edge = numbers(sides[0].vertices);
    if (several == 2)
      fail(MeshPart::triangle, t1,
           "triangles " + std::to_string(t0 + 1) + " and " + std::to_string(t1 + 1) +
               " lie on the same side of edge " + edge + ", expected one on each side",
           "overlapping-triangles");
    fail(MeshPart::triangle, sides[2].element(),
         "edge " + edge + " is shared by " + std::to_string(sides.size()) + " triangles, expected 2 at most",
         "overlapping-triangles");
  }

  void failIfRepeated(int t0, int t1) const {
    auto v0 = mesh_.triangles[t0], v1 = mesh_.triangles[t1];
    std::sort(v0.begin(), v0.end());
    std::sort(v1.begin(), v1.end());
    if (v0 != v1) return;
    fail(MeshPart::triangle, t1,
         "triangle " + std::to_string(t1 + 1) + " (" + numbers(mesh_.triangles[t1]) + ") repeats triangle " +
             std::to_string(t0 + 1) + ", expected it once",
         "repeated-triangle");
  }

  void checkAndOrientLabelledEdges() {
    std::vector<char> labelled(sides_.size(), 0);
    for (int e = 0; e < int(mesh_.boundaryEdges.size()); ++e) {
      auto& edge = mesh_.boundaryEdges[e];
      const auto failHere = [&](const std::string& what, const std::string& id = {}) {
        fail(MeshPart::edge, e, "edge " + std::to_string(e + 1) + " (" + numbers(edge) + ")" + what, id);
      };
      if (!isVertex(edge[0]) || !isVertex(edge[1])) failHere(", " + range());
      const auto on = sidesOn(sides_, edge);
      if (on.empty())
        failHere(" is not an edge of a triangle, expected an edge of the boundary", "label-inside");
      if (on.size() > 1)
        failHere(" lies between two triangles, expected an edge of the boundary", "label-inside");
      const ElementSide<2>& side = on.front();
      if (std::exchange(labelled[&side - sides_.data()], 1) != 0) {
        int other = 0;
        while (std::minmax(mesh_.boundaryEdges[other][0], mesh_.boundaryEdges[other][1]) !=
               std::minmax(edge[0], edge[1]))
          ++other;
        const Point& a = mesh_.vertices[edge[0]];
        const Point& b = mesh_.vertices[edge[1]];
        failHere(formatted(" from (%g, %g) to (%g, %g) is labelled twice, %d and %d, expected once", a.x(),
                           a.y(), b.x(), b.y(), mesh_.boundaryLabels[other], mesh_.boundaryLabels[e]),
                 "label-twice");
      }
      const auto& v = mesh_.triangles[side.element()];
      const std::array<int, 2> turned{v[side.corner()], v[(side.corner() + 1) % 3]};
      if (edge != turned && mesh_.hasCurve(e)) std::swap(mesh_.edgeCurves[e].from, mesh_.edgeCurves[e].to);
      edge = turned;
    }
  }

  TriangleMesh& mesh_;
  const FaultPlace& place_;
  ElementSides<2> sides_;
};

}  // namespace

double doubleArea(const TriangleMesh& mesh, int t) {
  const auto& [a, b, c] = mesh.triangles[t];
  const Point u = mesh.vertices[b] - mesh.vertices[a], v = mesh.vertices[c] - mesh.vertices[a];
  return cross(u, v);
}

double extent(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  return boxOf(mesh.vertices).sizes().maxCoeff();
}

double aspectRatio(const TriangleMesh& mesh, int t) {
  const double equilateral = 2 / std::sqrt(3.0);  // its edge over its height
  return longestEdgeSquared(mesh, t) / doubleArea(mesh, t) / equilateral;
}

void validate(TriangleMesh& mesh, const FaultPlace& place) {
  Validator(mesh, place).run();
}

TriangleMesh meshAboutAxis(TriangleMesh mesh, const char* beside) {
  constexpr double rounding = 1e-12;  // of the largest radius
  double largest = 0;
  for (const Point& vertex : mesh.vertices) largest = std::max(largest, std::abs(vertex.x()));
  std::vector<size_t> straight;
  const auto halfway = [&mesh](size_t e) -> Point {
    const auto& [a, b] = mesh.boundaryEdges[e];
    return (mesh.vertices[a] + mesh.vertices[b]) / 2;
  };
  for (size_t e = 0; e < mesh.edgeMiddles.size(); ++e)
    if (mesh.edgeMiddles[e] == halfway(e)) straight.push_back(e);
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    double& radius = mesh.vertices[v].x();
    if (std::abs(radius) <= rounding * largest) radius = 0;
    if (radius >= 0) continue;
    throw InputError(mesh.name + ": vertex " + std::to_string(v + 1) + " at x = " + digits(radius, 6) +
                     ", expected x >= 0 beside " + beside + ": x is the distance from the axis");
  }
  for (Point& middle : mesh.edgeMiddles)
    if (std::abs(middle.x()) <= rounding * largest) middle.x() = 0;
  for (const size_t e : straight) mesh.edgeMiddles[e] = halfway(e);
  return mesh;
}

}  // namespace mortier
