#include <algorithm>

#include "scene/document.h"
#include "scene/resolve.h"

namespace mortier {
namespace {

/// Whether most triangles are quarters of cells with both diagonals: they have a vertex with four triangles.
bool bothDiagonals(const TriangleMesh& mesh) {
  std::vector<int> around(mesh.vertices.size(), 0);
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle) ++around[v];
  const auto quarters =
      std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& triangle) {
        return std::any_of(triangle.begin(), triangle.end(), [&](int v) { return around[v] == 4; });
      });
  return 2 * quarters > static_cast<std::ptrdiff_t>(mesh.triangles.size());
}

/// Why the volumetric strain of a body is to be averaged; empty where it need not be.
std::string volumeNeed(const SceneDescription& scene, const BodyDescription& body, const TriangleMesh& mesh) {
  const auto needOf = [&](const MaterialDescription& material) -> std::string {
    if (nearlyIncompressible(scene, material))
      return "poisson = " + shortest(material.elasticity.poisson) + " keeps the volume";
    return flowLocks(scene, material, &mesh) ? "flow keeps the volume, on linear triangles" : "";
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
         !(scene.plane == Plane::strain && bothDiagonals(*mesh));
}

void decideVolumes(SceneDescription& scene, const std::vector<const TriangleMesh*>& meshes) {
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    BodyDescription& body = scene.bodies[b];
    if (body.volume != Volume::automatic || meshes[b] == nullptr) continue;
    body.volume = Volume::pointwise;
    body.volumeChoice = volumeNeed(scene, body, *meshes[b]);
    if (body.volumeChoice.empty()) continue;
    if (scene.accuracy.bound)
      body.volumeChoice = "accuracy.bound: bounds are of the strains of the displacements themselves";
    else
      body.volume = Volume::averaged;
  }
}

}  // namespace mortier
