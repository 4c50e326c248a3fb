// A body of several materials: each point has one of them.
#pragma once

#include <memory>
#include <vector>

#include "material/material.h"

namespace mortier {

/// Behaves at point i as materials[materialOf[i]]. Residuals are scaled to the yield stress of each material,
/// in elastic ones to the smallest of them.
/// \pre as many components everywhere
std::shared_ptr<const Material> materialOfParts(std::vector<std::shared_ptr<const Material>> materials,
                                                std::vector<int> materialOf);

}  // namespace mortier
