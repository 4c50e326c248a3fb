// A guaranteed bound of the error of the stress of elastic bodies in contact, with constant 1. K are the
// displacements that obey the supports and do not penetrate, S the pairs of stresses and contact pressures
// in equilibrium with all loads, without shear on the contact line and with a pressure that is nowhere
// negative. With u^ in K, (s^, p^) in S, G(u^) >= 0 the gap that is left, |.| the energy norm:
//
//   |s - sigma|^2  <=  |s^ - s|^2 + |E eps(u^) - s|^2 + 2 integral of p^ G(u^)
//
// for the exact stress sigma and any stress s, that of the finite elements here (docs/bounds.md has the
// proof). s^ comes from tractions that are balanced triangle by triangle (side_tractions.h), relaxed by
// sweeps (relaxation.h), u^ from a lift of the finite element displacement (lift.h).
#pragma once

#include <string>
#include <vector>

#include "bound/functional.h"
#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

struct EnergyBound {
  /// Why there is none; empty where there is.
  std::string obstacle;
  double bound = 0;   ///< the square root of the right-hand side [sqrt(J/m)]
  double stress = 0;  ///< |s^ - s|
  double lift = 0;    ///< |E eps(u^) - s|
  double gap = 0;     ///< integral of p^ G(u^) [J/m]
  double norm = 0;    ///< |s| [sqrt(J/m)]
  /// What data that are not linear on sides, or constant on triangles, have in the bound, over the norm [-].
  double oscillation = 0;
  /// What makes the bound strict, to rounding: the largest force that is left over in a triangle, and the
  /// largest shear or difference of normal tractions of a contact side, over the largest moment of a side
  /// [-].
  double imbalance = 0;
  double mismatch = 0;
  double leastPressure = 0;           ///< of p^ [Pa]
  double leastGap = 0;                ///< of u^ [m]
  std::vector<Enclosure> quantities;  ///< that are asked for, in their order

  /// Of the error over the exact norm: infinite where the bound is not below the norm.
  [[nodiscard]] double relative() const;
};

EnergyBound energyBound(const Model& model, const State& state,
                        const std::vector<Functional>& functionals = {});

}  // namespace mortier
