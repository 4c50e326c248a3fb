#include "plan/steps.h"

#include <algorithm>

#include "plan/loads.h"

namespace mortier {

bool hasFriction(const SceneDescription& scene) {
  return std::any_of(scene.contacts.begin(), scene.contacts.end(),
                     [](const ContactDescription& contact) { return contact.friction.any(); });
}

bool mayFlow(const BodyDescription& body) {
  const auto materials = materialsOf(body);
  return std::any_of(materials.begin(), materials.end(),
                     [](const MaterialDescription* each) { return each->flows(); });
}

bool stepsMatter(const SceneDescription& scene) {
  return hasFriction(scene) || std::any_of(scene.bodies.begin(), scene.bodies.end(), mayFlow);
}

double stepTolerance(const SceneDescription& scene) {
  if (!(scene.accuracy.energy > 0) || !stepsMatter(scene)) return scene.time.tolerance;
  const double share = (scene.degree == 1 ? 0.2 : 0.25) * scene.accuracy.energy;
  return scene.time.controlled() ? std::min(share, scene.time.tolerance) : share;
}

}  // namespace mortier
