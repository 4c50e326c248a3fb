#include "mesh/tetrahedron_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

#include "base/error.h"
#include "base/formatted.h"
#include "mesh/box_of.h"
#include "mesh/element_sides.h"

namespace mortier {
namespace {

/// Volume over the cube of the longest edge of a tetrahedron that is flat.
constexpr double flat = 1e-12;

/// Whether two triangles of the same vertices run around them in the same sense.
bool sameSense(const std::array<int, 3>& one, const std::array<int, 3>& other) {
  const auto at = std::find(other.begin(), other.end(), one[0]) - other.begin();
  return other[static_cast<size_t>(at + 1) % 3] == one[1];
}

template <size_t n>
void requireVertices(const TetrahedronMesh& mesh, const std::vector<std::array<int, n>>& items,
                     const char* what) {
  for (size_t i = 0; i < items.size(); ++i)
    for (const int v : items[i])
      if (v < 0 || v >= static_cast<int>(mesh.vertices.size()))
        throw InputError(mesh.name + ": " + what + " " + std::to_string(i + 1) + ": vertex " +
                         std::to_string(v + 1) + ", expected 1 to " + std::to_string(mesh.vertices.size()));
}

/// Of the centre of a tetrahedron.
std::string placeOf(const TetrahedronMesh& mesh, size_t t) {
  SpacePoint sum = SpacePoint::Zero();
  for (const int v : mesh.tetrahedra[t]) sum += mesh.vertices[v] / 4;
  return placeText(sum, 3);
}

void orientTetrahedra(TetrahedronMesh& mesh) {
  for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    std::array<int, 4>& tetrahedron = mesh.tetrahedra[t];
    const auto place = [&](int k) -> const SpacePoint& { return mesh.vertices[tetrahedron[k]]; };
    double longest = 0;
    for (const auto& [a, b] : sidesOfTetrahedron) longest = std::max(longest, (place(b) - place(a)).norm());
    const double signedVolume = volume(mesh, tetrahedron);
    if (!(std::abs(signedVolume) > flat * longest * longest * longest))
      throw InputError(mesh.name + ": tetrahedron " + std::to_string(t + 1) + " at " + placeOf(mesh, t) +
                       " is flat, expected a volume");
    if (signedVolume < 0) std::swap(tetrahedron[2], tetrahedron[3]);
  }
}

/// The triangles that belong to one tetrahedron, sorted.
ElementSides<3> boundaryOf(const TetrahedronMesh& mesh) {
  ElementSides<3> boundary;
  const auto outward = [&](const ElementSide<3>& side) {
    return sideOf(mesh.tetrahedra[side.element()], side.corner());
  };
  const auto fail = [&](const std::string& what) { throw InputError(mesh.name + ": tetrahedra " + what); };
  forEachPlace(sortedSides(mesh), [&](std::span<const ElementSide<3>> sides) {
    const auto number = [&](size_t i) { return std::to_string(sides[i].element() + 1); };
    if (sides.size() > 2)
      fail(number(0) + ", " + number(1) + " and " + number(2) + " share a triangle, expected two at most");
    if (sides.size() == 2 && sameSense(outward(sides[0]), outward(sides[1])))
      fail(number(0) + " and " + number(1) + " at " + placeOf(mesh, static_cast<size_t>(sides[1].element())) +
           " lie on the same side of the triangle that they share: the mesh is folded there, "
           "expected one on each side");
    if (sides.size() == 1) boundary.push_back(sides[0]);
  });
  return boundary;
}

}  // namespace

std::vector<std::array<int, 3>> outerTriangles(const TetrahedronMesh& mesh) {
  std::vector<std::array<int, 3>> triangles;
  for (const auto& side : boundaryOf(mesh))
    triangles.push_back(sideOf(mesh.tetrahedra[side.element()], side.corner()));
  return triangles;
}

std::vector<int> labelsOf(const TetrahedronMesh& mesh, const std::vector<std::array<int, 3>>& outer) {
  std::map<std::array<int, 3>, int> labels;
  for (size_t i = 0; i < mesh.boundaryLabels.size(); ++i)
    labels[sideOf(mesh.boundaryTriangles[i])] = mesh.boundaryLabels[i];
  std::vector<int> result;
  for (const auto& triangle : outer) {
    const auto found = labels.find(sideOf(triangle));
    result.push_back(found == labels.end() ? -1 : found->second);
  }
  return result;
}

double volume(const TetrahedronMesh& mesh, const std::array<int, 4>& tetrahedron) {
  const auto& [a, b, c, d] = tetrahedron;
  const SpacePoint& x = mesh.vertices[a];
  return (mesh.vertices[b] - x).cross(mesh.vertices[c] - x).dot(mesh.vertices[d] - x) / 6;
}

void requireVertices(const TetrahedronMesh& mesh) {
  requireVertices(mesh, mesh.tetrahedra, "tetrahedron");
  requireVertices(mesh, mesh.boundaryTriangles, "triangle");
}

