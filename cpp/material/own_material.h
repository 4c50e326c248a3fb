// A material whose rate is any function G(sigma, eps) (rate_law.h). For the strain of an iterate the law
//   E^-1 (s - s0) + weight G(s, eps) = strain
// is solved at every point by Newton's method, each step halved until |r|, r the law's residual in the energy
// norm, is less; then the law is linearised there: the predictor is s + H^-1 r with r ~ 0 and the moduli are
//   ds/dstrain = H^-1 (1 - weight dG/deps),  H = E^-1 + weight dG/ds.
#pragma once

#include <map>
#include <optional>

#include "material/deviatoric.h"

namespace mortier {

class RateLaw;

/// The expressions of a law, as a scene has them.
struct RateTexts {
  std::vector<std::string> rates;            ///< of 11, 22, 12 and, where they are given, 33, 13, 23
  std::map<std::string, std::string> named;  ///< parameters: numbers and expressions that may hold each other
};

/// A law as a scene has it.
struct OwnLaw {
  std::string name;  ///< "expression", or that of a registered law
  std::shared_ptr<const RateLaw> law;
  std::map<std::string, double> parameters;  ///< numbers only, for the log
  bool isotropic = false;                    ///< whether it is said to be
  bool inPlaneStrain = true;                 ///< whether the rate of eps33 is given
  std::string where;                         ///< what a message about it begins with
  std::optional<RateTexts> texts = {};       ///< none of a registered law
};

/// \throws InputError where an elastic constant is wrong, the law is none of the plane or of space
/// (Plane::none), or its rate without stress and strain is not a number.
std::shared_ptr<const Material> ownMaterial(const Elasticity& elasticity, const OwnLaw& law, Plane plane);

}  // namespace mortier
