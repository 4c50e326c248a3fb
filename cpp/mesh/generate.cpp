#include "mesh/generate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/digits.h"
#include "base/error.h"
#include "base/formatted.h"

namespace mortier {
namespace {

std::string text(const Point& p) {
  return formatted("(%g, %g)", p.x(), p.y());
}

constexpr double maxTriangles = 1e8;  // beyond what a desktop solves; keeps numbers within int

/// Distances from the focus of the nodes of n cells on a length L: A ((1 + L/A)^(i/n) - 1).
std::vector<double> distances(double L, int n, double A) {
  std::vector<double> result;
  for (int i = 0; i <= n; ++i) result.push_back(i == n ? L : A * std::expm1(std::log1p(L / A) * i / n));
  return result;
}

/// Where the diagonals of a cell meet; the mean of its corners where they do not.
Point crossing(const TriangleMesh& mesh, const std::array<int, 4>& corners) {
  constexpr double rounding = 1e-12;
  const auto corner = [&](int i) -> const Point& { return mesh.vertices[corners[i]]; };
  const auto middle = [&](int i, int j) -> Point { return corner(i) + (corner(j) - corner(i)) / 2; };
  Point mean = (middle(0, 2) + middle(1, 3)) / 2;
  const Point first = corner(2) - corner(0);
  const Point second = corner(3) - corner(1);
  const double area = cross(first, second);
  const double s = cross(corner(1) - corner(0), second) / area;
  const double t = cross(corner(1) - corner(0), first) / area;
  if (!(s > 0 && s < 1 && t > 0 && t < 1)) return mean;
  const Point met = corner(0) + s * first;
  // Of a parallelogram it is the mean, whose bits are kept.
  return (met - mean).norm() <= rounding * (first.norm() + second.norm()) ? mean : met;
}

/// \throws InputError unless there is one cell or more each way, and 1e8 triangles at most.
void checkCells(const std::string& name, double cells1, double cells2, Cut cut) {
  if (cells1 < 1 || cells2 < 1) throw InputError(name + ": cell counts, expected 1 or more each way");
  if (cells1 * cells2 * (cut == Cut::both ? 4 : 2) > maxTriangles)
    throw InputError(name + ": too many cells, expected 1e8 triangles at most");
}

/// Adds the triangles of one cell. That the new vertex is where both diagonals meet lets the four triangles
/// keep their volume in plane strain without locking (Nagtegaal, Parks and Rice 1974); a cell that is not
/// convex has the mean of its corners.
void addCell(TriangleMesh& mesh, const std::array<int, 4>& corners, Cut cut) {
  const auto& [a, b, c, d] = corners;
  if (cut == Cut::rising) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  } else if (cut == Cut::falling) {
    mesh.triangles.push_back({a, b, d});
    mesh.triangles.push_back({b, c, d});
  } else {
    const int centre = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(crossing(mesh, corners));
    for (const auto& [p, q] : {std::pair(a, b), {b, c}, {c, d}, {d, a}})
      mesh.triangles.push_back({p, q, centre});
  }
}

/// Region 1 everywhere, validated. \throws InputError
TriangleMesh finished(TriangleMesh mesh, const std::string& name) {
  mesh.name = name;
  mesh.regions.assign(mesh.triangles.size(), 1);
  validate(mesh);
  return mesh;
}

/// The half disc in two blocks: a core of 2m x m cells over the lowest point, its bottom on the arc, and 4m
/// lines that lead from its left side, top and right side to the flat side. The first and last line run along
/// the arc. Lengths are over the radius, the lowest point is the origin.
struct HalfDiscGrid {
  static constexpr double spread = 0.8;  // 1: equal cells on the flat side. The worst aspect ratio is least
  int m = 1;
  double core = 0.1;

  /// On the arc at an angle from the vertical.
  static Point onArc(double angle) {
    const double half = std::sin(angle / 2);
    return {std::sin(angle), 2 * half * half};
  }

