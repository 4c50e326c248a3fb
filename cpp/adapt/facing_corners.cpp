#include "adapt/adapted_meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "contact/smooth_part.h"
#include "mesh/boundary_line.h"
#include "mesh/line_part.h"
#include "mesh/refine.h"

namespace mortier {
namespace {

struct CornerCut {
  size_t edge = 0;  ///< of the boundary
  Point at;
};

/// Where the nearest edge of the line is to be cut.
std::optional<CornerCut> cutAt(const TriangleMesh& mesh, const CurvedEdges& curves, int label,
                               const Point& place) {
  constexpr double nextToAVertex = 0.1;
  double least = std::numeric_limits<double>::infinity();
  std::optional<CornerCut> cut;
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    if (mesh.boundaryLabels[e] != label) continue;
    const auto& [a, b] = mesh.boundaryEdges[e];
    const Point along = mesh.vertices[b] - mesh.vertices[a];
    const double part = (place - mesh.vertices[a]).dot(along) / along.squaredNorm();
    const Point at = mesh.vertices[a] + std::clamp(part, 0.0, 1.0) * along;
    const double distance = (place - at).norm();
    if (distance >= least) continue;
    least = distance;
    const bool curved =
        curves.count({a, b}) > 0 || curves.count({b, a}) > 0 ||
        (!mesh.edgeMiddles.empty() && mesh.edgeMiddles[e].allFinite() && !isStraight(mesh, e));
    const bool apart = distance > along.norm();
    if (curved || apart || part < nextToAVertex || part > 1 - nextToAVertex)
      cut.reset();
    else
      cut = CornerCut{e, at};
  }
  return cut;
}

void apply(TriangleMesh& mesh, const CornerCut& cut) {
  const auto [a, b] = mesh.boundaryEdges[cut.edge];
  const auto m = static_cast<int>(mesh.vertices.size());
  const bool straight = isStraight(mesh, cut.edge);
  mesh.vertices.push_back(cut.at);
  mesh.boundaryEdges[cut.edge] = {a, m};
  mesh.boundaryEdges.push_back({m, b});
  mesh.boundaryLabels.push_back(mesh.boundaryLabels[cut.edge]);
  if (!mesh.edgeMiddles.empty()) mesh.edgeMiddles.push_back(mesh.edgeMiddles[cut.edge]);
  if (straight) {
    mesh.edgeMiddles[cut.edge] = (mesh.vertices[a] + cut.at) / 2;
    mesh.edgeMiddles.back() = (cut.at + mesh.vertices[b]) / 2;
  }
  if (!mesh.edgeCurves.empty()) mesh.edgeCurves.emplace_back();
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::array<int, 3> old = mesh.triangles[t];
      if (old[k] != a || old[(k + 1) % 3] != b) continue;
      const int c = old[(k + 2) % 3];
      mesh.triangles[t] = {a, m, c};
      mesh.triangles.push_back({m, b, c});
      mesh.regions.push_back(mesh.regions[t]);
      return;
    }
}

}  // namespace

std::vector<Point> cornersOf(const TriangleMesh& mesh, int label) {
  const BoundaryLine line = boundaryLine(mesh, label);
  std::vector<Point> corners;
  const size_t n = line.points.size();
  for (size_t i = 0; i < n; ++i) {
    const bool end = i == 0 || i + 1 == n;
    if (end && line.closed && i + 1 == n) continue;
    if (end && !line.closed) {
      corners.push_back(line.points[i]);
      continue;
    }
    const Point before = line.points[i] - line.points[i == 0 ? n - 2 : i - 1];
    const Point after = line.points[i + 1] - line.points[i];
    const double turn = std::atan2(cross(before, after), before.dot(after));
    if (std::abs(turn) > sharpTurn) corners.push_back(line.points[i]);
  }
  return corners;
}

void cutFacing(TriangleMesh& mesh, const CurvedEdges& curves, int label, const std::vector<Point>& places) {
  for (const Point& place : places)
    if (const std::optional<CornerCut> cut = cutAt(mesh, curves, label, place)) apply(mesh, *cut);
}

std::vector<char> longerThanFacing(const TriangleMesh& mesh, int label, const TriangleMesh& other,
                                   int otherLabel) {
  constexpr double most = 2;
  constexpr double inside = 0.499;  // beyond its end nothing faces a line
  const LinePart line(boundaryLine(mesh, label));
  struct Edge {
    double middle, length;
  };
  std::vector<Edge> facing;
  for (const auto& [a, b] : sidesWith(other, otherLabel))
    facing.push_back({line.along((other.vertices[a] + other.vertices[b]) / 2),
                      (other.vertices[b] - other.vertices[a]).norm()});
  std::set<std::array<int, 2>> longer;
  for (const auto& [a, b] : sidesWith(mesh, label)) {
    const double length = (mesh.vertices[b] - mesh.vertices[a]).norm();
    const double middle = line.along((mesh.vertices[a] + mesh.vertices[b]) / 2);
    for (const Edge& each : facing)
      if (std::abs(each.middle - middle) < inside * length && length > most * each.length)
        longer.insert({a, b});
  }
  std::vector<char> marked(mesh.triangles.size(), 0);
  for (size_t t = 0; t < marked.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (longer.count({mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}) > 0) marked[t] = 1;
  return marked;
}

}  // namespace mortier
