#include "mesh/read.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "mesh/nastran.h"
#include "mesh/triangle_mesh.h"

namespace mortier {
namespace {

/// Of a file, in small letters.
std::string extensionOf(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool isOneOf(const std::vector<std::string>& extensions, const std::string& path) {
  return std::find(extensions.begin(), extensions.end(), extensionOf(path)) != extensions.end();
}

const std::vector<std::string> ofGmsh{".msh",  ".geo", ".geo_unrolled", ".brep", ".step", ".stp",
                                      ".iges", ".igs", ".unv",          ".bdf",  ".nas"};
const std::vector<std::string> ofPython{".inp", ".vtk", ".vtu", ".xdmf", ".med", ".meshb"};

void requireReadableByGmsh(const std::string& path) {
  if (isOneOf({".bdf", ".nas"}, path)) requireCardsOfGmsh(path);
}

void requireNoGeometry(const MeshSource& source) {
  if (source.size > 0 || !source.parameters.empty())
    throw InputError(source.path + ": size or parameters, expected only for a geometry that Gmsh meshes");
}

}  // namespace

std::string otherMeshFiles() {
  std::string text;
  for (const auto& extensions : {ofGmsh, ofPython})
    for (const std::string& extension : extensions) text += (text.empty() ? "" : ", ") + extension;
  return text + "; any that meshio reads: meshio convert FROM TO.vtu";
}

bool isGmshFile(const std::string& path) {
  return isOneOf(ofGmsh, path);
}

bool isPythonFile(const std::string& path) {
  return isOneOf(ofPython, path);
}

bool isMeditFile(const std::string& path) {
  return !isGmshFile(path) && !isPythonFile(path);
}

TriangleMesh readMesh(const MeshSource& source) {
  if (source.shape) return shapeMesh(*source.shape);
  if (isGmshFile(source.path)) {
    requireReadableByGmsh(source.path);
    return readGmsh(source);
  }
  requireNoGeometry(source);
  if (isPythonFile(source.path)) return readPythonFile(source);
  return readMedit(source.path, source.regions);
}

TetrahedronMesh readSpaceMesh(const MeshSource& source) {
  if (source.sweep) return sweptMesh(readMesh(source), *source.sweep);
  if (source.inSpace) return shapeMesh(*source.inSpace);
  if (isGmshFile(source.path)) {
    requireReadableByGmsh(source.path);
    return readSpaceGmsh(source);
  }
  requireNoGeometry(source);
  if (isPythonFile(source.path)) return readSpacePythonFile(source);
  return readSpaceMedit(source.path, source.regions);
}

namespace {

/// A cosine or a sine; those of right angles are exact.
double withoutRounding(double value) {
  constexpr double tiny = 1e-15;
  return std::abs(value) < tiny ? 0 : std::abs(std::abs(value) - 1) < tiny ? std::round(value) : value;
}

/// Numbers of the vertices of all layers: those on the axis are the same in each.
class SweptVertices {
 public:
  SweptVertices(const std::vector<Point>& plane, const Sweep& sweep, bool closed,
                std::vector<SpacePoint>& all)
      : numbers_(static_cast<size_t>(sweep.layers) + 1) {
    for (int layer = 0; layer <= sweep.layers; ++layer) {
      std::vector<int>& numbers = numbers_[static_cast<size_t>(layer)];
      if (closed && layer == sweep.layers) {
        numbers = numbers_.front();
        break;
      }
      const double part = static_cast<double>(layer) / sweep.layers;
      const double cosine = withoutRounding(std::cos(sweep.angle * part));
      const double sine = withoutRounding(std::sin(sweep.angle * part));
      for (size_t v = 0; v < plane.size(); ++v) {
        const Point& x = plane[v];
        const bool stays = sweep.length == 0 && x.x() == 0 && layer > 0;
        numbers.push_back(stays ? numbers_.front()[v] : static_cast<int>(all.size()));
        if (!stays) all.emplace_back(x.x() * cosine, x.y(), sweep.length * part + x.x() * sine);
      }
    }
  }
  [[nodiscard]] int operator()(int layer, int vertex) const {
    return numbers_[static_cast<size_t>(layer)][static_cast<size_t>(vertex)];
  }

