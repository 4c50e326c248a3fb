// A guaranteed bound of the error that the meshes make in the stress of elastic bodies in contact, with
// constant 1, and in one step of bodies that flow: against the exact solution of the same step from the same
// state,
//
//   E^-1 (sigma - s0) + k G(sigma) = eps(u) - eps(u0),    in equilibrium, contact as at the end of the step,
//
// k the time step times the scheme's diagonal coefficient. K are the displacements that obey the supports and
// do not penetrate, S the pairs of stresses and contact pressures in equilibrium with all loads, without
// shear on the contact line and with a pressure that is nowhere negative. With u^ in K, (s^, p^) in S
// (admissible.h), G(u^) >= 0 the gap that is left, |.| the energy norm, any stress t, r = G(t) and
// a = s0 + E (eps(u^ - u0) - k r), for any stress s:
//
//   |s - sigma|^2 + 2 k lambda |r - G(sigma)|^2  <=  |s^ - s|^2 + |a - s|^2 + 2 k integral of D(s^; t)
//                                                   + 2 integral of p^ G(u^)
//
// (docs/bounds.md has the proof; D as in flow_potential.h). s is that of the finite elements; t is s, so that
// a is s, but where u^ is another displacement: there it is nearly the stress that the law has for u^. Where
// nothing flows a is E eps(u^), and the terms with k are none.
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
  double bound = 0;       ///< the square root of the right-hand side [sqrt(J/m)]
  double stress = 0;      ///< |s^ - s|
  double flow = 0;        ///< the square root of what D is in it
  double lift = 0;        ///< |a - s|
  double gap = 0;         ///< integral of p^ G(u^) [J/m]
  double norm = 0;        ///< |s| [sqrt(J/m)]
  double strain = 0;      ///< bound of the error of the viscoplastic strain of the step, k G(s), in L^2 [m]
  double strainNorm = 0;  ///< of k G(s) [m]
  /// What data that are not linear on sides, or constant on triangles, have in the bound, over the norm [-].
  double oscillation = 0;
  /// What makes the bound strict, to rounding: the largest force that is left over in a triangle, and the
  /// largest shear or difference of normal tractions of a contact side, over the largest moment of a side
  /// [-].
  double imbalance = 0;
  double mismatch = 0;
  std::vector<Enclosure> quantities;  ///< that are asked for, in their order

  /// Of the error over the exact norm: infinite where the bound is not below the norm.
  [[nodiscard]] double relative() const;
};

/// \param functionals  to be enclosed, where nothing flows
/// \param weight  k, of bodies that may flow [s]; 0 of bodies that do not
EnergyBound energyBound(const Model& model, const State& state,
                        const std::vector<Functional>& functionals = {}, double weight = 0);

/// Why there is none, as far as model and data say so before the run. \param state  any at its end
std::string foreseenObstacle(const Model& model, const State& state, double weight = 0);

}  // namespace mortier
