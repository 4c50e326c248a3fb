// The half disc in two blocks: a core of 2m x m cells over the lowest point, its bottom on the arc, and
// 4m lines that lead from its left side, top and right side to the flat side. The first and last line run
// along the arc. Lengths are over the radius, the lowest point is the origin.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/digits.h"
#include "base/error.h"
#include "base/formatted.h"
#include "mesh/generate.h"

namespace mortier {
namespace {

constexpr double pi = std::numbers::pi;

/// On the arc at an angle from the vertical.
Point onArc(double angle) {
  const double half = std::sin(angle / 2);
  return {std::sin(angle), 2 * half * half};
}

struct HalfDiscGrid {
  static constexpr double spread = 0.8;  // 1: equal cells on the flat side. The worst aspect ratio is least
  int m = 1;
  double core = 0.1;

  /// Column i from -m to m, row j from 0 to m.
  [[nodiscard]] Point inCore(int i, int j) const {
    const Point foot = onArc(std::asin(core) * i / m);
    const double t = static_cast<double>(j) / m;
    const double top = onArc(std::asin(core)).y() + core;
    return {foot.x(), (1 - t) * foot.y() + t * top};
  }

  /// Where line k = 0 .. 4m begins.
  [[nodiscard]] Point inner(int k) const {
    if (k <= m) return inCore(-m, k);
    if (k >= 3 * m) return inCore(m, 4 * m - k);
    return inCore(k - 2 * m, m);
  }

  /// Where it ends, on the flat side: the lines of the sides of the core spread over more of it.
  [[nodiscard]] Point outer(int k) const {
    const double x = static_cast<double>(k - 2 * m) / (2 * m);
    return {x * (spread + (1 - spread) * x * x), 1};
  }

