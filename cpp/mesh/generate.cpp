#include "mesh/generate.h"

#include <sstream>
#include <utility>

#include "base/error.h"

namespace mortier {
namespace {

constexpr double maxTriangles = 1e8;  // beyond what a desktop solves; keeps numbers within int

std::string describe(const std::string& kind, const Rectangle& r) {
  std::ostringstream out;
  out << kind << ' ' << r.cellsX << 'x' << r.cellsY << " of (" << r.lower.x() << ", " << r.lower.y()
      << ") to (" << r.upper.x() << ", " << r.upper.y() << ')';
  return out.str();
}

void check(const Rectangle& r, const std::string& name, int trianglesPerCell) {
  if (r.cellsX < 1 || r.cellsY < 1) throw InputError(name + ": cell counts, expected 1 or more each way");
  if (double(r.cellsX) * r.cellsY * trianglesPerCell > maxTriangles) {
    throw InputError(name + ": too many cells, expected 1e8 triangles at most");
  }
  const bool finite = r.lower.allFinite() && r.upper.allFinite();
  if (!finite || !(r.lower.x() < r.upper.x()) || !(r.lower.y() < r.upper.y())) {
    throw InputError(name + ": corners, expected finite numbers with lower < upper in x and y");
  }
}

// Node i of n equal cells; both ends are met exactly.
double gridCoordinate(double lower, double upper, int i, int n) {
  return i == n ? upper : lower + (upper - lower) * i / n;
}

// Nodes row by row from the bottom, then the labelled edges, counterclockwise from the lower left corner.
TriangleMesh gridWithoutTriangles(const Rectangle& r) {
  TriangleMesh mesh;
  const int nx = r.cellsX, ny = r.cellsY;
  const auto node = [nx](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      mesh.vertices.emplace_back(gridCoordinate(r.lower.x(), r.upper.x(), i, nx),
                                 gridCoordinate(r.lower.y(), r.upper.y(), j, ny));
    }
  }
  const auto addEdge = [&mesh](int a, int b, int label) {
    mesh.boundaryEdges.push_back({a, b});
    mesh.boundaryLabels.push_back(label);
  };
  for (int i = 0; i < nx; ++i) addEdge(node(i, 0), node(i + 1, 0), 1);
  for (int j = 0; j < ny; ++j) addEdge(node(nx, j), node(nx, j + 1), 2);
  for (int i = nx; i > 0; --i) addEdge(node(i, ny), node(i - 1, ny), 3);
  for (int j = ny; j > 0; --j) addEdge(node(0, j), node(0, j - 1), 4);
  return mesh;
}

// Calls cut(a, b, c, d) for each cell, row by row; corners counterclockwise from the lower left.
template <class Cut>
void forEachCell(const Rectangle& r, const Cut& cut) {
  const int row = r.cellsX + 1;
  for (int j = 0; j < r.cellsY; ++j) {
    for (int i = 0; i < r.cellsX; ++i) {
      const int a = j * row + i;
      cut(a, a + 1, a + 1 + row, a + row);
    }
  }
}

// Validation finds rectangles too thin for their distance from the origin.
TriangleMesh finish(TriangleMesh mesh, const std::string& name) {
  mesh.name = name;
  mesh.regions.assign(mesh.triangles.size(), 1);
  validate(mesh);
  return mesh;
}

}  // namespace

TriangleMesh rectangleMesh(const Rectangle& rectangle) {
  const std::string name = describe("rectangle", rectangle);
  check(rectangle, name, 2);
  TriangleMesh mesh = gridWithoutTriangles(rectangle);
  forEachCell(rectangle, [&mesh](int a, int b, int c, int d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  });
  return finish(std::move(mesh), name);
}

TriangleMesh crissCrossMesh(const Rectangle& rectangle) {
  const std::string name = describe("criss-cross", rectangle);
  check(rectangle, name, 4);
  TriangleMesh mesh = gridWithoutTriangles(rectangle);
  forEachCell(rectangle, [&mesh](int a, int b, int c, int d) {
    const int centre = int(mesh.vertices.size());
    mesh.vertices.emplace_back(mesh.vertices[a] + (mesh.vertices[c] - mesh.vertices[a]) / 2);
    mesh.triangles.push_back({a, b, centre});
    mesh.triangles.push_back({b, c, centre});
    mesh.triangles.push_back({c, d, centre});
    mesh.triangles.push_back({d, a, centre});
  });
  return finish(std::move(mesh), name);
}

}  // namespace mortier
