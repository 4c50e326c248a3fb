#include "scene/build.h"

#include <algorithm>

#include "base/digits.h"
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
  return "the initial stress is not in equilibrium with the loads at t = 0; the bodies settled elastically, "
         "which "
         "changed it by up to " +
         digits(change) + " of the largest stress";
}

}  // namespace mortier
