// Data that are not linear on a side, or not constant on a triangle: energy norms of the stress s_D that
// carries the remainder, and of the displacement w that meets it (loaded_body.h), at most.
#pragma once

#include <array>

#include "bound/loaded_body.h"

namespace mortier {

/// A triangle with a side from p to q, the body to the left, and the vertex c opposite.
struct SideTriangle {
  Point p, q, c;

  SideTriangle(const TriangleMesh& mesh, const Side& side)
      : p(mesh.vertices[side.vertices[0]]), q(mesh.vertices[side.vertices[1]]) {
    for (const int v : mesh.triangles[side.triangles[0]])
      if (v != side.vertices[0] && v != side.vertices[1]) c = mesh.vertices[v];
  }
  [[nodiscard]] Point along() const { return q - p; }
  [[nodiscard]] Point outward() const { return Point(along().y(), -along().x()).normalized(); }
  [[nodiscard]] double length() const { return along().norm(); }
  [[nodiscard]] double height() const { return (p - c).dot(outward()); }
  [[nodiscard]] std::array<Point, 3> corners() const { return {p, q, c}; }
};

/// |s_D| of a force per area that works on no linear displacement, over its norm. \param x  corners
double carriesForce(const std::array<Point, 3>& x, const Eigen::Matrix3d& compliance);
/// The same of a traction on a side, in the best of some triangles over it inside of this one.
double carriesTraction(SideTriangle triangle, const Eigen::Matrix3d& compliance);

/// Adds a displacement w = datum times `along` on a side of the boundary. \param side  of MatchedBody::sides
void moveSide(const MatchedBody& place, int side, const Point& along, const SideDatum& datum, BodyData& data);
/// The energy norm of such a w, at most.
double movedEnergy(const MatchedBody& place, int side, const Point& along, const SideDatum& datum);

}  // namespace mortier
