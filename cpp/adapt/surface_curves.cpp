#include <algorithm>
#include <set>

#include <Eigen/Geometry>

#include "adapt/adapted_meshes.h"

namespace mortier {
namespace {

/// Where a part ends its normals are those of one side only. The arc from a vertex inside has a better one,
/// unless the end is a side of symmetry: the reflection of the normal inside, exact on spheres.
void improveRims(const TetrahedronMesh& mesh, CurvedFaces& curved) {
  constexpr double symmetric = 1e-9;
  std::map<std::array<int, 3>, int> count;  // of triangles, by edges and parts
  for (size_t i = 0; i < curved.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(curved.triangles[i][k], curved.triangles[i][(k + 1) % 3]);
      ++count[{low, high, curved.parts[i]}];
    }
  std::set<std::array<int, 2>> rims;
  for (const auto& [edge, triangles] : count)
    if (triangles == 1) rims.insert({{edge[0], edge[2]}, {edge[1], edge[2]}});
  std::set<std::array<int, 2>> mirrored;
  for (const auto& [a, b, c] : curved.triangles) {
    const SpacePoint& x = mesh.vertices[a];
    const SpacePoint across = (mesh.vertices[b] - x).cross(mesh.vertices[c] - x).normalized();
    for (const int v : {a, b, c})
      for (auto each = rims.lower_bound({v, 0}); each != rims.end() && (*each)[0] == v; ++each)
        if (std::abs(curved.normals.at(*each).dot(across)) < symmetric) mirrored.insert(*each);
  }
  std::map<std::array<int, 2>, SpacePoint> sums;
  for (const auto& [edge, triangles] : count)
    for (const auto& [v, inner] : {std::pair(edge[0], edge[1]), std::pair(edge[1], edge[0])}) {
      const std::array<int, 2> rim{v, edge[2]};
      if (rims.count(rim) == 0 || mirrored.count(rim) > 0 || rims.count({inner, edge[2]}) > 0) continue;
      const SpacePoint& normal = curved.normals.at({inner, edge[2]});
      const SpacePoint along = (mesh.vertices[inner] - mesh.vertices[v]).normalized();
      sums.try_emplace(rim, SpacePoint::Zero()).first->second += normal - 2 * normal.dot(along) * along;
    }
  for (const auto& [rim, sum] : sums) curved.normals[rim] = sum.normalized();
}

}  // namespace

CurvedFaces curvesBehind(TetrahedronMesh mesh, const SpaceHeld& held) {
  const std::vector<int> labels = boundaryLabels(mesh);
  const int unlabelled = labels.empty() ? 0 : labels.front() - 1;
  const auto sorted = [](std::array<int, 3> triangle) {
    std::sort(triangle.begin(), triangle.end());
    return triangle;
  };
  std::set<std::array<int, 3>> known;
  for (const auto& triangle : mesh.boundaryTriangles) known.insert(sorted(triangle));
  for (const auto& triangle : outerTriangles(mesh)) {
    if (known.count(sorted(triangle)) > 0) continue;
    mesh.boundaryTriangles.push_back(triangle);
    mesh.boundaryLabels.push_back(unlabelled);
  }
  CurvedFaces curved;
  bool plane = true;
  const SpaceNodes nodes = spaceNodes(mesh, 1);
  for (const int label : boundaryLabels(mesh)) {
    const ContactSurface surface(mesh, nodes, label, held);
    const auto first = static_cast<int>(curved.triangles.size());
    plane = plane && surface.planar;
    for (size_t t = 0; t < surface.triangles.size(); ++t) {
      const int part = first + surface.parts[t];
      const std::array<int, 6>& on = surface.triangles[t];
      curved.triangles.push_back({on[0], on[1], on[2]});
      curved.parts.push_back(part);
      for (int k = 0; k < 3; ++k) curved.normals[{on[k], part}] = surface.vertexNormals[t][k];
    }
  }
  if (plane) return {};
  improveRims(mesh, curved);
  return curved;
}

}  // namespace mortier
