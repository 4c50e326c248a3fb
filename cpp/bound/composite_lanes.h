// Eight composite triangles (composite_triangle.h) side by side in vector registers.
#pragma once

#include <array>

#include "base/lanes.h"
#include "bound/composite_triangle.h"

namespace mortier {

class CompositeLanes {
 public:
  using Twelve = std::array<Lanes, 12>;

  /// \param corners  x and y of each  \param compliance  its components 00, 11, 22, 01, 02, 12
  CompositeLanes(const std::array<Lanes, 6>& corners, const std::array<Lanes, 6>& compliance);

  /// The moments of a constant stress (s11, s22, s12).
  [[nodiscard]] Twelve momentsOf(const std::array<Lanes, 3>& stress) const;
  /// The modes of an Airy function of moments in equilibrium that is 0 at the first corner, with its
  /// gradient.
  [[nodiscard]] Twelve airyOf(const Twelve& m) const;
  /// K with x'K x = integral of s : E^-1 s, s the stress of Airy modes x (column major) [1/Pa].
  void airyEnergy(std::array<Lanes, 144>& K) const;
  /// The energy of the stress of moments in equilibrium and of the load of a constant body force (x and y),
  /// as CompositeTriangle has it [J/m].
  [[nodiscard]] Lanes energyOf(const Twelve& m, const std::array<Lanes, 3>& f) const;

 private:
  [[nodiscard]] std::array<Lanes, 2> sideOf(int k) const {
    const int last = (k + 1) % 3;
    return {x_[2 * last] - x_[2 * k], x_[2 * last + 1] - x_[2 * k + 1]};
  }
  std::array<Lanes, 6> x_;
  std::array<Lanes, 4> F_;          ///< row by row
  std::array<Lanes, 4> inverse_;    ///< of F
  std::array<Lanes, 6> reference_;  ///< J P'S P (composite_triangle.h), components in the order above
  Lanes J_;
};

}  // namespace mortier
