// By how much the bodies of an interface have slid along each other where they press,
//
//   slip = T u,   T: the rows of C with every direction turned by +90 degrees (interface.h).
//
// Slips are taken as small: nodes face what they faced as meshed. A slip of a part of an edge shows
// in nodal forces; past the end of the line that it touches a node would touch nothing.
#pragma once

#include "contact/interface.h"

namespace mortier {

struct Sliding {
  double slip = 0;   ///< of the node that slid farthest by the edges beside it [m]
  double edges = 0;  ///< that slip over the length of the shorter of these edges
  /// Where a node is past the end of the mortar line, by more than an edge and by more than a tenth of that
  /// line: the node and how far it slid [m]; -1: none is.
  int past = -1;
  double pastBy = 0;
};

/// \param p  nodal forces; nodes without one do not count [N/m]
Sliding slidingOf(const ContactInterface& interface, const ContactMesh& nonmortar, const ContactMesh& mortar,
                  const Vector& uNonmortar, const Vector& uMortar, const Vector& p);
/// The same of surfaces, at points of their common refinement; the length is that of a side of the triangle.
/// Whether a node is past the end is not found.
Sliding slidingInSpace(const ContactInterface& interface, const Vector& uNonmortar, const Vector& uMortar,
                       const Vector& p);

}  // namespace mortier
