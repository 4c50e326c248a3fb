// A law with any symmetric elliptic E made of the same law with an isotropic one. With E0 = c 1, c the
// largest eigenvalue of E (isotropic, nu = 0), E^-1 = E0^-1 + F F', and
//   E0^-1 (s - s0) + weight G(s) = strain - F F' (s - s0)
// is the law of E. Linearised, H = H0 + F F': the change of stress and the moduli of the isotropic law are
// corrected by
//   H^-1 = H0^-1 - B M^-1 B',   B = H0^-1 F,   M = 1 + F'B,
// all of positive matrices, whatever flows.
#pragma once

#include <Eigen/Eigenvalues>

#include "material/point_material.h"

namespace mortier {

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
    const Eigen::SelfAdjointEigenSolver<Square> eigen{Square(E)};
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
    soften(answer);
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

  void soften(PointAnswer<n>& answer) const {
    std::array<Lanes, n* n>& D = answer.moduli;  // column major, as all here
    std::array<Lanes, n * n> B;
    std::array<Lanes, n*(n + 1)> X;  // F'D and F' change, then M^-1 of it
    std::array<Lanes, n * n> M;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        B[n * j + i] = 0;
        X[n * j + i] = 0;
        for (int k = 0; k < n; ++k) {
          B[n * j + i] += D[n * k + i] * F_(k, j);
          X[n * j + i] += F_(k, i) * D[n * j + k];
        }
      }
    for (int i = 0; i < n; ++i) {
      X[n * n + i] = 0;
      for (int k = 0; k < n; ++k) X[n * n + i] += F_(k, i) * answer.change[k];
    }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        M[n * j + i] = i == j ? 1 : 0;
        for (int k = 0; k < n; ++k) M[n * j + i] += F_(k, i) * B[n * j + k];
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

  Law law_;
  Square inverse_;  ///< E^-1 [1/Pa]
  Square F_;
  Square excess_;  ///< F F'
};

}  // namespace mortier
