// Bodies that do not strain.
#include <Eigen/LU>

#include "fem/body.h"

namespace mortier {

void Body::findMotions() {
  const RigidMotion& motion = *conditions_.rigid;
  motions_.resize(dofs(), 3);
  for (int node = 0; node < nodes(); ++node) {
    const Point x = nodes_.places[node] - motion.at;
    motions_.middleRows<2>(2 * node) << 1, 0, -x.y(), 0, 1, x.x();
  }
  // Columns of about the same size, or the normal equations lose digits.
  const Eigen::Vector3d scale(1, 1, extent_);
  const Matrix scaled = motions_ * scale.cwiseInverse().asDiagonal();
  toMotion_ = scale.cwiseInverse().asDiagonal() *
              Matrix((scaled.transpose() * scaled).partialPivLu().solve(scaled.transpose()));
  for (int c = 0; c < 3; ++c) {
    if (motion.held[c]) continue;
    freeMotions_.conservativeResize(dofs(), ++freeDofs_);
    freeMotions_.rightCols<1>() = scaled.col(c);
  }
  equations_.assign(dofs(), -1);
  freeMotions_.conservativeResize(dofs(), freeDofs_);
}

Eigen::Vector3d Body::heldAt(double t) const {
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  const RigidMotion& motion = *conditions_.rigid;
  for (int c = 0; c < 3; ++c)
    if (motion.held[c]) values[c] = motion.held[c](motion.at.x(), motion.at.y(), t);
  return values;
}

/// Nodal forces that do the work of the given ones on the three motions.
Vector Body::rigidLoad(double t) const {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  const RigidMotion& motion = *conditions_.rigid;
  for (int c = 0; c < 3; ++c)
    if (motion.force[c]) force[c] = motion.force[c](motion.at.x(), motion.at.y(), t);
  return toMotion_.transpose() * force;
}

Vector Body::withHeld(const Eigen::Vector3d& held, const Vector& displacement) const {
  Eigen::Vector3d motion = held;
  const Eigen::Vector3d own = freeDofs_ > 0 ? motionOf(displacement) : held;
  for (int c = 0; c < 3; ++c)
    if (!conditions_.rigid->held[c]) motion[c] = own[c];
  return motions_ * motion;
}

Eigen::Vector3d Body::heldForce(const Vector& nodal) const {
  Eigen::Vector3d force = motions_.transpose() * nodal;
  for (int c = 0; c < 3; ++c)
    if (!conditions_.rigid->held[c]) force[c] = 0;
  return force;
}

}  // namespace mortier
