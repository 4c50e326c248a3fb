#include "lint/topology.h"

#include <algorithm>
#include <numeric>

#include "mesh/element_sides.h"

namespace mortier {

Topology topologyOf(const TriangleMesh& mesh) {
  const ElementSides<2> sides = sortedSides(mesh);
  std::vector<int> labels(sides.size(), noLabel);
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    for (const ElementSide<2>& side : sidesOn(sides, mesh.boundaryEdges[e]))
      labels[&side - sides.data()] = mesh.boundaryLabels[e];
  Topology topology;
  forEachPlace(sides, [&](std::span<const ElementSide<2>> on) {
    const ElementSide<2>& first = on[0];
    const auto& corners = mesh.triangles[first.element()];
    if (on.size() > 1)
      topology.neighbours.push_back({first.element(), on[1].element()});
    else
      topology.boundary.push_back({corners[first.corner()], corners[(first.corner() + 1) % 3],
                                   first.element(), labels[&first - sides.data()]});
  });
  return topology;
}

SegmentTree::SegmentTree(const TriangleMesh& mesh, const Topology& topology) {
  std::vector<int> edges(topology.boundary.size());
  std::iota(edges.begin(), edges.end(), 0);
  for (const BoundaryEdge& edge : topology.boundary) {
    segments_.push_back({mesh.vertices[edge.from], mesh.vertices[edge.to]});
    boxes_.emplace_back(segments_.back()[0]).extend(segments_.back()[1]);
  }
  tree_.init(edges.begin(), edges.end(), boxes_.begin(), boxes_.end());
}

double distanceToSegment(const Point& p, const std::array<Point, 2>& segment) {
  const Point along = segment[1] - segment[0];
  const double square = along.squaredNorm();
  const double s = square > 0 ? std::clamp((p - segment[0]).dot(along) / square, 0.0, 1.0) : 0.0;
  return (p - segment[0] - s * along).norm();
}

}  // namespace mortier
