#include "bound/relaxation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "bound/airy_system.h"

namespace mortier {
namespace {

/// Iterations end where what is still to come is estimated to be no more than this part of the energy. It has
/// been up to six times as much: bounds are about 1 % above the least at most.
constexpr double part = 0.01;
/// After as many a direct solution costs no more.
constexpr int mostIterations = 80;

/// A body of fewer triangles is solved directly.
constexpr size_t few = 1000;

/// Triangles with a smaller height over the longest side are thin.
constexpr double thin = 0.2;

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
      moments_(moments) {}

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
  Vector result(static_cast<Eigen::Index>(stress_.size()));
  for (int t = 0; t < static_cast<int>(stress_.size()); ++t) {
    const CompositeTriangle element = elementOf(t);
    result[t] = element.energyOf(differenceOf(t, element), forces_[t]);
  }
  return result;
}

void Relaxation::relax() {
  if (mesh_.triangles.size() < few && minimise()) return;
  if (!iterate(part, mostIterations)) minimise();
}

bool Relaxation::iterate(double part, int most) {
  // At the boundary, what leaves known tractions as they are: columns, or none.
  const size_t vertices = mesh_.vertices.size();
  std::vector<int> restricted(vertices, -1);
  std::vector<Eigen::Matrix3d> allowed;
  for (int e = 0; e < sides_.count(); ++e) {
    if (sides_.all()[e].triangles[1] >= 0) continue;
    for (const int vertex : sides_.all()[e].vertices) {
      if (restricted[vertex] >= 0) continue;
      restricted[vertex] = static_cast<int>(allowed.size());
      const Matrix modes = allowedModes(vertex, lengthAt(vertex));
      allowed.emplace_back(Eigen::Matrix3d::Zero());
      allowed.back().leftCols(modes.cols()) = modes;
      allowed.back().row(0) *= lengthAt(vertex);
    }
  }
  AirySystem system(sides_, vertices);
  std::vector<int> thinOnes;
  for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
    const CompositeTriangle element = elementOf(t);
    MomentMatrix K = element.airyEnergy();
    const AiryModes off = element.airyOf(differenceOf(t, element));
    AiryModes b = -K.lazyProduct(off);
    double energy = -b.dot(off);
    if (forces_[t] != Point(0, 0)) {
      const AiryModes load = element.airyLoadProduct(forces_[t]);
      energy += 2 * load.dot(off) + element.loadEnergy(forces_[t]);
      b -= load;
    }
    std::array<int, 3> sides{};
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      sides[k] = sides_.of(t, k);
      longest = std::max(longest, alongOf(sides[k]).squaredNorm());
      const double sign = !mayChange(sides[k]) ? 0 : sides_.left(t, k) ? 1 : -1;
      if (sign != 1) {
        K.row(9 + k) *= sign;
        K.col(9 + k) *= sign;
        b[9 + k] *= sign;
      }
      if (const int at = restricted[mesh_.triangles[t][k]]; at >= 0) {
        K.middleRows<3>(3 * k) = (allowed[at].transpose() * K.middleRows<3>(3 * k)).eval();
        K.middleCols<3>(3 * k) = (K.middleCols<3>(3 * k) * allowed[at]).eval();
        b.segment<3>(3 * k) = (allowed[at].transpose() * b.segment<3>(3 * k)).eval();
      }
    }
    system.add(mesh_.triangles[t], sides, K, b, energy);
    if (doubleArea(mesh_, t) < thin * longest) thinOnes.push_back(t);
  }
  if (!system.join(mesh_, sides_, thinOnes)) return false;
  const bool found = system.solve(part, most);
  for (int side = 0; side < sides_.count(); ++side) {
    if (mayChange(side)) {
      moments_[side][0] += system.atSide(side) * normalMode(side);
      moments_[side][1] -= system.atSide(side) * normalMode(side);
    }
    for (const int vertex : sides_.all()[side].vertices) {
      Eigen::Vector3d modes = system.atVertex(vertex);
      if (restricted[vertex] >= 0) modes = allowed[restricted[vertex]] * modes;
      const Eigen::Vector4d by = modesOf(side, vertex, 1) * modes;
      moments_[side][0] += by.head<2>();
      moments_[side][1] += by.tail<2>();
    }
  }
  return found;
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

}  // namespace mortier
