#include "material/anisotropy.h"

#include <Eigen/Geometry>
#include <sstream>

#include "base/dense_templates.h"
#include "base/error.h"
#include "material/point_material.h"
#include "material/space.h"

namespace mortier {
namespace {

// Linearised, the law of any elasticity (below) has H = H0 + F F': the change of stress and the moduli of the
// isotropic law are corrected by
//   H^-1 = H0^-1 - B M^-1 B',   B = H0^-1 F,   M = 1 + F'B,
// all of positive matrices, whatever flows.
template <int n>
void soften(const Eigen::Matrix<double, n, n>& F, PointAnswer<n>& answer) {
  std::array<Lanes, n* n>& D = answer.moduli;  // column major, as all here
  std::array<Lanes, n * n> B;
  std::array<Lanes, n*(n + 1)> X;  // F'D and F' change, then M^-1 of it
  std::array<Lanes, n * n> M;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      B[n * j + i] = 0;
      X[n * j + i] = 0;
      for (int k = 0; k < n; ++k) {
        B[n * j + i] += D[n * k + i] * F(k, j);
        X[n * j + i] += F(k, i) * D[n * j + k];
      }
    }
  for (int i = 0; i < n; ++i) {
    X[n * n + i] = 0;
    for (int k = 0; k < n; ++k) X[n * n + i] += F(k, i) * answer.change[k];
  }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      M[n * j + i] = i == j ? 1 : 0;
      for (int k = 0; k < n; ++k) M[n * j + i] += F(k, i) * B[n * j + k];
    }
  for (int k = 0; k < n; ++k)  // Gauss; M is positive
    for (int i = k + 1; i < n; ++i) {
      const Lanes factor = M[n * k + i] / M[n * k + k];
      for (int j = k + 1; j < n; ++j) M[n * j + i] -= factor * M[n * j + k];
      for (int j = 0; j <= n; ++j) X[n * j + i] -= factor * X[n * j + k];
    }
  for (int j = 0; j <= n; ++j)
    for (int k = n - 1; k >= 0; --k) {
      for (int i = k + 1; i < n; ++i) X[n * j + k] -= M[n * i + k] * X[n * j + i];
      X[n * j + k] /= M[n * k + k];
    }
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i < n; ++i) {
      Lanes& entry = j < n ? D[n * j + i] : answer.change[i];
      for (int k = 0; k < n; ++k) entry -= B[n * k + i] * X[n * j + k];
    }
}

// A law with any symmetric elliptic E made of the same law with an isotropic one. With E0 = c 1, c the
// largest eigenvalue of E (isotropic, nu = 0), E^-1 = E0^-1 + F F', and
//   E0^-1 (s - s0) + weight G(s) = strain - F F' (s - s0)
// is the law of E.
template <class Law>
class OfAnyElasticity {
  static constexpr int n = Law::components;
  using Components = std::array<Lanes, n>;
  using Square = Eigen::Matrix<double, n, n>;

 public:
  static constexpr int components = n;
  static constexpr bool linear = Law::linear;
  static constexpr bool needsTotalStrain = false;

  /// \param law  with the isotropic elasticity of modulus `largest`, the largest eigenvalue of E
  OfAnyElasticity(Law law, const Matrix& E, double largest) : law_(std::move(law)) {
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(E);
    const Eigen::Array<double, n, 1> inverse = eigen.eigenvalues().array().inverse();
    const Eigen::Array<double, n, 1> beyond = (inverse - 1 / largest).max(0);
    inverse_ = eigen.eigenvectors() * inverse.matrix().asDiagonal() * eigen.eigenvectors().transpose();
    F_ = eigen.eigenvectors() * beyond.sqrt().matrix().asDiagonal();
    excess_ = F_ * F_.transpose();
  }

