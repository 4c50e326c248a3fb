#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "time/quantity_motion.h"

namespace mortier {
namespace {

/// Writes into `motion` what makes its work with r that of the share of r along the conditions that `own`
/// names.
template <class Own>
void addSupports(const Body& body, const Quantity& quantity, const Own& own, Vector& motion) {
  for (const NodeSupport& support : body.supports().nodes()) {
    // r = sum of shares along the directions: rows of the inverse pick them.
    Eigen::Matrix2d directions = Eigen::Matrix2d::Identity();
    for (int i = 0; i < support.count; ++i) directions.col(i) = support.directions[i];
    const Eigen::Matrix2d shares =
        support.count == 2 ? Eigen::Matrix2d(directions.inverse()) : Eigen::Matrix2d(directions.transpose());
    const Point e = motionAt(quantity, body.placeOfNode(support.node)).head<2>();
    for (int i = 0; i < support.count; ++i) {
      const PrescribedDisplacement& held = body.conditions().displacements[support.conditions[i]];
      if (held.onAxis || !own(held.label, held.point, std::optional<SpacePoint>())) continue;
      motion.segment<2>(2 * support.node) += support.directions[i].dot(e) * shares.row(i).transpose();
    }
  }
}

template <class Own>
void addSpaceSupports(const Body& body, const Quantity& quantity, const Own& own, Vector& motion) {
  for (const SpaceSupport& support : body.space()->supports()) {
    // By the prescribed directions, which need not be orthogonal: D' shares = r on their span.
    const Eigen::Index n = support.count;
    const Matrix span = support.frame.topRows(n);
    const Matrix inSpan = support.directions.topRows(n) * span.transpose();  // lower triangular
    Vector along = support.directions.topRows(n) * motionAt(quantity, body.placeOfNode(support.node));
    for (int i = 0; i < support.count; ++i) {
      const SpaceCondition& held = body.space()->conditions().displacements[support.conditions[i]];
      if (!own(held.label, std::optional<Point>(), held.point)) along[i] = 0;
    }
    motion.segment<3>(3 * support.node) +=
        span.transpose() * inSpan.triangularView<Eigen::Lower>().solve(along);
  }
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

SpacePoint normalAt(const ContactInterface& interface, int row) {
  if (interface.dimension() == 3) return interface.spaceNormals()[row];
  const Point& n = interface.normals()[row];
  return {n.x(), n.y(), 0};
}

int firstSupport(const Body& body, int label, const std::optional<Point>& point,
                 const std::optional<SpacePoint>& pointInSpace) {
  if (body.space() != nullptr) {
    const std::vector<SpaceCondition>& held = body.space()->conditions().displacements;
    const auto found = std::find_if(held.begin(), held.end(), [&](const SpaceCondition& each) {
      return each.point == pointInSpace && (pointInSpace || each.label == label);
    });
    return found == held.end() ? -1 : static_cast<int>(found - held.begin());
  }
  const std::vector<PrescribedDisplacement>& held = body.conditions().displacements;
  const auto found = std::find_if(held.begin(), held.end(), [&](const PrescribedDisplacement& each) {
    return point ? each.point == point : each.actsOn(label);
  });
  return found == held.end() ? -1 : static_cast<int>(found - held.begin());
}

Vector reactionMotion(const Quantity& quantity, const Body& body) {
  if (body.rigid()) return rigidMotion(body, quantity);
  Vector motion = Vector::Zero(body.dofs());
  const int first = firstSupport(body, quantity.label, quantity.point, quantity.pointInSpace);
  const auto own = [&](int label, const std::optional<Point>& point,
                       const std::optional<SpacePoint>& inSpace) {
    return firstSupport(body, label, point, inSpace) == first;
  };
  if (body.space() != nullptr)
    addSpaceSupports(body, quantity, own, motion);
  else
    addSupports(body, quantity, own, motion);
  return motion;
}

Vector motionOf(const Quantity& quantity, const Model& model) {
  const Body& body = model.bodies[quantity.body];
  if (quantity.kind != Quantity::Kind::contactForce) return reactionMotion(quantity, body);
  Vector motion = Vector::Zero(body.dofs());
  const int dimension = body.dimension();
  for (const int node : body.boundaryNodes(quantity.whole ? std::nullopt : std::optional(quantity.label)))
    motion.segment(static_cast<Eigen::Index>(dimension) * node, dimension) =
        -motionAt(quantity, body.placeOfNode(node)).head(dimension);
  return motion;
}

}  // namespace mortier
