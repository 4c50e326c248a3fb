// Where the boundary of one body in space, as moved, lies within another: overlap.h for surfaces of
// triangles. A triangle with nodes in the middles of its sides is four triangles. A point is in a body where
// the nearest point of its surface says so, by the normal there, at edges and vertices the sum of the normals
// by their angles (Baerentzen and Aanaes, IEEE Transactions on Visualization and Computer Graphics 11, 2005).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <unsupported/Eigen/BVH>
#include <vector>

#include "mesh/tetrahedron_mesh.h"

namespace mortier {

/// The whole boundary of a mesh of tetrahedra.
struct SpaceOutline {
  std::vector<std::array<int, 3>> triangles;  ///< of nodes, counterclockwise seen from outside
  std::vector<int> labels;                    ///< of each; 0 where it has none
  /// Across side k, from node k of the triangle to the next, the triangle there.
  std::vector<std::array<int, 3>> neighbours;
  std::vector<std::vector<int>> around;  ///< by nodes of the body, the triangles there
};

SpaceOutline outlineOf(const TetrahedronMesh& mesh, const SpaceNodes& nodes);

/// The same with its nodes at given places. The outline must outlive it.
class MovedSurface {
 public:
  /// \param places  by nodes [m]
  MovedSurface(const SpaceOutline& outline, const std::vector<SpacePoint>& places);

  struct Nearest {
    double distance = infinity;  ///< negative inside the body [m]
    int triangle = -1;
    std::array<bool, 3> with{};  ///< which of its nodes the foot lies between
    SpacePoint foot{0, 0, 0};
  };
  /// \param beside  triangles with these normals that are no farther from x than `rounding` do not count
  [[nodiscard]] Nearest nearest(const SpacePoint& x, const std::vector<SpacePoint>& beside = {},
                                double rounding = 0) const;
  /// Outward, of length 1.
  [[nodiscard]] const SpacePoint& normal(int triangle) const { return normals_[triangle]; }
  /// Longest side [m].
  [[nodiscard]] double size(int triangle) const;
  /// The turn from a triangle to that across its side k, positive where the body is convex [rad].
  [[nodiscard]] double turn(int triangle, int k) const;
  [[nodiscard]] SpacePoint middle(int triangle) const;
  [[nodiscard]] double area(int triangle) const;
  /// All triangles at a foot.
  [[nodiscard]] std::vector<int> around(const Nearest& nearest) const;
  [[nodiscard]] const SpacePoint& corner(int triangle, int k) const {
    return places_[outline_->triangles[triangle][k]];
  }
  [[nodiscard]] const SpaceOutline& outline() const { return *outline_; }
  [[nodiscard]] const std::vector<SpacePoint>& places() const { return places_; }
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }

 private:
  const SpaceOutline* outline_;
  std::vector<SpacePoint> places_;
  std::vector<SpacePoint> normals_;
  std::vector<SpacePoint> nodeNormals_;
  Eigen::AlignedBox3d box_;
  std::vector<Eigen::AlignedBox3d> boxes_;
  Eigen::KdBVH<double, 3, int> tree_;
};

/// A node, or the middle of a triangle, of the surface of one of two bodies within the other one.
struct SpacePointInside {
  int of = 0;              ///< 0 or 1: the body whose surface it is of
  int triangle = 0;        ///< of that body; of several at a node that which faces the other surface
  bool node = false;       ///< of the triangle, or its middle
  SpacePoint at{0, 0, 0};  ///< [m]
  double depth = 0;        ///< its distance to the surface of the other body [m]
  int across = 0;          ///< the triangle there, of several that which faces the first surface
  SpacePoint foot{0, 0, 0};
};

/// \param rounding  of places: surfaces that are as close touch [m]
std::vector<SpacePointInside> pointsInside(const MovedSurface& one, const MovedSurface& other,
                                           double rounding);

}  // namespace mortier