  /// Column i from -m to m, row j from 0 to m.
  [[nodiscard]] Point inCore(int i, int j) const {
    const Point foot = onArc(std::asin(core) * i / m);
    const double t = static_cast<double>(j) / m;
    const double top = onArc(std::asin(core)).y() + core;
    return {foot.x(), (1 - t) * foot.y() + t * top};
  }

  /// Of the column and the row where line k = 0 .. 4m begins.
  template <class Of>
  auto atBegin(int k, const Of& of) const {
    return k <= m ? of(-m, k) : k >= 3 * m ? of(m, 4 * m - k) : of(k - 2 * m, m);
  }

  /// Line k at a part s of its length. On the flat side the lines of the sides of the core spread over more
  /// of it. The first and the last line are arcs; how far these are from straight fades out towards the
  /// middle line.
  [[nodiscard]] Point onLine(int k, double s) const {
    const double x = static_cast<double>(k - 2 * m) / (2 * m);
    const Point inner = atBegin(k, [&](int i, int j) { return inCore(i, j); });
    const Point outer(x * (spread + (1 - spread) * x * x), 1);
    const Point straight = inner + s * (outer - inner);
    const double begin = std::asin(core);
    const Point arc = onArc(begin + s * (std::numbers::pi / 2 - begin));
    const Point chord = onArc(begin) + s * (onArc(std::numbers::pi / 2) - onArc(begin));
    const Point bulge = arc - chord;
    return straight + Point(x * std::abs(x) * bulge.x(), x * x * bulge.y());
  }
};

}  // namespace

TriangleMesh gridMesh(const Grid& grid, Cut cut, const std::string& name) {
  checkCells(name, grid.n1, grid.n2, cut);
  TriangleMesh mesh;
  const int row = grid.closed ? grid.n1 : grid.n1 + 1;
  const auto node = [&](int i, int j) { return j * row + (grid.closed ? i % grid.n1 : i); };
  for (int j = 0; j <= grid.n2; ++j)
    for (int i = 0; i < row; ++i) mesh.vertices.push_back(grid.at(i, j));
  const auto addEdge = [&](int a, int b, int label) {
    mesh.boundaryEdges.push_back({a, b});
    mesh.boundaryLabels.push_back(label);
  };
  for (int i = 0; i < grid.n1; ++i) addEdge(node(i, 0), node(i + 1, 0), grid.labels[0]);
  for (int j = 0; j < grid.n2 && !grid.closed; ++j)
    addEdge(node(grid.n1, j), node(grid.n1, j + 1), grid.labels[1]);
  for (int i = grid.n1; i > 0; --i) addEdge(node(i, grid.n2), node(i - 1, grid.n2), grid.labels[2]);
  for (int j = grid.n2; j > 0 && !grid.closed; --j) addEdge(node(0, j), node(0, j - 1), grid.labels[3]);
  for (int j = 0; j < grid.n2; ++j)
    for (int i = 0; i < grid.n1; ++i)
      addCell(mesh, {node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)}, cut);
  return finished(std::move(mesh), name);
}

std::vector<double> gradedNodes(double a, double b, int n, double focus, double grading) {
  std::vector<double> nodes;
  if (grading == 1) {
    for (int i = 0; i <= n; ++i) nodes.push_back(i == n ? b : a + (b - a) * i / n);
    return nodes;
  }
  const double below = focus - a;
  const double above = b - focus;
  const double A = std::max(below, above) / (grading - 1);
  // Cells on both sides so that those at the focus are of one size.
  const double share = std::log1p(below / A) / (std::log1p(below / A) + std::log1p(above / A));
  int cellsBelow = static_cast<int>(std::lround(n * share));
  cellsBelow = std::clamp(cellsBelow, below > 0 ? 1 : 0, above > 0 ? n - 1 : n);
  if (below > 0)
    for (const std::vector<double> d = distances(below, cellsBelow, A); const double each : d)
      nodes.push_back(focus - each);
  std::reverse(nodes.begin(), nodes.end());
  if (above > 0) {
    const std::vector<double> d = distances(above, n - cellsBelow, A);
    for (size_t i = nodes.empty() ? 0 : 1; i < d.size(); ++i) nodes.push_back(focus + d[i]);
  }
  nodes.front() = a;
  nodes.back() = b;
  return nodes;
}

