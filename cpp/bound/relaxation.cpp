#include "bound/relaxation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace mortier {
namespace {

/// Iterations end where what is still to come is estimated to be no more than this part of the energy. It has
/// been up to six times as much: bounds are about 3 % above the least at most.
constexpr double stillToCome = 0.01;
/// After as many a direct solution costs no more.
constexpr int mostIterations = 80;

/// A body of fewer triangles is solved directly.
constexpr size_t few = 1000;

/// Triangles with a smaller height over the longest side are thin.
constexpr double thin = 0.2;

/// Of directions that are one.
constexpr double roundingOfDirections = 1e-9;

}  // namespace

Relaxation::Relaxation(const TriangleMesh& mesh, const Sides& sides,
                       const std::vector<Eigen::Matrix3d>& compliances, const std::vector<Stress>& stress,
                       const std::vector<BodyLoad>& forces, const std::vector<KnownTraction>& known,
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
  if (!forces_[triangle].isZero(0)) difference -= element.momentsOfLoad(forces_[triangle]);
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
  if (!iterate(stillToCome, mostIterations)) minimise();
}

/// All triangles at once are one block of the system, which is factorised.
bool Relaxation::solve(bool directly, double part, int most) {
  // At the boundary, what leaves known tractions as they are: columns, or none.
  const size_t vertices = mesh_.vertices.size();
  std::vector<int> restricted(vertices, -1);
  std::vector<Eigen::Matrix3d> allowed;
  for (int e = 0; e < sides_.count(); ++e) {
    if (sides_.all()[e].triangles[1] >= 0) continue;
    for (const int vertex : sides_.all()[e].vertices) {
      if (restricted[vertex] >= 0) continue;
      restricted[vertex] = static_cast<int>(allowed.size());
      allowed.push_back(allowedModes(vertex));
    }
  }
  const int count = static_cast<int>(mesh_.triangles.size());
  std::vector<int> block;
  for (int t = 0; t < count; ++t) {
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, alongOf(sides_.of(t, k)).squaredNorm());
    if (directly || doubleArea(mesh_, t) < thin * longest) block.push_back(t);
  }
  AirySystem system(mesh_, sides_, block);
  for (int t = 0; t < count; ++t) {
    const auto& triangle = mesh_.triangles[t];
    const CompositeTriangle element = elementOf(t);
    const Moments difference = differenceOf(t, element);
    MomentMatrix K = element.airyEnergy();
    AiryModes b = -K.lazyProduct(element.airyOf(difference));
    if (!forces_[t].isZero(0)) b -= element.airyLoadProduct(forces_[t]);
    std::array<int, 3> sides{};
    for (int k = 0; k < 3; ++k) {
      sides[k] = sides_.of(t, k);
      // The normal of the side, or 0 for a mode that is not there.
      const double sign = !mayChange(sides[k]) ? 0 : sides_.left(t, k) ? 1 : -1;
      K.row(9 + k) *= sign;
      K.col(9 + k) *= sign;
      b[9 + k] *= sign;
      if (const int at = restricted[triangle[k]]; at >= 0) {
        K.middleRows<3>(3 * k) = (allowed[at].transpose() * K.middleRows<3>(3 * k)).eval();
        K.middleCols<3>(3 * k) = (K.middleCols<3>(3 * k) * allowed[at]).eval();
        b.segment<3>(3 * k) = (allowed[at].transpose() * b.segment<3>(3 * k)).eval();
      }
    }
    system.add(triangle, sides, K, b, element.energyOf(difference, forces_[t]));
  }
  if (!system.factorise()) return false;
  bool found = system.solve(part, most);
  if (directly) found = found || system.iterations() == most;
  const auto modesAt = [&](int vertex) -> Eigen::Vector3d {
    const int at = restricted[vertex];
    return at < 0 ? system.atVertex(vertex) : Eigen::Vector3d(allowed[at] * system.atVertex(vertex));
  };
  for (int side = 0; side < sides_.count(); ++side) {
    const Eigen::Vector3d first = modesAt(sides_.all()[side].vertices[0]);
    const Eigen::Vector3d second = modesAt(sides_.all()[side].vertices[1]);
    const Point along = alongOf(side);
    const double square = along.squaredNorm();
    const Point mean = (second[0] - first[0]) / square * -turned(along) -
                       system.atSide(side) / std::sqrt(square) * along;  // J of it
    moments_[side][0] += mean + turned(first.tail<2>());
    moments_[side][1] -= turned(second.tail<2>()) + mean;
  }
  return found;
}

bool Relaxation::mayChange(int side) const {
  if (sides_.all()[side].triangles[1] >= 0) return true;
  const auto& [count, known, moments] = known_[side];
  for (int k = 0; k < count; ++k)
    if (std::abs(alongOf(side).normalized().dot(known[k])) > roundingOfDirections) return false;
  return true;
}

Point Relaxation::alongOf(int side) const {
  const auto& [a, b] = sides_.all()[side].vertices;
  return mesh_.vertices[b] - mesh_.vertices[a];
}

/// A known component d of the traction d/ds J grad Phi is left as it is where J grad Phi has none along d, so
/// that grad Phi is along d, and the mean along the side, J ((Phi(Q) - Phi(P))/L) tau, has none either.
Eigen::Matrix3d Relaxation::allowedModes(int vertex) const {
  Eigen::Matrix3d allowed = Eigen::Matrix3d::Identity();
  int directions = 2;  // of grad Phi
  for (const int side : sides_.sidesAt(vertex)) {
    if (sides_.all()[side].triangles[1] >= 0) continue;
    for (int k = 0; k < known_[side].count; ++k) {
      const Point& d = known_[side].known[k];
      if (std::abs(d.dot(turned(alongOf(side).normalized()))) > roundingOfDirections) allowed(0, 0) = 0;
      if (directions == 1 && std::abs(d.dot(turned(allowed.block<2, 1>(1, 1)))) > roundingOfDirections)
        directions = 0;
      directions = std::min(directions, 1);
      allowed.bottomRightCorner<2, 2>() << (directions == 1 ? d : Point(0, 0)), Point(0, 0);
    }
  }
  return allowed;
}

}  // namespace mortier
