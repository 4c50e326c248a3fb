#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "time/quantity_motion.h"

#include "time/nodal_forces.h"

namespace mortier {
namespace {

/// What makes its work with r that of the share of r along a condition.
Vector motionOfSupports(const Body& body, const Quantity& quantity, int condition) {
  Vector motion = Vector::Zero(body.dofs());
  if (condition < 0) return motion;
  const Condition& own = body.conditions().displacements[condition];
  const int dimension = body.dimension();
  for (const NodeSupport& support : body.supports().nodes()) {
    std::array<double, 3> along{};
    for (int i = 0; i < support.count; ++i) {
      const Condition& held = body.conditions().displacements[support.conditions[i]];
      if (held.point == own.point && held.onAxis == own.onAxis && held.label == own.label)
        along[i] = support.directions[i].dot(motionAt(quantity, support.place));
    }
    motion.segment(static_cast<Eigen::Index>(dimension) * support.node, dimension) =
        support.motion(along).head(dimension);
  }
  return motion;
}

/// Of a body that does not strain: the part along the motions that are held.
Vector rigidMotion(const Body& body, const Quantity& quantity) {
  const RigidMotion& rigid = *body.conditions().rigid;
  Vector motion = Vector::Zero(static_cast<Eigen::Index>(rigid.held.size()));
  motion.head(body.dimension()) = motionAt(quantity, rigid.at).head(body.dimension());
  if (isMoment(quantity.component)) motion[body.rotationAbout(axisOf(quantity))] = 1;
  for (Eigen::Index c = 0; c < motion.size(); ++c)
    if (!rigid.held[c]) motion[c] = 0;
  return body.displacementOf(motion);
}

}  // namespace

int axisOf(const Quantity& quantity) {
  return static_cast<int>(quantity.component) % 3;
}

int motionNumber(const Quantity& quantity, const Body& body) {
  const int axis = axisOf(quantity);
  return quantity.component >= Quantity::Component::rotationX ? body.rotationAbout(axis) : axis;
}

SpacePoint motionAt(const Quantity& quantity, const SpacePoint& x) {
  const SpacePoint axis = SpacePoint::Unit(axisOf(quantity));
  return isMoment(quantity.component) ? SpacePoint(axis.cross(x - quantity.about)) : axis;
}

int firstSupport(const Body& body, int label, const std::optional<SpacePoint>& point) {
  const std::vector<Condition>& held = body.conditions().displacements;
  const auto found = std::find_if(held.begin(), held.end(), [&](const Condition& each) {
    return point ? each.point == point : each.actsOn(label);
  });
  return found == held.end() ? -1 : static_cast<int>(found - held.begin());
}

Vector reactionMotion(const Quantity& quantity, const Body& body) {
  if (body.rigid()) return rigidMotion(body, quantity);
  return motionOfSupports(body, quantity, firstSupport(body, quantity.label, quantity.point));
}

Vector motionOf(const Quantity& quantity, const Model& model) {
  const Body& body = model.bodies[quantity.body];
  if (quantity.kind != Quantity::Kind::contactForce) return reactionMotion(quantity, body);
  Vector motion = Vector::Zero(body.dofs());
  const int dimension = body.dimension();
  const std::optional<int> label = quantity.whole ? std::nullopt : std::optional(quantity.label);
  std::vector<int> nodes = body.boundaryNodes(label);
  // Rows of ties act on nodes behind a side that is apart from the other one, too.
  for (const Tie& tie : model.ties)
    for (size_t side = 0; side < tie.sides().size(); ++side)
      if (isTieSide(tie, side, quantity.body, label))
        forEachEntry(tie.sides()[side].C, [&](int, int dof, double) { nodes.push_back(dof / dimension); });
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const int node : nodes)
    motion.segment(static_cast<Eigen::Index>(dimension) * node, dimension) =
        -motionAt(quantity, body.placeOfNode(node)).head(dimension);
  return motion;
}

}  // namespace mortier
