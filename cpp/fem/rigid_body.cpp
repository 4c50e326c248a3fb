// Bodies that do not strain.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/sparse.h"
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
    freeMotions_.conservativeResize(dofs(), freeMotions_.cols() + 1);
    freeMotions_.rightCols<1>() = scaled.col(c);
  }
  freeMotions_.conservativeResize(dofs(), freeMotions_.cols());
  supports_.freeMotionsOnly(static_cast<int>(freeMotions_.cols()));
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
  const Eigen::Vector3d own = freeDofs() > 0 ? motionOf(displacement) : held;
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

Vector Body::moved(const Vector& displacement) const {
  if (!turns()) return displacement;
  const Eigen::Vector3d motion = motionOf(displacement);
  const double versine = 2 * std::pow(std::sin(motion[2] / 2), 2);
  const Eigen::Matrix2d turn{{-versine, -std::sin(motion[2])}, {std::sin(motion[2]), -versine}};
  Vector u(dofs());
  for (int node = 0; node < nodes(); ++node)
    u.segment<2>(2 * node) = motion.head<2>() + turn * (nodes_.places[node] - conditions_.rigid->at);
  return u;
}

// The reference point moves as node A less the angle times its arm, and the angle is the difference of A and
// B across their distance: what acts on the nodes becomes forces at A and B of the same resultant and moment.
Eigen::SparseMatrix<double> Body::changeOfMoved(const Vector& displacement,
                                                const std::vector<int>& nodes) const {
  const std::vector<Point>& x = nodes_.places;
  const int a = nodes.front();
  const int b = *std::max_element(nodes.begin(), nodes.end(), [&](int one, int other) {
    return (x[one] - x[a]).squaredNorm() < (x[other] - x[a]).squaredNorm();
  });
  const Point across = x[b] - x[a];
  const Point angle = turned(across) / across.squaredNorm();
  const Eigen::Vector3d motion = motionOf(displacement);
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(motion[2]).toRotationMatrix();
  Triplets entries;
  const auto add = [&](int node, int of, const Eigen::Matrix2d& by) {
    for (const int row : {0, 1})
      for (const int column : {0, 1}) entries.emplace_back(2 * node + row, 2 * of + column, by(row, column));
  };
  for (const int node : nodes) {
    const Point arm = rotation * (x[node] - conditions_.rigid->at) - (x[a] - conditions_.rigid->at);
    const Eigen::Matrix2d byAngle = turned(arm) * angle.transpose();
    add(node, a, Eigen::Matrix2d::Identity() - byAngle);
    add(node, b, byAngle);
  }
  return assembled(dofs(), dofs(), entries);
}

}  // namespace mortier
