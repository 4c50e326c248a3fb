#include "scene/resolve.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "base/digits.h"
#include "base/error.h"
#include "mesh/boundary_line.h"
#include "scene/document.h"
#include "scene/keys.h"

namespace mortier {

namespace {

int numberOf(const std::map<std::string, int>& names, const std::string& name, const std::string& what,
             const std::string& meshName, const std::string& place) {
  if (const auto found = names.find(name); found != names.end()) {
    return found->second;
  }
  Keys words;
  for (const auto& [known, number] : names) {
    words.push_back(known);
  }
  throw InputError(place + ": label = \"" + name + "\", " +
                   (words.empty()
                        ? "the mesh " + meshName + " has no names of " + what
                        : "expected one of " + joined(words) + " (" + what + " of " + meshName + ")"));
}

template <class Labels>
Keys wordsFor(const Labels& labels) {
  Keys words;
  for (const int label : labels) {
    words.push_back(std::to_string(label));
  }
  return words;
}

template <class Mesh>
int boundaryLabelOf(const Mesh& mesh, int label, const std::string& name, const std::string& place) {
  if (!name.empty()) {
    label = numberOf(mesh.labelNames, name, "boundaries", mesh.name, place);
  }
  const std::vector<int> labels = boundaryLabels(mesh);
  if (std::binary_search(labels.begin(), labels.end(), label)) {
    return label;
  }
  throw InputError(place + ": label = " + std::to_string(label) +
                   (labels.empty() ? ", the mesh " + mesh.name + " has no labelled boundary"
                                   : ", expected one of " + joined(wordsFor(labels)) +
                                         " (boundary labels of " + mesh.name + ")"));
}

template <class Mesh>
int regionLabelOf(const Mesh& mesh, int label, const std::string& name, const std::string& place) {
  if (!name.empty()) {
    label = numberOf(mesh.regionNames, name, "regions", mesh.name, place);
  }
  const std::set<int> labels(mesh.regions.begin(), mesh.regions.end());
  if (labels.count(label) > 0) {
    return label;
  }
  throw InputError(place + ": region label = " + std::to_string(label) + ", expected one of " +
                   joined(wordsFor(labels)) + " (regions of " + mesh.name + ")");
}

/// \param elements  of the mesh, by their vertices
template <class Mesh, class Elements, class Place>
Place vertexPointOf(const Mesh& mesh, const Elements& elements, const Place& point,
                    const std::string& place) {
  constexpr double near = 1e-3;
  const auto distance = [&](int vertex) { return (mesh.vertices[vertex] - point).norm(); };
  int nearest = 0;
  for (int v = 1; v < static_cast<int>(mesh.vertices.size()); ++v)
    if (distance(v) < distance(nearest)) nearest = v;
  double shortestEdge = std::numeric_limits<double>::infinity();
  for (const auto& element : elements)
    if (std::find(element.begin(), element.end(), nearest) != element.end())
      for (const int other : element)
        if (other != nearest)
          shortestEdge = std::min(shortestEdge, (mesh.vertices[other] - mesh.vertices[nearest]).norm());
  if (!(distance(nearest) <= near * shortestEdge))
    throw InputError(place + ": point = " + shortest(point) + ", expected a vertex of " + mesh.name +
                     ": the nearest one is at " + shortest(mesh.vertices[nearest]) + ", " +
                     digits(distance(nearest), 3) + " away");
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v)
    if (v != nearest && distance(v) <= near * shortestEdge)
      throw InputError(place + ": point = " + shortest(point) + ", expected one vertex of " + mesh.name +
                       " there: vertices " + std::to_string(std::min(v, nearest) + 1) + " and " +
                       std::to_string(std::max(v, nearest) + 1) + " lie in one place");
  return mesh.vertices[nearest];
}

}  // namespace

int boundaryLabel(const TriangleMesh& mesh, int label, const std::string& name, const std::string& place) {
  return boundaryLabelOf(mesh, label, name, place);
}
int boundaryLabel(const TetrahedronMesh& mesh, int label, const std::string& name, const std::string& place) {
  return boundaryLabelOf(mesh, label, name, place);
}

int regionLabel(const TriangleMesh& mesh, int label, const std::string& name, const std::string& place) {
  return regionLabelOf(mesh, label, name, place);
}
int regionLabel(const TetrahedronMesh& mesh, int label, const std::string& name, const std::string& place) {
  return regionLabelOf(mesh, label, name, place);
}

Point vertexPoint(const TriangleMesh& mesh, const Point& point, const std::string& place) {
  return vertexPointOf(mesh, mesh.triangles, point, place);
}
SpacePoint vertexPoint(const TetrahedronMesh& mesh, const SpacePoint& point, const std::string& place) {
  return vertexPointOf(mesh, mesh.tetrahedra, point, place);
}

}  // namespace mortier
