#include "bound/airy_system.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/interrupt.h"
#include "linear/strip_solver.h"

namespace mortier {
namespace {

/// Of the block's diagonal.
constexpr double regularised = 1e-12;

/// What iterations still take that gain like those before: with g the gains, the last one times the largest
/// of (g_(j+1) + ... + g_k)/g_j (Meurant, Papez, Tichy, Numer. Algorithms 88 (2021)).
double toCome(const std::vector<double>& gains) {
  constexpr size_t fewest = 3;
  if (gains.size() < fewest) return std::numeric_limits<double>::infinity();
  double sum = gains.back();
  double ratio = 0;
  for (size_t j = gains.size() - 1; j-- > 0;) {
    ratio = std::max(ratio, sum / gains[j]);
    sum += gains[j];
  }
  return ratio * gains.back();
}

}  // namespace

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

bool AirySystem::join(const TriangleMesh& mesh, const Sides& sides, const std::vector<int>& triangles) {
  invertDiagonal();
  if (triangles.empty()) return true;
  number_.assign(b_.size(), -1);
  const auto put = [&](int mode) {
    if (number_[mode] >= 0) return;
    number_[mode] = static_cast<int>(inBlock_.size());
    inBlock_.push_back(mode);
  };
  for (const int t : triangles)
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) put(3 * mesh.triangles[t][k] + c);
      put(firstSide_ + sides.of(t, k));
    }
  std::vector<MatrixEntry> own;
  // Takes a coupling out of the sweeps where one of its modes is in the block.
  const auto take = [&](int i, int j, double& value) {
    const int a = number_[i];
    const int b = number_[j];
    if (value == 0 || (a < 0 && b < 0)) return;
    if (a >= 0 && b >= 0)
      own.push_back({std::min(a, b), std::max(a, b), value});
    else
      toBlock_.push_back({a < 0 ? i : j, a < 0 ? j : i, value});
    value = 0;
  };
  for (int v = 0; v < vertices_; ++v) {
    if (number_[3 * v] < 0) continue;
    for (int c = 0; c < 3; ++c)
      for (int r = c; r < 3; ++r) take(3 * v + r, 3 * v + c, diagonal_[v](r, c));
    diagonal_[v].setIdentity();
    inverse_[v].setIdentity();
  }
  for (size_t e = 0; e < sides_.size(); ++e) {
    Coupling& side = sides_[e];
    const int mode = firstSide_ + static_cast<int>(e);
    const auto joined = [&](int other) { return number_[other] >= 0; };
    if (!joined(mode) &&
        std::none_of(side.vertices.begin(), side.vertices.end(), [&](int v) { return joined(3 * v); }) &&
        std::none_of(side.others.begin(), side.others.end(), [&](int o) { return joined(firstSide_ + o); }))
      continue;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) take(3 * side.vertices[0] + r, 3 * side.vertices[1] + c, side.ends(r, c));
    for (int i = 0; i < 4; ++i) {
      for (int c = 0; c < 3; ++c) take(mode, 3 * side.vertices[i] + c, side.withVertices[i][c]);
      take(mode, firstSide_ + side.others[i], side.withOthers[i]);
    }
    if (number_[mode] < 0) continue;
    take(mode, mode, side.own);
    side.own = 1;
  }
  block_ = assembled(static_cast<int>(inBlock_.size()), own);
  // A linear function is no stress.
  for (int c = 0; c < block_.pattern.size; ++c) block_.values[block_.pattern.columnStart[c]] *= 1 + regularised;
  blockSolver_ = stripSolver(block_.pattern);
  return blockSolver_->factorise(block_.values);
}

void AirySystem::solveBlock(Vector& f) const {
  Vector x = f(inBlock_);
  blockSolver_->condense(x);
  blockSolver_->expand(x);
  f(inBlock_) = x;
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
  if (inBlock_.empty()) return;
  for (const auto& [column, row, value] : toBlock_) f[row] -= value * f[column];
  solveBlock(f);
}

void AirySystem::backward(Vector& f) const {
  if (!inBlock_.empty()) {
    solveBlock(f);
    for (const auto& [column, row, value] : toBlock_) f[column] -= value * f[row];
  }
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
  for (const int mode : inBlock_) result[mode] = 0;
  const SparsePattern& pattern = block_.pattern;
  for (int c = 0; c < pattern.size; ++c)
    for (int k = pattern.columnStart[c]; k < pattern.columnStart[c + 1]; ++k) {
      const int r = pattern.rows[k];
      result[inBlock_[r]] += block_.values[k] * f[inBlock_[c]];
      if (r != c) result[inBlock_[c]] += block_.values[k] * f[inBlock_[r]];
    }
}

bool AirySystem::solve(double part, int most) {
  x_.setZero(b_.size());
  Vector& r = b_;
  forward(r);
  Vector z(r.size());
  multiplyDiagonal(r, z);
  Vector p = z;
  Vector q(r.size());
  double rho = r.dot(z);
  std::vector<double> gains;
  for (iterations_ = 0; iterations_ < most; ++iterations_) {
    if (!(energy_ > 0) || !(rho > 0)) return true;
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
    if (!(curvature > 0) || !std::isfinite(step)) return false;
    x_ += step * t;
    r -= step * q;
    gains.push_back(step * rho);
    energy_ -= gains.back();
    if (toCome(gains) <= part * energy_) return true;
    multiplyDiagonal(r, z);
    const double next = r.dot(z);
    p = z + (next / rho) * p;
    rho = next;
  }
  return false;
}

}  // namespace mortier
