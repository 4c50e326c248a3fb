// Edges of a mesh, and which of them are near a point: for geometric checks.
#pragma once

#include <Eigen/Geometry>
#include <unsupported/Eigen/BVH>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace mortier {

constexpr int noLabel = -1;

/// An edge with a triangle on one side only, the body to its left.
struct BoundaryEdge {
  int from = 0;
  int to = 0;
  int triangle = 0;
  int label = noLabel;  ///< noLabel where the mesh gives none
};

struct Topology {
  std::vector<BoundaryEdge> boundary;
  std::vector<std::array<int, 2>> neighbours;  ///< pairs of triangles that share an edge
};

/// \pre the mesh is valid (validate).
Topology topologyOf(const TriangleMesh& mesh);

/// The edges of `Topology::boundary` in boxes.
class SegmentTree {
 public:
  SegmentTree(const TriangleMesh& mesh, const Topology& topology);

  /// Calls visit(edge) for each edge whose box meets the box between two corners.
  template <class Visit>
  void near(const Point& lower, const Point& upper, Visit visit) const {
    struct Search {
      Eigen::AlignedBox2d within;
      const std::vector<Eigen::AlignedBox2d>& boxes;
      Visit& visit;
      bool intersectVolume(const Eigen::AlignedBox2d& box) const { return within.intersects(box); }
      bool intersectObject(int edge) const {
        if (intersectVolume(boxes[edge])) visit(edge);
        return false;  // the search goes on
      }
    };
    Search search{{lower, upper}, boxes_, visit};
    Eigen::BVIntersect(tree_, search);
  }
  [[nodiscard]] const std::vector<std::array<Point, 2>>& segments() const { return segments_; }

 private:
  std::vector<std::array<Point, 2>> segments_;
  std::vector<Eigen::AlignedBox2d> boxes_;
  Eigen::KdBVH<double, 2, int> tree_;
};

/// [m]
double distanceToSegment(const Point& p, const std::array<Point, 2>& segment);

}  // namespace mortier
