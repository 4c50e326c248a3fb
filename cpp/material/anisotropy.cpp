#include "material/anisotropy.h"

#include <sstream>

#include "base/error.h"
#include "material/any_elasticity.h"

namespace mortier {
namespace {

/// From (s11, s22, s12) to (p, q, r), s33 as it is.
Matrix basis(Eigen::Index n) {
  constexpr double h = std::numbers::sqrt2 / 2;
  Matrix T = Matrix::Identity(n, n);
  T.topLeftCorner<3, 3>() << h, h, 0, h, -h, 0, 0, 0, std::numbers::sqrt2;
  return T;
}

/// \throws InputError unless all eigenvalues are positive beyond rounding.
void requireElliptic(const Matrix& tensor, const std::string& what, const std::string& unit) {
  constexpr double rounding = 1e-13;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(tensor, Eigen::EigenvaluesOnly);
  const double smallest = eigen.eigenvalues()[0];
  if (smallest > rounding * tensor.cwiseAbs().maxCoeff()) return;
  std::ostringstream message;
  message << "the smallest eigenvalue of " << what << " is " << smallest << ' ' << unit
          << ", expected > 0 (elliptic)";
  throw InputError(message.str());
}

Eigen::Index componentsIn(Plane plane) {
  return plane == Plane::stress ? 3 : 4;
}

/// Of isotropic elasticity without Poisson's effect, E = c 1.
Elasticity stiffestOf(const Anisotropy& anisotropy) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(anisotropy.stiffness, Eigen::EigenvaluesOnly);
  return {eigen.eigenvalues().maxCoeff(), 0};
}

template <class Law>
std::shared_ptr<const Material> make(const Law& law, const Anisotropy& anisotropy, const Elasticity& stiffest,
                                     Plane plane, const LawDescription& description) {
  if (plane == Plane::stress)
    return pointMaterial(OfAnyElasticity<Law>(law, anisotropy.stiffness, stiffest.young), description);
  const InPlaneStrain<Law> inStrain(law, stiffest);
  return pointMaterial(OfAnyElasticity<InPlaneStrain<Law>>(inStrain, anisotropy.stiffness, stiffest.young),
                       description);
}

/// The moduli in place of Young's modulus and Poisson's ratio.
LawDescription described(LawDescription law, const Anisotropy& anisotropy) {
  law.variant += (law.variant.empty() ? "" : ", ") + anisotropy.name;
  law.parameters.erase(law.parameters.begin(), law.parameters.begin() + 2);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(anisotropy.stiffness, Eigen::EigenvaluesOnly);
  law.parameters.insert(law.parameters.begin(), {{"smallest_modulus", eigen.eigenvalues().minCoeff(), "Pa"},
                                                 {"largest_modulus", eigen.eigenvalues().maxCoeff(), "Pa"}});
  return law;
}

}  // namespace

Anisotropy anisotropyOf(const Orthotropy& given, Plane plane) {
  const Eigen::Index n = componentsIn(plane);
  const auto& [e1, e2, e3] = given.young;
  const auto& [nu12, nu13, nu23] = given.poisson;
  Matrix compliance = Matrix::Zero(n, n);
  compliance(0, 0) = 1 / e1;
  compliance(1, 1) = 1 / e2;
  compliance(0, 1) = compliance(1, 0) = -nu12 / e1;
  compliance(2, 2) = 1 / given.shear;
  if (n == 4) {
    compliance(3, 3) = 1 / e3;
    compliance(0, 3) = compliance(3, 0) = -nu13 / e1;
    compliance(1, 3) = compliance(3, 1) = -nu23 / e2;
  }
  const Matrix T = basis(n).inverse();
  const Matrix onBasis = T.transpose() * compliance * T;
  requireElliptic(onBasis, "the compliance", "1/Pa");
  Matrix stiffness = onBasis.inverse();
  stiffness = (0.5 * (stiffness + stiffness.transpose())).eval();
  return {std::move(stiffness), "orthotropic"};
}

Anisotropy anisotropyOf(const Matrix& stiffness, Plane plane) {
  constexpr double rounding = 1e-12;
  if (stiffness.rows() != componentsIn(plane) || stiffness.cols() != stiffness.rows())
    throw InputError(plane == Plane::stress ? "expected three rows of three (s11, s22, s12 in plane stress)"
                                            : "expected four rows of four (s11, s22, s12, s33)");
  const double largest = stiffness.cwiseAbs().maxCoeff();
  if (!((stiffness - stiffness.transpose()).cwiseAbs().maxCoeff() <= rounding * largest))
    throw InputError("expected a symmetric matrix");
  const Matrix T = basis(stiffness.rows());
  const Matrix onBasis = T * (0.5 * (stiffness + stiffness.transpose())) * T.transpose();
  requireElliptic(onBasis, "the stiffness", "Pa");
  return {onBasis, "general"};
}

Anisotropy turned(const Anisotropy& anisotropy, double angle) {
  const double c = std::cos(2 * angle);
  const double s = std::sin(2 * angle);
  Matrix R = Matrix::Identity(anisotropy.stiffness.rows(), anisotropy.stiffness.cols());
  R.block<2, 2>(1, 1) << c, s, -s, c;  // into the axes of the body
  return {R.transpose() * anisotropy.stiffness * R, anisotropy.name};
}

std::shared_ptr<const Material> anisotropicMaterial(const Anisotropy& anisotropy, const StressLaw& flow,
                                                    Plane plane) {
  const Elasticity stiffest = stiffestOf(anisotropy);
  const double e = stiffest.young;
  const auto made = [&](const auto& law, const LawDescription& description) {
    return make(law, anisotropy, stiffest, plane, described(description, anisotropy));
  };
  const Pair a{plane == Plane::stress ? 0.5 : 1.5, 1.5};
  if (const auto* norton = std::get_if<NortonCreep>(&flow)) {
    requireValid(*norton);
    return made(NortonLaw({e, e}, a, *norton), describe(stiffest, *norton));
  }
  if (const auto* perzyna = std::get_if<Viscoplasticity>(&flow)) {
    requireValid(*perzyna);
    if (plane == Plane::stress && perzyna->projection != Projection::frobenius)
      throw InputError("expected projection = \"frobenius\" beside elasticity that is not isotropic");
    LawDescription description = describe(stiffest, *perzyna);
    if (plane == Plane::stress) description.variant = projectionNames[static_cast<int>(perzyna->projection)];
    return made(PerzynaLaw({e, e}, a, {1, 1}, *perzyna), description);
  }
  return made(ElasticLaw({e, e}), describe(stiffest));
}

}  // namespace mortier
