// Rate laws that repeat built-in ones.
#pragma once

#include <cmath>
#include <memory>

#include "material/norton.h"
#include "material/own_material.h"
#include "material/perzyna.h"
#include "material/rate_law.h"
#include "material/viscoelastic.h"

namespace mortier {

template <class Tensor>
auto mises(const Tensor& s) {
  using std::sqrt;
  using Number = decltype(s.c11);
  Number shear = s.c12 * s.c12;
  if constexpr (requires { s.c13; }) shear = Number(shear + s.c13 * s.c13 + s.c23 * s.c23);
  return Number(sqrt(s.c11 * s.c11 + s.c22 * s.c22 + s.c33 * s.c33 - s.c11 * s.c22 - s.c22 * s.c33 -
                     s.c33 * s.c11 + 3 * shear));
}

/// factor times the deviator.
template <class Tensor, class Number>
Tensor alongDeviator(const Tensor& s, const Number& factor) {
  const Number mean = (s.c11 + s.c22 + s.c33) / 3;
  Tensor result{};
  result.c11 = factor * (s.c11 - mean);
  result.c22 = factor * (s.c22 - mean);
  result.c12 = factor * s.c12;
  result.c33 = factor * (s.c33 - mean);
  if constexpr (requires { s.c13; }) {
    result.c13 = factor * s.c13;
    result.c23 = factor * s.c23;
  }
  return result;
}

struct OwnNorton {
  static constexpr bool needsTotalStrain = false;
  NortonCreep creep;
  template <class Tensor>
  Tensor rateOf(const Tensor& s, const Tensor&) const {
    using std::pow;
    using Number = decltype(s.c11);
    const Number relative = mises(s) / creep.referenceStress;
    return alongDeviator(
        s, Number(pow(relative, creep.exponent - 1) * (1.5 * creep.referenceRate / creep.referenceStress)));
  }
};

struct OwnPerzyna {
  static constexpr bool needsTotalStrain = false;
  Viscoplasticity law;
  template <class Tensor>
  Tensor rateOf(const Tensor& s, const Tensor&) const {
    using std::max;
    using Number = decltype(s.c11);
    return alongDeviator(
        s, Number(max(Number(1 - law.yieldStress / mises(s)), Number(0)) / (2 * law.viscosity)));
  }
};

struct OwnSolid {
  static constexpr bool needsTotalStrain = true;
  Elasticity elasticity;
  Viscoelasticity law;
  template <class Tensor>
  Tensor rateOf(const Tensor& s, const Tensor& e) const {
    using Number = decltype(s.c11);
    const double g = law.relaxedFraction;
    const double shear = elasticity.young / (1 + elasticity.poisson);
    const Tensor rate = alongDeviator(s, Number(1 / (shear * law.relaxationTime)));
    const Tensor still = alongDeviator(e, Number(g / law.relaxationTime));
    Tensor result{};
    result.c11 = rate.c11 - still.c11;
    result.c22 = rate.c22 - still.c22;
    result.c12 = rate.c12 - still.c12;
    result.c33 = rate.c33 - still.c33;
    if constexpr (requires { s.c13; }) {
      result.c13 = rate.c13 - still.c13;
      result.c23 = rate.c23 - still.c23;
    }
    return result;
  }
};

inline OwnLaw named(std::shared_ptr<const RateLaw> law) {
  OwnLaw own;
  own.name = "own";
  own.law = std::move(law);
  own.where = "here: law = \"own\"";
  return own;
}

}  // namespace mortier
