// The stress that kinematic hardening sets against the flow, for what counts energies.
#pragma once

#include "material/material.h"

namespace mortier {

/// What a material may be beside. The back stress X is linear in the viscoplastic strain eps_v of a point:
/// X : eps_v / 2 is stored there.
class BackStress {
 public:
  virtual ~BackStress() = default;
  /// By components [Pa].
  [[nodiscard]] virtual PointVector backStress(const Matrix& viscoplasticStrain, int point) const = 0;
};

/// That of any material; nothing where it has none.
inline PointVector backStressOf(const Material& material, const Matrix& viscoplasticStrain, int point) {
  const auto* hardening = dynamic_cast<const BackStress*>(&material);
  if (hardening == nullptr) return PointVector::Zero(viscoplasticStrain.rows());
  return hardening->backStress(viscoplasticStrain, point);
}

}  // namespace mortier
