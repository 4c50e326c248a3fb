#include "scene/resolve.h"

#include <functional>

#include "base/error.h"
#include "mesh/read.h"

namespace mortier {
namespace {

using NumberLabel =
    std::function<void(int body, int& label, const std::string& name, const std::string& where)>;
using PlacePoint = std::function<void(int body, Point& point, const std::string& where)>;

void forEachPlace(SceneDescription& scene, const NumberLabel& boundary, const NumberLabel& region,
                  const PlacePoint& vertex) {
  for (int b = 0; b < static_cast<int>(scene.bodies.size()); ++b) {
    for (ConditionDescription& c : scene.bodies[b].conditions)
      if (scene.bodies[b].isTool())
        continue;
      else if (c.point)
        vertex(b, *c.point, c.where);
      else
        boundary(b, c.label, c.labelName, c.where);
    for (RegionDescription& r : scene.bodies[b].regions) region(b, r.label, r.labelName, r.where);
  }
  for (ContactDescription& contact : scene.contacts)
    for (SideDescription* side : {&contact.nonmortar, &contact.mortar})
      boundary(bodyIndex(scene, side->body), side->label, side->labelName, side->where);
  for (QuantityDescription& q : scene.quantities)
    if (q.whole)
      continue;
    else if (ofLabel(q.kind) && !q.point)
      boundary(bodyIndex(scene, q.body), q.label, q.labelName, q.where);
    else if (q.kind == Quantity::Kind::reaction)
      vertex(bodyIndex(scene, q.body), *q.point, q.where);
}

std::vector<const TriangleMesh*> pointersTo(const std::vector<TriangleMesh>& meshes) {
  std::vector<const TriangleMesh*> pointers;
  for (const TriangleMesh& mesh : meshes) pointers.push_back(&mesh);
  return pointers;
}

}  // namespace

TriangleMesh meshOf(const BodyDescription& body) {
  if (!body.mesh.shape) return readMesh(body.mesh);
  try {
    return shapeMesh(*body.mesh.shape);
  } catch (const InputError& error) {
    throw InputError(body.meshWhere + (body.isTool() ? ": tool " : ": body ") + body.name +
                     (body.isTool() ? ": shape: " : ": mesh: ") + error.what());
  }
}

ResolvedScene resolveScene(SceneDescription scene) {
  std::vector<TriangleMesh> meshes;
  for (const BodyDescription& body : scene.bodies) meshes.push_back(meshOf(body));
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
      [&](int body, Point& point, const std::string& where) {
        point = vertexPoint(meshes[body], point, place(body, where));
      });
  decideSides(scene, pointersTo(meshes));
  decideVariants(scene, pointersTo(meshes));
  decideVolumes(scene, pointersTo(meshes));
  return {std::move(scene), std::move(meshes)};
}

void resolveWhatCanBe(SceneDescription& scene, const std::vector<const TriangleMesh*>& meshes) {
  constexpr int none = -2;
  const auto number = [&](std::map<std::string, int> TriangleMesh::*names) {
    return [&meshes, names](int body, int& label, const std::string& name, const std::string& /*where*/) {
      if (meshes[body] == nullptr || name.empty()) return;
      const auto& known = meshes[body]->*names;
      const auto found = known.find(name);
      label = found == known.end() ? none : found->second;
    };
  };
  const auto vertex = [&](int body, Point& point, const std::string& where) {
    if (meshes[body] == nullptr) return;
    try {
      point = vertexPoint(*meshes[body], point, where);
    } catch (const InputError&) {
      return;  // named by the lint
    }
  };
  forEachPlace(scene, number(&TriangleMesh::labelNames), number(&TriangleMesh::regionNames), vertex);
  decideSides(scene, meshes);
  decideVariants(scene, meshes);
  decideVolumes(scene, meshes);
}

}  // namespace mortier
