// The total strain of a state, for laws that depend on it.
#pragma once

#include "material/material.h"
#include "solver/state.h"

namespace mortier {

/// E^-1 s and the viscoplastic strain [-]: since t = 0, with the elastic strain of the stress that was there.
inline Matrix totalStrain(const Material& material, const BodyState& state) {
  Matrix strain;
  material.elasticStrain(state.stress, strain);
  strain += state.viscoplasticStrain;
  return strain;
}

/// That, where the law depends on it; nothing elsewhere.
inline Matrix strainOfLaw(const Material& material, const BodyState& state) {
  return material.needsTotalStrain() ? totalStrain(material, state) : Matrix();
}

}  // namespace mortier
