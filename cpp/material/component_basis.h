// Components 11, 22, 12, 33 of a stress or a strain and the basis p, q, r, s33 of material/stress.h.
#pragma once

#include <Eigen/Core>
#include <numbers>

namespace mortier {

/// Components from p, q, r and, where n is 4, s33 (stress.h).
template <int n>
Eigen::Matrix<double, 4, n> componentsBy() {
  constexpr double h = std::numbers::sqrt2 / 2;
  Eigen::Matrix<double, 4, n> T = Eigen::Matrix<double, 4, n>::Zero();
  T(0, 0) = T(0, 1) = T(1, 0) = T(2, 2) = h;
  T(1, 1) = -h;
  if constexpr (n == 4) T(3, 3) = 1;
  return T;
}
/// The inverse.
template <int n>
Eigen::Matrix<double, n, 4> byComponents() {
  Eigen::Matrix<double, n, 4> F = componentsBy<n>().transpose();
  F(2, 2) = std::numbers::sqrt2;
  return F;
}

}  // namespace mortier
