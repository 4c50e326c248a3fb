#include "bound/relaxation.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/interrupt.h"

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

AirySystem::AirySystem(const TriangleMesh& mesh, const Sides& sides, const std::vector<int>& thin)
    : vertices_(static_cast<int>(mesh.vertices.size())),
      firstSide_(stride * vertices_),
      sides_(sides.count()),
      sidesFrom_(mesh.vertices.size() + 1, 0),
      diagonal_(mesh.vertices.size(), Block::Zero()),
      b_(Vector::Zero(firstSide_ + sides.count())) {
  for (int e = 0; e < sides.count(); ++e) {
    const auto [low, high] = std::minmax(sides.all()[e].vertices[0], sides.all()[e].vertices[1]);
    ++sidesFrom_[low + 1];
    sides_[e].vertices = {low, high, low, low};  // what is not there couples with 0
    sides_[e].others.fill(e);
  }
  for (int v = 0; v < vertices_; ++v) sidesFrom_[v + 1] += sidesFrom_[v];
  if (thin.empty()) return;
  joined_.assign(b_.size(), 0);
  for (const int t : thin)
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) joined_[stride * mesh.triangles[t][k] + c] = 1;
      joined_[firstSide_ + sides.of(t, k)] = 1;
    }
}

void AirySystem::add(const std::array<int, 3>& triangle, const std::array<int, 3>& sidesOf,
                     const MomentMatrix& K, const AiryModes& b, double energy) {
  std::array<int, 12> modes{};
  for (int k = 0; k < 3; ++k) {
    for (int c = 0; c < 3; ++c) modes[3 * k + c] = stride * triangle[k] + c;
    modes[9 + k] = firstSide_ + sidesOf[k];
  }
  for (int i = 0; i < 12; ++i) b_[modes[i]] += b[i];
  energy_ += energy;
  const auto joined = [&](int i) { return !joined_.empty() && joined_[modes[i]] != 0; };
  constexpr std::array<int, 6> groups{0, 3, 6, 9, 10, 11};
  if (std::none_of(groups.begin(), groups.end(), joined)) return addToSweeps(triangle, sidesOf, K);
  const bool allJoined = std::all_of(groups.begin(), groups.end(), joined);
  MomentMatrix rest = K;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j <= i; ++j) {
      if (!joined(i) && !joined(j)) continue;
      const auto [low, high] = std::minmax(modes[i], modes[j]);
      if (joined(i) && joined(j) && K(i, j) != 0)
        ofBlock_.emplace_back(high, low, K(i, j));
      else if (K(i, j) != 0)
        toBlock_.emplace_back(modes[joined(i) ? i : j], modes[joined(i) ? j : i], K(i, j));
      rest(i, j) = 0;
      rest(j, i) = 0;
    }
  if (!allJoined) addToSweeps(triangle, sidesOf, rest);
}

void AirySystem::addToSweeps(const std::array<int, 3>& triangle, const std::array<int, 3>& sidesOf,
                             const MomentMatrix& K) {
  const auto couple = [&](Coupling& with, int place, int vertex, int side) {
    with.withVertices.col(place).head<3>() += K.block<3, 1>(3 * vertex, 9 + side);
  };
  for (int k = 0; k < 3; ++k) {
    const int last = (k + 1) % 3;
    const int apex = (k + 2) % 3;
    diagonal_[triangle[k]].topRows<3>() += K.block<3, 3>(3 * k, 3 * k);
    Coupling& side = sides_[sidesOf[k]];
    const bool ascends = triangle[k] < triangle[last];
    side.ends.topRows<3>() += ascends ? K.block<3, 3>(3 * k, 3 * last) : K.block<3, 3>(3 * last, 3 * k);
    couple(side, ascends ? 0 : 1, k, k);
    couple(side, ascends ? 1 : 0, last, k);
    const bool second = side.vertices[2] != side.vertices[0];  // the side of two triangles
    side.vertices[second ? 3 : 2] = triangle[apex];
    couple(side, second ? 3 : 2, apex, k);
    side.own += K(9 + k, 9 + k);
    int slot = second ? 2 : 0;
    for (const int other : {last, apex})
      if (sidesOf[other] > sidesOf[k]) {
        side.others[slot] = sidesOf[other];
        side.withOthers[slot++] = K(9 + other, 9 + k);
      }
  }
}

/// Modes that are not allowed, and those in the block, have no diagonal: they get a 1.
void AirySystem::invertDiagonal() {
  inverse_.assign(diagonal_.size(), Block::Zero());
  for (size_t v = 0; v < diagonal_.size(); ++v) {
    for (int c = 0; c < 3; ++c)
      if (diagonal_[v](c, c) == 0) diagonal_[v](c, c) = 1;
    const Eigen::Matrix3d D = diagonal_[v].topRows<3>();
    // Values and derivatives have units of their own.
    const Eigen::Vector3d scale = D.diagonal().array().rsqrt();
    Eigen::Matrix3d inverse = (scale.asDiagonal() * D * scale.asDiagonal()).inverse();
    if (!inverse.allFinite()) inverse.setIdentity();
    inverse_[v].topRows<3>() = scale.asDiagonal() * inverse * scale.asDiagonal();
  }
  for (Coupling& side : sides_)
    if (side.own == 0) side.own = 1;
}

