#include "bound/relaxation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "bound/airy_system.h"

namespace mortier {
namespace {

/// Iterations end where what is still to come is estimated to be no more than this part of the energy. It has
/// been up to six times as much: bounds are about 3 % above the least at most.
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

/// What valuesOf(triangle) has, by lanes.
template <size_t n, class Values>
std::array<Lanes, n> gathered(const Batch& batch, const Values& valuesOf) {
  alignas(64) double buffer[n][laneCount];
  for (int lane = 0; lane < laneCount; ++lane) {
    const auto& values = valuesOf(batch.first + std::min(lane, batch.count - 1));
    for (size_t i = 0; i < n; ++i) buffer[i][lane] = values[i];
  }
  std::array<Lanes, n> result;
  for (size_t i = 0; i < n; ++i) result[i].copy_from(buffer[i], std::experimental::vector_aligned);
  return result;
}

/// The energy of Airy modes x beside those of a stress in eight triangles, E(x) = E(0) - 2 b'x + x'K x.
class AiryLanes {
 public:
  /// \param signs  of the normals of the sides in x: 1, or -1, or 0 for modes that are not there
  void fill(const CompositeLanes& elements, const CompositeLanes::Twelve& difference,
            const std::array<Lanes, 3>& signs) {
    std::array<Lanes, 144> K;
    elements.airyEnergy(K);
    off_ = elements.airyOf(difference);
    energy_ = 0;
    for (int i = 0; i < 12; ++i) {
      const Lanes* const row = &K[static_cast<size_t>(12) * i];
      b_[i] = -row[0] * off_[0];
      for (int j = 1; j < 12; ++j) b_[i] -= row[j] * off_[j];
      energy_ -= b_[i] * off_[i];
    }
    for (int k = 9; k < 12; ++k) {
      b_[k] *= signs[k - 9];
      for (int i = 0; i < 12; ++i) {
        K[static_cast<size_t>(12) * i + k] *= signs[k - 9];
        K[static_cast<size_t>(12) * k + i] *= signs[k - 9];
      }
    }
    for (int i = 0; i < 144; ++i) K[i].copy_to(K_[i].data(), std::experimental::element_aligned);
  }
  /// Of one of the triangles.
  [[nodiscard]] MomentMatrix K(int lane) const {
    MomentMatrix result;
    for (int i = 0; i < 144; ++i) result.data()[i] = K_[i][lane];
    return result;
  }
  [[nodiscard]] AiryModes b(int lane) const { return modes(b_, lane); }
  [[nodiscard]] AiryModes off(int lane) const { return modes(off_, lane); }
  [[nodiscard]] double energy(int lane) const { return energy_[lane]; }

