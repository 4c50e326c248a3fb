// How far the stress of a body is from the exact one, estimated from itself (Zienkiewicz and Zhu, Int. J. Numer.
// Methods Engrg. 33, 1992): stresses of linear triangles are best at the centres, so a linear field fitted to the
// centres around a vertex is a better stress there; what triangles lack to the continuous field of these values is the
// estimate. It knows the error of the mesh, not that of the steps in time.
#pragma once

#include <vector>

#include "fem/body.h"

namespace mortier {

struct ErrorEstimate {
  Vector error;       ///< per triangle, integral of e : E^-1 e [J/m], e the estimated error of the stress
  double energy = 0;  ///< integral of s : E^-1 s of the recovered stress [J/m]
  /// In the energy norm; 0 without stress [-].
  [[nodiscard]] double relative() const;
};

/// \param stress  components x points [Pa]. Regions of the mesh are recovered one by one: stresses jump between
/// materials.
ErrorEstimate estimateError(const Body& body, const Matrix& stress);

}  // namespace mortier
