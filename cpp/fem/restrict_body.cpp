// A part of a body as a body of its own.
#include <algorithm>

#include "fem/body.h"
#include "material/parts.h"
#include "mesh/triangle_sides.h"

namespace mortier {
namespace {

/// Entries of a vector, so many at each of the places.
template <class Value>
std::vector<Value> taken(const std::vector<Value>& all, const std::vector<int>& places, size_t each = 1) {
  std::vector<Value> result;
  if (all.empty()) return result;
  result.reserve(each * places.size());
  for (const int place : places) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(each * place);
    result.insert(result.end(), first, first + static_cast<std::ptrdiff_t>(each));
  }
  return result;
}

std::vector<int> numbersOf(const std::vector<int>& nodes, int count) {
  std::vector<int> numbers(count, -1);
  for (size_t i = 0; i < nodes.size(); ++i) numbers[nodes[i]] = static_cast<int>(i);
  return numbers;
}

TriangleMesh restrictedMesh(const TriangleMesh& whole, const BodyCut& cut, const std::vector<int>& number) {
  TriangleMesh mesh;
  mesh.name = whole.name;
  const auto vertices =
      std::lower_bound(cut.nodes.begin(), cut.nodes.end(), static_cast<int>(whole.vertices.size()));
  mesh.vertices = taken(whole.vertices, {cut.nodes.begin(), vertices});
  mesh.triangles = taken(whole.triangles, cut.triangles);
  for (auto& triangle : mesh.triangles)
    for (int& vertex : triangle) vertex = number[vertex];
  mesh.regions = taken(whole.regions, cut.triangles);
  mesh.boundaryEdges = whole.boundaryEdges;
  for (auto& edge : mesh.boundaryEdges)
    for (int& vertex : edge) vertex = number[vertex];
  mesh.boundaryLabels = whole.boundaryLabels;
  mesh.labelNames = whole.labelNames;
  mesh.regionNames = whole.regionNames;
  mesh.edgeMiddles = whole.edgeMiddles;
  mesh.edgeCurves = whole.edgeCurves;
  return mesh;
}

ElementNodes restrictedNodes(const ElementNodes& whole, const BodyCut& cut, const std::vector<int>& number) {
  ElementNodes nodes;
  nodes.degree = whole.degree;
  nodes.places = taken(whole.places, cut.nodes);
  nodes.triangles = taken(whole.triangles, cut.triangles, whole.perTriangle());
  for (int& node : nodes.triangles) node = number[node];
  nodes.middles = whole.middles;
  for (int& node : nodes.middles) node = number[node];
  nodes.boundary = whole.boundary;
  for (BoundaryStretch& stretch : nodes.boundary)
    for (int& node : stretch.nodes) node = number[node];
  return nodes;
}

/// Of each labelled edge, whether a triangle of the mesh is behind it.
std::vector<char> edgesOfTriangles(const TriangleMesh& mesh) {
  const TriangleSides sides = sortedSides(mesh);
  std::vector<char> own;
  for (const auto& [a, b] : mesh.boundaryEdges) own.push_back(sidesOn(sides, a, b).empty() ? 0 : 1);
  return own;
}

std::vector<int> pointsOf(const std::vector<int>& triangles, int each) {
  std::vector<int> points;
  points.reserve(each * triangles.size());
  for (const int triangle : triangles)
    for (int i = 0; i < each; ++i) points.push_back(each * triangle + i);
  return points;
}

}  // namespace

Body::Body(const Body& whole, const BodyCut& cut)
    : name_(whole.name_),
      conditions_(whole.conditions_),
      axisymmetric_(whole.axisymmetric_),
      largestGradient_(whole.largestGradient_),
      extent_(whole.extent_) {
  const std::vector<int> number = numbersOf(cut.nodes, whole.nodes());
  mesh_ = restrictedMesh(whole.mesh_, cut, number);
  nodes_ = restrictedNodes(whole.nodes_, cut, number);
  supports_ = whole.supports_.renumbered(number);
  ownEdges_ = edgesOfTriangles(mesh_);
  const size_t each = whole.pointsOfTriangle();
  const size_t n = nodes_.perTriangle();
  {
    const std::vector<int> points = pointsOf(cut.triangles, static_cast<int>(each));
    material_ = materialAt(whole.material_, points);
    if (heated()) conditions_.expansion = Matrix(whole.conditions_.expansion(Eigen::all, points));
  }
  weights_ = taken(whole.weights_, cut.triangles, each);
  gradients_ = taken(whole.gradients_, cut.triangles, 2 * (n - 1) * each);
  hoops_ = taken(whole.hoops_, cut.triangles, n * each);
  if (whole.patches_) {
    // Patches are whole (solver/model.h), in the order of their first triangles.
    std::vector<int> patchOf = taken(whole.patches_->patchOf(), cut.triangles);
    std::vector<int> known = patchOf;
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    for (int& patch : patchOf)
      patch = static_cast<int>(std::lower_bound(known.begin(), known.end(), patch) - known.begin());
    patches_.emplace(patchOf, nodes_, places(), weights_, gradients_, hoops_);
  }
  std::vector<char> own(nodes(), 0);
  for (const int node : nodes_.triangles) own[node] = 1;
  numberEquations(own);
  findSteadyLoads();
}

}  // namespace mortier
