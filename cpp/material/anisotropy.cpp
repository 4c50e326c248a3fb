#include "material/anisotropy.h"

#include <Eigen/Geometry>

#include "base/dense_templates.h"
#include "base/digits.h"
#include "base/error.h"
#include "material/component_basis.h"
#include "material/interior_path.h"
#include "material/point_material.h"

namespace mortier {
namespace {

/// From (s11, s22, s12) to (p, q, r), s33 as it is; or from s11, s22, s12, s33, s13, s23 to those of space.
Matrix basis(Eigen::Index n) {
  return n == 6 ? Matrix(byComponents<6>()) : Matrix(byComponents<4>().topLeftCorner(n, n));
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
  throw InputError("the smallest eigenvalue of " + what + " is " + digits(smallest, 6) + " " + unit +
                   ", expected > 0 (elliptic)");
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
/// \param F  column major  \param D, change  of the isotropic law, corrected
template <size_t n>
void soften(const std::array<Lanes, n * n>& F, std::array<Lanes, n * n>& D, std::array<Lanes, n>& change) {
  std::array<Lanes, n * n> B;
  std::array<Lanes, n*(n + 1)> X;  // F'D and F' change, then M^-1 of it
  std::array<Lanes, n * n> M;
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < n; ++i) {
      B[n * j + i] = X[n * j + i] = 0;
      for (size_t k = 0; k < n; ++k) {
        B[n * j + i] += D[n * k + i] * F[n * j + k];
        X[n * j + i] += F[n * i + k] * D[n * j + k];
      }
    }
  for (size_t i = 0; i < n; ++i) {
    X[n * n + i] = 0;
    for (size_t k = 0; k < n; ++k) X[n * n + i] += F[n * i + k] * change[k];
  }
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < n; ++i) {
      M[n * j + i] = i == j ? 1 : 0;
      for (size_t k = 0; k < n; ++k) M[n * j + i] += F[n * i + k] * B[n * j + k];
    }
  for (size_t k = 0; k < n; ++k)  // Gauss; M is positive
    for (size_t i = k + 1; i < n; ++i) {
      const Lanes factor = M[n * k + i] / M[n * k + k];
      for (size_t j = k + 1; j < n; ++j) M[n * j + i] -= factor * M[n * j + k];
      for (size_t j = 0; j <= n; ++j) X[n * j + i] -= factor * X[n * j + k];
    }
  for (size_t j = 0; j <= n; ++j)
    for (size_t k = n; k-- > 0;) {
      for (size_t i = k + 1; i < n; ++i) X[n * j + k] -= M[n * i + k] * X[n * j + i];
      X[n * j + k] /= M[n * k + k];
    }
  for (size_t j = 0; j <= n; ++j)
    for (size_t i = 0; i < n; ++i) {
      Lanes& entry = j < n ? D[n * j + i] : change[i];
      for (size_t k = 0; k < n; ++k) entry -= B[n * k + i] * X[n * j + k];
    }
}

/// Symmetric H^-1 of a batch, column major.
template <size_t n>
std::array<Lanes, n * n> loadModuli(const Batch& batch, const Linearisation& law) {
  constexpr size_t block = n < 6 ? 3 : 6;
  const auto lower = batch.load<block*(block + 1) / 2>(law.moduli.data());
  std::array<Lanes, n * n> D;
  size_t next = 0;
  for (size_t j = 0; j < block; ++j)
    for (size_t i = j; i < block; ++i) D[n * j + i] = D[n * i + j] = lower[next++];
  if constexpr (n > block) {
    const auto row = batch.load<n>(law.beyond.data());
    for (size_t k = 0; k < n; ++k) D[n * k + block] = D[n * block + k] = row[k];
  }
  return D;
}

/// \tparam n  components of the stress
template <size_t n>
class AnisotropicMaterial final : public Material {
  using Square = Eigen::Matrix<double, n, n>;

 public:
  /// \pre the moduli of the isotropic law are symmetric
  AnisotropicMaterial(const Anisotropy& anisotropy, std::shared_ptr<const Material> isotropic,
                      const std::vector<double>& angles)
      : isotropic_(std::move(isotropic)), name_(anisotropy.name) {
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(anisotropy.stiffness);
    moduli_ = eigen.eigenvalues();
    const Vector inverse = moduli_.cwiseInverse();
    rootInverse_ = eigen.eigenvectors() * inverse.cwiseSqrt().asDiagonal();
    F_ =
        eigen.eigenvectors() * (inverse.array() - 1 / moduli_.maxCoeff()).max(0).sqrt().matrix().asDiagonal();
    axes_.resize(4, static_cast<Eigen::Index>(angles.size()));
    for (size_t i = 0; i < angles.size(); ++i)
      axes_.col(static_cast<Eigen::Index>(i)) << std::cos(2 * angles[i]), std::sin(2 * angles[i]),
          std::cos(angles[i]), std::sin(angles[i]);
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
  [[nodiscard]] int components() const override { return n; }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress, int point) const override {
    if constexpr (n != 4) return 0;
    const Square root = atPoint(rootInverse_, point);
    const Square inverse = root * root.transpose();
    return -inverse.template block<1, 3>(n - 1, 0).dot(stress) / inverse(n - 1, n - 1);
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
      const Square root = atPoint(rootInverse_, i);
      strain.col(i) = root * (root.transpose() * stress.col(i));
    }
  }
  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(const PathStart& start,
                                                           std::vector<int> points) const override {
    return newtonPath(*this, start, std::move(points));
  }

