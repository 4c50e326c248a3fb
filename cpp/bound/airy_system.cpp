#include "bound/airy_system.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <experimental/simd>
#include <limits>

#include "base/interrupt.h"

namespace mortier {
namespace {

/// Of the block's diagonal.
constexpr double regularised = 1e-12;

using Four = std::experimental::fixed_size_simd<double, 4>;

Four four(const double* values) {
  return Four(values, std::experimental::element_aligned);
}

void put(const Four& values, double* target) {
  values.copy_to(target, std::experimental::element_aligned);
}

/// A x, A by its columns.
template <class Columns>
Four product(const Columns& A, const double* x) {
  return four(A[0].data()) * x[0] + four(A[1].data()) * x[1] + four(A[2].data()) * x[2];
}

template <class Columns>
void addTo(Columns& to, const Eigen::Matrix3d& K) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) to[c][r] += K(r, c);
}

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
      diagonal_(mesh.vertices.size()),
      b_(Vector::Zero(firstSide_ + sides.count())) {
  for (int e = 0; e < sides.count(); ++e) {
    const auto [low, high] = std::minmax(sides.all()[e].vertices[0], sides.all()[e].vertices[1]);
    ++sidesFrom_[low + 1];
    sides_[e].vertices = {low, high, low, low};  // what is not there couples with 0
    sides_[e].others.fill(e);
  }
  for (int v = 0; v < vertices_; ++v) sidesFrom_[v + 1] += sidesFrom_[v];
  if (thin.empty()) return;
  number_.assign(b_.size(), -1);
  const auto number = [&](int mode) {
    if (number_[mode] >= 0) return;
    number_[mode] = static_cast<int>(inBlock_.size());
    inBlock_.push_back(mode);
  };
  for (const int t : thin)
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) number(stride * mesh.triangles[t][k] + c);
      number(firstSide_ + sides.of(t, k));
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
  const auto joined = [&](int i) { return !number_.empty() && number_[modes[i]] >= 0; };
  constexpr std::array<int, 6> groups{0, 3, 6, 9, 10, 11};
  if (std::none_of(groups.begin(), groups.end(), joined)) return addToSweeps(triangle, sidesOf, K);
  MomentMatrix rest = K;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j <= i; ++j) {
      if (!joined(i) && !joined(j)) continue;
      const int a = number_[modes[i]];
      const int c = number_[modes[j]];
      if (a >= 0 && c >= 0)
        ofBlock_.push_back({std::min(a, c), std::max(a, c), K(i, j)});
      else if (K(i, j) != 0)
        toBlock_.push_back({a < 0 ? modes[i] : modes[j], std::max(a, c), K(i, j)});
      rest(i, j) = 0;
      rest(j, i) = 0;
    }
  addToSweeps(triangle, sidesOf, rest);
}

void AirySystem::addToSweeps(const std::array<int, 3>& triangle, const std::array<int, 3>& sidesOf,
                             const MomentMatrix& K) {
  const auto couple = [&](Padded& with, int vertex, int side) {
    for (int c = 0; c < 3; ++c) with[c] += K(3 * vertex + c, 9 + side);
  };
  for (int k = 0; k < 3; ++k) {
    const int last = (k + 1) % 3;
    const int apex = (k + 2) % 3;
    addTo(diagonal_[triangle[k]], K.block<3, 3>(3 * k, 3 * k));
    Coupling& side = sides_[sidesOf[k]];
    const bool ascends = triangle[k] < triangle[last];
    addTo(side.ends, ascends ? K.block<3, 3>(3 * k, 3 * last) : K.block<3, 3>(3 * last, 3 * k));
    couple(side.withVertices[ascends ? 0 : 1], k, k);
    couple(side.withVertices[ascends ? 1 : 0], last, k);
    const bool second = side.vertices[2] != side.vertices[0];  // the side of two triangles
    side.vertices[second ? 3 : 2] = triangle[apex];
    couple(side.withVertices[second ? 3 : 2], apex, k);
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
  inverse_.resize(diagonal_.size());
  for (size_t v = 0; v < diagonal_.size(); ++v) {
    Eigen::Matrix3d D;
    for (int c = 0; c < 3; ++c) {
      if (diagonal_[v][c][c] == 0) diagonal_[v][c][c] = 1;
      for (int r = 0; r < 3; ++r) D(r, c) = diagonal_[v][c][r];
    }
    // Values and derivatives have units of their own.
    const Eigen::Vector3d scale = D.diagonal().array().rsqrt();
    Eigen::Matrix3d inverse = (scale.asDiagonal() * D * scale.asDiagonal()).inverse();
    if (!inverse.allFinite()) inverse.setIdentity();
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) inverse_[v][c][r] = scale[r] * inverse(r, c) * scale[c];
  }
  for (Coupling& side : sides_)
    if (side.own == 0) side.own = 1;
}

