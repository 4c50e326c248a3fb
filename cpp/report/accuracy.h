// How accurate a state is, by its own estimate (fem/error_estimate.h).
#pragma once

#include <string>
#include <vector>

#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// Estimated errors of the stress, relative, in the energy norm [-]. They are those of the meshes; what the steps in
/// time add is not in them.
struct Accuracy {
  double all = 0;
  std::vector<double> bodies;
  std::string worstBody;  ///< the body of the triangle with the largest error, and its centre [m]
  Point worst = Point::Zero();
};

Accuracy accuracyOf(const Model& model, const State& state);

}  // namespace mortier
