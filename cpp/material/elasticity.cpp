#include "material/elasticity.h"

#include <cmath>

#include "base/error.h"
#include "base/formatted.h"
#include "material/deviatoric.h"

namespace mortier {

Eigen::Array3d Elasticity::moduli() const {
  return {young / (1 - poisson), young / (1 + poisson), young / (1 + poisson)};
}

void requireParameter(bool holds, const char* name, double value, const char* expected) {
  if (holds && std::isfinite(value)) return;
  throw InputError(formatted("%s = %g, expected %s", name, value, expected));
}

void requireValid(const Elasticity& elasticity) {
  requireParameter(elasticity.young > 0, "young", elasticity.young, "young > 0 [Pa]");
  requireParameter(elasticity.poisson > -1 && elasticity.poisson < 0.5, "poisson", elasticity.poisson,
                   "-1 < poisson < 0.5");
}

LawDescription describe(const std::string& name, const Elasticity& elasticity) {
  return {name, "", {{"young", elasticity.young, "Pa"}, {"poisson", elasticity.poisson, ""}}};
}

LawDescription describe(const Elasticity& elasticity) {
  LawDescription description = describe("elastic", elasticity);
  description.flows = false;
  return description;
}

std::shared_ptr<const Material> elasticMaterial(const Elasticity& elasticity, Plane plane) {
  return isotropicMaterial(elasticity, plane, describe(elasticity),
                           []<size_t n>(const Pair& e, const Pair& /*a*/) { return ElasticLaw<n>(e); });
}

}  // namespace mortier