  [[nodiscard]] bool symmetric() const { return law_.symmetric(); }
  [[nodiscard]] double stressScale() const { return law_.stressScale(); }
  [[nodiscard]] double stiffness(double weight) const { return law_.stiffness(weight); }
  template <class Scalar>
  [[nodiscard]] auto flows(const std::array<Scalar, n>& stress) const {
    return law_.flows(stress);
  }
  [[nodiscard]] Lanes penalty(const Components& stress) const { return law_.penalty(stress); }
  [[nodiscard]] Components rate(const Components& stress, const Components& total) const {
    return law_.rate(stress, total);
  }
  [[nodiscard]] Components elasticStrain(const Components& stress) const { return times(inverse_, stress); }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress) const {
    return -inverse_.template block<1, 3>(n - 1, 0).dot(stress) / inverse_(n - 1, n - 1);
  }

  [[nodiscard]] PointAnswer<n> linearise(PointStep<n> point) const {
    Components moved;
    for (int k = 0; k < n; ++k) moved[k] = point.stress[k] - point.stress0[k];
    moved = times(excess_, moved);
    for (int k = 0; k < n; ++k) point.strain[k] -= moved[k];
    PointAnswer<n> answer = law_.linearise(point);
    soften<n>(F_, answer);
    for (int k = 0; k < n; ++k) answer.predictor[k] = point.stress[k] + answer.change[k];
    return answer;
  }
  /// The law is met halfway, as by elasticity.
  [[nodiscard]] PointAnswer<n> regularise(const PointStep<n>& point, const Lanes& /*penalty*/) const {
    PointAnswer<n> answer = linearise(point);
    for (Lanes& change : answer.change) change *= 0.5;
    return answer;
  }

 private:
  static Components times(const Square& matrix, const Components& x) {
    Components y;
    for (int i = 0; i < n; ++i) {
      y[i] = matrix(i, 0) * x[0];
      for (int k = 1; k < n; ++k) y[i] += matrix(i, k) * x[k];
    }
    return y;
  }

  Law law_;
  Square inverse_;  ///< E^-1 [1/Pa]
  Square F_;
  Square excess_;  ///< F F'
};

/// From (s11, s22, s12) to (p, q, r), s33 as it is; or from s11, s22, s12, s33, s13, s23 to those of space.
Matrix basis(Eigen::Index n) {
  constexpr double h = std::numbers::sqrt2 / 2;
  Matrix T = Matrix::Identity(n, n);
  constexpr std::array inSpace{0, 1, 3, 2, 4, 5};
  if (n < 6)
    T.topLeftCorner<3, 3>() << h, h, 0, h, -h, 0, 0, 0, std::numbers::sqrt2;
  else
    for (int j = 0; j < 6; ++j) T.col(j) = fromSpaceCartesian(SpaceStress::Unit(inSpace[j]));
  return T;
}

/// Rows and columns of the components in a tensor.
constexpr std::array tensorRows{0, 1, 0, 2, 0, 1};
constexpr std::array tensorColumns{0, 1, 1, 2, 2, 2};

Vector componentsOf(const Eigen::Matrix3d& tensor, Eigen::Index n) {
  Vector components(n);
  for (int k = 0; k < n; ++k) components[k] = tensor(tensorRows[k], tensorColumns[k]);
  return components;
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
  return plane == Plane::stress ? 3 : plane == Plane::none ? 6 : 4;
}

/// Of isotropic elasticity without Poisson's effect, E = c 1.
Elasticity stiffestOf(const Anisotropy& anisotropy) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(anisotropy.stiffness, Eigen::EigenvaluesOnly);
  return {eigen.eigenvalues().maxCoeff(), 0};
}

