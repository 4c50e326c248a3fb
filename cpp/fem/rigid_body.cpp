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

namespace {

/// x -> t x x
Eigen::Matrix3d crossed(const SpacePoint& t) {
  return Eigen::Matrix3d{{0, -t.z(), t.y()}, {t.z(), 0, -t.x()}, {-t.y(), t.x(), 0}};
}

/// A rotation by a vector t, and what its change dt turns by: d(R x) = (T dt) x R x.
struct Rotation {
  explicit Rotation(const SpacePoint& t) {
    const double angle = t.norm();
    const Eigen::Matrix3d axis = crossed(angle > 0 ? SpacePoint(t / angle) : SpacePoint(0, 0, 0));
    const double versine = 2 * std::pow(std::sin(angle / 2), 2);
    lessIdentity = std::sin(angle) * axis + versine * axis * axis;
    if (angle > 0) change += versine / angle * axis + (1 - std::sin(angle) / angle) * axis * axis;
  }
  Eigen::Matrix3d lessIdentity;  ///< R - 1
  Eigen::Matrix3d change = Eigen::Matrix3d::Identity();
};

}  // namespace

SpacePoint Body::turnOf(const Vector& motion) const {
  return dimension() == 3 ? SpacePoint(motion.tail<3>()) : SpacePoint(0, 0, motion[2]);
}

Vector Body::moved(const Vector& displacement) const {
  if (!turns()) return displacement;
  const int n = dimension();
  const Vector motion = motionOf(displacement);
  const Rotation rotation(turnOf(motion));
  Vector u(dofs());
  for (int node = 0; node < nodes(); ++node)
    u.segment(n * node, n) =
        motion.head(n) + (rotation.lessIdentity * (placeOfNode(node) - conditions_.rigid->at)).head(n);
  return u;
}

// Motions are linear in the displacements of two nodes, in space of three that lie on no line: what acts on
// all nodes becomes forces at these of the same resultant and moment.
Eigen::SparseMatrix<double> Body::changeOfMoved(const Vector& displacement,
                                                const std::vector<int>& nodes) const {
  const int n = dimension();
  const auto farthest = [&](auto&& distance) {
    return *std::max_element(nodes.begin(), nodes.end(),
                             [&](int one, int other) { return distance(one) < distance(other); });
  };
  const auto way = [&](int from, int to) { return SpacePoint(placeOfNode(to) - placeOfNode(from)); };
  std::vector<int> few{nodes.front()};
  few.push_back(farthest([&](int node) { return way(few[0], node).norm(); }));
  if (n == 3)
    few.push_back(farthest([&](int node) { return way(few[0], few[1]).cross(way(few[0], node)).norm(); }));
  const SpacePoint& at = conditions_.rigid->at;
  const Eigen::Index motions = motions_.cols();
  Matrix ofFew(n * few.size(), motions);
  for (size_t i = 0; i < few.size(); ++i)
    ofFew.middleRows(n * static_cast<Eigen::Index>(i), n) =
        motions_.middleRows(static_cast<Eigen::Index>(n) * few[i], n);
  Vector scale = Vector::Ones(motions);
  scale.tail(motions - n).setConstant(extent_);
  const Matrix toMotion =
      scale.cwiseInverse().asDiagonal() *
      Matrix((ofFew * scale.cwiseInverse().asDiagonal()).completeOrthogonalDecomposition().pseudoInverse());
  const Rotation rotation(turnOf(motionOf(displacement)));
  Triplets entries;
  for (const int node : nodes) {
    const SpacePoint arm = placeOfNode(node) - at + rotation.lessIdentity * (placeOfNode(node) - at);
    const Eigen::Matrix3d byTurn = -crossed(arm) * rotation.change;
    Matrix change(n, motions);
    change.leftCols(n).setIdentity();
    change.rightCols(motions - n) = n == 3 ? Matrix(byTurn) : Matrix(byTurn.col(2).head(n));
    const Matrix entriesOf = change * toMotion;
    for (size_t i = 0; i < few.size(); ++i)
      for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column)
          entries.emplace_back(n * node + row, n * few[i] + column,
                               entriesOf(row, n * static_cast<Eigen::Index>(i) + column));
  }
  return assembled(dofs(), dofs(), entries);
}

}  // namespace mortier