namespace {

/// The normals of a boundary triangle in the order of the vertices that it is to have, outward.
void turnNormals(TetrahedronMesh& mesh, size_t i, const std::array<int, 3>& outward) {
  if (mesh.boundaryNormals.empty()) return;
  const std::array<SpacePoint, 3> before = mesh.boundaryNormals[i];
  const auto& [a, b, c] = outward;
  const SpacePoint out = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
  for (size_t k = 0; k < 3; ++k) {
    const auto& old = mesh.boundaryTriangles[i];
    const SpacePoint& n =
        before[static_cast<size_t>(std::find(old.begin(), old.end(), outward[k]) - old.begin())];
    mesh.boundaryNormals[i][k] = n.dot(out) < 0 ? SpacePoint(-n) : n;
  }
}

}  // namespace

void validate(TetrahedronMesh& mesh) {
  if (mesh.tetrahedra.empty())
    throw InputError(
        mesh.name +
        ": no tetrahedra, expected a body in space; triangles in a plane become one with extrude "
        "or revolve, or are one without dimension = 3");
  for (size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!mesh.vertices[v].allFinite())
      throw InputError(mesh.name + ": vertex " + std::to_string(v + 1) + " is not finite");
  requireVertices(mesh);
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const auto& tetrahedron : mesh.tetrahedra)
    for (const int v : tetrahedron) used[v] = 1;
  if (const auto unused = std::find(used.begin(), used.end(), 0); unused != used.end())
    throw InputError(mesh.name + ": vertex " + std::to_string(unused - used.begin() + 1) +
                     " belongs to no tetrahedron");
  orientTetrahedra(mesh);
  std::vector<std::array<int, 4>> sorted = mesh.tetrahedra;
  for (auto& tetrahedron : sorted) std::sort(tetrahedron.begin(), tetrahedron.end());
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    throw InputError(mesh.name + ": two tetrahedra have the same vertices");

  const ElementSides<3> boundary = boundaryOf(mesh);
  std::vector<char> labelled(boundary.size(), 0);
  for (size_t i = 0; i < mesh.boundaryTriangles.size(); ++i) {
    std::array<int, 3>& triangle = mesh.boundaryTriangles[i];
    const auto found = sidesOn(boundary, triangle);
    const std::string here = mesh.name + ": triangle " + std::to_string(i + 1);
    if (found.empty()) throw InputError(here + " is labelled, but is not on the boundary");
    if (labelled[&found[0] - boundary.data()]++ != 0) throw InputError(here + " is labelled twice");
    const std::array<int, 3> outward = sideOf(mesh.tetrahedra[found[0].element()], found[0].corner());
    turnNormals(mesh, i, outward);
    triangle = outward;
  }
}

double aspectRatio(const TetrahedronMesh& mesh, int t) {
  const double regular = std::sqrt(1.5);  // its edge over its height
  const std::array<int, 4>& vertices = mesh.tetrahedra[t];
  const auto place = [&](int k) -> const SpacePoint& { return mesh.vertices[vertices[k]]; };
  double longest = 0;
  for (const auto& [a, b] : sidesOfTetrahedron) longest = std::max(longest, (place(b) - place(a)).norm());
  double largest = 0;  // of the sides' areas
  for (int k = 0; k < 4; ++k) {
    const auto [a, b, c] = sideOf(vertices, k);
    const SpacePoint& x = mesh.vertices[a];
    largest = std::max(largest, (mesh.vertices[b] - x).cross(mesh.vertices[c] - x).norm() / 2);
  }
  return longest * largest / (3 * std::abs(volume(mesh, vertices))) / regular;
}

double extent(const TetrahedronMesh& mesh) {
  return boxOf(mesh.vertices).sizes().maxCoeff();
}

SpaceNodes spaceNodes(const TetrahedronMesh& mesh, int degree) {
  SpaceNodes nodes;
  nodes.degree = degree;
  nodes.places = mesh.vertices;
  std::vector<std::array<int, 2>> edges;
  const auto edgeOf = [](int a, int b) { return std::array<int, 2>{std::min(a, b), std::max(a, b)}; };
  if (degree > 1) {
    edges.reserve(6 * mesh.tetrahedra.size());
    for (const auto& vertices : mesh.tetrahedra)
      for (const auto& [a, b] : sidesOfTetrahedron) edges.push_back(edgeOf(vertices[a], vertices[b]));
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (const auto& [a, b] : edges) nodes.places.emplace_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
  }
  const auto middleOf = [&](int a, int b) {
    const auto found = std::lower_bound(edges.begin(), edges.end(), edgeOf(a, b));
    return static_cast<int>(mesh.vertices.size() + (found - edges.begin()));
  };
  nodes.elements.reserve(mesh.tetrahedra.size() * static_cast<size_t>(nodes.perElement()));
  for (const auto& vertices : mesh.tetrahedra) {
    nodes.elements.insert(nodes.elements.end(), vertices.begin(), vertices.end());
    if (degree > 1)
      for (const auto& [a, b] : sidesOfTetrahedron)
        nodes.elements.push_back(middleOf(vertices[a], vertices[b]));
  }
  for (const auto& [a, b, c] : mesh.boundaryTriangles) {
    std::array<int, 6>& face = nodes.faces.emplace_back(std::array<int, 6>{a, b, c, -1, -1, -1});
    if (degree > 1) face = {a, b, c, middleOf(a, b), middleOf(b, c), middleOf(c, a)};
  }
  return nodes;
}

}  // namespace mortier
