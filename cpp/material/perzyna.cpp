#include "material/perzyna.h"

#include <cmath>
#include <sstream>

#include "base/error.h"
#include "material/stress.h"
#include "material/yield_domain.h"

namespace mortier {
namespace {

using Eigen::Array3d;

void require(bool holds, const char* name, double value, const char* expected) {
  if (holds && std::isfinite(value)) return;
  std::ostringstream message;
  message << name << " = " << value << ", expected " << expected;
  throw InputError(message.str());
}

/// Writes diag(d) - c x y' as a 3 x 3 matrix, column major.
void storeModuli(const Array3d& d, double c, const Array3d& x, const Array3d& y, double* moduli) {
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) moduli[3 * j + i] = -(c * x[i]) * y[j];
    moduli[3 * j + j] += d[j];
  }
}

/// The largest entry so far; NaN stays.
double largest(double soFar, const Array3d& x) {
  for (int i = 0; i < 3; ++i)
    if (!(std::abs(x[i]) <= soFar)) soFar = std::abs(x[i]);
  return soFar;
}

class Elastic final : public Material {
 public:
  explicit Elastic(const Elasticity& elasticity) : e_(elasticity.moduli()) {}

  [[nodiscard]] int components() const override { return 3; }
  [[nodiscard]] bool symmetricTangent() const override { return true; }
  [[nodiscard]] bool linear() const override { return true; }
  [[nodiscard]] double stressScale() const override { return 0; }
  [[nodiscard]] double stiffness(double /*weight*/) const override { return 0; }

  double linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                   int end) const override {
    double residual = 0;
    for (int i = begin; i < end; ++i) {
      const Array3d s1 = step.stress0.col(i).array() + e_ * step.strain.col(i).array();
      residual = largest(residual, s1 - stress.col(i).array());
      result.predictor.col(i) = s1;
      storeModuli(e_, 0, e_, e_, &result.moduli(0, i));
    }
    return residual;
  }

  void viscoplasticRate(const Matrix& stress, Matrix& rate) const override {
    rate.setZero(stress.rows(), stress.cols());
  }

  void elasticStrain(const Matrix& stress, Matrix& strain) const override {
    strain = e_.inverse().matrix().asDiagonal() * stress;
  }

  [[nodiscard]] bool flows(const Matrix& /*stress*/, int /*point*/) const override { return false; }

 private:
  Array3d e_;
};

class Perzyna final : public Material {
 public:
  Perzyna(const Elasticity& elasticity, const Viscoplasticity& law)
      : e_(elasticity.moduli()),
        law_(law),
        domain_(yieldDomain(law.yieldStress, projectionNorm(law.projection))) {}

  [[nodiscard]] int components() const override { return 3; }
  [[nodiscard]] bool symmetricTangent() const override { return law_.projection == Projection::frobenius; }
  [[nodiscard]] bool linear() const override { return false; }
  [[nodiscard]] double stressScale() const override { return law_.yieldStress; }
  [[nodiscard]] double stiffness(double weight) const override {
    return weight / (2 * law_.viscosity) * e_.maxCoeff();
  }

  // With v = strain - E^-1 (s - s0), theta = weight/(2 lambda) and t = s + c v, the law v = theta (s - P_B s)
  // reads
  //   v = theta kappa (t - P_B t),  kappa = 1/(1 + c theta),
  // and its linearisation in s and strain is (yield_domain.h)
  //   H ds = B d + r,  H = E^-1 + theta kappa diag(softening) + (theta/z) x y',
  // a rank-one change of a diagonal matrix. c = 0 judges yielding by s alone; `anticipate` by a stress that v
  // moves by up to E v while v is small, never far beyond the yield surface when it is large.
  double linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                   int end) const override {
    constexpr double reach = 100;  // in yield stresses, for v >> sigma_Y/E
    const double theta = step.weight / (2 * law_.viscosity);
    double residual = 0;
    for (int i = begin; i < end; ++i) {
      const Array3d s = stress.col(i).array();
      const Array3d v = step.strain.col(i).array() - (s - step.stress0.col(i).array()) / e_;
      const double c =
          step.anticipate ? 1 / (1 / e_[1] + v.matrix().norm() / (reach * law_.yieldStress)) : 0.0;
      const Array3d t = s + c * v;
      Array3d increment;
      if (!domain_.yields(t)) {
        increment = e_ * v;
        storeModuli(e_, 0, e_, e_, &result.moduli(0, i));
      } else {
        const double kappa = 1 / (1 + c * theta);
        const ProjectionOnYield P = domain_.project(t, kappa);
        Array3d r = v - theta * kappa * P.overstress;
        if (c > 0) r = P.stretch * r + c * theta * (P.y * r).sum() / P.z * P.x;
        const Array3d h = (1 / e_ + theta * kappa * P.softening).inverse();
        const Array3d hx = h * P.x;
        const Array3d hy = h * P.y;
        const double rankOne = theta / (P.z + theta * (P.y * hx).sum());
        increment = h * r - rankOne * (hy * r).sum() * hx;
        storeModuli(h, rankOne, hx, hy, &result.moduli(0, i));
      }
      residual = largest(residual, increment);
      result.predictor.col(i) = s + increment;
    }
    return residual;
  }

  void viscoplasticRate(const Matrix& stress, Matrix& rate) const override {
    rate.resize(stress.rows(), stress.cols());
    for (Eigen::Index i = 0; i < stress.cols(); ++i) {
      const Array3d s = stress.col(i).array();
      if (domain_.yields(s))
        rate.col(i) = domain_.project(s).overstress / (2 * law_.viscosity);
      else
        rate.col(i).setZero();
    }
  }

  void elasticStrain(const Matrix& stress, Matrix& strain) const override {
    strain = e_.inverse().matrix().asDiagonal() * stress;
  }

  [[nodiscard]] bool flows(const Matrix& stress, int point) const override {
    return domain_.yields(stress.col(point).array());
  }

 private:
  /// Weights of the norm on p, q, r; only their ratios matter.
  [[nodiscard]] Array3d projectionNorm(Projection projection) const {
    switch (projection) {
      case Projection::elasticity:
        return e_ / e_[1];
      case Projection::compliance:
        return e_[1] / e_;
      case Projection::frobenius:
        break;
    }
    return Array3d::Ones();
  }

  Array3d e_;
  Viscoplasticity law_;
  YieldDomain domain_;
};

void check(const Elasticity& elasticity) {
  require(elasticity.young > 0, "young", elasticity.young, "young > 0 [Pa]");
  require(elasticity.poisson > -1 && elasticity.poisson < 0.5, "poisson", elasticity.poisson,
          "-1 < poisson < 0.5");
}

}  // namespace

Eigen::Array3d Elasticity::moduli() const {
  return {young / (1 - poisson), young / (1 + poisson), young / (1 + poisson)};
}

std::shared_ptr<const Material> elasticMaterial(const Elasticity& elasticity) {
  check(elasticity);
  return std::make_shared<Elastic>(elasticity);
}

std::shared_ptr<const Material> perzynaMaterial(const Elasticity& elasticity,
                                                const Viscoplasticity& viscoplasticity) {
  check(elasticity);
  require(viscoplasticity.viscosity > 0, "viscosity", viscoplasticity.viscosity, "viscosity > 0 [Pa s]");
  require(viscoplasticity.yieldStress > 0, "yield_stress", viscoplasticity.yieldStress,
          "yield_stress > 0 [Pa]");
  return std::make_shared<Perzyna>(elasticity, viscoplasticity);
}

}  // namespace mortier
