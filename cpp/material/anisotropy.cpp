#include "material/anisotropy.h"

#include <Eigen/Geometry>
#include <sstream>

#include "base/dense_templates.h"
#include "base/error.h"
#include "base/worst.h"
#include "material/interior_path.h"
#include "material/parts.h"

namespace mortier {
namespace {

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

// With E0 = c 1, c the largest eigenvalue of E (isotropic, nu = 0), E^-1 = E0^-1 + F F', and the law of E
//   E0^-1 (s - s0) + weight G(s) = strain - F F' (s - s0)
// is that of E0 at another strain. Linearised, it has H = H0 + F F': changes of stress and moduli are
// corrected by
//   H^-1 = H0^-1 - B M^-1 B',   B = H0^-1 F,   M = 1 + F'B,
// all of positive matrices, whatever flows.
class AnisotropicMaterial final : public Material, public Pointwise {
 public:
  AnisotropicMaterial(const Anisotropy& anisotropy, std::shared_ptr<const Material> isotropic,
                      const std::vector<double>& angles)
      : isotropic_(std::move(isotropic)), name_(anisotropy.name) {
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(anisotropy.stiffness);
    moduli_ = eigen.eigenvalues();
    const Vector inverse = moduli_.cwiseInverse();
    rootInverse_ = eigen.eigenvectors() * inverse.cwiseSqrt().asDiagonal();
    F_ =
        eigen.eigenvectors() * (inverse.array() - 1 / moduli_.maxCoeff()).max(0).sqrt().matrix().asDiagonal();
    for (const double angle : angles)
      axes_.push_back({std::cos(2 * angle), std::sin(2 * angle), std::cos(angle), std::sin(angle)});
  }

  /// The moduli in place of Young's modulus and Poisson's ratio.
  [[nodiscard]] std::vector<LawDescription> laws() const override {
    std::vector<LawDescription> laws = isotropic_->laws();
    for (LawDescription& law : laws) {
      law.variant += (law.variant.empty() ? "" : ", ") + name_;
      law.parameters[0] = {"smallest_modulus", moduli_.minCoeff(), "Pa"};
      law.parameters[1] = {"largest_modulus", moduli_.maxCoeff(), "Pa"};
    }
    return laws;
  }
  [[nodiscard]] int components() const override { return isotropic_->components(); }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress, int point) const override {
    if (components() != 4) return 0;
    const ComponentMatrix root = atPoint(rootInverse_, point);
    const ComponentMatrix inverse = root * root.transpose();
    return -inverse.block<1, 3>(3, 0).dot(stress) / inverse(3, 3);
  }
  [[nodiscard]] std::shared_ptr<const Material> restricted(const std::vector<int>& points) const override {
    auto own = std::make_shared<AnisotropicMaterial>(*this);
    if (axes_.empty()) return own;
    own->axes_.clear();
    for (const int point : points) own->axes_.push_back(axes_[point]);
    return own;
  }
  [[nodiscard]] bool symmetricTangent() const override { return isotropic_->symmetricTangent(); }
  [[nodiscard]] bool linear() const override { return isotropic_->linear(); }
  [[nodiscard]] bool needsTotalStrain() const override { return isotropic_->needsTotalStrain(); }
  [[nodiscard]] double stressScale() const override { return isotropic_->stressScale(); }
  [[nodiscard]] double stiffness(double weight) const override { return isotropic_->stiffness(weight); }
  [[nodiscard]] bool flows(const Matrix& stress, int point, const Matrix* strain) const override {
    return isotropic_->flows(stress, point, strain);
  }

  using Material::choosePenalty, Material::elasticStrain, Material::interiorPath, Material::viscoplasticRate;

