// Meshes of triangles and of tetrahedra under the same names, for what is done to both alike.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <type_traits>
#include <vector>

#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

template <class Mesh>
inline constexpr bool ofTetrahedra = std::is_same_v<std::remove_const_t<Mesh>, TetrahedronMesh>;

/// For messages.
template <class Mesh>
inline constexpr const char* elementWord = ofTetrahedra<Mesh> ? "tetrahedron" : "triangle";
template <class Mesh>
inline constexpr const char* elementsWord = ofTetrahedra<Mesh> ? "tetrahedra" : "triangles";
template <class Mesh>
inline constexpr const char* sideWord = ofTetrahedra<Mesh> ? "triangle" : "edge";

/// Beside that of a point in the plane (base/types.h).
inline const SpacePoint& asSpacePoint(const SpacePoint& x) {
  return x;
}

template <class Mesh>
auto& elementsOf(Mesh& mesh) {
  if constexpr (ofTetrahedra<Mesh>)
    return mesh.tetrahedra;
  else
    return mesh.triangles;
}

/// Of the boundary.
template <class Mesh>
auto& labelledSides(Mesh& mesh) {
  if constexpr (ofTetrahedra<Mesh>)
    return mesh.boundaryTriangles;
  else
    return mesh.boundaryEdges;
}

/// The labels present on the boundary, ascending, each once.
template <class Mesh>
std::vector<int> boundaryLabels(const Mesh& mesh) {
  std::vector<int> labels = mesh.boundaryLabels;
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  return labels;
}

/// The sides that carry a label, in the mesh's order; none where the label is missing.
template <class Mesh>
auto sidesWith(const Mesh& mesh, int label) {
  std::remove_cvref_t<decltype(labelledSides(mesh))> sides;
  for (size_t i = 0; i < mesh.boundaryLabels.size(); ++i)
    if (mesh.boundaryLabels[i] == label) sides.push_back(labelledSides(mesh)[i]);
  return sides;
}

/// The vertices of those sides, ascending, each once.
template <class Mesh>
std::vector<int> verticesOn(const Mesh& mesh, int label) {
  std::vector<int> vertices;
  for (const auto& side : sidesWith(mesh, label)) vertices.insert(vertices.end(), side.begin(), side.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

/// The vertices of a side, ascending, those of an edge after a -1.
template <size_t n>
std::array<int, 3> sideOf(const std::array<int, n>& vertices) {
  std::array<int, 3> side{-1, -1, -1};
  std::copy(vertices.begin(), vertices.end(), side.begin());
  std::sort(side.begin(), side.end());
  return side;
}

/// Calls visit(side, element) for the sides of all elements that have no vertex but some. \param some  by
/// vertices
template <class Mesh, class Visit>
void forEachSide(const Mesh& mesh, const std::vector<char>& some, Visit visit) {
  const auto& elements = elementsOf(mesh);
  for (size_t e = 0; e < elements.size(); ++e)
    for (const int without : elements[e]) {
      std::array<int, ofTetrahedra<Mesh> ? 3 : 2> side{};
      std::copy_if(elements[e].begin(), elements[e].end(), side.begin(), [&](int v) { return v != without; });
      if (std::all_of(side.begin(), side.end(), [&](int v) { return some[v] != 0; }))
        visit(sideOf(side), static_cast<int>(e));
    }
}

/// Elements behind the sides of a label.
using ElementsBehind = std::map<std::array<int, 3>, int>;
template <class Mesh>
ElementsBehind elementsBehind(const Mesh& mesh, int label) {
  ElementsBehind behind;
  std::vector<char> on(mesh.vertices.size(), 0);
  for (size_t i = 0; i < mesh.boundaryLabels.size(); ++i) {
    if (mesh.boundaryLabels[i] != label) continue;
    behind[sideOf(labelledSides(mesh)[i])] = 0;
    for (const int v : labelledSides(mesh)[i]) on[v] = 1;
  }
  forEachSide(mesh, on, [&](const std::array<int, 3>& side, int element) {
    if (const auto found = behind.find(side); found != behind.end()) found->second = element;
  });
  return behind;
}

}  // namespace mortier
