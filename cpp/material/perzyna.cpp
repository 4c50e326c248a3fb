#include "material/perzyna.h"

#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/worst.h"
#include "material/interior_path.h"
#include "material/law_lanes.h"
#include "material/perzyna_path.h"
#include "material/stress.h"
#include "material/yield_domain.h"
#include "material/yield_lanes.h"

namespace mortier {
namespace {

using Eigen::Array3d;

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
    Largest residual;
    const LaneVector zero{};
    const std::array<Lanes, 9> moduli = diagonalMinusRankOne({e_[0], e_[1], e_[2]}, 0, zero, zero);
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      const LaneVector strain = batch.load<3>(step.strain.data());
      const LaneVector s = batch.load<3>(stress.data());
      LaneVector s1 = batch.load<3>(step.stress0.data());
      LaneVector change;
      for (int c = 0; c < 3; ++c) {
        s1[c] += e_[c] * strain[c];
        change[c] = s1[c] - s[c];
      }
      residual.add(change);
      batch.store(s1, result.predictor.data());
      storeModuli(batch, moduli, result.moduli);
    }
    result.addElastic(end - begin);
    return residual.value();
  }

  double regularise(const MaterialStep& step, const Matrix& stress, const Vector& /*penalty*/,
                    double relaxation, Linearisation& result, int begin, int end) const override {
    // D = E: the law is met halfway, and relaxation 2 is the whole way.
    const double change = linearise(step, stress, result, begin, end);
    for (int i = begin; i < end; ++i)
      result.predictor.col(i) = stress.col(i) + 0.5 * relaxation * (result.predictor.col(i) - stress.col(i));
    return 0.5 * change;
  }

  void choosePenalty(const Matrix& stress, Vector& penalty) const override { penalty.setZero(stress.cols()); }

  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(double /*weight*/,
                                                           const Matrix& /*stress0*/) const override {
    return nullptr;
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
        domain_(yieldDomain(law.yieldStress, projectionNorm(law.projection))),
        lanes_(law.yieldStress, projectionNorm(law.projection)[0] / projectionNorm(law.projection)[1]) {}

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
    Largest residual;
    bool flows = false;
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      const LaneVector s = batch.load<3>(stress.data());
      const LaneVector s0 = batch.load<3>(step.stress0.data());
      LaneVector v = batch.load<3>(step.strain.data());
      for (int k = 0; k < 3; ++k) v[k] -= (s[k] - s0[k]) / e_[k];
      const LinearisedLanes law = lineariseLanes(step, s, v);
      residual.add(law.increment);
      flows = flows || law.flows;
      LaneVector predictor = s;
      for (int k = 0; k < 3; ++k) predictor[k] += law.increment[k];
      batch.store(predictor, result.predictor.data());
      storeModuli(batch, law.moduli, result.moduli);
    }
    if (!flows) result.addElastic(end - begin);
    return residual.value();
  }

  // t solves A (t - s) = v - theta (t - P_B t), A = D^-1 + E^-1, v as above. With x = s + v/A and
  // kappa = 1/(1 + theta/A) it is t = x - (theta kappa/A) (x - P x), P the projection with the weights w kappa.
  double regularise(const MaterialStep& step, const Matrix& stress, const Vector& penalty, double relaxation,
                    Linearisation& result, int begin, int end) const override {
    const double theta = step.weight / (2 * law_.viscosity);
    const Array3d norm = projectionNorm(law_.projection);
    Worst change;
    for (int i = begin; i < end; ++i) {
      const Array3d s = stress.col(i).array();
      const Array3d v = step.strain.col(i).array() - (s - step.stress0.col(i).array()) / e_;
      const Array3d A = 2 / e_ + penalty[i] * theta;
      const Array3d x = s + v / A;
      Array3d difference = v / A;
      if (domain_.yields(x)) {
        const Array3d kappa = A / (A + theta);
        difference =
            (v - theta * kappa * yieldDomain(law_.yieldStress, norm * kappa).project(x).overstress) / A;
      }
      change.add(difference.abs().maxCoeff<Eigen::PropagateNaN>());
      result.predictor.col(i) = s + relaxation * difference;
      storeModuli((1 / (1 / e_ + penalty[i] * theta)).matrix().asDiagonal(), result.moduli, i);
    }
    return change.value();
  }

  // The flow stiffens by 1 along the normal of the yield surface and by `softening` at least along it.
  void choosePenalty(const Matrix& stress, Vector& penalty) const override {
    penalty.setZero(stress.cols());
    for (Eigen::Index i = 0; i < stress.cols(); ++i) {
      const Array3d s = stress.col(i).array();
      if (!domain_.yields(s)) continue;
      penalty[i] = std::sqrt(domain_.project(s).softening.minCoeff());
    }
  }

  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(double weight,
                                                           const Matrix& stress0) const override {
    return perzynaPath({e_, domain_.a(), domain_.b(), law_.yieldStress, weight / (2 * law_.viscosity)},
                       stress0);
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
  struct LinearisedLanes {
    LaneVector increment;  ///< H^-1 r
    std::array<Lanes, 9> moduli;
    bool flows = false;  ///< any of them
  };

  [[nodiscard]] LinearisedLanes lineariseLanes(const MaterialStep& step, const LaneVector& s,
                                               const LaneVector& v) const {
    constexpr double reach = 100;  // in yield stresses, for v >> sigma_Y/E
    const double theta = step.weight / (2 * law_.viscosity);
    Lanes c = 0;
    LaneVector t = s;
    if (step.anticipate) {
      c = 1 / (1 / e_[1] + sqrt(dot(v, v)) / (reach * law_.yieldStress));
      for (int k = 0; k < 3; ++k) t[k] += c * v[k];
    }
    LaneVector h{e_[0], e_[1], e_[2]};
    LaneVector r = v;
    LaneVector hx{};
    LaneVector hy{};
    Lanes rankOne = 0;
    const LaneMask flowing = lanes_.yields(t);
    LinearisedLanes result;
    result.flows = any_of(flowing);
    if (result.flows) {
      const Lanes kappa = step.anticipate ? 1 / (1 + c * theta) : Lanes(1);
      const LaneProjection P = lanes_.project(t, kappa, flowing);
      for (int k = 0; k < 3; ++k) r[k] = select(flowing, v[k] - theta * kappa * P.overstress[k], v[k]);
      if (step.anticipate) {
        const Lanes along = c * theta * dot(P.y, r) / P.z;
        for (int k = 0; k < 3; ++k)
          r[k] = select(flowing, P.stretch[k == 0 ? 0 : 1] * r[k] + along * P.x[k], v[k]);
      }
      const Lanes hp = 1 / (1 / e_[0] + theta * kappa * P.softening[0]);
      const Lanes hq = 1 / (1 / e_[1] + theta * kappa * P.softening[1]);
      for (int k = 0; k < 3; ++k) {
        h[k] = select(flowing, k == 0 ? hp : hq, h[k]);
        hx[k] = h[k] * P.x[k];
        hy[k] = h[k] * P.y[k];
      }
      rankOne = select(flowing, theta / (P.z + theta * dot(P.y, hx)), 0);
    }
    const Lanes along = rankOne * dot(hy, r);
    for (int k = 0; k < 3; ++k) result.increment[k] = h[k] * r[k] - along * hx[k];
    result.moduli = diagonalMinusRankOne(h, rankOne, hx, hy);
    return result;
  }

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
  YieldLanes lanes_;
};