bool AirySystem::factorise() {
  invertDiagonal();
  std::vector<int> number(ofBlock_.empty() ? 0 : b_.size(), -1);  // of the modes that are allowed
  for (const Entry& entry : ofBlock_)
    if (entry.col() == entry.row()) number[entry.row()] = 0;
  for (int mode = 0; mode < static_cast<int>(number.size()); ++mode)
    if (number[mode] == 0) {
      number[mode] = static_cast<int>(inBlock_.size());
      inBlock_.push_back(mode);
    }
  if (inBlock_.empty()) return true;
  for (Entry& entry : ofBlock_) entry = {number[entry.row()], number[entry.col()], entry.value()};
  const auto size = static_cast<int>(inBlock_.size());
  block_ = assembled(size, size, ofBlock_);
  ofBlock_ = {};
  const int* start = block_.outerIndexPtr();
  for (int c = 0; c < size; ++c)
    block_.valuePtr()[start[c]] *= 1 + regularised;  // a linear function is no stress
  const int* rows = block_.innerIndexPtr();
  blockSolver_ = multifrontalSolver({size, true, {start, start + size + 1}, {rows, rows + start[size]}}, {});
  return blockSolver_->factorise({block_.valuePtr(), block_.valuePtr() + start[size]});
}

void AirySystem::solveBlock(Vector& f) const {
  Vector x = f(inBlock_);
  blockSolver_->condense(x);
  blockSolver_->expand(x);
  f(inBlock_) = x;
}

void AirySystem::forward(Vector& f) const {
  for (int v = 0; v < vertices_; ++v) {
    const Eigen::Vector4d own = inverse_[v] * at(f, v).head<3>();
    at(f, v) = own;
    for (int e = sidesFrom_[v]; e < sidesFrom_[v + 1]; ++e)
      at(f, sides_[e].vertices[1]).head<3>() -= sides_[e].ends.transpose() * own;
  }
  for (size_t e = 0; e < sides_.size(); ++e) {
    const Coupling& side = sides_[e];
    Eigen::Vector4d sum = side.withVertices.col(0).cwiseProduct(at(f, side.vertices[0]));
    for (int i = 1; i < 4; ++i) sum += side.withVertices.col(i).cwiseProduct(at(f, side.vertices[i]));
    const double x = (f[firstSide_ + e] - sum.sum()) / side.own;
    f[firstSide_ + e] = x;
    for (int i = 0; i < 4; ++i) f[firstSide_ + side.others[i]] -= side.withOthers[i] * x;
  }
  if (inBlock_.empty()) return;
  for (const Entry& each : toBlock_) f[each.row()] -= each.value() * f[each.col()];
  solveBlock(f);
}

void AirySystem::backward(Vector& f) const {
  if (!inBlock_.empty()) {
    solveBlock(f);
    for (const Entry& each : toBlock_) f[each.col()] -= each.value() * f[each.row()];
  }
  for (size_t e = sides_.size(); e-- > 0;) {
    const Coupling& side = sides_[e];
    double x = f[firstSide_ + e];
    for (int i = 0; i < 4; ++i) x -= side.withOthers[i] * f[firstSide_ + side.others[i]];
    x /= side.own;
    f[firstSide_ + e] = x;
    for (int i = 0; i < 4; ++i) at(f, side.vertices[i]) -= side.withVertices.col(i) * x;
  }
  for (int v = vertices_ - 1; v >= 0; --v) {
    Eigen::Vector4d left = at(f, v);
    for (int e = sidesFrom_[v]; e < sidesFrom_[v + 1]; ++e)
      left -= sides_[e].ends * at(f, sides_[e].vertices[1]).head<3>();
    at(f, v) = inverse_[v] * left.head<3>();
  }
}

void AirySystem::multiplyDiagonal(const Vector& f, Vector& result) const {
  for (int v = 0; v < vertices_; ++v) at(result, v) = diagonal_[v] * f.segment<3>(stride * v);
  for (size_t e = 0; e < sides_.size(); ++e) result[firstSide_ + e] = sides_[e].own * f[firstSide_ + e];
  for (const int mode : inBlock_) result[mode] = 0;
  forEachEntry(block_, [&](int r, int c, double value) {
    result[inBlock_[r]] += value * f[inBlock_[c]];
    if (r != c) result[inBlock_[c]] += value * f[inBlock_[r]];
  });
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
