#include "mesh/cells.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace mortier {

namespace {

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

}  // namespace

void checkCells(const std::string& name, double cells1, double cells2, Cut cut) {
  if (cells1 < 1 || cells2 < 1) throw InputError(name + ": cell counts, expected 1 or more each way");
  if (cells1 * cells2 * (cut == Cut::both ? 4 : 2) > maxTriangles)
    throw InputError(name + ": too many cells, expected 1e8 triangles at most");
}

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

TriangleMesh finished(TriangleMesh mesh, const std::string& name) {
  mesh.name = name;
  mesh.regions.assign(mesh.triangles.size(), 1);
  validate(mesh);
  return mesh;
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

}  // namespace mortier
