#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "time/quantity_motion.h"

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
  const SpacePoint there = motionAt(quantity, {rigid.at.x(), rigid.at.y(), 0});
  const double x = rigid.held[0] ? there.x() : 0;
  const double y = rigid.held[1] ? there.y() : 0;
  const double angle = rigid.held[2] && isMoment(quantity.component) ? 1 : 0;
  Vector motion(body.dofs());
  for (int node = 0; node < body.nodes(); ++node) {
    const Point arm = body.placeOfNode(node).head<2>() - rigid.at;
    motion.segment<2>(2 * node) << x - angle * arm.y(), y + angle * arm.x();
  }
  return motion;
}

}  // namespace

int axisOf(const Quantity& quantity) {
  using enum Quantity::Component;
  const Quantity::Component along = quantity.component;
  return along == x || along == momentX ? 0 : along == y || along == momentY ? 1 : 2;
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
    for (const auto& [side, C] :
         {std::pair(&tie.pair().nonmortar, &tie.C1()), {&tie.pair().mortar, &tie.C2()}})
      if (side->body == quantity.body && (!label || side->label == *label))
        forEachEntry(*C, [&](int, int dof, double) { nodes.push_back(dof / dimension); });
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const int node : nodes)
    motion.segment(static_cast<Eigen::Index>(dimension) * node, dimension) =
        -motionAt(quantity, body.placeOfNode(node)).head(dimension);
  return motion;
}

}  // namespace mortier
