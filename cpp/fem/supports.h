// What holds a body: the motions of single nodes that conditions on labelled sides or at vertices prescribe,
//   d . u = value,   d a coordinate axis, the outward normal of the side or its tangent.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/datum.h"
#include "base/types.h"
#include "mesh/element_nodes.h"

namespace mortier {

/// Directions of displacements and tractions: axes, outward normal, tangent (the body to its left).
enum Component : int { alongX, alongY, alongNormal, alongTangent };

/// Displacement along a direction (Component), prescribed on a labelled boundary or, along an axis, at a
/// vertex [m].
struct PrescribedDisplacement {
  int label = 0;
  int component = 0;
  Datum value;
  std::optional<Point> point = {};  ///< where the vertex is, in place of the label [m]
  bool onAxis = false;              ///< of all nodes with x = 0, in place of the label

  [[nodiscard]] bool actsOn(int boundary) const { return !point && !onAxis && label == boundary; }
};

/// Nodes on the axis of a body of revolution stay there.
inline PrescribedDisplacement heldOnAxis() {
  Datum zero = [](double, double, double) { return 0.0; };
  zero.degree = 0;
  zero.inTime = false;
  return {0, alongX, std::move(zero), std::nullopt, true};
}

/// A node that may move along one direction only, or not at all.
struct NodeSupport {
  int node = 0;
  int count = 0;                          ///< prescribed motions: 1 or 2
  std::array<Point, 2> directions;        ///< d, unit vectors, independent
  std::array<int, 2> conditions{-1, -1};  ///< that prescribe them

  /// Whether one motion is prescribed along neither axis: the equations of the node are then those of the
  /// normal d and the tangent (-d.y, d.x).
  [[nodiscard]] bool turned() const { return count == 1 && directions[0].x() != 0 && directions[0].y() != 0; }
};

/// A further condition at a node that the others hold already in its direction; data that agree obey it.
struct FurtherMotion {
  int support = 0;  ///< number of the NodeSupport
  int condition = 0;
  Point direction{0, 0};
};

/// The normal of a node is that of the circle through it and its neighbours on the sides with a normal or
/// tangential condition, so it is exact on straight sides and on circles whatever the spacing. Where such
/// sides meet in a corner (they turn by 40 degrees or more) each has its own normal, and the node is held.
class Supports {
 public:
  Supports() = default;
  /// Labels and points that the mesh does not have hold nothing.
  Supports(const TriangleMesh& mesh, const ElementNodes& nodes,
           const std::vector<PrescribedDisplacement>& conditions);
  /// Of linear displacements.
  Supports(const TriangleMesh& mesh, const std::vector<PrescribedDisplacement>& conditions)
      : Supports(mesh, elementNodes(mesh, 1), conditions) {}

  [[nodiscard]] const std::vector<NodeSupport>& nodes() const { return nodes_; }  ///< ascending
  [[nodiscard]] const std::vector<FurtherMotion>& further() const { return further_; }

 private:
  void hold(NodeSupport& support, const Point& direction, int condition);

  std::vector<NodeSupport> nodes_;
  std::vector<FurtherMotion> further_;
};

/// The displacement nearest to `u` that has the prescribed `values` (support.count) along the directions.
Point prescribed(const NodeSupport& support, const std::array<double, 2>& values, const Point& u);

/// The prescribed motion along a direction or against it; -1 for none.
int sameMotion(const NodeSupport& support, const Point& direction);

/// The motion along a further direction that the prescribed values imply.
double impliedMotion(const NodeSupport& support, const std::array<double, 2>& values, const Point& direction);

}  // namespace mortier
