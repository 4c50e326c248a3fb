// What the edges of Gmsh's curves stand for.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "mesh/gmsh_library.h"
#include "mesh/sampled_curve.h"

namespace mortier {

/// Nodes of a plane mesh of Gmsh.
struct PlaneNodes {
  std::map<size_t, Point> at;  ///< by tag [m]
  double z = 0;
};

/// Of an edge: the middle of what it stands for [m], not finite where that is not known or straight, and the
/// curve where that is no circle.
struct KnownEdge {
  Point middle;
  EdgeCurve curve = {};
};

/// \param curve  of Gmsh  \param ends  tags of the nodes of its edges, two by two
std::vector<KnownEdge> knownEdges(const Gmsh& gmsh, int curve, const std::vector<size_t>& ends,
                                  const PlaneNodes& nodes);

}  // namespace mortier