 private:
  static AiryModes modes(const CompositeLanes::Twelve& all, int lane) {
    AiryModes result;
    for (int i = 0; i < 12; ++i) result[i] = all[i][lane];
    return result;
  }
  std::array<std::array<double, laneCount>, 144> K_{};
  CompositeLanes::Twelve b_, off_;
  Lanes energy_;
};

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

CompositeLanes Relaxation::elementsOf(const Batch& batch) const {
  return {gathered<6>(batch,
                      [&](int t) {
                        const auto& v = mesh_.triangles[t];
                        const Point& a = mesh_.vertices[v[0]];
                        const Point& b = mesh_.vertices[v[1]];
                        const Point& c = mesh_.vertices[v[2]];
                        return std::array{a.x(), a.y(), b.x(), b.y(), c.x(), c.y()};
                      }),
          gathered<6>(batch, [&](int t) {
            const Eigen::Matrix3d& S = compliances_[t];
            return std::array{S(0, 0), S(1, 1), S(2, 2), S(1, 0), S(2, 0), S(2, 1)};
          })};
}

CompositeLanes::Twelve Relaxation::differencesOf(const Batch& batch, const CompositeLanes& elements) const {
  CompositeLanes::Twelve result = gathered<12>(batch, [&](int t) -> Moments {
    const Moments all = momentsOf(sides_, moments_, t);
    if (forces_[t].isZero(0)) return all;
    return all - elementOf(t).momentsOfLoad(forces_[t]);
  });
  const CompositeLanes::Twelve taken =
      elements.momentsOf(gathered<3>(batch, [&](int t) -> const Stress& { return stress_[t]; }));
  for (int i = 0; i < 12; ++i) result[i] -= taken[i];
  return result;
}

Vector Relaxation::energies() const {
  const int count = static_cast<int>(stress_.size());
  Vector result(count);
  for (int begin = 0; begin < count; begin += laneCount) {
    const Batch batch(begin, count);
    const CompositeLanes elements = elementsOf(batch);
    const auto forces = gathered<3>(batch, [&](int t) -> const BodyLoad& { return forces_[t]; });
    batch.store<1>({elements.energyOf(differencesOf(batch, elements), forces)}, result.data());
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
  const int count = static_cast<int>(mesh_.triangles.size());
  std::vector<int> thinOnes;
  for (int t = 0; t < count; ++t) {
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, alongOf(sides_.of(t, k)).squaredNorm());
    if (doubleArea(mesh_, t) < thin * longest) thinOnes.push_back(t);
  }
  AirySystem system(mesh_, sides_, thinOnes);
  AiryLanes lanes;
  for (int begin = 0; begin < count; begin += laneCount) {
    const Batch batch(begin, count);
    const CompositeLanes elements = elementsOf(batch);
    const auto signs = gathered<3>(batch, [&](int t) {
      std::array<double, 3> sign;
      for (int k = 0; k < 3; ++k) sign[k] = !mayChange(sides_.of(t, k)) ? 0 : sides_.left(t, k) ? 1 : -1;
      return sign;
    });
    lanes.fill(elements, differencesOf(batch, elements), signs);
    for (int lane = 0; lane < batch.count; ++lane) {
      const int t = batch.first + lane;
      const auto& triangle = mesh_.triangles[t];
      MomentMatrix K = lanes.K(lane);
      AiryModes b = lanes.b(lane);
      double energy = lanes.energy(lane);
      if (!forces_[t].isZero(0)) {
        const CompositeTriangle element = elementOf(t);
        AiryModes load = element.airyLoadProduct(forces_[t]);
        energy += 2 * load.dot(lanes.off(lane)) + element.loadEnergy(forces_[t]);
        for (int k = 0; k < 3; ++k) load[9 + k] *= signs[k][lane];
        b -= load;
      }
      std::array<int, 3> sides{};
      for (int k = 0; k < 3; ++k) {
        sides[k] = sides_.of(t, k);
        if (const int at = restricted[triangle[k]]; at >= 0) {
          K.middleRows<3>(3 * k) = (allowed[at].transpose() * K.middleRows<3>(3 * k)).eval();
          K.middleCols<3>(3 * k) = (K.middleCols<3>(3 * k) * allowed[at]).eval();
          b.segment<3>(3 * k) = (allowed[at].transpose() * b.segment<3>(3 * k)).eval();
        }
      }
      system.add(triangle, sides, K, b, energy);
    }
  }
  if (!system.factorise()) return false;
  const bool found = system.solve(part, most);
  const auto modesAt = [&](int vertex) -> Eigen::Vector3d {
    const int at = restricted[vertex];
    return at < 0 ? system.atVertex(vertex) : Eigen::Vector3d(allowed[at] * system.atVertex(vertex));
  };
  for (int side = 0; side < sides_.count(); ++side) {
    const Eigen::Vector3d first = modesAt(sides_.all()[side].vertices[0]);
    const Eigen::Vector3d second = modesAt(sides_.all()[side].vertices[1]);
    const Point along = alongOf(side);
    const double square = along.squaredNorm();
    const Point mean = (second[0] - first[0]) / square * turned(along) -
                       system.atSide(side) / std::sqrt(square) * along;  // J of it
    moments_[side][0] += mean - turned(first.tail<2>());
    moments_[side][1] += turned(second.tail<2>()) - mean;
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