TriangleMesh rectangleMesh(const Rectangle& r, Cut cut) {
  const std::string name =
      formatted("rectangle %dx%d of ", r.cellsX, r.cellsY) + text(r.lower) + " to " + text(r.upper);
  checkCells(name, r.cellsX, r.cellsY, cut);
  const bool finite = r.lower.allFinite() && r.upper.allFinite();
  if (!finite || !(r.lower.x() < r.upper.x()) || !(r.lower.y() < r.upper.y()))
    throw InputError(name + ": corners, expected finite numbers with lower < upper in x and y");
  const Point focus = r.focus.value_or(r.lower);
  if (!((focus - r.lower).minCoeff() >= 0 && (r.upper - focus).minCoeff() >= 0))
    throw InputError(name + ": focus " + text(focus) + ", expected a point of the rectangle");
  if (!(r.grading.minCoeff() >= 1 && r.grading.maxCoeff() <= 1e6))
    throw InputError(name + ": grading " + text(r.grading) + ", expected 1 to 1e6 each way");
  for (const int c : {0, 1})
    if (r.grading[c] != 1 && focus[c] > r.lower[c] && focus[c] < r.upper[c] &&
        (c == 0 ? r.cellsX : r.cellsY) < 2)
      throw InputError(name + ": one cell with a focus inside, expected 2 or more");
  const std::vector<double> x = gradedNodes(r.lower.x(), r.upper.x(), r.cellsX, focus.x(), r.grading.x());
  const std::vector<double> y = gradedNodes(r.lower.y(), r.upper.y(), r.cellsY, focus.y(), r.grading.y());
  return gridMesh({r.cellsX, r.cellsY, [&](int i, int j) { return Point(x[i], y[j]); }}, cut, name);
}

TriangleMesh crissCrossMesh(const Rectangle& r) {
  return rectangleMesh(r, Cut::both);
}

TriangleMesh quadrilateralMesh(const Quadrilateral& q, Cut cut) {
  std::string name = "quadrilateral";
  for (const Point& corner : q.corners) name += ' ' + text(corner);
  for (int k = 0; k < 4; ++k) {
    const Point along = q.corners[(k + 1) % 4] - q.corners[k];
    const Point next = q.corners[(k + 2) % 4] - q.corners[(k + 1) % 4];
    if (!(cross(along, next) > 0))
      throw InputError(name + ": corner " + std::to_string((k + 1) % 4 + 1) +
                       ", expected finite corners of a convex quadrilateral, counterclockwise");
  }
  const auto at = [&](int i, int j) -> Point {
    const double s = static_cast<double>(i) / q.cells1;
    const double t = static_cast<double>(j) / q.cells2;
    const auto& [a, b, c, d] = q.corners;
    return (1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * d + s * c);
  };
  return gridMesh({q.cells1, q.cells2, at}, cut, name);
}

