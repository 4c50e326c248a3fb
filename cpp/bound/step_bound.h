// A guaranteed bound of the error that the meshes make in one step of bodies that flow: against the exact
// solution (sigma, G(sigma)) of the same step from the same state,
//
//   E^-1 (sigma - s0) + k G(sigma) = eps(u) - eps(u0),    in equilibrium, contact as at the end of the step,
//
// k the time step times the scheme's diagonal coefficient. With the admissible pair u^, (s^, p^)
// (admissible.h), any stress t, r = G(t) and a = s0 + E (eps(u^ - u0) - k r), for any stress s:
//
//   |s - sigma|^2 + 2 k lambda |r - G(sigma)|^2  <=  |s^ - s|^2 + |a - s|^2 + 2 k integral of D(s^; t)
//                                                   + 2 integral of p^ G(u^)
//
// (docs/bounds.md has the proof; D as in flow_potential.h). s is that of the finite elements; t is s, so that
// a is s, but where u^ is another displacement: there it is nearly the stress that the law has for u^.
#pragma once

#include <string>

#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

struct StepBound {
  std::string obstacle;    ///< why there is none; empty where there is
  double bound = 0;        ///< the square root of the right-hand side [sqrt(J/m)]
  double stress = 0;       ///< |s^ - s|
  double flow = 0;         ///< the square root of what D is in it
  double lift = 0;         ///< |a - s|
  double gap = 0;          ///< integral of p^ G(u^) [J/m]
  double norm = 0;         ///< |s|
  double strain = 0;       ///< bound of the error of the viscoplastic strain of the step, k G(s), in L^2 [m]
  double strainNorm = 0;   ///< of k G(s) [m]
  double oscillation = 0;  ///< of the data on the meshes: others than linear ones have an obstacle
};

/// \param weight  k [s]
StepBound stepBound(const Model& model, const State& state, double weight);

}  // namespace mortier
