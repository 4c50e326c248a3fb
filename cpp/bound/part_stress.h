// The stress in equilibrium at the vertices of the three parts of composite triangles (composite_triangle.h),
// with its component beyond the plane, and the places at which convex functions of it are taken.
#pragma once

#include <array>
#include <vector>

#include "bound/loaded_body.h"

namespace mortier {

using PointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;
/// Of a field that is linear in each part, at the vertices of the parts.
using PartStress = std::array<PointVector, 9>;

/// s^ - s at the vertices of the parts. What is not of the plane is free: it is chosen as the law would.
/// \param law  of the body, linearised  \param components  of stresses
PartStress addedIn(const LoadedBody& loaded, int triangle, const Linearisation& law, Eigen::Index components);

/// A place in a part by its barycentric coordinates, and its share of the part's area: as one of the vertices
/// of small triangles, or as the centroid of one.
struct Place {
  std::array<double, 3> at;
  double share = 0;
  bool vertex = false;
};

/// Of the small triangles that cut each side of a part into so many.
std::vector<Place> placesIn(int cuts);

/// Integral of v : A w over a triangle of area 1, of linear functions with values at its vertices.
double product(const PointMatrix& A, const PointVector* v, const PointVector* w);

}  // namespace mortier
