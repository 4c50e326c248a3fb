// How far the stress of a body is from the exact one, estimated from itself (Zienkiewicz and Zhu, Int. J. Numer.
// Methods Engrg. 33, 1992): stresses of linear triangles are best at the centres, so a linear field fitted to the
// centres around a vertex is a better stress there; what triangles lack to the continuous field of these values is the
// estimate. It knows the error of the mesh, not that of the steps in time.
#pragma once

#include <array>
#include <vector>

#include "fem/body.h"

namespace mortier {

struct ErrorEstimate {
  Vector error;       ///< per triangle, integral of e : E^-1 e [J/m], e the estimated error of the stress
  double energy = 0;  ///< integral of s : E^-1 s of the recovered stress [J/m]
  /// In the energy norm; 0 without stress [-].
  [[nodiscard]] double relative() const;
};

/// Estimates for one body, which must outlive it. Regions of the mesh are recovered one by one: stresses jump between
/// materials.
class ErrorEstimator {
 public:
  explicit ErrorEstimator(const Body& body);
  /// \param stress  components x points [Pa].
  [[nodiscard]] ErrorEstimate operator()(const Matrix& stress) const;

 private:
  struct Part {
    int triangle = 0;
    double weight = 0;
  };
  const Body& body_;
  std::vector<std::array<int, 3>> corners_;  ///< of each triangle, among the recovered stresses
  std::vector<size_t> first_{0};             ///< part of each recovered stress
  std::vector<Part> parts_;                  ///< it is the sum of weight times stress
};

}  // namespace mortier
