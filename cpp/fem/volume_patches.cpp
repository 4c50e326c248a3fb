#include "fem/volume_patches.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <functional>
#include <numbers>
#include <numeric>
#include <queue>
#include <utility>

namespace mortier {
namespace {

/// Parts that share sides: of each part the neighbours, ascending, and how many sides they share.
struct Neighbours {
  std::vector<int> from;
  std::vector<std::pair<int, int>> list;
};

struct Side {
  std::array<int, 2> ends;
  int triangle;
};

/// Interior sides between triangles of one region, as pairs of triangles.
std::vector<std::array<int, 2>> innerSides(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      sides.push_back({{low, high}, static_cast<int>(t)});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::pair(a.ends, a.triangle) < std::pair(b.ends, b.triangle);
  });
  std::vector<std::array<int, 2>> pairs;
  for (size_t i = 0; i + 1 < sides.size(); ++i) {
    const int a = sides[i].triangle;
    const int b = sides[i + 1].triangle;
    if (sides[i].ends == sides[i + 1].ends && mesh.regions[a] == mesh.regions[b]) pairs.push_back({a, b});
  }
  return pairs;
}

Neighbours neighboursOf(const std::vector<std::array<int, 2>>& sides, const std::vector<int>& part,
                        int count) {
  std::vector<std::array<int, 2>> both;
  for (const auto& [a, b] : sides) {
    if (part[a] == part[b]) continue;
    both.push_back({part[a], part[b]});
    both.push_back({part[b], part[a]});
  }
  std::sort(both.begin(), both.end());
  Neighbours result;
  result.from.assign(count + 1, 0);
  for (size_t i = 0; i < both.size(); ++i) {
    if (i > 0 && both[i] == both[i - 1]) {
      ++result.list.back().second;
      continue;
    }
    result.list.emplace_back(both[i][1], 1);
    ++result.from[both[i][0] + 1];
  }
  std::partial_sum(result.from.begin(), result.from.end(), result.from.begin());
  return result;
}

/// Joins parts in twos: first those with the fewest neighbours that are free, each with the free one that it
/// shares most sides with. One that stays alone joins the smallest neighbour. \returns how many there are
int joinInTwos(const std::vector<std::array<int, 2>>& sides, std::vector<int>& part, int count) {
  const Neighbours neighbours = neighboursOf(sides, part, count);
  const auto forEachNeighbour = [&](int p, auto visit) {
    for (int i = neighbours.from[p]; i < neighbours.from[p + 1]; ++i) visit(neighbours.list[i]);
  };
  std::vector<int> joined(count, -1);
  std::vector<int> size;
  std::vector<int> free(count);
  using Candidate = std::pair<int, int>;  // free neighbours, part
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> next;
  for (int p = 0; p < count; ++p) {
    free[p] = neighbours.from[p + 1] - neighbours.from[p];
    next.emplace(free[p], p);
  }
  while (!next.empty()) {
    const auto [freeThen, p] = next.top();
    next.pop();
    if (joined[p] >= 0 || freeThen != free[p]) continue;
    std::array<int, 3> best{0, 0, -1};
    forEachNeighbour(p, [&](const std::pair<int, int>& other) {
      const std::array<int, 3> candidate{-other.second, free[other.first], other.first};
      if (joined[other.first] < 0 && (best[2] < 0 || candidate < best)) best = candidate;
    });
    if (best[2] < 0) continue;
    for (const int of : {p, best[2]}) joined[of] = static_cast<int>(size.size());
    size.push_back(2);
    for (const int of : {p, best[2]})
      forEachNeighbour(of, [&](const std::pair<int, int>& other) {
        if (joined[other.first] < 0) next.emplace(--free[other.first], other.first);
      });
  }
  for (int p = 0; p < count; ++p) {
    if (joined[p] >= 0) continue;
    int smallest = -1;
    forEachNeighbour(p, [&](const std::pair<int, int>& other) {
      if (smallest < 0 || size[joined[other.first]] < size[smallest]) smallest = joined[other.first];
    });
    if (smallest < 0) {
      smallest = static_cast<int>(size.size());
      size.push_back(0);
    }
    joined[p] = smallest;
    ++size[smallest];
  }
  for (int& p : part) p = joined[p];
  return static_cast<int>(size.size());
}

}  // namespace

std::vector<int> volumePatches(const TriangleMesh& mesh, int degree) {
  const std::vector<std::array<int, 2>> sides = innerSides(mesh);
  std::vector<int> patchOf(mesh.triangles.size());
  std::iota(patchOf.begin(), patchOf.end(), 0);
  const int pairs = joinInTwos(sides, patchOf, static_cast<int>(patchOf.size()));
  if (degree == 1) joinInTwos(sides, patchOf, pairs);
  return patchOf;
}

