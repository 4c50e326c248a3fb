#include "material/law_check.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <random>

#include "base/dense_templates.h"
#include "base/worst.h"
#include "material/stress.h"

namespace mortier {
namespace {

class Trial {
 public:
  Trial(const Material& material, const LawRange& range)
      : material_(material), range_(range), n_(material.components()) {
    Matrix compliance;
    material.elasticStrain(Matrix::Identity(n_, n_), compliance);
    C_ = (compliance + compliance.transpose()) / 2;
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(C_);
    rootC_ = eigen.operatorSqrt();
    rootE_ = eigen.operatorInverseSqrt();
  }

  LawCheck run() {
    for (int i = 0; i < range_.samples; ++i) takeSample();
    for (size_t i = 0; i < stresses_.size(); ++i) takeMultiples(stresses_[i], strains_[i]);
    if (result_.lipschitz > 0) {
      result_.monotony /= result_.lipschitz;
      for (size_t i = 0; i < stresses_.size(); i += 4) takeTangents(stresses_[i], strains_[i]);
    }
    return result_;
  }

 private:
  Vector random(double size) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> decades(-3, 0);
    Vector direction(n_);
    for (double& each : direction) each = normal(random_);
    return direction.normalized() * (size * std::pow(10, decades(random_)));
  }

  [[nodiscard]] Vector rate(const Vector& stress, const Vector& strain) const {
    const Matrix s = stress;
    const Matrix e = strain;
    Matrix G;
    material_.viscoplasticRate(s, G, &e);
    return G.col(0);
  }

  void takeSample() {
    ++result_.samples;
    const Vector s = random(range_.stress);
    Vector e = random(range_.strain);
    if (n_ == 4) e[3] = 0;
    const Vector G = rate(s, e);
    if (!usable(G) || !takeSlopes(s, e)) return takeOverflow(s);
    ++result_.numbers;
    if (const double size = (rootC_ * s).norm() * (rootE_ * G).norm(); size > 0)
      result_.dissipation = std::min(result_.dissipation, s.dot(G) / size);
    takeTurns(s, e, G);
    stresses_.push_back(s);
    strains_.push_back(e);
  }

  /// Turned axes: in the plane q and r turn by twice the angle.
  void takeTurns(const Vector& s, const Vector& e, const Vector& G) {
    for (const double angle : {0.3, 0.9, 1.4}) {
      const auto turned = [&](Vector x) {
        if (n_ >= 6)
          x.head<6>() = turnedInSpace(x.head<6>(), angle);
        else
          x.segment<2>(1) = Eigen::Rotation2Dd(2 * angle) * Eigen::Vector2d(x.segment<2>(1));
        return x;
      };
      const Vector other = rate(turned(s), turned(e));
      const double size = std::max(G.norm(), other.norm());
      if (size > 0) result_.turning = worse(result_.turning, (other - turned(G)).norm() / size);
    }
  }

  static SpaceStress turnedInSpace(const SpaceStress& x, double angle) {
    const SpaceStress s = toSpaceCartesian(x);
    Eigen::Matrix3d tensor;
    tensor << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
    const Eigen::Matrix3d Q = (Eigen::AngleAxisd(angle, SpacePoint::UnitZ()) *
                               Eigen::AngleAxisd(1 - angle, SpacePoint(1, 2, 0).normalized()))
                                  .toRotationMatrix();
    const Eigen::Matrix3d t = Q * tensor * Q.transpose();
    return fromSpaceCartesian(SpaceStress{t(0, 0), t(1, 1), t(2, 2), t(0, 1), t(0, 2), t(1, 2)});
  }

  [[nodiscard]] bool usable(const Vector& G) const { return std::isfinite((rootE_ * G).squaredNorm()); }

  void takeOverflow(const Vector& s) {
    if (result_.overflow.size() == 0 || s.norm() < result_.overflow.norm()) result_.overflow = s;
  }

