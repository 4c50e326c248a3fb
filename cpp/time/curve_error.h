// What flat sides in place of curved ones change of a quantity that is linear in the solution. With w the
// distance of the surface, outwards, from the sides that stand for it, and z the response to the quantity
// (quantity_error.h), the first change of a quantity J of bodies that are larger by w is
//
//   dJ = integral of w (s : E^-1 t - q div z) over the sides  -  integral of w f z over their edges,
//
// but for its sign, q the traction along their normal that is given, f the tractions on other sides of the
// body that end at the curved ones, which are wider by w there. In space surfaces are those that contact
// knows (contact/boundary_surface.h), in the plane curves; what is not known counts as flat.
#pragma once

#include <vector>

#include "solver/model.h"
#include "solver/state.h"
#include "solver/step_system.h"

namespace mortier {

/// By elements, the volume between their sides and the surface that these stand for, positive where the body
/// is larger than its mesh [m^2, m^3 in space and of rings].
Vector volumeBehindSides(const Body& body);

/// By how much the length of a side in the plane, or its area in space, differs from that as meshed, of what
/// has all of its vertices among some [m, m^2]. \param among  by vertices
double growthOfSide(const Body& body, int label, const std::vector<char>& among);

/// Between a side and its surface.
struct Lens {
  double volume = 0;
  double pulled = 0;  ///< the same times the traction along the normal outwards
};

/// Of a model at a time.
class CurvedSides {
 public:
  /// \param model  must outlive it.
  CurvedSides(const Model& model, double time);
  /// \param z  the response, by bodies
  /// \param moved  displacements on which loads do their work
  [[nodiscard]] double changeOf(const State& state, const std::vector<Response>& z,
                                const std::vector<Vector>& moved) const;
  /// Integral of w s : E^-1 s / 2: the energy of a body between its sides and its surface.
  [[nodiscard]] double energyBehind(size_t body, const Matrix& stress) const;

 private:
  const Model& model_;
  std::vector<std::vector<Lens>> lenses_;  ///< by bodies and elements
  std::vector<Vector> loads_;              ///< by bodies: what tractions on wider sides add to nodes (dofs)
};

}  // namespace mortier
