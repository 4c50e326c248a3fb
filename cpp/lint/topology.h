// Edges of a mesh, and which of them are near a point: what geometric checks ask for.
#pragma once

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

/// A uniform grid over segments, about one a cell.
class SegmentGrid {
 public:
  explicit SegmentGrid(std::vector<std::array<Point, 2>> segments);

  /// Calls visit(segment) for each segment whose cells meet the box, some of them more than once.
  template <class Visit>
  void near(const Point& lower, const Point& upper, Visit visit) const {
    const auto [x0, y0] = cell(lower);
    const auto [x1, y1] = cell(upper);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x)
        for (const int segment : cells_[static_cast<size_t>(y) * columns_ + x]) visit(segment);
  }
  [[nodiscard]] const std::vector<std::array<Point, 2>>& segments() const { return segments_; }

 private:
  [[nodiscard]] std::array<int, 2> cell(const Point& p) const;

  std::vector<std::array<Point, 2>> segments_;
  Point lower_{0, 0};
  Point size_{1, 1};  ///< of a cell
  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::vector<int>> cells_;
};

/// Over the edges of `topology.boundary`, in their order.
SegmentGrid boundaryGrid(const TriangleMesh& mesh, const Topology& topology);

/// [m]
double distanceToSegment(const Point& p, const std::array<Point, 2>& segment);

/// The length of an edge of the other labelled line over that of one of the first, where both are shortest:
/// on graded lines, where contact is expected. \pre neither is empty
double edgeRatioWhereFine(const TriangleMesh& mesh, int label, const TriangleMesh& other, int otherLabel);

/// Lower left and upper right corner of all vertices [m].
std::array<Point, 2> boundingBox(const TriangleMesh& mesh);

}  // namespace mortier