 private:
  /// Columns in axes that are turned: q and r, and in space the shears 13 and 23.
  template <class Scalar>
  static std::array<Scalar, n * n> turned(std::array<Scalar, n * n> columns,
                                          const std::array<Scalar, 4>& axes) {
    const auto turnPair = [&](Scalar& first, Scalar& second, const Scalar& cosine, const Scalar& sine) {
      const Scalar x = first;
      first = cosine * x - sine * second;
      second = cosine * second + sine * x;
    };
    for (size_t j = 0; j < n; ++j) {
      turnPair(columns[n * j + 1], columns[n * j + 2], axes[0], axes[1]);
      if constexpr (n == 6) turnPair(columns[n * j + 3], columns[n * j + 4], axes[2], axes[3]);
    }
    return columns;
  }
  [[nodiscard]] Square atPoint(const Square& columns, int point) const {
    if (axes_.size() == 0) return columns;
    std::array<double, n * n> all;
    std::copy(columns.data(), columns.data() + all.size(), all.begin());
    all = turned<double>(all, {axes_(0, point), axes_(1, point), axes_(2, point), axes_(3, point)});
    return Eigen::Map<const Square>(all.data());
  }
  [[nodiscard]] std::array<Lanes, n * n> factorAt(const Batch& batch) const {
    std::array<Lanes, n * n> F;
    for (size_t k = 0; k < F.size(); ++k) F[k] = F_.data()[k];
    return axes_.size() == 0 ? F : turned<Lanes>(F, batch.load<4>(axes_.data()));
  }

  /// \param part  of the change of stress that the predictor takes
  LawReport linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                      int end, double part) const {
    const int points = end - begin;
    const Matrix s = stress.middleCols(begin, points);
    const Matrix s0 = step.stress0.middleCols(begin, points);
    Matrix strain(n, points);
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      const std::array<Lanes, n* n> F = factorAt(batch);
      const auto from = batch.load<n>(step.stress0.data());
      auto moved = batch.load<n>(stress.data());
      auto rest = batch.load<n>(step.strain.data());
      for (size_t k = 0; k < n; ++k) moved[k] -= from[k];
      for (size_t j = 0; j < n; ++j) {
        Lanes along = 0;
        for (size_t k = 0; k < n; ++k) along += F[n * j + k] * moved[k];
        for (size_t k = 0; k < n; ++k) rest[k] -= F[n * j + k] * along;
      }
      Batch(i - begin, points).store(rest, strain.data());
    }
    Linearisation law = isotropic_->room(points);
    const LawReport report =
        isotropic_->linearise({step.weight, s0, strain, step.anticipate}, s, law, 0, points);
    Largest largest;
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      const Batch own(i - begin, points);
      std::array<Lanes, n* n> moduli = loadModuli<n>(own, law);
      auto predictor = batch.load<n>(stress.data());
      auto change = own.load<n>(law.predictor.data());
      for (size_t k = 0; k < n; ++k) change[k] -= predictor[k];
      soften<n>(factorAt(batch), moduli, change);
      for (size_t k = 0; k < n; ++k) {
        change[k] *= part;
        predictor[k] += change[k];
      }
      largest.add(change);
      batch.store(predictor, result.predictor.data());
      storeModuli<n>(batch, moduli, result);
    }
    return {largest.value(), report.elastic};
  }

  std::shared_ptr<const Material> isotropic_;
  std::string name_;
  Vector moduli_;       ///< eigenvalues of E [Pa]
  Square rootInverse_;  ///< its product with the transpose is E^-1 [1/Pa]
  Square F_;
  Matrix axes_;  ///< 4 x points: cosine and sine of twice the angle, and of it; empty where all have the same
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
  const int components = isotropic->components();
  if (components == 3)
    return std::make_shared<AnisotropicMaterial<3>>(anisotropy, std::move(isotropic), angles);
  if (components == 4)
    return std::make_shared<AnisotropicMaterial<4>>(anisotropy, std::move(isotropic), angles);
  return std::make_shared<AnisotropicMaterial<6>>(anisotropy, std::move(isotropic), angles);
}

}  // namespace mortier
