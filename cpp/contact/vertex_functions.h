// The hat functions of the vertices of a nonmortar surface in space, and the rows to which each goes.
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "contact/surface.h"

namespace mortier {

/// A vertex of the nonmortar surface, as one of its smooth parts sees it.
using PartVertex = std::pair<int, int>;  // vertex, part

struct VertexFacts {
  SpacePoint place, normal;
  double curvature = 0;
  std::set<PartVertex> neighbours;
  bool sees = false;
  std::vector<std::pair<int, double>> rows;  ///< to which its hat function goes, with which part
};

using VertexTable = std::map<PartVertex, VertexFacts>;

/// Neighbours are those along edges.
VertexTable verticesOf(const ContactSurface& surface);

/// Gives the hat functions without a row to neighbours that have one.
void shareFunctions(VertexTable& vertices);

}  // namespace mortier