TriangleMesh annulusMesh(const Annulus& a, Cut cut) {
  const std::string name = formatted("annulus of radii %g and %g about ", a.inner, a.outer) + text(a.centre);
  if (!(a.inner > 0 && a.outer > a.inner && std::isfinite(a.outer) && a.centre.allFinite()))
    throw InputError(name + ", expected finite numbers with 0 < inner < outer");
  if (a.quarters != 1 && a.quarters != 2 && a.quarters != 4)
    throw InputError(name + ": " + std::to_string(a.quarters) + " quarters, expected 1, 2 or 4");
  if (a.quarters == 4 && a.cellsAround < 3)
    throw InputError(name + ": cell counts, expected 3 or more around");
  const bool closed = a.quarters == 4;
  // From the end of the sector to its beginning and outwards, so that cells are counterclockwise.
  const auto at = [&](int i, int j) -> Point {
    const int k = closed ? (a.cellsAround - i) % a.cellsAround : a.cellsAround - i;
    const double angle = std::numbers::pi / 2 * a.quarters * k / a.cellsAround;
    const double r =
        j == a.cellsAcross ? a.outer : a.inner * std::pow(a.outer / a.inner, double(j) / a.cellsAcross);
    Point direction(std::cos(angle), std::sin(angle));
    // On the axes to the last bit.
    if (static_cast<long long>(k) * a.quarters % a.cellsAround == 0) direction = direction.array().round();
    return a.centre + r * direction;
  };
  return gridMesh({a.cellsAround, a.cellsAcross, at, closed, {1, 3, 2, 4}}, cut, name);
}

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
  const int rings = std::max(1, static_cast<int>(std::lround(growth * 4 * m / std::numbers::pi)));
  checkCells(name, 4.0 * m, rings + m, cut);
  const int left = disc.quarter ? 0 : -m;  // the first column
  const int first = 2 * (m + left);        // line

  // 1. Nodes.
  TriangleMesh mesh;
  const auto add = [&](const Point& p) { mesh.vertices.emplace_back(disc.lowest + disc.radius * p); };
  for (int j = 0; j <= m; ++j)
    for (int i = left; i <= m; ++i) add(grid.inCore(i, j));
  for (int r = 1; r <= rings; ++r)
    for (int k = first; k <= 4 * m; ++k)
      add(grid.onLine(k, r == rings ? 1.0 : std::expm1(growth * r / rings) / std::expm1(growth)));
  const auto coreNode = [&](int i, int j) { return j * (m - left + 1) + i - left; };
  const auto ringNode = [&](int r, int k) {
    if (r == 0) return grid.atBegin(k, coreNode);
    return (m + 1) * (m - left + 1) + (r - 1) * (4 * m - first + 1) + k - first;
  };

  // 2. Labels.
  const auto addEdge = [&](int a, int b, int label) {
    mesh.boundaryEdges.push_back({a, b});
    mesh.boundaryLabels.push_back(label);
  };
  const auto onRing = [&](int r) {  // edges beside a ring: near or far from the lowest point
    return mesh.vertices[ringNode(r, 4 * m)].y() + mesh.vertices[ringNode(r - 1, 4 * m)].y() <
                   2 * (disc.lowest.y() + disc.radius * HalfDiscGrid::onArc(std::numbers::pi / 4).y())
               ? 1
               : 3;
  };
  const auto onAxis = [&](int i) { return i <= m ? coreNode(0, i) : ringNode(i - m, 2 * m); };
  for (int i = 0; i < m + rings && disc.quarter; ++i) addEdge(onAxis(i + 1), onAxis(i), 4);
  for (int r = rings; r > 0 && !disc.quarter; --r) addEdge(ringNode(r, 0), ringNode(r - 1, 0), onRing(r));
  for (int i = left; i < m; ++i) addEdge(coreNode(i, 0), coreNode(i + 1, 0), 1);
  for (int r = 1; r <= rings; ++r) addEdge(ringNode(r - 1, 4 * m), ringNode(r, 4 * m), onRing(r));
  for (int k = 4 * m; k > first; --k) addEdge(ringNode(rings, k), ringNode(rings, k - 1), 2);

  // 3. Cells. A single diagonal runs through the core one way and through the rings the other, so that every
  // node of the arc has three triangles. Were it mirrored about the vertical axis, the lowest point would
  // have four, and a wrong pressure.
  const Cut around = cut == Cut::both ? cut : cut == Cut::rising ? Cut::falling : Cut::rising;
  for (int j = 0; j < m; ++j)
    for (int i = left; i < m; ++i)
      addCell(mesh, {coreNode(i, j), coreNode(i + 1, j), coreNode(i + 1, j + 1), coreNode(i, j + 1)}, cut);
  for (int r = 0; r < rings; ++r)
    for (int k = first; k < 4 * m; ++k)
      addCell(mesh, {ringNode(r, k), ringNode(r, k + 1), ringNode(r + 1, k + 1), ringNode(r + 1, k)}, around);
  return finished(std::move(mesh), (disc.quarter ? "quarter of a " : "") + name);
}

}  // namespace mortier
