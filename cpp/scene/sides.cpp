#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/digits.h"
#include "fem/supports.h"
#include "mesh/boundary_line.h"
#include "mesh/simplices.h"
#include "scene/document.h"
#include "scene/resolve.h"

namespace mortier {
namespace {

/// Mean length of the edges of the sides with a label; none where the mesh lacks it.
template <class Mesh>
std::optional<double> meanEdge(const Mesh& mesh, int label) {
  double length = 0;
  size_t edges = 0;
  for (size_t i = 0; i < mesh.boundaryLabels.size(); ++i) {
    const auto& side = labelledSides(mesh)[i];
    if (mesh.boundaryLabels[i] != label) continue;
    for (size_t k = 0; k < (side.size() > 2 ? side.size() : 1); ++k, ++edges)
      length += (mesh.vertices[side[(k + 1) % side.size()]] - mesh.vertices[side[k]]).norm();
  }
  return edges > 0 ? std::optional(length / static_cast<double>(edges)) : std::nullopt;
}

/// Whether the normal motion of all vertices of a side is prescribed: a wall, whatever its modulus.
bool isWall(const SceneDescription& scene, const SideDescription& side,
            const std::vector<const TriangleMesh*>& meshes) {
  const size_t body = bodyIndex(scene, side.body);
  if (scene.bodies[body].isTool()) return true;
  if (meshes[body] == nullptr) return false;
  const auto& vertices = meshes[body]->vertices;
  const std::vector<char> held = heldDofs(*meshes[body], scene.bodies[body].conditions);
  const auto edges = sidesWith(*meshes[body], side.label);
  return !edges.empty() && std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto normal = axisOf(alongNormal, vertices[edge[0]], vertices[edge[1]]);
    return std::all_of(edge.begin(), edge.end(), [&](int v) {
      return normal ? held[2 * v + *normal] != 0 : held[2 * v] != 0 && held[2 * v + 1] != 0;
    });
  });
}

/// Of a body in a half-plane or half-space, by the stiffest of its regions at the side.
template <class Mesh>
double bodyCompliance(const SceneDescription& scene, const SideDescription& side, const Mesh& mesh) {
  const BodyDescription& body = scene.bodies[bodyIndex(scene, side.body)];
  const auto compliance = [&](const MaterialDescription& material) {
    const bool thin = scene.plane == Plane::stress && !scene.inSpace();
    const double poisson = thin ? 0 : material.elasticity.poisson;
    return (1 - poisson * poisson) / material.elasticity.young;
  };
  if (body.regions.empty()) return compliance(body.material);
  double least = std::numeric_limits<double>::infinity();
  std::set<int> regions;  // beside it
  for (const auto& [vertices, element] : elementsBehind(mesh, side.label))
    regions.insert(mesh.regions[element]);
  for (const int region : regions) {
    const auto own = std::find_if(
        body.regions.begin(), body.regions.end(),
        [&](const RegionDescription& each) { return each.label == region && each.material.has_value(); });
    least = std::min(least, compliance(own == body.regions.end() ? body.material : *own->material));
  }
  return least;
}

double young(const SceneDescription& scene, const SideDescription& side) {
  return scene.bodies[bodyIndex(scene, side.body)].material.elasticity.young;
}

}  // namespace

double stiffnessRatio(const SceneDescription& scene, const SideDescription& one, const SideDescription& other,
                      const std::vector<const TriangleMesh*>& meshes) {
  if (isWall(scene, other, meshes)) return 0;
  if (isWall(scene, one, meshes)) return std::numeric_limits<double>::infinity();
  return young(scene, one) / young(scene, other);
}

double surfaceCompliance(const SceneDescription& scene, const SideDescription& side,
                         const std::vector<const TriangleMesh*>& meshes) {
  if (isWall(scene, side, meshes)) return 0;
  return bodyCompliance(scene, side, *meshes[bodyIndex(scene, side.body)]);
}

double surfaceCompliance(const SceneDescription& scene, const SideDescription& side,
                         const TetrahedronMesh& mesh) {
  return scene.bodies[bodyIndex(scene, side.body)].isTool() ? 0 : bodyCompliance(scene, side, mesh);
}

namespace {

/// \param edge1, edge2  mean lengths of the edges of the side named first and of the other [m]
/// \param stiffness  of the first over that of the other
void decideSide(ContactDescription& contact, double edge1, double edge2, double stiffness) {
  constexpr double equal = 1e-9;  // then the side named first
  constexpr double far = 100;     // a coarse soft side may touch between its nodes
  const bool secondIsFiner = edge2 < (1 - equal) * edge1;
  const bool alike = !secondIsFiner && edge2 <= (1 + equal) * edge1;
  contact.choice =
      alike ? "both meshes are as fine, nonmortar is the side named first" : "nonmortar is the finer mesh";
  const bool firstIsStiffer = stiffness > far;
  const bool secondIsStiffer = stiffness < 1 / far;
  const bool second = firstIsStiffer || (secondIsFiner && !secondIsStiffer);
  if (firstIsStiffer || secondIsStiffer)
    contact.choice =
        contact.otherSide ? "nonmortar is the far stiffer body (swap)" : "nonmortar is the far softer body";
  else if (contact.otherSide)
    contact.choice = alike ? "both meshes are as fine, nonmortar is the side named last (swap)"
                           : "nonmortar is the coarser mesh (swap)";
  contact.nonmortarSide = second != contact.otherSide ? 1 : 0;
}

/// \param edgeOf  mean length of the edges of a side, if it is known \param stiffness  as above
template <class EdgeOf, class Stiffness>
void decideSides(SceneDescription& scene, const EdgeOf& edgeOf, const Stiffness& stiffness) {
  forEachPair(scene, [&](ContactDescription& contact) {
    if (contact.nonmortarSide) return;
    const std::optional<double> edge1 = edgeOf(contact.sides[0]);
    const std::optional<double> edge2 = edgeOf(contact.sides[1]);
    if (edge1 && edge2) decideSide(contact, *edge1, *edge2, stiffness(contact));
  });
}

}  // namespace

