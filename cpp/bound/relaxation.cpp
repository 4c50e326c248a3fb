#include "bound/relaxation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/interrupt.h"

namespace mortier {
namespace {

/// Sweeps of the relaxation. More are not worthwhile where what they would still take away, as their gains go
/// down geometrically, is a small part of the energy.
constexpr int fewestSweeps = 3;
constexpr int mostSweeps = 6;
constexpr double worthwhile = 0.05;

/// A body of fewer triangles is solved directly: sweeps are slow on coarse meshes of thin triangles.
constexpr size_t few = 10000;

/// Of directions that are one.
constexpr double rounding = 1e-9;

Point turned(const Point& v) {  // J v
  return {v.y(), -v.x()};
}

}  // namespace

Relaxation::Relaxation(const TriangleMesh& mesh, const Sides& sides,
                       const std::vector<Eigen::Matrix3d>& compliances, const std::vector<Stress>& stress,
                       const std::vector<Point>& forces, const std::vector<KnownTraction>& known,
                       SideMoments& moments)
    : mesh_(mesh),
      sides_(sides),
      compliances_(compliances),
      stress_(stress),
      forces_(forces),
      known_(known),
      moments_(moments) {
  double largest = 0;
  for (const Eigen::Matrix3d& each : compliances) largest = std::max(largest, each.cwiseAbs().maxCoeff());
  scale_ = 1 / largest;
  energies_.reserve(compliances.size());
  gradient_.reserve(compliances.size());
  for (int t = 0; t < static_cast<int>(compliances.size()); ++t) {
    const CompositeTriangle element = elementOf(t);
    energies_.emplace_back((scale_ * element.energy()).cast<float>());
    gradient_.emplace_back(scale_ * (element.energy() * differenceOf(t, element)));
    if (forces_[t] != Point(0, 0)) gradient_.back() += scale_ * element.loadProduct(forces_[t]);
  }
}

CompositeTriangle Relaxation::elementOf(int triangle) const {
  const auto& v = mesh_.triangles[triangle];
  return {{mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]]}, compliances_[triangle]};
}

Moments Relaxation::differenceOf(int triangle, const CompositeTriangle& element) const {
  Moments difference = momentsOf(sides_, moments_, triangle) - element.momentsOf(stress_[triangle]);
  if (forces_[triangle] != Point(0, 0)) difference -= element.momentsOfLoad(forces_[triangle]);
  return difference;
}

Vector Relaxation::energies() const {
  Vector result(static_cast<Eigen::Index>(energies_.size()));
  for (int t = 0; t < static_cast<int>(energies_.size()); ++t) {
    const CompositeTriangle element = elementOf(t);
    const Moments difference = differenceOf(t, element);
    result[t] = difference.dot(element.energy() * difference);
    if (forces_[t] != Point(0, 0))
      result[t] += 2 * difference.dot(element.loadProduct(forces_[t])) + element.loadEnergy(forces_[t]);
  }
  return result;
}

template <int columns>
void Relaxation::change(int triangle, int place, const Eigen::Matrix<double, columns, 1>& by) {
  gradient_[triangle] +=
      (energies_[triangle].middleCols<columns>(place) * by.template cast<float>()).template cast<double>();
}

void Relaxation::relax() {
  if (mesh_.triangles.size() < few && minimise()) return;
  double energy = energies().sum();
  double gain = 0;
  for (int i = 1; i <= mostSweeps; ++i) {
    const double gainBefore = gain;
    gain = sweep();
    energy -= gain;
    const bool fades = i > 1 && gain < gainBefore;
    const double left = fades ? gain * gain / (gainBefore - gain) : gain > 0 ? energy : 0;
    if (i >= fewestSweeps && left <= worthwhile * energy) return;
  }
  minimise();
}

double Relaxation::sweep() {
  constexpr int often = 10000;
  double gain = 0;
  for (int e = 0; e < sides_.count(); ++e) {
    if (e % often == 0) stopIfInterrupted();
    gain += relaxSide(e);
  }
  for (int v = 0; v < static_cast<int>(mesh_.vertices.size()); ++v) {
    if (v % often == 0) stopIfInterrupted();
    gain += relaxVertex(v);
  }
  return gain / scale_;
}

Point Relaxation::normalMode(int side) const {
  return -alongOf(side).normalized();  // J n
}

bool Relaxation::mayChange(int side) const {
  if (sides_.all()[side].triangles[1] >= 0) return true;
  const auto& [count, known, moments] = known_[side];
  for (int k = 0; k < count; ++k)
    if (std::abs(normalMode(side).dot(known[k])) > rounding) return false;
  return true;
}

