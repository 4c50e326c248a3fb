// Meshes of triangles and of tetrahedra under the same names, for what is done to both alike.
#pragma once

#include <type_traits>

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

}  // namespace mortier