void decideSides(SceneDescription& scene, const std::vector<const TriangleMesh*>& meshes) {
  decideSides(
      scene,
      [&](const SideDescription& side) {
        const TriangleMesh* mesh = meshes[bodyIndex(scene, side.body)];
        return mesh != nullptr ? meanEdge(*mesh, side.label) : std::nullopt;
      },
      [&](const ContactDescription& contact) {
        return contact.variant == CouplingKind::interpolation
                   ? 1
                   : stiffnessRatio(scene, contact.sides[0], contact.sides[1], meshes);
      });
}

void decideSides(SceneDescription& scene, const std::vector<TetrahedronMesh>& meshes) {
  decideSides(
      scene,
      [&](const SideDescription& side) { return meanEdge(meshes[bodyIndex(scene, side.body)], side.label); },
      [&](const ContactDescription& contact) {
        return young(scene, contact.sides[0]) / young(scene, contact.sides[1]);
      });
}

std::optional<int> axisOf(int component, const Point& from, const Point& to) {
  constexpr double aligned = 1e-9;
  if (component == alongX || component == alongY) return component;
  Point along = (to - from).normalized();
  if (component == alongNormal) along = {along.y(), -along.x()};
  if (std::abs(along.y()) < aligned) return 0;
  if (std::abs(along.x()) < aligned) return 1;
  return std::nullopt;
}

std::vector<char> heldDofs(const TriangleMesh& mesh, const std::vector<ConditionDescription>& conditions) {
  std::vector<char> held(2 * mesh.vertices.size(), 0);
  for (const ConditionDescription& condition : conditions) {
    if (condition.kind != ConditionDescription::Kind::displacement) continue;
    if (condition.point) {
      if (condition.component > alongY) continue;
      const int vertex = vertexAt(mesh, *condition.point);
      if (vertex >= 0) held[2 * vertex + condition.component] = 1;
      continue;
    }
    for (const auto& [a, b] : sidesWith(mesh, condition.label)) {
      if (const auto axis = axisOf(condition.component, mesh.vertices[a], mesh.vertices[b]))
        for (const int v : {a, b}) held[2 * v + *axis] = 1;
    }
  }
  return held;
}

double crossedPart(const TriangleMesh& mesh) {
  std::vector<int> around(mesh.vertices.size(), 0);
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle) ++around[v];
  const auto quarters =
      std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& triangle) {
        return std::any_of(triangle.begin(), triangle.end(), [&](int v) { return around[v] == 4; });
      });
  return static_cast<double>(quarters) / static_cast<double>(mesh.triangles.size());
}

namespace {

/// Why the volumetric strain of a body is to be averaged; empty where it need not be.
std::string volumeNeed(const SceneDescription& scene, const BodyDescription& body) {
  // Where linear triangles with one diagonal begin to lock: Hertz's pressure is off by 0.7 % at 0.45 and by 6
  // to 31 % at 0.49, by 0.3 % with the average. Crossed cells do not lock, and are better with it all the
  // same.
  constexpr double locks = 0.45;
  const bool linear = scene.degree == 1 && (scene.inSpace() || scene.plane != Plane::stress);
  const auto needOf = [&](const MaterialDescription& material) -> std::string {
    if (nearlyIncompressible(scene, material) || (linear && material.elasticity.poisson >= locks))
      return "poisson = " + shortest(material.elasticity.poisson) + " keeps the volume";
    const bool flows = linear && material.flows() && material.as<OwnLaw>() == nullptr;
    if (!flows) return "";
    return std::string("flow keeps the volume, on linear ") + (scene.inSpace() ? "tetrahedra" : "triangles");
  };
  std::string need = needOf(body.material);
  for (const RegionDescription& region : body.regions)
    if (need.empty() && region.material) need = needOf(*region.material);
  return need;
}

}  // namespace

bool nearlyIncompressible(const SceneDescription& scene, const MaterialDescription& material) {
  constexpr double nearly = 0.49;
  return (scene.inSpace() ? scene.degree == 1 : scene.plane != Plane::stress) &&
         material.elasticity.poisson > nearly;
}

bool flowLocks(const SceneDescription& scene, const MaterialDescription& material, const TriangleMesh* mesh) {
  if (scene.degree != 1 || !material.flows()) return false;
  if (scene.inSpace()) return true;
  return scene.plane != Plane::stress && material.as<OwnLaw>() == nullptr &&
         !(scene.plane == Plane::strain && crossedPart(*mesh) > 0.5);
}

void decideVolumes(SceneDescription& scene) {
  for (BodyDescription& body : scene.bodies) {
    if (body.volume != Volume::automatic) continue;
    body.volume = Volume::pointwise;
    body.volumeChoice = volumeNeed(scene, body);
    if (body.volumeChoice.empty()) continue;
    if (scene.accuracy.bound)
      body.volumeChoice = "accuracy.bound: bounds are of the strains of the displacements themselves";
    else
      body.volume = Volume::averaged;
  }
}

}  // namespace mortier
