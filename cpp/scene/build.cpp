#include "scene/build.h"

#include "scene/memory_need.h"

namespace mortier {

namespace {

/// Where data are tried before the run: the ends of the first and last step, and between.
std::vector<double> sampleTimes(const TimePlan& plan) {
  const double step = plan.end / (plan.steps > 0 ? plan.steps : 100);
  return {0, step, 0.5 * plan.end, plan.end - step, plan.end};
}

}  // namespace

Model buildModel(ResolvedScene& scene) {
  Model model;
  const SceneDescription& description = scene.description;
  const std::vector<double> times = sampleTimes(description.time);
  model.bodies.reserve(description.bodies.size());
  for (size_t b = 0; b < description.bodies.size(); ++b) {
    const BodyDescription& body = description.bodies[b];
    model.bodies.push_back(description.inSpace()
                               ? buildSpaceBody(body, std::move(scene.spaceMeshes[b]), description, times)
                               : buildBody(body, std::move(scene.meshes[b]), description, times));
  }
  scene.meshes.clear();
  scene.spaceMeshes.clear();
  if (description.inSpace()) requireMemory(memoryNeed(model, description.solver), false);
  for (const ContactDescription& contact : description.contacts) {
    addContact(description, contact, model);
  }
  return model;
}

}  // namespace mortier
