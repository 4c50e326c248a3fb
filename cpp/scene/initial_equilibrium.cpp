#include "scene/initial_equilibrium.h"

#include <algorithm>
#include <cstdio>

#include "base/error.h"
#include "time/initial_balance.h"

namespace mortier {

std::string findInitialEquilibrium(const SceneDescription& scene, const Model& model, State state) {
  constexpr double noticeable = 1e-6;
  const auto stressed = [](const Body& body) { return body.hasInitialStress(); };
  if (std::none_of(model.bodies.begin(), model.bodies.end(), stressed)) return "";
  double change = 0;
  try {
    change = balanceInitialStress(model, state, scene.solver);
  } catch (const InputError& error) {
    throw InputError(scene.path + ": " + error.what());
  }
  if (change <= noticeable) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", change);
  return "the initial stress is not in equilibrium with the loads at t = 0; the bodies settled elastically, "
         "which "
         "changed it by up to " +
         std::string(text) + " of the largest stress";
}

}  // namespace mortier
