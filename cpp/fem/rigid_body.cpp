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
  const int n = dimension();
  const auto motions = static_cast<int>(motion.held.size());
  motions_.resize(dofs(), motions);
  for (int node = 0; node < nodes(); ++node) {
    const SpacePoint arm = placeOfNode(node) - motion.at;
    auto rows = motions_.middleRows(static_cast<Eigen::Index>(n) * node, n);
    rows.leftCols(n).setIdentity();
    for (int c = n; c < motions; ++c) rows.col(c) = SpacePoint::Unit(n == 3 ? c - n : 2).cross(arm).head(n);
  }
  // Columns of about the same size, or the normal equations lose digits.
  Vector scale = Vector::Ones(motions);
  scale.tail(motions - n).setConstant(extent_);
  const Matrix scaled = motions_ * scale.cwiseInverse().asDiagonal();
  toMotion_ = scale.cwiseInverse().asDiagonal() *
              Matrix(Matrix(scaled.transpose() * scaled).partialPivLu().solve(Matrix(scaled.transpose())));
  for (int c = 0; c < motions; ++c) {
    if (motion.held[c]) continue;
    freeMotions_.conservativeResize(dofs(), freeMotions_.cols() + 1);
    freeMotions_.rightCols<1>() = scaled.col(c);
  }
  freeMotions_.conservativeResize(dofs(), freeMotions_.cols());
  supports_.freeMotionsOnly(static_cast<int>(freeMotions_.cols()));
}

namespace {

/// The values of the data that there are, else 0.
Vector valuesOf(const std::vector<Datum>& data, const SpacePoint& at, double t) {
  Vector values = Vector::Zero(static_cast<Eigen::Index>(data.size()));
  for (size_t c = 0; c < data.size(); ++c)
    if (data[c]) values[static_cast<Eigen::Index>(c)] = data[c](at, t);
  return values;
}

}  // namespace

Vector Body::heldAt(double t) const {
  return valuesOf(conditions_.rigid->held, conditions_.rigid->at, t);
}

/// Nodal forces that do the work of the given ones on the motions.
Vector Body::rigidLoad(double t) const {
  return toMotion_.transpose() * valuesOf(conditions_.rigid->force, conditions_.rigid->at, t);
}

Vector Body::withHeld(const Vector& held, const Vector& displacement) const {
  Vector motion = held;
  const Vector own = freeDofs() > 0 ? motionOf(displacement) : held;
  for (Eigen::Index c = 0; c < motion.size(); ++c)
    if (!conditions_.rigid->held[c]) motion[c] = own[c];
  return displacementOf(motion);
}

Vector Body::heldForce(const Vector& nodal) const {
  Vector force = motions_.transpose() * nodal;
  for (Eigen::Index c = 0; c < force.size(); ++c)
    if (!conditions_.rigid->held[c]) force[c] = 0;
  return force;
}

Vector Body::moved(const Vector& displacement) const {
  if (!turns()) return displacement;
  const Vector motion = motionOf(displacement);
  const Point at = conditions_.rigid->at.head<2>();
  const double versine = 2 * std::pow(std::sin(motion[2] / 2), 2);
  const Eigen::Matrix2d turn{{-versine, -std::sin(motion[2])}, {std::sin(motion[2]), -versine}};
  Vector u(dofs());
  for (int node = 0; node < nodes(); ++node)
    u.segment<2>(2 * node) = motion.head<2>() + turn * (nodes_.places[node] - at);
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
  const Point at = conditions_.rigid->at.head<2>();
  const Point across = x[b] - x[a];
  const Point angle = turned(across) / across.squaredNorm();
  const Vector motion = motionOf(displacement);
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(motion[2]).toRotationMatrix();
  Triplets entries;
  const auto add = [&](int node, int of, const Eigen::Matrix2d& by) {
    for (const int row : {0, 1})
      for (const int column : {0, 1}) entries.emplace_back(2 * node + row, 2 * of + column, by(row, column));
  };
  for (const int node : nodes) {
    const Point arm = rotation * (x[node] - at) - (x[a] - at);
    const Eigen::Matrix2d byAngle = turned(arm) * angle.transpose();
    add(node, a, Eigen::Matrix2d::Identity() - byAngle);
    add(node, b, byAngle);
  }
  return assembled(dofs(), dofs(), entries);
}

}  // namespace mortier
