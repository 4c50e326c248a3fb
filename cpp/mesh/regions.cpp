#include "mesh/regions.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include "base/error.h"
#include "mesh/triangle_sides.h"

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

/// Leaves out the items that are not to be kept, and what other lists have of them; empty ones stay empty.
template <class Keep, class Items, class... Others>
void keepItems(const Keep& keep, Items& items, Others&... others) {
  size_t kept = 0;
  const auto take = [&](auto& list, size_t from) {
    if (!list.empty()) list[kept] = list[from];
  };
  for (size_t i = 0; i < items.size(); ++i) {
    if (!keep(items[i])) continue;
    (take(others, i), ...);
    items[kept++] = items[i];
  }
  const auto end = [&](auto& list) { list.resize(std::min(list.size(), kept)); };
  (end(items), (end(others), ...));
}

template <class Keep>
void keepEdges(TriangleMesh& mesh, const Keep& keep) {
  keepItems(keep, mesh.boundaryEdges, mesh.boundaryLabels, mesh.edgeMiddles, mesh.edgeCurves);
}

template <class Keep>
void keepTriangles(TetrahedronMesh& mesh, const Keep& keep) {
  keepItems(keep, mesh.boundaryTriangles, mesh.boundaryLabels, mesh.boundaryNormals);
}

/// \param elements  triangles or tetrahedra of the mesh
template <class Mesh, class Elements>
void keepElements(Mesh& mesh, Elements& elements, const std::vector<std::string>& regions) {
  std::set<int> wanted;
  for (const std::string& region : regions) wanted.insert(numberOf(region, mesh));
  keepItems([&](int region) { return wanted.count(region) > 0; }, mesh.regions, elements);
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

}  // namespace

void keepRegions(TriangleMesh& mesh, const std::vector<std::string>& regions) {
  keepElements(mesh, mesh.triangles, regions);
  const TriangleSides sides = sortedSides(mesh);
  keepEdges(mesh, [&](const auto& edge) { return sidesOn(sides, edge[0], edge[1]).size() == 1; });
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
  const TriangleSides sides = sortedSides(mesh);
  keepEdges(mesh, [&](const auto& edge) { return sidesOn(sides, edge[0], edge[1]).size() < 2; });
}

}  // namespace mortier