  /// Line k at a part s of its length. The first and the last are arcs; how far these are from straight fades
  /// out towards the middle line.
  [[nodiscard]] Point onLine(int k, double s) const {
    const Point straight = inner(k) + s * (outer(k) - inner(k));
    const double begin = std::asin(core);
    const Point arc = onArc(begin + s * (pi / 2 - begin));
    const Point chord = onArc(begin) + s * (onArc(pi / 2) - onArc(begin));
    const Point bulge = arc - chord;
    const double x = static_cast<double>(k - 2 * m) / (2 * m);
    return straight + Point(x * std::abs(x) * bulge.x(), x * x * bulge.y());
  }
};

/// The triangles right of a vertical line of edges, which get the label 4.
TriangleMesh rightOf(double x, const TriangleMesh& whole) {
  TriangleMesh mesh;
  std::vector<int> number(whole.vertices.size(), -1);
  for (size_t v = 0; v < number.size(); ++v)
    if (whole.vertices[v].x() >= x) {
      number[v] = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(whole.vertices[v]);
    }
  for (size_t t = 0; t < whole.triangles.size(); ++t) {
    const auto& corners = whole.triangles[t];
    if (std::any_of(corners.begin(), corners.end(), [&](int v) { return number[v] < 0; })) continue;
    mesh.triangles.push_back({number[corners[0]], number[corners[1]], number[corners[2]]});
    if (!whole.regions.empty()) mesh.regions.push_back(whole.regions[t]);
    for (size_t k = 0; k < 3; ++k) {
      const int a = corners[k];
      const int b = corners[(k + 1) % 3];
      if (whole.vertices[a].x() != x || whole.vertices[b].x() != x) continue;
      mesh.boundaryEdges.push_back({number[a], number[b]});
      mesh.boundaryLabels.push_back(4);
    }
  }
  for (size_t e = 0; e < whole.boundaryEdges.size(); ++e) {
    const auto& [a, b] = whole.boundaryEdges[e];
    if (number[a] < 0 || number[b] < 0) continue;
    mesh.boundaryEdges.push_back({number[a], number[b]});
    mesh.boundaryLabels.push_back(whole.boundaryLabels[e]);
  }
  return mesh;
}

}  // namespace

TriangleMesh halfDiscMesh(const HalfDisc& disc, Cut cut) {
  const std::string name =
      formatted("half disc of radius %g on (%g, %g)", disc.radius, disc.lowest.x(), disc.lowest.y());
  if (!(disc.radius > 0 && std::isfinite(disc.radius) && disc.lowest.allFinite()))
    throw InputError(name + ", expected finite numbers and a radius > 0");
  if (!(disc.core > 0 && 3 * disc.core < disc.radius))
    throw InputError(name + ": core " + digits(disc.core, 6) +
                     ", expected more than 0 and less than a third of the radius");
  checkCells(name, disc.cells, disc.cells, cut);
  const HalfDiscGrid grid{disc.cells, disc.core / disc.radius};
  const int m = grid.m;
  // Rings so that cells are about as long as wide: sizes grow with the distance from the lowest point.
  const double growth = std::log(0.9 / grid.core);
  const int rings = std::max(1, static_cast<int>(std::lround(growth * 4 * m / pi)));
  checkCells(name, 4.0 * m, rings + m, cut);

  // 1. Nodes.
  TriangleMesh mesh;
  const auto add = [&](const Point& p) { mesh.vertices.emplace_back(disc.lowest + disc.radius * p); };
  for (int j = 0; j <= m; ++j)
    for (int i = -m; i <= m; ++i) add(grid.inCore(i, j));
  for (int r = 1; r <= rings; ++r)
    for (int k = 0; k <= 4 * m; ++k)
      add(grid.onLine(k, r == rings ? 1.0 : std::expm1(growth * r / rings) / std::expm1(growth)));
  const auto coreNode = [m](int i, int j) { return j * (2 * m + 1) + i + m; };
  const auto ringNode = [&](int r, int k) {
    if (r > 0) return (m + 1) * (2 * m + 1) + (r - 1) * (4 * m + 1) + k;
    return k <= m ? coreNode(-m, k) : k >= 3 * m ? coreNode(m, 4 * m - k) : coreNode(k - 2 * m, m);
  };

  // 2. Labels.
  const auto addEdge = [&](int a, int b, int label) {
    mesh.boundaryEdges.push_back({a, b});
    mesh.boundaryLabels.push_back(label);
  };
  const auto onRing = [&](int r) {  // edges beside a ring: near or far from the lowest point
    return mesh.vertices[ringNode(r, 0)].y() + mesh.vertices[ringNode(r - 1, 0)].y() <
                   2 * (disc.lowest.y() + disc.radius * onArc(pi / 4).y())
               ? 1
               : 3;
  };
  for (int r = rings; r > 0; --r) addEdge(ringNode(r, 0), ringNode(r - 1, 0), onRing(r));
  for (int i = -m; i < m; ++i) addEdge(coreNode(i, 0), coreNode(i + 1, 0), 1);
  for (int r = 1; r <= rings; ++r) addEdge(ringNode(r - 1, 4 * m), ringNode(r, 4 * m), onRing(r));
  for (int k = 4 * m; k > 0; --k) addEdge(ringNode(rings, k), ringNode(rings, k - 1), 2);

  // 3. Cells. A single diagonal runs through the core one way and through the rings the other, so that every
  // node of the arc has three triangles. Were it mirrored about the vertical axis, the lowest point would
  // have four, and a wrong pressure.
  const Cut around = cut == Cut::both ? cut : cut == Cut::rising ? Cut::falling : Cut::rising;
  for (int j = 0; j < m; ++j)
    for (int i = -m; i < m; ++i)
      addCell(mesh, {coreNode(i, j), coreNode(i + 1, j), coreNode(i + 1, j + 1), coreNode(i, j + 1)}, cut);
  for (int r = 0; r < rings; ++r)
    for (int k = 0; k < 4 * m; ++k)
      addCell(mesh, {ringNode(r, k), ringNode(r, k + 1), ringNode(r + 1, k + 1), ringNode(r + 1, k)}, around);
  mesh = finished(std::move(mesh), name);
  return disc.quarter ? finished(rightOf(disc.lowest.x(), mesh), "quarter of a " + name) : mesh;
}

}  // namespace mortier
