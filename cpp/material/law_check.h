// A law tried at random stresses and strains: what theory demands of it, and whether its tangent is right.
// With |s|_C^2 = s : E^-1 s and |e|_E^2 = e : E e the step of backward Euler of length k is the fixed point
// of
//   G -> elastic solution (s, eps) with the viscoplastic strain k G -> G(s, eps),
// and elasticity, contact or not, takes a change dg of that strain to changes with
//   |ds|_C^2 + |deps|_E^2 <= |dg|_E^2.
// With the Lipschitz constant L of G, |dG|_E <= L (|ds|_C^2 + |deps|_E^2)^(1/2), each step with k < 1/L has
// one solution (Proposition 1 of the note: k0 = 1/L). Where G is monotone and depends on the stress alone, as
// the gradient of a convex function is, each step has one whatever its length.
#pragma once

#include "material/material.h"

namespace mortier {

/// A rate is usable where it is finite and has a norm: a step is cut back from a stress where it has none.
/// The rate is tried at multiples of the samples too, up to the stress of an elastic strain of 1.
struct LawRange {
  double stress = 0;  ///< largest size of a stress [Pa]; the least is a thousandth of it
  double strain = 0;  ///< of a strain [-]
  int samples = 100;
};

struct LawCheck {
  int samples = 0;
  int numbers = 0;           ///< samples at which the rate and its slopes are usable numbers
  Vector overflow = {};      ///< least stress that was tried at which they are not [Pa]; empty for none
  double lipschitz = 0;      ///< L [1/s]
  Vector steepest = {};      ///< stress at which it is that [Pa]
  double monotony = 0;       ///< least eigenvalue of the symmetric part of dG/ds, over L [-]
  double dissipation = 1;    ///< least s : G/(|s|_C |G|_E) [-]
  double turning = 0;        ///< largest |G(Q s Q') - Q G Q'| over the largest |G| of such stresses [-]
  double tangent = 0;        ///< largest relative distance of ds/dstrain from differences [-]
  Vector worstTangent = {};  ///< stress at which it is that [Pa]

  [[nodiscard]] bool monotone() const { return monotony > -1e-6; }
};

/// The same samples each time. Tangents are those of steps from 1e-5 to 1e5 times 1/L.
LawCheck checkLaw(const Material& material, const LawRange& range);

}  // namespace mortier
