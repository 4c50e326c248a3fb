#include "material/plane_strain.h"

#include <cmath>

#include "material/deviator.h"
#include "material/plane_strain_path.h"

namespace mortier {
namespace {

using StressLanes = std::array<Lanes, 4>;  ///< p, q, r, s33

/// What all that is isotropic and in plane strain shares.
class PlaneStrain : public Material {
 public:
  explicit PlaneStrain(const Elasticity& elasticity)
      : poisson_(elasticity.poisson),
        shear_(elasticity.young / (1 + elasticity.poisson)),
        bulk_(elasticity.young / (1 - 2 * elasticity.poisson)) {}

  [[nodiscard]] int components() const override { return 4; }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress, int /*point*/) const override {
    return poisson_ * std::numbers::sqrt2 * stress[0];
  }
  [[nodiscard]] bool symmetricTangent() const override { return true; }

  void elasticStrain(const Matrix& stress, Matrix& strain) const override {
    strain.resize(4, stress.cols());
    for (Eigen::Index i = 0; i < stress.cols(); ++i) {
      Split<double> s = split(pointOf(stress, i));
      for (double& component : s.deviator) component /= shear_;
      s.pressure /= bulk_;
      setPoint(joined(s), i, strain);
    }
  }

 protected:
  static std::array<double, 4> pointOf(const Matrix& m, Eigen::Index i) {
    return {m(0, i), m(1, i), m(2, i), m(3, i)};
  }
  static void setPoint(const std::array<double, 4>& values, Eigen::Index i, Matrix& m) {
    m.col(i) = Eigen::Map<const Eigen::Vector4d>(values.data());
  }
  static void store(const Batch& batch, const PlaneModuli<Lanes>& moduli, Linearisation& result) {
    storeModuli(batch, moduli.plane, result.moduli);
    batch.store(moduli.beyond, result.beyond.data());
  }

  /// strain - E^-1 (s - s0): what is left for the flow.
  [[nodiscard]] Split<Lanes> rest(const Batch& batch, const MaterialStep& step, const Split<Lanes>& s) const {
    const Split<Lanes> s0 = split(batch.load<4>(step.stress0.data()));
    Split<Lanes> v = split(batch.load<4>(step.strain.data()));
    for (int k = 0; k < 3; ++k) v.deviator[k] -= (s.deviator[k] - s0.deviator[k]) / shear_;
    v.pressure -= (s.pressure - s0.pressure) / bulk_;
    return v;
  }

  double poisson_;
  double shear_;  ///< E/(1+nu) [Pa]
  double bulk_;   ///< E/(1-2 nu) [Pa]
};

class PlaneStrainElastic final : public PlaneStrain {
 public:
  using PlaneStrain::PlaneStrain;

  [[nodiscard]] bool linear() const override { return true; }
  [[nodiscard]] double stressScale() const override { return 0; }
  [[nodiscard]] double stiffness(double /*weight*/) const override { return 0; }

  double linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                   int end) const override {
    return relax(step, stress, 1, result, begin, end);
  }
  double regularise(const MaterialStep& step, const Matrix& stress, const Vector& /*penalty*/,
                    double relaxation, Linearisation& result, int begin, int end) const override {
    // D = E: the law is met halfway, and relaxation 2 is the whole way.
    return 0.5 * relax(step, stress, 0.5 * relaxation, result, begin, end);
  }
  void choosePenalty(const Matrix& stress, Vector& penalty) const override { penalty.setZero(stress.cols()); }

  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(double /*weight*/,
                                                           const Matrix& /*stress0*/) const override {
    return nullptr;
  }
  void viscoplasticRate(const Matrix& stress, Matrix& rate) const override {
    rate.setZero(stress.rows(), stress.cols());
  }
  [[nodiscard]] bool flows(const Matrix& /*stress*/, int /*point*/) const override { return false; }

 private:
  /// The predictor becomes s + part (law - s). \returns the largest |law - s|.
  double relax(const MaterialStep& step, const Matrix& stress, double part, Linearisation& result, int begin,
               int end) const {
    Largest residual;
    const LaneVector zero{};
    const Lanes shear = shear_;
    const PlaneModuli<Lanes> moduli =
        planeModuli(diagonalMinusRankOne({shear, shear, shear}, 0, zero, zero), Lanes(bulk_));
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      StressLanes s = batch.load<4>(stress.data());
      Split<Lanes> v = rest(batch, step, split(s));
      for (Lanes& component : v.deviator) component *= shear_;
      v.pressure *= bulk_;
      const StressLanes change = joined(v);
      residual.add(change);
      for (int k = 0; k < 4; ++k) s[k] += part * change[k];
      batch.store(s, result.predictor.data());
      store(batch, moduli, result);
    }
    result.addElastic(end - begin);
    return residual.value();
  }
};