  void takeMultiples(const Vector& s, const Vector& e) {
    constexpr double factor = 1.25;
    const double strain = (C_ * s).norm();
    const double nearest = result_.overflow.size() == 0 ? 1 / strain : result_.overflow.norm() / s.norm();
    for (double multiple = 1; multiple * strain <= 1 && multiple < nearest; multiple *= factor)
      if (!usable(rate(multiple * s, e))) return takeOverflow(multiple * s);
  }

  /// \returns whether they are numbers.
  bool takeSlopes(const Vector& s, const Vector& e) {
    constexpr double part = 1e-6;
    const int count = material_.needsTotalStrain() ? 2 * n_ : n_;
    Matrix slopes(n_, count);
    for (int k = 0; k < count; ++k) {
      const bool byStress = k < n_;
      const double h = part * (byStress ? s.norm() : e.norm());
      const Vector d = h * Vector::Unit(n_, k % n_);
      slopes.col(k) = byStress ? Vector((rate(s + d, e) - rate(s - d, e)) / (2 * h))
                               : Vector((rate(s, e + d) - rate(s, e - d)) / (2 * h));
    }
    if (!slopes.allFinite()) return false;
    const Matrix byStress = rootE_ * slopes.leftCols(n_) * rootE_;
    Matrix all = byStress;
    if (count > n_) {
      all.conservativeResize(n_, count);
      all.rightCols(n_) = rootE_ * slopes.rightCols(n_) * rootC_;
    }
    const double steep =
        std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix>(Matrix(all * all.transpose())).eigenvalues()[n_ - 1]);
    if (!std::isfinite(steep)) return false;
    if (!(steep <= result_.lipschitz)) {
      result_.lipschitz = steep;
      result_.steepest = s;
    }
    const Matrix symmetric = (byStress + byStress.transpose()) / 2;
    result_.monotony =
        std::min(result_.monotony, Eigen::SelfAdjointEigenSolver<Matrix>(symmetric).eigenvalues()[0]);
    return true;
  }

  /// The stress at the end of a step, linearised there.
  Vector solve(const MaterialStep& step, Vector stress, Linearisation& law) const {
    constexpr int most = 200;
    constexpr double still = 1e-14;
    for (int k = 0; k < most; ++k) {
      const double change = material_.linearise(step, Matrix(stress), law, 0, 1).change;
      stress = law.predictor.col(0);
      if (!(change > still * stress.norm())) break;
    }
    return stress;
  }

  /// Steps that end at a stress and a strain.
  void takeTangents(const Vector& s, const Vector& e) {
    constexpr double part = 1e-5;
    const Vector G = rate(s, e);
    for (double decade = -5; decade <= 5; decade += 2) {
      const double weight = std::pow(10, decade) / result_.lipschitz;
      const Matrix stress0 = s / 2;
      const Vector strain = C_ * (s / 2) + weight * G;
      const Matrix strain0 = e - strain;
      Linearisation law = material_.room(1);
      const Matrix at = strain;
      const Vector end = solve({weight, stress0, at, false, &strain0}, s, law);
      double size = 0;
      double off = 0;
      for (int k = 0; k < (n_ >= 6 ? 6 : 3); ++k) {
        const Vector d = part * strain.norm() * Vector::Unit(n_, k);
        Linearisation other = material_.room(1);
        const Matrix above = strain + d;
        const Matrix below = strain - d;
        const Vector difference = (solve({weight, stress0, above, false, &strain0}, end, other) -
                                   solve({weight, stress0, below, false, &strain0}, end, other)) /
                                  (2 * d.norm());
        const Vector tangent = stressOf(law, Vector::Unit(n_, k), 0);
        size = std::max(size, difference.norm());
        off = worse(off, (difference - tangent).norm());
      }
      if (!(off / size <= result_.tangent)) {
        result_.tangent = off / size;
        result_.worstTangent = s;
      }
    }
  }

  const Material& material_;
  LawRange range_;
  int n_;
  Matrix C_;
  Matrix rootC_;
  Matrix rootE_;
  std::mt19937 random_{1};
  std::vector<Vector> stresses_;
  std::vector<Vector> strains_;
  LawCheck result_;
};

}  // namespace

LawCheck checkLaw(const Material& material, const LawRange& range) {
  return Trial(material, range).run();
}

}  // namespace mortier