void VolumePatches::findPatches(const ElementNodes& nodes) {
  const int patches = patchOf_.empty() ? 0 : *std::max_element(patchOf_.begin(), patchOf_.end()) + 1;
  trianglesFrom_.assign(patches + 1, 0);
  for (const int patch : patchOf_) ++trianglesFrom_[patch + 1];
  std::partial_sum(trianglesFrom_.begin(), trianglesFrom_.end(), trianglesFrom_.begin());
  triangles_.resize(patchOf_.size());
  std::vector<int> next(trianglesFrom_.begin(), trianglesFrom_.end() - 1);
  for (size_t t = 0; t < patchOf_.size(); ++t) triangles_[next[patchOf_[t]]++] = static_cast<int>(t);
  nodesFrom_.assign(1, 0);
  for (int patch = 0; patch < patches; ++patch) {
    const auto first = static_cast<std::ptrdiff_t>(nodes_.size());
    for (const int t : triangles(patch))
      nodes_.insert(nodes_.end(), nodes.of(t), nodes.of(t) + nodes.perTriangle());
    std::sort(nodes_.begin() + first, nodes_.end());
    nodes_.erase(std::unique(nodes_.begin() + first, nodes_.end()), nodes_.end());
    nodesFrom_.push_back(static_cast<int>(nodes_.size()));
  }
}

VolumePatches::VolumePatches(const std::vector<int>& patchOf, const ElementNodes& nodes,
                             const std::vector<Point>& places, const std::vector<double>& weights,
                             const std::vector<double>& gradients, const std::vector<double>& hoops)
    : patchOf_(patchOf), points_(nodes.degree == 1 ? 1 : 3), terms_(nodes.degree == 1 ? 1 : 3) {
  constexpr double overRoot2 = std::numbers::sqrt2 / 2;
  findPatches(nodes);
  const int n = nodes.perTriangle();
  basis_.resize(terms_ * weights.size());
  rowsFrom_.resize(weights.size());
  if (!hoops.empty()) uniform_.resize(weights.size());
  for (int patch = 0; patch < count(); ++patch) {
    const Range own = this->nodes(patch);
    const auto width = static_cast<Eigen::Index>(own.size());
    std::vector<int> points;
    for (const int t : triangles(patch))
      for (int i = 0; i < points_; ++i) points.push_back(points_ * t + i);
    const auto m = static_cast<Eigen::Index>(points.size());
    Point centre = Point::Zero();
    for (const int i : points) centre += places[i] / static_cast<double>(m);
    double size = 0;
    for (const int i : points) size = std::max(size, (places[i] - centre).lpNorm<Eigen::Infinity>());
    // Values at the points: polynomials, of theta the rows of the nodes and of a uniform motion along x.
    Matrix F(m, terms_);
    Matrix theta = Matrix::Zero(m, 2 * width + 1);
    Vector w(m);
    for (Eigen::Index k = 0; k < m; ++k) {
      const int i = points[k];
      w[k] = weights[i];
      F(k, 0) = 1;
      if (terms_ == 3) F.row(k).tail<2>() = (places[i] - centre).transpose() / size;
      const int* triangle = nodes.of(i / points_);
      const auto column = [&](int a) {
        return 2 * (std::lower_bound(own.begin(), own.end(), triangle[a]) - own.begin());
      };
      for (int a = 1; a < n; ++a)
        for (int c = 0; c < 2; ++c)
          theta(k, column(a) + c) = gradients[2 * static_cast<size_t>(n - 1) * i + 2 * (a - 1) + c];
      for (int a = 0; a < n && !hoops.empty(); ++a) {
        const double hoop = overRoot2 * hoops[static_cast<size_t>(n) * i + a];
        theta(k, column(a)) += hoop;
        theta(k, 2 * width) += hoop;
      }
      // The gradients sum to zero.
      for (int a = 1; a < n; ++a)
        for (int c = 0; c < 2; ++c)
          theta(k, column(0) + c) -= gradients[2 * static_cast<size_t>(n - 1) * i + 2 * (a - 1) + c];
    }
    const Matrix L = (F.transpose() * w.asDiagonal() * F).llt().matrixL();
    F = L.triangularView<Eigen::Lower>().solve(F.transpose()).transpose().eval();
    Matrix rows = F * (F.transpose() * w.asDiagonal() * theta);
    for (Eigen::Index k = 0; k < m; ++k) {
      const int i = points[k];
      for (int term = 0; term < terms_; ++term) basis_[terms_ * i + term] = F(k, term);
      const int* triangle = nodes.of(i / points_);
      for (int a = 0; a < n && !hoops.empty(); ++a) {
        const double hoop = overRoot2 * hoops[static_cast<size_t>(n) * i + a];
        rows(k, 2 * (std::lower_bound(own.begin(), own.end(), triangle[a]) - own.begin())) -= hoop;
        rows(k, 2 * width) -= hoop;
      }
      if (!hoops.empty()) uniform_[i] = rows(k, 2 * width);
      rowsFrom_[i] = rows_.size();
      for (Eigen::Index column = 0; column < 2 * width; ++column) rows_.push_back(rows(k, column));
    }
  }
}

Vector VolumePatches::averaged(const Vector& theta, const std::vector<double>& weights) const {
  Vector result(theta.size());
  for (int patch = 0; patch < count(); ++patch) {
    Eigen::Vector3d moments = Eigen::Vector3d::Zero();
    const auto forEachPoint = [&](auto visit) {
      for (const int t : triangles(patch))
        for (int i = points_ * t; i < points_ * (t + 1); ++i)
          for (int term = 0; term < terms_; ++term) visit(i, term, basis_[terms_ * i + term]);
    };
    forEachPoint([&](int i, int term, double value) { moments[term] += weights[i] * value * theta[i]; });
    forEachPoint([&](int i, int term, double value) {
      result[i] = (term == 0 ? 0 : result[i]) + value * moments[term];
    });
  }
  return result;
}

}  // namespace mortier