bool AirySystem::factorise() {
  invertDiagonal();
  if (inBlock_.empty()) return true;
  block_ = assembled(static_cast<int>(inBlock_.size()), ofBlock_);
  ofBlock_ = {};
  for (int c = 0; c < block_.pattern.size; ++c) {
    double& diagonal = block_.values[block_.pattern.columnStart[c]];
    diagonal = diagonal == 0 ? 1 : diagonal * (1 + regularised);  // a linear function is no stress
  }
  blockSolver_ = multifrontalSolver(block_.pattern, {});
  return blockSolver_->factorise(block_.values);
}

void AirySystem::solveBlock(Vector& f) const {
  Vector x = f(inBlock_);
  blockSolver_->condense(x);
  blockSolver_->expand(x);
  f(inBlock_) = x;
}

void AirySystem::forward(Vector& f) const {
  double* const all = f.data();
  for (int v = 0; v < vertices_; ++v) {
    double* const x = all + stride * static_cast<size_t>(v);
    put(product(inverse_[v], x), x);
    const Four own = four(x);
    for (int e = sidesFrom_[v]; e < sidesFrom_[v + 1]; ++e) {
      double* const high = all + stride * static_cast<size_t>(sides_[e].vertices[1]);
      for (int c = 0; c < 3; ++c) high[c] -= reduce(four(sides_[e].ends[c].data()) * own);
    }
  }
  double* const ofSides = all + firstSide_;
  for (size_t e = 0; e < sides_.size(); ++e) {
    const Coupling& side = sides_[e];
    Four sum = 0;
    for (int i = 0; i < 4; ++i)
      sum += four(side.withVertices[i].data()) * four(all + stride * static_cast<size_t>(side.vertices[i]));
    const double x = (ofSides[e] - reduce(sum)) / side.own;
    ofSides[e] = x;
    for (int i = 0; i < 4; ++i) ofSides[side.others[i]] -= side.withOthers[i] * x;
  }
  if (inBlock_.empty()) return;
  for (const auto& [column, row, value] : toBlock_) f[inBlock_[row]] -= value * f[column];
  solveBlock(f);
}

void AirySystem::backward(Vector& f) const {
  if (!inBlock_.empty()) {
    solveBlock(f);
    for (const auto& [column, row, value] : toBlock_) f[column] -= value * f[inBlock_[row]];
  }
  double* const all = f.data();
  double* const ofSides = all + firstSide_;
  for (size_t e = sides_.size(); e-- > 0;) {
    const Coupling& side = sides_[e];
    double x = ofSides[e];
    for (int i = 0; i < 4; ++i) x -= side.withOthers[i] * ofSides[side.others[i]];
    x /= side.own;
    ofSides[e] = x;
    for (int i = 0; i < 4; ++i) {
      double* const at = all + stride * static_cast<size_t>(side.vertices[i]);
      put(four(at) - four(side.withVertices[i].data()) * x, at);
    }
  }
  for (int v = vertices_ - 1; v >= 0; --v) {
    double* const x = all + stride * static_cast<size_t>(v);
    Four left = four(x);
    for (int e = sidesFrom_[v]; e < sidesFrom_[v + 1]; ++e)
      left -= product(sides_[e].ends, all + stride * static_cast<size_t>(sides_[e].vertices[1]));
    put(left, x);
    put(product(inverse_[v], x), x);
  }
}

void AirySystem::multiplyDiagonal(const Vector& f, Vector& result) const {
  for (int v = 0; v < vertices_; ++v)
    put(product(diagonal_[v], f.data() + stride * static_cast<size_t>(v)),
        result.data() + stride * static_cast<size_t>(v));
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