void require(bool holds, const char* name, double value, const char* expected) {
  if (holds && std::isfinite(value)) return;
  std::ostringstream message;
  message << name << " = " << value << ", expected " << expected;
  throw InputError(message.str());
}

}  // namespace

Eigen::Array3d Elasticity::moduli() const {
  return {young / (1 - poisson), young / (1 + poisson), young / (1 + poisson)};
}

void requireValid(const Elasticity& elasticity) {
  require(elasticity.young > 0, "young", elasticity.young, "young > 0 [Pa]");
  require(elasticity.poisson > -1 && elasticity.poisson < 0.5, "poisson", elasticity.poisson,
          "-1 < poisson < 0.5");
}

void requireValid(const Viscoplasticity& viscoplasticity) {
  require(viscoplasticity.viscosity > 0, "viscosity", viscoplasticity.viscosity, "viscosity > 0 [Pa s]");
  require(viscoplasticity.yieldStress > 0, "yield_stress", viscoplasticity.yieldStress,
          "yield_stress > 0 [Pa]");
}

std::shared_ptr<const Material> elasticMaterial(const Elasticity& elasticity) {
  requireValid(elasticity);
  return std::make_shared<Elastic>(elasticity);
}

std::shared_ptr<const Material> perzynaMaterial(const Elasticity& elasticity,
                                                const Viscoplasticity& viscoplasticity) {
  requireValid(elasticity);
  requireValid(viscoplasticity);
  return std::make_shared<Perzyna>(elasticity, viscoplasticity);
}

}  // namespace mortier