double Relaxation::relaxSide(int side) {
  if (!mayChange(side)) return 0;
  const Side& at = sides_.all()[side];
  const Point mode = normalMode(side);
  // The first end as a triangle sees it; the second has the opposite.
  Eigen::Vector4d effect;
  effect << mode, -mode;
  double curvature = 0;
  double slope = 0;
  std::array<int, 2> places{};
  for (int i = 0; i < 2 && at.triangles[i] >= 0; ++i) {
    const int t = at.triangles[i];
    int k = 0;
    while (sides_.of(t, k) != side) ++k;
    places[i] = 4 * k;
    // From the right both the ends and the sign change: the effect is the same.
    curvature += effect.dot(energies_[t].block<4, 4>(4 * k, 4 * k).cast<double>() * effect);
    slope += effect.dot(gradient_[t].segment<4>(4 * k));
  }
  const double amount = -slope / curvature;
  if (!std::isfinite(amount)) return 0;
  for (int i = 0; i < 2 && at.triangles[i] >= 0; ++i) {
    change<4>(at.triangles[i], places[i], amount * effect);
  }
  moments_[side][0] += amount * mode;
  moments_[side][1] -= amount * mode;
  return -amount * slope;
}

Point Relaxation::alongOf(int side) const {
  const auto& [a, b] = sides_.all()[side].vertices;
  return mesh_.vertices[b] - mesh_.vertices[a];
}

Relaxation::Modes Relaxation::modesOf(int side, int vertex, double length) const {
  const Point along = alongOf(side);
  const bool first = sides_.all()[side].vertices[0] == vertex;
  const Point mean = turned((first ? -length : length) / along.squaredNorm() * along);
  Modes modes = Modes::Zero();
  modes.col(0) << mean, -mean;
  for (int c = 0; c < 2; ++c)
    modes.block<2, 1>(first ? 0 : 2, 1 + c) = (first ? -1 : 1) * turned(Point::Unit(c));
  return modes;
}

double Relaxation::lengthAt(int vertex) const {
  double length = 0;
  for (const int side : sides_.sidesAt(vertex)) length = std::max(length, alongOf(side).norm());
  return length;
}

Relaxation::Modes Relaxation::seenBy(int triangle, int k, int vertex, double length) const {
  const Modes modes = modesOf(sides_.of(triangle, k), vertex, length);
  if (sides_.left(triangle, k)) return modes;
  Modes other;  // from the right, the ends and the sign are the other way round
  other << -modes.bottomRows<2>(), -modes.topRows<2>();
  return other;
}

Matrix Relaxation::allowedModes(int vertex, double length) const {
  Eigen::Matrix<double, Eigen::Dynamic, 3> forbidden(0, 3);
  for (const int side : sides_.sidesAt(vertex)) {
    if (sides_.all()[side].triangles[1] >= 0) continue;
    if (known_[side].count == 2) return Matrix(3, 0);  // none leaves all of it as it is
    const Modes modes = modesOf(side, vertex, length);
    for (int k = 0; k < known_[side].count; ++k)
      for (int end = 0; end < 2; ++end) {
        forbidden.conservativeResize(forbidden.rows() + 1, 3);
        forbidden.bottomRows<1>() = known_[side].known[k].transpose() * modes.middleRows<2>(2 * end);
      }
  }
  if (forbidden.rows() == 0) return Matrix::Identity(3, 3);
  const Eigen::JacobiSVD<Matrix> svd(forbidden, Eigen::ComputeFullV);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() &&
         svd.singularValues()[rank] > rounding * svd.singularValues()[0])
    ++rank;
  return svd.matrixV().rightCols(3 - rank);
}

double Relaxation::relaxVertex(int vertex) {
  bool inside = true;
  const double length = lengthAt(vertex);
  for (const int side : sides_.sidesAt(vertex)) {
    if (sides_.all()[side].triangles[1] >= 0) continue;
    if (known_[side].count == 2) return 0;  // no mode leaves all of it as it is
    inside = false;
  }
  effects_.clear();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  for (const int t : sides_.trianglesAt(vertex)) {
    const auto& v = mesh_.triangles[t];
    const int i = v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
    Effect effect{t, {4 * i, 4 * ((i + 2) % 3)}, {}};
    for (int s = 0; s < 2; ++s) {
      const int k = effect.places[s] / 4;
      effect.modes[s] = seenBy(t, k, vertex, length);
      slope += effect.modes[s].transpose() * gradient_[t].segment<4>(4 * k);
    }
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b)
        hessian +=
            effect.modes[a].transpose() *
            (energies_[t].block<4, 4>(effect.places[a], effect.places[b]).cast<double>() * effect.modes[b]);
    effects_.push_back(effect);
  }
  Eigen::Vector3d amount;
  if (inside) {
    amount = -hessian.ldlt().solve(slope);
  } else {
    const Matrix allowed = allowedModes(vertex, length);
    if (allowed.cols() == 0) return 0;
    const Matrix reduced = allowed.transpose() * hessian * allowed;
    amount = -allowed * reduced.ldlt().solve(Vector(allowed.transpose() * slope));
  }
  if (!amount.allFinite()) return 0;
  for (const Effect& effect : effects_)
    for (int s = 0; s < 2; ++s) change<4>(effect.triangle, effect.places[s], effect.modes[s] * amount);
  for (const int side : sides_.sidesAt(vertex)) {
    const Eigen::Vector4d by = modesOf(side, vertex, length) * amount;
    moments_[side][0] += by.head<2>();
    moments_[side][1] += by.tail<2>();
  }
  return -amount.dot(slope);
}

}  // namespace mortier