  LawReport linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                      int end) const override {
    return linearise(step, stress, result, begin, end, 1);
  }
  /// The law is met halfway, as by elasticity.
  LawReport regularise(const MaterialStep& step, const Matrix& stress, const Vector& /*penalty*/,
                       double relaxation, Linearisation& result, int begin, int end) const override {
    return linearise(step, stress, result, begin, end, 0.5 * relaxation);
  }
  void choosePenalty(const Matrix& stress, Vector& penalty, int begin, int end) const override {
    isotropic_->choosePenalty(stress, penalty, begin, end);
  }
  void viscoplasticRate(const MaterialState& state, Matrix& rate, int begin, int end) const override {
    isotropic_->viscoplasticRate(state, rate, begin, end);
  }
  void elasticStrain(const Matrix& stress, Matrix& strain, int begin, int end) const override {
    for (int i = begin; i < end; ++i) {
      const ComponentMatrix root = atPoint(rootInverse_, i);
      strain.col(i) = root * (root.transpose() * stress.col(i));
    }
  }
  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(const PathStart& start,
                                                           std::vector<int> points) const override {
    return newtonPath(*this, start, std::move(points));
  }

 private:
  /// Columns in the axes of a point: q and r turned, and in space the shears 13 and 23.
  [[nodiscard]] ComponentMatrix atPoint(const ComponentMatrix& columns, int point) const {
    ComponentMatrix turned = columns;
    if (axes_.empty()) return turned;
    const auto& [c2, s2, c, s] = axes_[point];
    const auto turnPair = [&](int k, double cosine, double sine) {
      turned.row(k) = cosine * columns.row(k) - sine * columns.row(k + 1);
      turned.row(k + 1) = cosine * columns.row(k + 1) + sine * columns.row(k);
    };
    turnPair(1, c2, s2);
    if (columns.rows() == 6) turnPair(3, c, s);
    return turned;
  }

  /// \param part  of the change of stress that the predictor takes
  LawReport linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                      int end, double part) const {
    const int points = end - begin;
    const Matrix s = stress.middleCols(begin, points);
    const Matrix s0 = step.stress0.middleCols(begin, points);
    Matrix strain = step.strain.middleCols(begin, points);
    for (int i = 0; i < points; ++i) {
      const ComponentMatrix F = atPoint(F_, begin + i);
      strain.col(i) -= F * (F.transpose() * (s.col(i) - s0.col(i)));
    }
    Linearisation law = isotropic_->room(points);
    const LawReport report =
        isotropic_->linearise({step.weight, s0, strain, step.anticipate}, s, law, 0, points);
    Worst worst;
    for (int i = 0; i < points; ++i) {
      const ComponentMatrix F = atPoint(F_, begin + i);
      const ComponentMatrix moduli = moduliAt(law, i);
      const ComponentMatrix B = moduli * F;
      const Eigen::LLT<ComponentMatrix> M(ComponentMatrix::Identity(F.rows(), F.rows()) + F.transpose() * B);
      PointVector change = law.predictor.col(i) - s.col(i);
      change -= B * M.solve(PointVector(F.transpose() * change));
      worst.add(part * change.cwiseAbs().maxCoeff<Eigen::PropagateNaN>());
      result.predictor.col(begin + i) = s.col(i) + part * change;
      setModuli(moduli - B * M.solve(ComponentMatrix(B.transpose())), begin + i, result);
    }
    return {worst.value(), report.elastic};
  }

  std::shared_ptr<const Material> isotropic_;
  std::string name_;
  Vector moduli_;                ///< eigenvalues of E [Pa]
  ComponentMatrix rootInverse_;  ///< its product with the transpose is E^-1 [1/Pa]
  ComponentMatrix F_;
  std::vector<std::array<double, 4>> axes_;  ///< cosine and sine of twice the angle of a point, and of it
};

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

Elasticity stiffestOf(const Anisotropy& anisotropy) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(anisotropy.stiffness, Eigen::EigenvaluesOnly);
  return {eigen.eigenvalues().maxCoeff(), 0};
}

std::shared_ptr<const Material> anisotropicMaterial(const Anisotropy& anisotropy,
                                                    std::shared_ptr<const Material> isotropic,
                                                    const std::vector<double>& angles) {
  return std::make_shared<AnisotropicMaterial>(anisotropy, std::move(isotropic), angles);
}

}  // namespace mortier
