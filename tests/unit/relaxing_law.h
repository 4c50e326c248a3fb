// A law that the program does not have, with any symmetric elliptic E and a flow that depends on the total
// strain.
#pragma once

#include <Eigen/LU>
#include <random>

#include "material/point_material.h"

namespace mortier {

template <int n>
std::array<Lanes, n> times(const Eigen::Matrix<double, n, n>& A, const std::array<Lanes, n>& x) {
  std::array<Lanes, n> y{};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) y[i] += A(i, j) * x[j];
  return y;
}

/// G = (s - K eps)/eta with any matrix K: for a symmetric one the standard linear solid, which relaxes to K
/// eps.
template <int n>
class Relaxing {
 public:
  using Square = Eigen::Matrix<double, n, n>;
  using Stress = std::array<Lanes, n>;
  static constexpr int components = n;
  static constexpr bool linear = false;
  static constexpr bool needsTotalStrain = true;

  Relaxing(const Square& E, const Square& K, double eta) : C_(E.inverse()), K_(K), eta_(eta) {}

  [[nodiscard]] bool symmetric() const { return false; }
  [[nodiscard]] double stressScale() const { return 0; }
  [[nodiscard]] double stiffness(double weight) const { return weight / eta_ / C_.norm(); }
  template <class Scalar>
  [[nodiscard]] bool flows(const std::array<Scalar, n>& /*stress*/) const {
    return true;
  }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress) const { return stress.sum(); }
  [[nodiscard]] Lanes penalty(const Stress& /*stress*/) const { return 1; }
  [[nodiscard]] Stress rate(const Stress& stress, const Stress& total) const {
    Stress rate = times<n>(K_, total);
    for (int k = 0; k < n; ++k) rate[k] = (stress[k] - rate[k]) / eta_;
    return rate;
  }
  [[nodiscard]] Stress elasticStrain(const Stress& stress) const { return times<n>(C_, stress); }
  [[nodiscard]] PointAnswer<n> linearise(const PointStep<n>& point) const {
    Stress r = point.strain;
    Stress step = point.stress;
    for (int k = 0; k < n; ++k) step[k] -= point.stress0[k];
    const Stress elastic = elasticStrain(step);
    const Stress flow = rate(point.stress, point.total);
    for (int k = 0; k < n; ++k) r[k] -= elastic[k] + point.weight * flow[k];
    const Square inverse = (C_ + Square::Identity() * (point.weight / eta_)).inverse();
    const Square tangent = inverse * (Square::Identity() + point.weight / eta_ * K_);
    PointAnswer<n> answer{point.stress, times<n>(inverse, r), {}, true};
    for (int k = 0; k < n; ++k) answer.predictor[k] += answer.change[k];
    for (int k = 0; k < n * n; ++k) answer.moduli[k] = tangent.reshaped()[k];
    return answer;
  }
  [[nodiscard]] PointAnswer<n> regularise(const PointStep<n>& point, const Lanes& /*penalty*/) const {
    return linearise(point);
  }

 private:
  Square C_;
  Square K_;
  double eta_;
};

template <int n>
Eigen::Matrix<double, n, n> elliptic(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::Matrix<double, n, n> A =
      Eigen::Matrix<double, n, n>::NullaryExpr([&] { return normal(random); });
  return A * A.transpose() + Eigen::Matrix<double, n, n>::Identity();
}

}  // namespace mortier
