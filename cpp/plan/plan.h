// The plan of a run: what of a scene will be modelled, what will not, and why. Everything in it follows from
// the scene and its meshes; what depends on the solution (whether a body yields) is said as a condition.
#pragma once

#include <string>
#include <vector>

#include "plan/loads.h"
#include "solver/model.h"

namespace mortier {

struct PlanItem {
  std::string part;      ///< "body upper", "contact 0", "time", "scene"
  bool modelled = true;  ///< or left out
  std::string what;
  std::string why;
};

using Plan = std::vector<PlanItem>;

Plan planOf(const SceneDescription& scene, const Model& model);

/// A line an item, for `mortier check`.
std::string planText(const Plan& plan);

}  // namespace mortier