template <class Law>
std::shared_ptr<const Material> make(const Law& law, const Anisotropy& anisotropy, const Elasticity& stiffest,
                                     Plane plane, const LawDescription& description) {
  const auto made = [&]<class Whole>(const Whole& whole) {
    return pointMaterial(OfAnyElasticity<Whole>(whole, anisotropy.stiffness, stiffest.young), description);
  };
  if constexpr (Law::components == 5)
    return made(InSpace<Law>(law, stiffest));
  else
    return plane == Plane::stress ? made(law) : made(InPlaneStrain<Law>(law, stiffest));
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

/// \tparam n  directions of the flow
template <size_t n>
std::shared_ptr<const Material> makeAny(const Anisotropy& anisotropy, const StressLaw& flow, Plane plane) {
  const Elasticity stiffest = stiffestOf(anisotropy);
  const double e = stiffest.young;
  const auto made = [&](const auto& law, const LawDescription& description) {
    return make(law, anisotropy, stiffest, plane, described(description, anisotropy));
  };
  const Pair a{plane == Plane::stress ? 0.5 : 1.5, 1.5};
  if (const auto* norton = std::get_if<NortonCreep>(&flow)) {
    requireValid(*norton);
    return made(NortonLaw<n>({e, e}, a, *norton), describe(stiffest, *norton));
  }
  if (const auto* perzyna = std::get_if<Viscoplasticity>(&flow)) {
    requireValid(*perzyna);
    if (plane == Plane::stress && perzyna->projection != Projection::frobenius)
      throw InputError("expected projection = \"frobenius\" beside elasticity that is not isotropic");
    LawDescription description = describe(stiffest, *perzyna);
    if (plane == Plane::stress) description.variant = projectionNames[static_cast<int>(perzyna->projection)];
    return made(PerzynaLaw<n>({e, e}, a, {1, 1}, *perzyna), description);
  }
  return made(ElasticLaw<n>({e, e}), describe(stiffest));
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
  compliance(2, 2) = 1 / given.shear[0];
  for (int k = 4; k < n; ++k) compliance(k, k) = 1 / given.shear[k - 3];
  if (n > 3) {
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
                     : plane == Plane::none ? "expected six rows of six (s11, s22, s12, s33, s13, s23)"
                                            : "expected four rows of four (s11, s22, s12, s33)");
  const double largest = stiffness.cwiseAbs().maxCoeff();
  if (!((stiffness - stiffness.transpose()).cwiseAbs().maxCoeff() <= rounding * largest))
    throw InputError("expected a symmetric matrix");
  const Matrix T = basis(stiffness.rows());
  const Matrix onBasis = T * (0.5 * (stiffness + stiffness.transpose())) * T.transpose();
  requireElliptic(onBasis, "the stiffness", "Pa");
  return {onBasis, "general"};
}

Anisotropy turned(const Anisotropy& anisotropy, const Eigen::Matrix3d& axes) {
  if (axes == Eigen::Matrix3d::Identity()) return anisotropy;
  const Eigen::Index n = anisotropy.stiffness.rows();
  const Matrix components = basis(n).inverse();
  Matrix R(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
    for (int k = 0; k < n; ++k)
      tensor(tensorRows[k], tensorColumns[k]) = tensor(tensorColumns[k], tensorRows[k]) = components(k, j);
    R.col(j) = basis(n) * componentsOf(axes * tensor * axes.transpose(), n);
  }
  return {R * anisotropy.stiffness * R.transpose(), anisotropy.name};
}

Eigen::Matrix3d axesAt(double angle) {
  return Eigen::AngleAxisd(angle, SpacePoint::UnitZ()).toRotationMatrix();
}

Vector alongAxes(const std::array<double, 3>& values, const Eigen::Matrix3d& axes, Plane plane) {
  const Eigen::Map<const Eigen::Vector3d> along(values.data());
  return basis(componentsIn(plane)) *
         componentsOf(axes * along.asDiagonal() * axes.transpose(), componentsIn(plane));
}

std::shared_ptr<const Material> anisotropicMaterial(const Anisotropy& anisotropy, const StressLaw& flow,
                                                    Plane plane) {
  return plane == Plane::none ? makeAny<5>(anisotropy, flow, plane) : makeAny<3>(anisotropy, flow, plane);
}

}  // namespace mortier
