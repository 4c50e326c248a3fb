#include "mesh/regions.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include "base/error.h"

namespace mortier {
namespace {

template <class Mesh>
std::string regionsOf(const Mesh& mesh) {
  const std::set<int> present(mesh.regions.begin(), mesh.regions.end());
  std::string text;
  for (const int region : present) {
    text += (text.empty() ? "" : ", ") + std::to_string(region);
    for (const auto& [name, number] : mesh.regionNames)
      if (number == region) text += " (" + name + ")";
  }
  return text;
}

template <class Mesh>
int numberOf(const std::string& region, const Mesh& mesh) {
  const auto named = mesh.regionNames.find(region);
  int number = 0;
  const char* const end = region.data() + region.size();
  const bool isNumber = std::from_chars(region.data(), end, number).ptr == end;
  if (named != mesh.regionNames.end()) number = named->second;
  if ((named != mesh.regionNames.end() || isNumber) &&
      std::find(mesh.regions.begin(), mesh.regions.end(), number) != mesh.regions.end())
    return number;
  throw InputError(mesh.name + ": no region " + region + ", expected one of " + regionsOf(mesh));
}

template <class Keep>
void keepEdges(TriangleMesh& mesh, const Keep& keep) {
  size_t kept = 0;
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    if (!keep(mesh.boundaryEdges[e])) continue;
    mesh.boundaryEdges[kept] = mesh.boundaryEdges[e];
    mesh.boundaryLabels[kept] = mesh.boundaryLabels[e];
    if (!mesh.edgeMiddles.empty()) mesh.edgeMiddles[kept] = mesh.edgeMiddles[e];
    if (!mesh.edgeCurves.empty()) mesh.edgeCurves[kept] = mesh.edgeCurves[e];
    ++kept;
  }
  mesh.boundaryEdges.resize(kept);
  mesh.boundaryLabels.resize(kept);
  if (!mesh.edgeMiddles.empty()) mesh.edgeMiddles.resize(kept);
  if (!mesh.edgeCurves.empty()) mesh.edgeCurves.resize(kept);
}

/// The sides of all triangles, smaller vertex first, in order: one that two triangles share stands there
/// twice.
std::vector<std::pair<int, int>> sidesOf(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (const auto& corners : mesh.triangles)
    for (int k = 0; k < 3; ++k) sides.emplace_back(std::minmax(corners[k], corners[(k + 1) % 3]));
  std::sort(sides.begin(), sides.end());
  return sides;
}

auto timesIn(const std::vector<std::pair<int, int>>& sides, const std::array<int, 2>& edge) {
  const auto [first, last] =
      std::equal_range(sides.begin(), sides.end(), std::pair<int, int>(std::minmax(edge[0], edge[1])));
  return last - first;
}

/// \param elements  triangles or tetrahedra of the mesh
template <class Mesh, class Elements>
void keepElements(Mesh& mesh, Elements& elements, const std::vector<std::string>& regions) {
  std::set<int> wanted;
  for (const std::string& region : regions) wanted.insert(numberOf(region, mesh));
  size_t kept = 0;
  for (size_t t = 0; t < elements.size(); ++t) {
    if (wanted.count(mesh.regions[t]) == 0) continue;
    elements[kept] = elements[t];
    mesh.regions[kept++] = mesh.regions[t];
  }
  elements.resize(kept);
  mesh.regions.resize(kept);
}

/// Leaves out vertices that none of the elements has, and numbers the others by their order in them.
template <class Mesh, class Elements, class Boundary>
void renumberVertices(Mesh& mesh, Elements& elements, Boundary& boundary) {
  std::vector<int> numbers(mesh.vertices.size(), -1);
  auto vertices = std::exchange(mesh.vertices, {});
  const auto renumber = [&](int& v) {
    if (numbers[v] < 0) {
      numbers[v] = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(vertices[v]);
    }
    v = numbers[v];
  };
  for (auto& corners : elements)
    for (int& v : corners) renumber(v);
  for (auto& item : boundary)
    for (int& v : item) renumber(v);
}

template <class Keep>
void keepTriangles(TetrahedronMesh& mesh, const Keep& keep) {
  size_t kept = 0;
  for (size_t i = 0; i < mesh.boundaryTriangles.size(); ++i) {
    if (!keep(mesh.boundaryTriangles[i])) continue;
    mesh.boundaryTriangles[kept] = mesh.boundaryTriangles[i];
    mesh.boundaryLabels[kept++] = mesh.boundaryLabels[i];
  }
  mesh.boundaryTriangles.resize(kept);
  mesh.boundaryLabels.resize(kept);
}

}  // namespace

void keepRegions(TriangleMesh& mesh, const std::vector<std::string>& regions) {
  keepElements(mesh, mesh.triangles, regions);
  const auto sides = sidesOf(mesh);
  keepEdges(mesh, [&](const std::array<int, 2>& edge) { return timesIn(sides, edge) == 1; });
  renumberVertices(mesh, mesh.triangles, mesh.boundaryEdges);
}

void keepRegions(TetrahedronMesh& mesh, const std::vector<std::string>& regions) {
  requireVertices(mesh);
  keepElements(mesh, mesh.tetrahedra, regions);
  const TriangleCount count(mesh);
  keepTriangles(mesh, [&](const std::array<int, 3>& triangle) { return count(triangle) == 1; });
  renumberVertices(mesh, mesh.tetrahedra, mesh.boundaryTriangles);
}

void dropInnerTriangles(TetrahedronMesh& mesh) {
  const TriangleCount count(mesh);
  keepTriangles(mesh, [&](const std::array<int, 3>& triangle) { return count(triangle) < 2; });
}

void dropInnerEdges(TriangleMesh& mesh) {
  const auto sides = sidesOf(mesh);
  keepEdges(mesh, [&](const std::array<int, 2>& edge) { return timesIn(sides, edge) < 2; });
}

}  // namespace mortier
