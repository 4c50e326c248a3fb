#include "scene/build.h"

#include "scene/build_body.h"
#include "scene/build_contact.h"
#include "scene/sides.h"

namespace mortier {

namespace {

/// Where data are tried before the run: the ends of the first and last step, and between.
std::vector<double> sampleTimes(const TimePlan& plan) {
  const double step = plan.end / (plan.steps > 0 ? plan.steps : 100);
  return {0, step, 0.5 * plan.end, plan.end - step, plan.end};
}

}  // namespace

std::vector<const TriangleMesh*> meshesOf(const Model& model) {
  std::vector<const TriangleMesh*> meshes;
  for (const Body& body : model.bodies) meshes.push_back(&body.mesh());
  return meshes;
}

Model buildModel(const SceneDescription& description, std::vector<std::string>& warnings) {
  Model model;
  const std::vector<double> times = sampleTimes(description.time);
  model.bodies.reserve(description.bodies.size());
  for (const BodyDescription& body : description.bodies) {
    model.bodies.push_back(buildBody(body, description.plane, times, warnings));
  }
  SceneDescription scene = description;
  decideSides(scene, meshesOf(model));
  for (const ContactDescription& contact : scene.contacts) {
    addContact(scene, contact, model, warnings);
  }
  return model;
}

}  // namespace mortier