 private:
  std::vector<std::vector<int>> numbers_;
};

const SpacePoint unknownNormal = SpacePoint::Constant(std::numeric_limits<double>::quiet_NaN());

/// At the end `a` of a boundary edge to `b` in a plane mesh, by the circle through its middle; not finite
/// where that is not known. \param right  whether outside is to the right of the way to b
Point normalOfEdge(const TriangleMesh& plane, size_t e, int a, int b, bool right) {
  if (plane.edgeMiddles.empty() || plane.hasCurve(e)) return unknownNormal.head<2>();
  const Point along = plane.vertices[b] - plane.vertices[a];
  const Point half = (plane.edgeMiddles[e] - plane.vertices[a]).normalized();
  const Point tangent = (2 * half.dot(along) * half - along).normalized();
  return right ? Point(tangent.y(), -tangent.x()) : Point(-tangent.y(), tangent.x());
}

template <size_t n>
bool allDifferent(std::array<int, n> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return std::adjacent_find(numbers.begin(), numbers.end()) == numbers.end();
}

}  // namespace

TetrahedronMesh sweptMesh(TriangleMesh plane, const Sweep& sweep) {
  constexpr double nearlyAll = 1e-6;
  const double around = 2 * std::numbers::pi;
  const bool closed = sweep.angle > around * (1 - nearlyAll);
  Sweep exact = sweep;
  if (closed) exact.angle = around;
  if (sweep.length == 0) plane = meshAboutAxis(std::move(plane), "revolve");
  if (!(exact.angle / sweep.layers < std::numbers::pi * (1 - nearlyAll)))
    throw InputError(plane.name + ": layers that turn by half a circle, expected more of them");
  TetrahedronMesh mesh;
  mesh.name = plane.name;
  const SweptVertices vertex(plane.vertices, exact, closed, mesh.vertices);
  const auto addTriangle = [&](const std::array<int, 3>& triangle, int label, size_t surface,
                               const std::array<SpacePoint, 3>& normals) {
    if (!allDifferent(triangle)) return;
    if (surface >= plane.boundaryEdges.size() || plane.hasCurve(surface) ||
        (!plane.edgeMiddles.empty() && plane.edgeMiddles[surface].allFinite())) {
      mesh.geometry.triangles.push_back(triangle);
      mesh.geometry.numbers.push_back(static_cast<int>(surface));
    }
    mesh.boundaryTriangles.push_back(triangle);
    mesh.boundaryLabels.push_back(label);
    mesh.boundaryNormals.push_back(normals);
  };
  const auto swept = [&](const Point& n, int v, int layer) {
    constexpr double alongAxis = 1e-9;
    if (sweep.length != 0) return SpacePoint(n.x(), n.y(), 0);
    if (plane.vertices[v].x() == 0)
      return std::abs(n.x()) < alongAxis ? SpacePoint(0, n.y() < 0 ? -1 : 1, 0) : unknownNormal;
    const double angle = exact.angle * layer / sweep.layers;
    return SpacePoint(n.x() * std::cos(angle), n.y(), n.x() * std::sin(angle));
  };
  // Diagonals of the sides of a prism go from the smaller number above to the larger one below.
  for (int layer = 0; layer < sweep.layers; ++layer) {
    for (size_t t = 0; t < plane.triangles.size(); ++t) {
      std::array<int, 3> corners = plane.triangles[t];
      std::sort(corners.begin(), corners.end());
      for (size_t split = 0; split < 3; ++split) {  // the corner that is below and above
        std::array<int, 4> tetrahedron{};
        for (size_t k = 0; k < 3; ++k)
          tetrahedron[k < split ? k : k + 1] = vertex(layer + (k < split ? 1 : 0), corners[k]);
        tetrahedron[split] = vertex(layer + 1, corners[split]);
        if (!allDifferent(tetrahedron)) continue;
        mesh.tetrahedra.push_back(tetrahedron);
        mesh.regions.push_back(plane.regions[t]);
      }
    }
    for (size_t e = 0; e < plane.boundaryEdges.size(); ++e) {
      const auto& [a, b] = std::minmax(plane.boundaryEdges[e][0], plane.boundaryEdges[e][1]);
      const bool right = a == plane.boundaryEdges[e][0];  // of the edge is outside
      const Point atA = normalOfEdge(plane, e, a, b, right);
      const Point atB = normalOfEdge(plane, e, b, a, !right);
      addTriangle({vertex(layer, a), vertex(layer, b), vertex(layer + 1, a)}, plane.boundaryLabels[e], e,
                  {swept(atA, a, layer), swept(atB, b, layer), swept(atA, a, layer + 1)});
      addTriangle({vertex(layer, b), vertex(layer + 1, b), vertex(layer + 1, a)}, plane.boundaryLabels[e], e,
                  {swept(atB, b, layer), swept(atB, b, layer + 1), swept(atA, a, layer + 1)});
    }
  }
  mesh.labelNames = plane.labelNames;
  mesh.regionNames = plane.regionNames;
  mesh.sharedLabels = plane.sharedLabels;
  mesh.sharedRegions = plane.sharedRegions;
  mesh.changed = plane.changed;
  int largest = 0;
  for (const int label : plane.boundaryLabels) largest = std::max(largest, label);
  for (const auto& [name, label] : plane.labelNames) largest = std::max(largest, label);
  for (const int end : {0, 1}) {
    if (closed) break;
    const int label = largest + 1 + end;
    mesh.labelNames.emplace(end == 0 ? "start" : "end", label);
    for (const auto& [a, b, c] : plane.triangles) {
      const int layer = end == 0 ? 0 : sweep.layers;
      addTriangle({vertex(layer, a), vertex(layer, b), vertex(layer, c)}, label,
                  plane.boundaryEdges.size() + static_cast<size_t>(end),
                  {unknownNormal, unknownNormal, unknownNormal});
    }
  }
  validate(mesh);
  mesh.geometry.surfaces = surfacesOf(plane, exact);
  return mesh;
}

}  // namespace mortier
