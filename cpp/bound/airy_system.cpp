#include "bound/airy_system.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/interrupt.h"

namespace mortier {

AirySystem::AirySystem(const Sides& sides, size_t vertices)
    : vertices_(static_cast<int>(vertices)),
      firstSide_(3 * vertices_),
      sides_(sides.count()),
      sidesFrom_(vertices + 1, 0),
      diagonal_(vertices, Eigen::Matrix3d::Zero()),
      b_(Vector::Zero(firstSide_ + sides.count())) {
  for (int e = 0; e < sides.count(); ++e) {
    const auto [low, high] = std::minmax(sides.all()[e].vertices[0], sides.all()[e].vertices[1]);
    ++sidesFrom_[low + 1];
    Coupling& side = sides_[e];
    side.vertices = {low, high, low, low};  // what is not there couples with 0
    side.others.fill(e);
    side.ends.setZero();
    side.withVertices.fill(Eigen::Vector3d::Zero());
    side.withOthers.fill(0);
    side.own = 0;
  }
  for (int v = 0; v < vertices_; ++v) sidesFrom_[v + 1] += sidesFrom_[v];
}

void AirySystem::add(const std::array<int, 3>& triangle, const std::array<int, 3>& sidesOf,
                     const MomentMatrix& K, const AiryModes& b, double energy) {
  for (int k = 0; k < 3; ++k) {
    const int last = (k + 1) % 3;
    const int apex = (k + 2) % 3;
    diagonal_[triangle[k]] += K.block<3, 3>(3 * k, 3 * k);
    b_.segment<3>(3 * triangle[k]) += b.segment<3>(3 * k);
    b_[firstSide_ + sidesOf[k]] += b[9 + k];
    Coupling& side = sides_[sidesOf[k]];
    const bool ascends = triangle[k] < triangle[last];
    if (ascends)
      side.ends += K.block<3, 3>(3 * k, 3 * last);
    else
      side.ends += K.block<3, 3>(3 * last, 3 * k);
    side.withVertices[ascends ? 0 : 1] += K.block<3, 1>(3 * k, 9 + k);
    side.withVertices[ascends ? 1 : 0] += K.block<3, 1>(3 * last, 9 + k);
    const bool second = side.own != 0;  // the side of two triangles
    side.vertices[second ? 3 : 2] = triangle[apex];
    side.withVertices[second ? 3 : 2] = K.block<3, 1>(3 * apex, 9 + k);
    side.own += K(9 + k, 9 + k);
    int slot = second ? 2 : 0;
    for (const int other : {last, apex})
      if (sidesOf[other] > sidesOf[k]) {
        side.others[slot] = sidesOf[other];
        side.withOthers[slot++] = K(9 + other, 9 + k);
      }
  }
  energy_ += energy;
}

/// Modes that are not allowed stay 0: they get a 1.
void AirySystem::invertDiagonal() {
  inverse_.resize(diagonal_.size());
  for (size_t v = 0; v < diagonal_.size(); ++v) {
    for (int c = 0; c < 3; ++c)
      if (diagonal_[v](c, c) == 0) diagonal_[v](c, c) = 1;
    // Values and derivatives have units of their own.
    const Eigen::Vector3d scale = diagonal_[v].diagonal().array().rsqrt();
    const Eigen::Matrix3d scaled = scale.asDiagonal() * diagonal_[v] * scale.asDiagonal();
    inverse_[v] = scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
    if (!inverse_[v].allFinite()) inverse_[v] = scale.cwiseAbs2().asDiagonal();
  }
  for (Coupling& side : sides_)
    if (side.own == 0) side.own = 1;
}

void AirySystem::forward(Vector& f) const {
  for (int v = 0; v < vertices_; ++v) {
    const Eigen::Vector3d x = inverse_[v] * f.segment<3>(3 * v);
    f.segment<3>(3 * v) = x;
    for (int e = sidesFrom_[v]; e < sidesFrom_[v + 1]; ++e)
      f.segment<3>(3 * sides_[e].vertices[1]) -= sides_[e].ends.transpose() * x;
  }
  double* const ofSides = f.data() + firstSide_;
  for (size_t e = 0; e < sides_.size(); ++e) {
    const Coupling& side = sides_[e];
    double left = ofSides[e];
    for (int i = 0; i < 4; ++i) left -= side.withVertices[i].dot(f.segment<3>(3 * side.vertices[i]));
    left /= side.own;
    ofSides[e] = left;
    for (int i = 0; i < 4; ++i) ofSides[side.others[i]] -= side.withOthers[i] * left;
  }
}

void AirySystem::backward(Vector& f) const {
  double* const ofSides = f.data() + firstSide_;
  for (size_t e = sides_.size(); e-- > 0;) {
    const Coupling& side = sides_[e];
    double left = ofSides[e];
    for (int i = 0; i < 4; ++i) left -= side.withOthers[i] * ofSides[side.others[i]];
    left /= side.own;
    ofSides[e] = left;
    for (int i = 0; i < 4; ++i) f.segment<3>(3 * side.vertices[i]) -= side.withVertices[i] * left;
  }
  for (int v = vertices_ - 1; v >= 0; --v) {
    Eigen::Vector3d left = f.segment<3>(3 * v);
    for (int e = sidesFrom_[v]; e < sidesFrom_[v + 1]; ++e)
      left -= sides_[e].ends * f.segment<3>(3 * sides_[e].vertices[1]);
    f.segment<3>(3 * v) = inverse_[v] * left;
  }
}

void AirySystem::multiplyDiagonal(const Vector& f, Vector& result) const {
  for (int v = 0; v < vertices_; ++v) result.segment<3>(3 * v) = diagonal_[v] * f.segment<3>(3 * v);
  for (size_t e = 0; e < sides_.size(); ++e) result[firstSide_ + e] = sides_[e].own * f[firstSide_ + e];
}

void AirySystem::solve(double worthwhile, int most) {
  invertDiagonal();
  x_.setZero(b_.size());
  Vector& r = b_;
  forward(r);
  Vector z(r.size());
  multiplyDiagonal(r, z);
  Vector p = z;
  Vector q(r.size());
  double rho = r.dot(z);
  double before = energy_;
  for (iterations_ = 0; iterations_ < most && rho > 0; ++iterations_) {
    stopIfInterrupted();
    Vector& t = z;
    t = p;
    backward(t);
    multiplyDiagonal(t, q);
    q = p - q;
    forward(q);
    q += t;
    const double curvature = p.dot(q);
    const double step = rho / curvature;
    if (!(curvature > 0) || !std::isfinite(step)) break;
    x_ += step * t;
    r -= step * q;
    const double gain = step * rho;
    energy_ -= gain;
    const bool done = before - energy_ <= worthwhile * energy_ && iterations_ > 1;
    before = energy_ + gain;
    if (done || !(energy_ > 0)) break;
    multiplyDiagonal(r, z);
    const double next = r.dot(z);
    p = z + (next / rho) * p;
    rho = next;
  }
}

}  // namespace mortier
