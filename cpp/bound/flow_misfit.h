// What a body that flows adds to the bound of a step (step_bound.h), by integrals over the parts of composite
// triangles in which s^ is linear: of squares exactly, of D(s^; t) from above. D is convex in s^, and so is
// (m/2) |s^ - t|^2 - D, m = 1/(2 lambda): on small triangles the first is at most what the mean of its values
// at the vertices gives, the second at least what its value at the centroid gives.
#pragma once

#include "bound/flow_potential.h"
#include "bound/loaded_body.h"

namespace mortier {

struct FlowMisfit {
  double stress = 0;    ///< |s^ - s|^2 [J/m]
  double lift = 0;      ///< |a - s|^2 [J/m]
  double flow = 0;      ///< 2 k integral of D(s^; t) [J/m]
  double shift = 0;     ///< |k r - k G(s)|^2 [m^2]
  double norm = 0;      ///< |s|^2 [J/m]
  double strain = 0;    ///< |k G(s)|^2 [m^2]
  double fluidity = 0;  ///< 1/(2 lambda), the largest [1/(Pa s)]
};

/// \param own  the body on its own mesh, `loaded` that on the matched mesh
/// \param state  of it at the end of the step
/// \param lowered  u_h - u^ (dofs of the matched mesh)  \param weight  k [s]
FlowMisfit flowMisfit(const Body& own, const BodyState& state, const LoadedBody& loaded,
                      const Vector& lowered, double weight);

}  // namespace mortier
