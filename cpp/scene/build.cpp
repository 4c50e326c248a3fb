#include "scene/build.h"

#include "scene/build_body.h"
#include "scene/build_contact.h"

namespace mortier {

namespace {

/// Where data are tried before the run: the ends of the first and last step, and between.
std::vector<double> sampleTimes(const TimePlan& plan) {
  const double step = plan.end / (plan.steps > 0 ? plan.steps : 100);
  return {0, step, 0.5 * plan.end, plan.end - step, plan.end};
}

}  // namespace

Model buildModel(const SceneDescription& scene, std::vector<std::string>& warnings) {
  Model model;
  const std::vector<double> times = sampleTimes(scene.time);
  model.bodies.reserve(scene.bodies.size());
  for (const BodyDescription& body : scene.bodies) {
    model.bodies.push_back(buildBody(body, scene.plane, times, warnings));
  }
  for (const ContactDescription& contact : scene.contacts) {
    addContact(scene, contact, model, warnings);
  }
  return model;
}

}  // namespace mortier
