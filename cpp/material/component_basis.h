// Components 11, 22, 12, 33 and, in space, 13, 23 of a stress or a strain and the bases p, q, r, s33 and that
// of space of material/stress.h.
#pragma once

#include <Eigen/Core>
#include <numbers>

#include "material/stress.h"

namespace mortier {

/// How many components a tensor has whose basis has n.
template <int n>
constexpr int tensorSize = n == 6 ? 6 : 4;

/// Components from p, q, r and, where n is 4, s33, or from the basis of space (stress.h).
template <int n>
Eigen::Matrix<double, tensorSize<n>, n> componentsBy() {
  constexpr double h = std::numbers::sqrt2 / 2;
  Eigen::Matrix<double, tensorSize<n>, n> T = Eigen::Matrix<double, tensorSize<n>, n>::Zero();
  if constexpr (n == 6) {
    constexpr std::array rows{0, 1, 3, 2, 4, 5};  // 11, 22, 33, 12, 13, 23
    for (int j = 0; j < n; ++j) {
      const SpaceStress all = toSpaceCartesian(SpaceStress::Unit(j));
      for (int i = 0; i < n; ++i) T(rows[i], j) = all[i];
    }
    return T;
  }
  T(0, 0) = T(0, 1) = T(1, 0) = T(2, 2) = h;
  T(1, 1) = -h;
  if constexpr (n == 4) T(3, 3) = 1;
  return T;
}
/// The inverse.
template <int n>
Eigen::Matrix<double, n, tensorSize<n>> byComponents() {
  Eigen::Matrix<double, n, tensorSize<n>> F = componentsBy<n>().transpose();
  F(2, 2) = std::numbers::sqrt2;
  if constexpr (n == 6) F(3, 4) = F(4, 5) = std::numbers::sqrt2;
  return F;
}

}  // namespace mortier
