// Materials that differ from point to point.
#pragma once

#include <memory>
#include <vector>

#include "material/material.h"

namespace mortier {

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
