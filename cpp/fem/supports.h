// What holds a body: the motions of single nodes that conditions on labelled sides or at vertices prescribe,
//   d . u = value,   d a coordinate axis, the outward normal of the side or its tangent.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/datum.h"
#include "base/two_part_vector.h"
#include "base/types.h"
#include "mesh/element_nodes.h"
#include "mesh/tetrahedron_mesh.h"

namespace mortier {

/// Directions of displacements and tractions: axes, outward normal, and in the plane the tangent (the body to
/// its left).
enum Component : int { alongX, alongY, alongZ, alongNormal, alongTangent };

/// A displacement [m] or a force per area along a direction (Component), on a labelled boundary; in the plane
/// the force is per length [N/m per metre of depth, Pa]. A pressure p is the normal traction -p. Or a
/// displacement or a force along an axis at a vertex [N/m], about an axis of revolution and in space [N].
struct Condition {
  int label = 0;
  int component = 0;
  Datum value = {};
  std::optional<SpacePoint> point =
      {};                  ///< where the vertex is, in place of the label [m]; z = 0 in the plane
  bool onAxis = false;     ///< of all nodes with x = 0, in place of the label
  bool whereItIs = false;  ///< the displacement in which the run begins, in place of the value

  [[nodiscard]] bool actsOn(int boundary) const { return !point && !onAxis && label == boundary; }
};

/// Nodes on the axis of a body of revolution stay there.
inline Condition heldOnAxis() {
  Datum zero = [](const SpacePoint&, double) { return 0.0; };
  zero.degree = 0;
  zero.inTime = false;
  return {0, alongX, std::move(zero), std::nullopt, true};
}

/// A node of which one motion or more are prescribed. In the plane nothing is along z.
struct NodeSupport {
  int node = 0;
  SpacePoint place{0, 0, 0};                        ///< [m]
  int count = 0;                                    ///< prescribed motions, at most the dimension
  std::array<SpacePoint, 3> directions;             ///< d, unit vectors, the first `count` independent
  std::array<int, 3> conditions{-1, -1, -1};        ///< that prescribe them
  Eigen::Matrix3d frame = Eigen::Matrix3d::Zero();  ///< orthonormal rows; the first `count` span the d
  bool turned = false;  ///< whether its equations are those of the other rows, not of the axes

  /// What has these components along the prescribed directions, and none across them.
  [[nodiscard]] SpacePoint motion(const std::array<double, 3>& values) const;
  /// The part of a vector in the span of the directions.
  [[nodiscard]] SpacePoint held(const SpacePoint& vector) const;
  /// The prescribed motion along a direction or against it; -1 for none.
  [[nodiscard]] int same(const SpacePoint& direction) const;
  /// The motion along a further direction that the prescribed values imply.
  [[nodiscard]] double implied(const std::array<double, 3>& values, const SpacePoint& direction) const;
};

/// A further condition at a node that the others hold already in its direction; data that agree obey it.
struct FurtherMotion {
  int support = 0;  ///< number of the NodeSupport
  int condition = 0;
  SpacePoint direction{0, 0, 0};
};

/// In the plane the normal of a node is that of the circle through it and its neighbours on the sides with a
/// normal or tangential condition, so it is exact on straight sides and on circles whatever the spacing; in
/// space the normals of triangles count so that it is exact on spheres (Max 1999). Where such sides meet in a
/// corner (they turn by 40 degrees or more) each has its own normal.
class Supports {
 public:
  Supports() = default;
  // Labels and points that the mesh does not have hold nothing.
  Supports(const TriangleMesh& mesh, const ElementNodes& nodes, const std::vector<Condition>& conditions);
  Supports(const TetrahedronMesh& mesh, const SpaceNodes& nodes, const std::vector<Condition>& conditions);
  /// Of linear displacements.
  Supports(const TriangleMesh& mesh, const std::vector<Condition>& conditions)
      : Supports(mesh, elementNodes(mesh, 1), conditions) {}

  [[nodiscard]] const std::vector<NodeSupport>& nodes() const { return nodes_; }  ///< ascending
  [[nodiscard]] const std::vector<FurtherMotion>& further() const { return further_; }

  // Equations: a node has as many as there are dimensions, less its prescribed motions.

  /// Of each dof; -1 where that motion is prescribed.
  [[nodiscard]] const std::vector<int>& equations() const { return equations_; }
  [[nodiscard]] int freeDofs() const { return freeDofs_; }
  /// Of a body that does not strain: none of nodes.
  void freeMotionsOnly(int count);
  /// The directions of a node's equations, rows; null where they are the axes.
  [[nodiscard]] const Eigen::Matrix3d* frameOf(int node) const {
    return turnedOf_.empty() || turnedOf_[node] < 0 ? nullptr : &nodes_[turnedOf_[node]].frame;
  }
  /// Nodal vectors (dofs) to equations; what acts along prescribed motions is left out.
  [[nodiscard]] Vector gather(const Vector& nodal) const;
  /// The reverse: dofs, nothing along prescribed motions.
  [[nodiscard]] Vector spread(const Vector& x) const;
  /// Writes what `conditions`, those of the constructor, prescribe at time t into `u` (dofs).
  void prescribe(const std::vector<Condition>& conditions, double t, Vector& u) const;
  /// The change from t0 to t1 into an increment.
  void prescribeIncrement(const std::vector<Condition>& conditions, double t0, double t1,
                          TwoPartVector& increment) const;

 private:
  template <class Nodes, class NodesOf, class DirectionsOf>
  void build(const Nodes& nodes, const std::vector<Condition>& conditions, const NodesOf& nodesOf,
             const DirectionsOf& directionsOf);
  void hold(NodeSupport& support, const SpacePoint& direction, int condition);
  [[nodiscard]] SpacePoint vectorAt(const Vector& nodal, int node) const;
  /// What is prescribed at time t1 less that at t0, where there is one.
  [[nodiscard]] SpacePoint motionOf(const NodeSupport& support, const std::vector<Condition>& conditions,
                                    std::optional<double> t0, double t1) const;

  int dimension_ = 2;
  std::vector<NodeSupport> nodes_;
  std::vector<FurtherMotion> further_;
  std::vector<int> equations_;
  std::vector<int> turnedOf_;  ///< by nodes, their turned support or -1; empty where there are none
  int freeDofs_ = 0;
};

}  // namespace mortier
