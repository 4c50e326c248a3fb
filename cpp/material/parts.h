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

// Materials that differ from point to point.

class Pointwise {
 public:
  virtual ~Pointwise() = default;
  /// The material of some points only, in this order.
  [[nodiscard]] virtual std::shared_ptr<const Material> restricted(const std::vector<int>& points) const = 0;
};

/// The same for any material.
inline std::shared_ptr<const Material> materialAt(const std::shared_ptr<const Material>& material,
                                                  const std::vector<int>& points) {
  const auto* pointwise = dynamic_cast<const Pointwise*>(material.get());
  return pointwise != nullptr ? pointwise->restricted(points) : material;
}

}  // namespace mortier
