#include "fem/tangent_assembly.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

#include "fem/element.h"
#include "mesh/triangle_sides.h"

namespace mortier {
namespace {

/// Parts that share sides: of each part the neighbours, ascending, and how many sides they share.
struct TriangleGraph {
  std::vector<int> from;
  std::vector<std::pair<int, int>> list;
};

/// Interior sides between triangles of one region, as pairs of triangles.
std::vector<std::array<int, 2>> innerSides(const TriangleMesh& mesh) {
  std::vector<std::array<int, 2>> pairs;
  forEachEdge(sortedSides(mesh), [&](std::span<const TriangleSide> sides) {
    if (sides.size() < 2) return;
    const std::array pair{sides[0].triangle(), sides[1].triangle()};
    if (mesh.regions[pair[0]] == mesh.regions[pair[1]]) pairs.push_back(pair);
  });
  return pairs;
}

TriangleGraph neighboursOf(const std::vector<std::array<int, 2>>& sides, const std::vector<int>& part,
                           int count) {
  std::vector<int> from(count + 1, 0);
  const auto forEachBoth = [&](auto visit) {
    for (const auto& [a, b] : sides) {
      if (part[a] == part[b]) continue;
      visit(part[a], part[b]);
      visit(part[b], part[a]);
    }
  };
  forEachBoth([&](int a, int) { ++from[a + 1]; });
  std::partial_sum(from.begin(), from.end(), from.begin());
  std::vector<int> all(from.back());
  std::vector<int> next(from.begin(), from.end() - 1);
  forEachBoth([&](int a, int b) { all[next[a]++] = b; });
  TriangleGraph result;
  result.from.assign(1, 0);
  for (int p = 0; p < count; ++p) {
    std::sort(all.begin() + from[p], all.begin() + from[p + 1]);
    for (int i = from[p]; i < from[p + 1]; ++i)
      if (i > from[p] && all[i] == all[i - 1])
        ++result.list.back().second;
      else
        result.list.emplace_back(all[i], 1);
    result.from.push_back(static_cast<int>(result.list.size()));
  }
  return result;
}

/// Joins parts in twos: first those with the fewest neighbours that are free, each with the free one that it
/// shares most sides with. One that stays alone joins the smallest neighbour. \returns how many there are
int joinInTwos(const std::vector<std::array<int, 2>>& sides, std::vector<int>& part, int count) {
  const TriangleGraph neighbours = neighboursOf(sides, part, count);
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
  const int patches = degree == 1 ? joinInTwos(sides, patchOf, pairs) : pairs;
  // Numbered as their first triangles are: neighbours in memory.
  std::vector<int> number(patches, -1);
  int next = 0;
  for (int& patch : patchOf) {
    if (number[patch] < 0) number[patch] = next++;
    patch = number[patch];
  }
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
  local_.reserve(nodes.triangles.size());
  for (size_t t = 0; t < patchOf_.size(); ++t) {
    const std::span<const int> own = this->nodes(patchOf_[t]);
    for (int a = 0; a < ofTriangle_; ++a)
      local_.push_back(
          static_cast<int>(std::lower_bound(own.begin(), own.end(), nodes.of(t)[a]) - own.begin()));
  }
}

VolumePatches::VolumePatches(const std::vector<int>& patchOf, const ElementNodes& nodes,
                             const std::vector<Point>& places, const std::vector<double>& weights,
                             const std::vector<double>& gradients, const std::vector<double>& hoops)
    : patchOf_(patchOf),
      ofTriangle_(nodes.perTriangle()),
      points_(nodes.degree == 1 ? 1 : 3),
      terms_(nodes.degree == 1 ? 1 : 3) {
  findPatches(nodes);
  const int n = ofTriangle_;
  basis_.resize(terms_ * weights.size());
  rows_.assign(2 * static_cast<size_t>(terms_) * nodes_.size(), 0);
  if (!hoops.empty()) uniform_.assign(static_cast<size_t>(terms_) * count(), 0);
  Matrix F;  // the polynomials at the points
  std::vector<int> points;
  for (int patch = 0; patch < count(); ++patch) {
    points.clear();
    for (const int t : triangles(patch))
      for (int i = 0; i < points_; ++i) points.push_back(points_ * t + i);
    const auto m = static_cast<Eigen::Index>(points.size());
    Point centre = Point::Zero();
    for (const int i : points) centre += places[i] / static_cast<double>(m);
    double size = 0;
    for (const int i : points) size = std::max(size, (places[i] - centre).lpNorm<Eigen::Infinity>());
    F.resize(terms_, m);
    Eigen::Matrix3d gram = Eigen::Matrix3d::Identity();
    gram.topLeftCorner(terms_, terms_).setZero();
    for (Eigen::Index k = 0; k < m; ++k) {
      F(0, k) = 1;
      if (terms_ == 3) F.col(k).tail<2>() = (places[points[k]] - centre) / size;
      gram.topLeftCorner(terms_, terms_) += weights[points[k]] * F.col(k) * F.col(k).transpose();
    }
    const Eigen::Matrix3d L = gram.llt().matrixL();
    L.topLeftCorner(terms_, terms_).triangularView<Eigen::Lower>().solveInPlace(F);
    for (Eigen::Index k = 0; k < m; ++k) {
      const int i = points[k];
      const int* at = local(i / points_);
      for (int term = 0; term < terms_; ++term) {
        basis_[static_cast<size_t>(terms_) * i + term] = F(term, k);
        const double factor = weights[i] * F(term, k);
        double* row = const_cast<double*>(this->row(patch, term));
        const double* gradient = &gradients[2 * static_cast<size_t>(n - 1) * i];
        for (int a = 1; a < n; ++a)
          for (int c = 0; c < 2; ++c) {
            const double part = factor * gradient[2 * (a - 1) + c];
            row[2 * at[a] + c] += part;
            row[2 * at[0] + c] -= part;  // gradients sum to zero
          }
        for (int a = 0; a < n && !hoops.empty(); ++a) {
          const double part = factor * overRoot2 * hoops[static_cast<size_t>(n) * i + a];
          row[2 * at[a]] += part;
          uniform_[static_cast<size_t>(terms_) * patch + term] += part;
        }
      }
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
