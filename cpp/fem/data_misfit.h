// What the discrete problem makes of a datum against the datum as it was written: nodal loads are integrals
// of it, and the rest is orthogonal to the trial functions or lies between the nodes.
#pragma once

#include <array>
#include <vector>

#include "base/adaptive_quadrature.h"
#include "base/datum.h"

namespace mortier {

/// A datum at a time on an edge. \param nodes  both ends, and of a quadratic edge the middle
ResolvedEdge onEdge(const Datum& datum, const std::vector<Point>& nodes, double t);
/// The same on a triangle. \param nodes  of the element: 3, or 6
ResolvedTriangle onTriangle(const Datum& datum, const std::vector<Point>& nodes, double t);

/// The L2 projection onto polynomials of a degree (0, 1, 2) at some places.
std::vector<double> projection(const ResolvedTriangle& triangle, int degree,
                               const std::vector<std::array<double, 3>>& places);

/// The part of a datum that the discrete problem does not have: w = f - (projection or interpolant). All
/// integrals are of an edge or triangle of measure 1; by length or area they are those of the real one.
struct Misfit {
  double square = 0;     ///< integral of w^2
  double most = 0;       ///< largest |w| at a sample
  double primitive = 0;  ///< edges: integral of W^2, W' = w, the mean of W being 0; by length^3
  double minusHalf = 0;  ///< edges: |w|^2 of order -1/2, that is |W| |w| of each wave in w; by length^2
  double slope = 0;      ///< edges: integral of w'^2; over the length. Infinite where w jumps
};

/// w of the L2 projection onto polynomials of a degree (0, 1, 2).
Misfit misfit(const ResolvedTriangle& triangle, int degree);
/// An edge of a line: a datum on it, its nodes (both ends, of a quadratic one the middle) and its length.
struct LineEdge {
  ResolvedEdge datum;
  std::array<int, 3> nodes{-1, -1, -1};
  double length = 0;
};
/// The L2 projection of a datum onto the continuous functions of a degree on all edges together, by nodal
/// values of each: nodal loads say no more of a traction. What alternates from edge to edge is not in it.
std::vector<std::array<double, 3>> lineProjection(const std::vector<LineEdge>& edges, int degree);

/// w of the interpolant through the ends (degree 1), and the middle (degree 2).
Misfit interpolationMisfit(const ResolvedEdge& edge, const std::array<double, 3>& values, int degree);

}  // namespace mortier
