// A guaranteed bound of the error that the meshes make in the stress of elastic bodies in contact, with
// constant 1 (Prager and Synge; docs/bounds.md has the proof). K are the displacements that obey the supports
// and do not penetrate, S the pairs of stresses and contact pressures in equilibrium with all loads, without
// shear on the contact line and with a pressure that is nowhere negative. With u^ in K, (s^, p^) in S
// (admissible.h), G(u^) >= 0 the gap that is left, |.| the energy norm, a = E eps(u^), for any stress s:
//
//   |s - sigma|^2  <=  |s^ - s|^2 + |a - s|^2 + 2 integral of p^ G(u^)
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "solver/model.h"
#include "solver/state.h"
#include "time/quantity.h"

namespace mortier {

/// A number of the exact solution.
struct Enclosure {
  std::string obstacle;  ///< why there is none; empty where there is
  double lower = 0;      ///< the exact value is not below
  double upper = 0;      ///< and not above
  /// What each triangle of the bodies' own meshes adds to the half of upper - lower, nearly.
  std::vector<Vector> parts = {};
  std::optional<double> estimate = {};  ///< of an error of which nothing is proved

  /// Of a computed value, at most.
  [[nodiscard]] double error(double value) const { return std::max({value - lower, upper - value, 0.0}); }
};

struct EnergyBound {
  /// Why there is none; empty where there is.
  std::string obstacle;
  double bound = 0;   ///< the square root of the right-hand side [sqrt(J/m)]
  double stress = 0;  ///< |s^ - s|
  double lift = 0;    ///< |a - s|
  double gap = 0;     ///< integral of p^ G(u^) [J/m]
  double norm = 0;    ///< |s| [sqrt(J/m)]
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

/// \param quantities  to be enclosed
EnergyBound energyBound(const Model& model, const State& state, const std::vector<Quantity>& quantities = {});

/// Why there is none, as far as model and data say so before the run. \param state  any at its end
std::string foreseenObstacle(const Model& model, const State& state);

}  // namespace mortier
