#include "scene/resolve.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <set>
#include <type_traits>

#include "base/digits.h"
#include "base/error.h"
#include "mesh/boundary_line.h"
#include "mesh/read.h"
#include "mesh/regions.h"
#include "scene/document.h"
#include "scene/keys.h"

namespace mortier {
namespace {

int numberOf(const std::map<std::string, int>& names, const std::string& name, const std::string& what,
             const std::string& meshName, const std::string& place) {
  if (const auto found = names.find(name); found != names.end()) return found->second;
  Keys words;
  for (const auto& [known, number] : names) words.push_back(known);
  throw InputError(place + ": label = \"" + name + "\", " +
                   (words.empty()
                        ? "the mesh " + meshName + " has no names of " + what
                        : "expected one of " + joined(words) + " (" + what + " of " + meshName + ")"));
}

Keys wordsFor(const std::set<int>& labels) {
  Keys words;
  for (const int label : labels) words.push_back(std::to_string(label));
  return words;
}

template <class Mesh>
int boundaryLabel(const Mesh& mesh, int label, const std::string& name, const std::string& place) {
  if (!name.empty()) label = numberOf(mesh.labelNames, name, "boundaries", mesh.name, place);
  const std::set<int> labels = knownNumbers(mesh.boundaryLabels, mesh.sharedLabels);
  if (labels.contains(label)) return label;
  throw InputError(place + ": label = " + std::to_string(label) +
                   (labels.empty() ? ", the mesh " + mesh.name + " has no labelled boundary"
                                   : ", expected one of " + joined(wordsFor(labels)) +
                                         " (boundary labels of " + mesh.name + ")"));
}

template <class Mesh>
int regionLabel(const Mesh& mesh, int label, const std::string& name, const std::string& place) {
  if (!name.empty()) label = numberOf(mesh.regionNames, name, "regions", mesh.name, place);
  const std::set<int> labels = knownNumbers(mesh.regions, mesh.sharedRegions);
  if (labels.contains(label)) return label;
  throw InputError(place + ": region label = " + std::to_string(label) + ", expected one of " +
                   joined(wordsFor(labels)) + " (regions of " + mesh.name + ")");
}

template <class Mesh, class Place>
Place vertexPointOf(const Mesh& mesh, const Place& point, const std::string& place) {
  constexpr double near = 1e-3;
  const auto distance = [&](int vertex) { return (mesh.vertices[vertex] - point).norm(); };
  int nearest = 0;
  for (int v = 1; v < static_cast<int>(mesh.vertices.size()); ++v)
    if (distance(v) < distance(nearest)) nearest = v;
  double shortestEdge = std::numeric_limits<double>::infinity();
  for (const auto& element : elementsOf(mesh))
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

using NumberLabel =
    std::function<void(int body, int& label, const std::string& name, const std::string& where)>;

/// \param vertex  (body, Point& or SpacePoint&, where)
template <class PlacePoint>
void forEachPlace(SceneDescription& scene, const NumberLabel& boundary, const NumberLabel& region,
                  const PlacePoint& vertex) {
  for (int b = 0; b < static_cast<int>(scene.bodies.size()); ++b) {
    for (ConditionDescription& c : scene.bodies[b].conditions)
      if (scene.bodies[b].isTool())
        continue;
      else if (c.point)
        vertex(b, *c.point, c.where);
      else if (c.pointInSpace)
        vertex(b, *c.pointInSpace, c.where);
      else
        boundary(b, c.label, c.labelName, c.where);
    for (RegionDescription& r : scene.bodies[b].regions) region(b, r.label, r.labelName, r.where);
  }
  forEachPair(scene, [&](ContactDescription& contact) {
    for (SideDescription& side : contact.sides)
      boundary(bodyIndex(scene, side.body), side.label, side.labelName, side.where);
  });
  for (QuantityDescription& q : scene.quantities)
    if (q.whole)
      continue;
    else if (ofLabel(q.kind) && !q.point && !q.pointInSpace)
      boundary(bodyIndex(scene, q.body), q.label, q.labelName, q.where);
    else if (q.kind == Quantity::Kind::reaction && q.point)
      vertex(bodyIndex(scene, q.body), *q.point, q.where);
    else if (q.kind == Quantity::Kind::reaction)
      vertex(bodyIndex(scene, q.body), *q.pointInSpace, q.where);
}

std::vector<const TriangleMesh*> pointersTo(const std::vector<TriangleMesh>& meshes) {
  std::vector<const TriangleMesh*> pointers;
  for (const TriangleMesh& mesh : meshes) pointers.push_back(&mesh);
  return pointers;
}

/// Gives the mesh of a body, of groups that share sides or elements, those that the scene names. \pre labels
/// are numbers. \throws InputError
template <class Mesh>
void chooseGroupsOf(SceneDescription& scene, int body, Mesh& mesh) {
  std::set<int> labels;
  std::set<int> regions;
  const auto into = [&](std::set<int>& used) {
    return [&used, body](int of, int& label, const std::string& /*name*/, const std::string& /*where*/) {
      if (of == body) used.insert(label);
    };
  };
  forEachPlace(scene, into(labels), into(regions),
               [](int /*body*/, auto& /*point*/, const std::string& /*where*/) {});
  chooseGroups(mesh, labels, regions);
}

/// Labels and points of the scene become those of the meshes. \throws InputError
template <class Mesh>
void findPlaces(SceneDescription& scene, std::vector<Mesh>& meshes) {
  const auto place = [&](int body, const std::string& where) {
    return where + ": body " + scene.bodies[body].name;
  };
  forEachPlace(
      scene,
      [&](int body, int& label, const std::string& name, const std::string& where) {
        label = boundaryLabel(meshes[body], label, name, place(body, where));
      },
      [&](int body, int& label, const std::string& name, const std::string& where) {
        label = regionLabel(meshes[body], label, name, place(body, where));
      },
      [&]<class Place>(int body, Place& point, const std::string& where) {
        if constexpr (std::is_same_v<decltype(meshes[body].vertices.front()), Place&>)
          point = vertexPointOf(meshes[body], point, place(body, where));
      });
  for (size_t b = 0; b < meshes.size(); ++b) chooseGroupsOf(scene, static_cast<int>(b), meshes[b]);
}

}  // namespace

Point vertexPoint(const TriangleMesh& mesh, const Point& point, const std::string& place) {
  return vertexPointOf(mesh, point, place);
}

namespace {

void placeAt(const SpacePoint& place, double size, TriangleMesh& mesh) {
  mesh = triangleAt(place.head<2>(), size);
}
void placeAt(const SpacePoint& place, double size, TetrahedronMesh& mesh) {
  mesh = tetrahedronAt(place, size);
}

/// Tools that are points get a size at which they are seen beside the bodies. \param meshes  null if unknown
template <class Mesh>
void sizePoints(const SceneDescription& scene, const std::vector<Mesh*>& meshes) {
  constexpr double part = 0.05;
  double largest = 0;
  for (size_t b = 0; b < meshes.size(); ++b)
    if (meshes[b] != nullptr && !scene.bodies[b].point) largest = std::max(largest, extent(*meshes[b]));
  for (size_t b = 0; b < meshes.size() && largest > 0; ++b)
    if (meshes[b] != nullptr && scene.bodies[b].point)
      placeAt(*scene.bodies[b].reference, part * largest, *meshes[b]);
}

/// \param read  readMesh or readSpaceMesh
template <class Read>
auto meshBy(const Read& read, const BodyDescription& body) {
  if (body.point) {
    decltype(read(body.mesh)) mesh;
    placeAt(*body.reference, 1, mesh);
    return mesh;
  }
  try {
    return read(body.mesh);
  } catch (const InputError& error) {
    if (!body.mesh.inSpace && !body.mesh.shape) throw;  // which names the file
    throw InputError(body.meshWhere + (body.isTool() ? ": tool " : ": body ") + body.name +
                     (body.isTool() ? ": shape: " : ": mesh: ") + error.what());
  }
}

}  // namespace

TriangleMesh meshOf(const BodyDescription& body) {
  return meshBy(readMesh, body);
}

ResolvedScene resolveScene(SceneDescription scene) {
  ResolvedScene resolved{std::move(scene), {}, {}};
  SceneDescription& description = resolved.description;
  const auto read = [&](const auto& by, auto& meshes) {
    for (const BodyDescription& body : description.bodies) meshes.push_back(meshBy(by, body));
    std::vector<std::remove_reference_t<decltype(meshes.front())>*> pointers;
    for (auto& mesh : meshes) pointers.push_back(&mesh);
    sizePoints(description, pointers);
    findPlaces(description, meshes);
  };
  if (description.inSpace()) {
    read(readSpaceMesh, resolved.spaceMeshes);
    decideSides(description, resolved.spaceMeshes);
  } else {
    read(readMesh, resolved.meshes);
    decideSides(description, pointersTo(resolved.meshes));
  }
  decideVolumes(description);
  return resolved;
}

std::vector<InputError> resolveWhatCanBe(SceneDescription& scene, const std::vector<TriangleMesh*>& meshes) {
  sizePoints(scene, meshes);
  constexpr int none = -2;
  const auto number = [&](std::map<std::string, int> TriangleMesh::*names) {
    return [&meshes, names](int body, int& label, const std::string& name, const std::string& /*where*/) {
      if (meshes[body] == nullptr || name.empty()) return;
      const auto& known = meshes[body]->*names;
      const auto found = known.find(name);
      label = found == known.end() ? none : found->second;
    };
  };
  const auto vertex = [&]<class Place>(int body, Place& point, const std::string& where) {
    if constexpr (std::is_same_v<Place, Point>) {
      if (meshes[body] == nullptr) return;
      try {
        point = vertexPoint(*meshes[body], point, where);
      } catch (const InputError&) {
        return;  // named by the lint
      }
    }
  };
  forEachPlace(scene, number(&TriangleMesh::labelNames), number(&TriangleMesh::regionNames), vertex);
  std::vector<InputError> faults;
  for (size_t b = 0; b < meshes.size(); ++b) {
    if (meshes[b] == nullptr) continue;
    try {
      chooseGroupsOf(scene, static_cast<int>(b), *meshes[b]);
    } catch (const InputError& error) {
      faults.push_back(error);
    }
  }
  decideSides(scene, std::vector<const TriangleMesh*>(meshes.begin(), meshes.end()));
  decideVolumes(scene);
  return faults;
}

}  // namespace mortier