class PlaneStrainPerzyna final : public PlaneStrain {
 public:
  PlaneStrainPerzyna(const Elasticity& elasticity, const Viscoplasticity& law)
      : PlaneStrain(elasticity), law_(law), radius_(law.yieldStress * rootTwoThirds) {}

  [[nodiscard]] bool linear() const override { return false; }
  [[nodiscard]] double stressScale() const override { return law_.yieldStress; }
  [[nodiscard]] double stiffness(double weight) const override { return thetaOf(weight) * shear_; }

  // With v = strain - E^-1 (s - s0), theta = weight/(2 lambda) and t = s + c v, the law v = theta (s - P_B s) reads
  //   v = theta kappa (t - P_B t),  kappa = 1/(1 + c theta),
  // for every c >= 0 (perzyna.cpp). With n = dev t/|dev t|, R = sigma_Y sqrt(2/3) and rho = R/|dev t| its linearisation
  // H ds = B d + r is diagonal along n, across it and on the pressure:
  //   along   H = 1/2mu + theta,                                r = v.n - theta (s.n - R)
  //   across  H = 1/2mu + theta (1 - rho)/(1 + c theta rho),    r = (1 + c theta)/(1 + c theta rho) (v - n n.v)
  double linearise(const MaterialStep& step, const Matrix& stress, Linearisation& result, int begin,
                   int end) const override {
    constexpr double reach = 100;  // in yield stresses, for v >> sigma_Y/E
    const double theta = thetaOf(step.weight);
    Largest residual;
    bool elastic = true;
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      StressLanes stressLanes = batch.load<4>(stress.data());
      const Split<Lanes> s = split(stressLanes);
      const Split<Lanes> v = rest(batch, step, s);
      Lanes c = 0;
      LaneVector t = s.deviator;
      if (step.anticipate) {
        c = 1 / (1 / shear_ + sqrt(dot(v.deviator, v.deviator)) / (reach * law_.yieldStress));
        for (int k = 0; k < 3; ++k) t[k] += c * v.deviator[k];
      }
      const Lanes size = sqrt(dot(t, t));
      const LaneMask flowing = yields(size);
      elastic = elastic && none_of(flowing);
      const Lanes length = select(flowing, size, 1);
      const Lanes beyond = select(flowing, max(size - radius_, Lanes(0)), 0);
      const Lanes flows = select(flowing, 1, 0);
      const Lanes rho = 1 - beyond / length;
      LaneVector n;
      for (int k = 0; k < 3; ++k) n[k] = flows * (t[k] / length);

      const Lanes across = 1 / (1 / shear_ + theta * (beyond / length) / (1 + c * theta * rho));
      const Lanes along = 1 / (1 / shear_ + theta * flows);
      const Lanes stretch = 1 + c * theta * (1 - rho) / (1 + c * theta * rho);
      const Lanes vn = dot(v.deviator, n);
      const Lanes overstress = dot(s.deviator, n) - radius_ - min(size - radius_, Lanes(0));
      const Lanes rn = along * (vn - theta * flows * overstress) - across * stretch * vn;
      Split<Lanes> increment{{}, bulk_ * v.pressure};
      for (int k = 0; k < 3; ++k) increment.deviator[k] = across * stretch * v.deviator[k] + rn * n[k];

      const StressLanes change = joined(increment);
      residual.add(change);
      for (int k = 0; k < 4; ++k) stressLanes[k] += change[k];
      batch.store(stressLanes, result.predictor.data());
      store(batch,
            planeModuli(diagonalMinusRankOne({across, across, across}, across - along, n, n), Lanes(bulk_)),
            result);
    }
    if (elastic) result.addElastic(end - begin);
    return residual.value();
  }

  // D^-1 = E^-1 + penalty theta on the deviator, E^-1 on the pressure. t solves A (t - s) = v - theta (t - P_B t),
  // A = D^-1 + E^-1: with x = s + v/A it is t = x - theta/(A + theta) (x - P_B x).
  double regularise(const MaterialStep& step, const Matrix& stress, const Vector& penalty, double relaxation,
                    Linearisation& result, int begin, int end) const override {
    const double theta = thetaOf(step.weight);
    Largest change;
    for (int i = begin; i < end; i += laneCount) {
      const Batch batch(i, end);
      StressLanes stressLanes = batch.load<4>(stress.data());
      const Split<Lanes> s = split(stressLanes);
      const Split<Lanes> v = rest(batch, step, s);
      const Lanes soft = theta * batch.load<1>(penalty.data())[0];
      const Lanes A = 2 / shear_ + soft;
      LaneVector x;
      for (int k = 0; k < 3; ++k) x[k] = s.deviator[k] + v.deviator[k] / A;
      const Lanes size = sqrt(dot(x, x));
      const Lanes back = select(yields(size), theta / (A + theta) * max(size - radius_, Lanes(0)) / size, 0);
      Split<Lanes> difference{{}, bulk_ / 2 * v.pressure};
      for (int k = 0; k < 3; ++k) difference.deviator[k] = v.deviator[k] / A - back * x[k];
      const StressLanes way = joined(difference);
      change.add(way);
      for (int k = 0; k < 4; ++k) stressLanes[k] += relaxation * way[k];
      batch.store(stressLanes, result.predictor.data());
      const Lanes D = 1 / (1 / shear_ + soft);
      store(batch, planeModuli(diagonalMinusRankOne({D, D, D}, 0, {}, {}), Lanes(bulk_)), result);
    }
    return change.value();
  }

  // The flow stiffens by 1 along the normal of the yield surface and by 1 - rho across it.
  void choosePenalty(const Matrix& stress, Vector& penalty) const override {
    penalty.resize(stress.cols());
    for (Eigen::Index i = 0; i < stress.cols(); ++i) penalty[i] = std::sqrt(flowShare(sizeOf(stress, i)));
  }

  [[nodiscard]] std::unique_ptr<InteriorPath> interiorPath(double weight,
                                                           const Matrix& stress0) const override {
    return planeStrainPath(shear_, bulk_, law_.yieldStress, thetaOf(weight), stress0);
  }

  void viscoplasticRate(const Matrix& stress, Matrix& rate) const override {
    rate.resize(4, stress.cols());
    for (Eigen::Index i = 0; i < stress.cols(); ++i) {
      Split<double> s = split(pointOf(stress, i));
      const double share = flowShare(sizeOf(stress, i)) / (2 * law_.viscosity);
      for (double& component : s.deviator) component *= share;
      s.pressure = 0;
      setPoint(joined(s), i, rate);
    }
  }

  [[nodiscard]] bool flows(const Matrix& stress, int point) const override {
    return sizeOf(stress, point) >= onSurface * radius_;
  }

 private:
  /// A stress on the yield surface, up to rounding, counts as beyond it, as in YieldDomain.
  static constexpr double onSurface = 1 - 0.5e-10;

  [[nodiscard]] LaneMask yields(const Lanes& size) const { return size >= onSurface * radius_; }
  [[nodiscard]] double thetaOf(double weight) const { return weight / (2 * law_.viscosity); }
  static double sizeOf(const Matrix& stress, Eigen::Index i) {
    const auto [k, q, r] = split(pointOf(stress, i)).deviator;
    return std::sqrt(k * k + q * q + r * r);
  }
  /// 1 - rho
  [[nodiscard]] double flowShare(double size) const { return size > radius_ ? (size - radius_) / size : 0; }

  Viscoplasticity law_;
  double radius_;  ///< sigma_Y sqrt(2/3), of the deviator on the yield surface [Pa]
};

}  // namespace

std::shared_ptr<const Material> planeStrainElasticMaterial(const Elasticity& elasticity) {
  requireValid(elasticity);
  return std::make_shared<PlaneStrainElastic>(elasticity);
}

std::shared_ptr<const Material> planeStrainPerzynaMaterial(const Elasticity& elasticity,
                                                           const Viscoplasticity& viscoplasticity) {
  requireValid(elasticity);
  requireValid(viscoplasticity);
  return std::make_shared<PlaneStrainPerzyna>(elasticity, viscoplasticity);
}

}  // namespace mortier
