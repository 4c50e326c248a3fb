// The limit of what contact is: sides touch where their normals make 120 degrees or more
// (contact/common_refinement.h).
#pragma once

#include <string>

#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// Of contacts that follow the bodies, the one of those that press in a state whose sides are nearest to that
/// limit, in words for a message that begins with "; ". Empty where none is within 10 degrees of it. \pre the
/// rows are those of the state
std::string nearFacingLimit(const Model& model, const State& state);

}  // namespace mortier
