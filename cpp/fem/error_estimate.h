// How far the stress of a body is from the exact one, estimated from itself (Zienkiewicz and Zhu, Int. J.
// Numer. Methods Engrg. 33, 1992): stresses of elements are best at their quadrature points, so a polynomial
// of the degree of the displacements, fitted to those around a vertex, is a better stress there. The estimate
// is the difference of the stress from the continuous field of these values. It has the error of the mesh,
// not that of the steps in time.
#pragma once

#include <memory>

#include "base/parallel.h"
#include "fem/body.h"

namespace mortier {

struct ErrorEstimate {
  Vector error;       ///< per element, integral of e : E^-1 e [J/m], e the estimated error of the stress
  double energy = 0;  ///< integral of s : E^-1 s of the recovered stress [J/m]
  /// In the energy norm; 0 without stress [-].
  [[nodiscard]] double relative() const;
};

/// Estimates for one body, which must outlive it. Regions of the mesh are recovered one by one: stresses jump
/// between materials.
class ErrorEstimator {
 public:
  explicit ErrorEstimator(const Body& body);
  /// \param stress  components x points [Pa].
  [[nodiscard]] ErrorEstimate operator()(const Matrix& stress, Threads& threads = Threads::none()) const;
  /// The recovered stress at the nodes of all elements, one after the other: components x (elements times
  /// nodes of each) [Pa].
  [[nodiscard]] Matrix recovered(const Matrix& stress, Threads& threads = Threads::none()) const;

  class Recovery;

 private:
  std::shared_ptr<const Recovery> recovery_;
};

}  // namespace mortier
