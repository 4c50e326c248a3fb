#include "solver/model.h"

#include <algorithm>

#include "fem/rigid_modes.h"
#include "linear/partition.h"
#include "mesh/triangle_sides.h"

namespace mortier {
namespace {

/// Triangles that have a side in common.
Graph neighbourhoods(const Body& body) {
  const size_t triangles = body.mesh().triangles.size();
  const TriangleSides sides = sortedSides(body.mesh());
  const auto forEachPair = [&](auto visit) {
    forEachEdge(sides, [&](std::span<const TriangleSide> on) {
      if (on.size() > 1) visit(on[0].triangle(), on[1].triangle());
    });
  };
  Graph graph;
  graph.start.assign(triangles + 1, 0);
  forEachPair([&](int a, int b) {
    ++graph.start[a + 1];
    ++graph.start[b + 1];
  });
  for (size_t t = 0; t < triangles; ++t) graph.start[t + 1] += graph.start[t];
  graph.neighbours.resize(graph.start.back());
  std::vector<int> next(graph.start.begin(), graph.start.end() - 1);
  forEachPair([&](int a, int b) {
    graph.neighbours[next[a]++] = b;
    graph.neighbours[next[b]++] = a;
  });
  return graph;
}

/// Of a body: the first rank that has a part of it, and the shares of that and of those after it.
struct Cut {
  int firstRank = 0;
  std::vector<double> shares;
};

Cut cutOf(const std::vector<Body>& bodies, size_t body, int ranks) {
  constexpr double least = 0.1;  // of a rank's share: what is smaller goes to its neighbour
  double before = 0;
  double all = 0;
  const auto sizeOf = [&](size_t b) { return static_cast<double>(bodies[b].points()); };
  for (size_t b = 0; b < bodies.size(); ++b) {
    if (b < body) before += sizeOf(b);
    all += sizeOf(b);
  }
  const double begin = before / all * ranks;
  const double end = (before + sizeOf(body)) / all * ranks;
  Cut cut{std::min(static_cast<int>(begin), ranks - 1), {}};
  for (int rank = cut.firstRank; rank < std::max(cut.firstRank + 1, ranks) && rank < end; ++rank)
    cut.shares.push_back(std::min(end, rank + 1.0) - std::max(begin, static_cast<double>(rank)));
  if (cut.shares.size() > 1 && cut.shares.back() < least) {
    *(cut.shares.end() - 2) += cut.shares.back();
    cut.shares.pop_back();
  }
  if (cut.shares.size() > 1 && cut.shares.front() < least) {
    cut.shares[1] += cut.shares[0];
    cut.shares.erase(cut.shares.begin());
    ++cut.firstRank;
  }
  for (double& share : cut.shares) share /= end - begin;
  return cut;
}

}  // namespace

std::vector<std::vector<int>> ownersOf(const std::vector<Body>& bodies, Ranks& ranks) {
  std::vector<std::vector<int>> owners;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const Cut cut = cutOf(bodies, b, ranks.count());
    const auto triangles = bodies[b].mesh().triangles.size();
    std::vector<int>& owner = owners.emplace_back(triangles, cut.firstRank);
    if (cut.shares.size() == 1) continue;
    std::vector<double> share(triangles, 0.0);
    if (ranks.first()) {
      const std::vector<int> part = partition(neighbourhoods(bodies[b]), cut.shares);
      std::copy(part.begin(), part.end(), share.begin());
    }
    ranks.sum(share.data(), triangles);
    for (size_t t = 0; t < triangles; ++t) owner[t] += static_cast<int>(share[t]);
    const VolumePatches* patches = bodies[b].patches();
    for (int p = 0; patches != nullptr && p < patches->count(); ++p)  // a patch is of one rank
      for (const int t : patches->triangles(p)) owner[t] = owner[*patches->triangles(p).begin()];
  }
  return owners;
}

BodyPart partOf(const Body& whole, const std::vector<int>& owner, Ranks& ranks) {
  BodyPart part;
  part.wholePoints = whole.points();
  part.pointsOfTriangle = whole.pointsOfTriangle();
  const ElementNodes& nodes = whole.elementNodes();
  const auto triangles = static_cast<int>(owner.size());
  // 1. The first rank that has a triangle at a node is owned for it.
  constexpr int several = 1;
  constexpr int mine = 2;
  std::vector<int> first(whole.nodes(), -1);
  std::vector<char> which(whole.nodes(), 0);
  for (int t = 0; t < triangles; ++t) {
    if (owner[t] == ranks.rank()) part.cut.triangles.push_back(t);
    for (int i = 0; i < nodes.perTriangle(); ++i) {
      const int node = nodes.of(t)[i];
      if (first[node] >= 0 && first[node] != owner[t]) which[node] |= several;
      if (first[node] < 0 || owner[t] < first[node]) first[node] = owner[t];
      if (owner[t] == ranks.rank()) which[node] |= mine;
    }
  }
  // 2. What all ranks have.
  std::vector<char> everywhere(whole.nodes(), 0);
  for (const BoundaryStretch& stretch : nodes.boundary)
    for (const int node : stretch.nodes) everywhere[node] = 1;
  for (const NodeSupport& support : whole.supports().nodes()) everywhere[support.node] = 1;

  for (int node = 0; node < whole.nodes(); ++node) {
    const bool shared = (which[node] & several) != 0 || everywhere[node] != 0;
    const bool own = (which[node] & mine) != 0;
    if (own || everywhere[node] != 0) {
      if (shared) {
        part.shared.push_back(static_cast<int>(part.cut.nodes.size()));
        part.places.push_back(part.placesOfAll);
      }
      part.cut.nodes.push_back(node);
      part.own.push_back(own ? 1 : 0);
      part.owned.push_back(first[node] == ranks.rank() ? 1 : 0);
    }
    if (shared) ++part.placesOfAll;
  }
  const Matrix motions = rigidModes(whole);
  part.motions.resize(2 * static_cast<Eigen::Index>(part.cut.nodes.size()), motions.cols());
  for (Eigen::Index i = 0; i < motions.cols(); ++i) part.motions.col(i) = nodesOfPart(part, motions.col(i));
  if (!ranks.first()) return part;
  part.whole = &whole;
  part.trianglesOf.resize(ranks.count());
  part.nodesOf.resize(ranks.count());
  for (int t = 0; t < triangles; ++t) part.trianglesOf[owner[t]].push_back(t);
  for (int node = 0; node < whole.nodes(); ++node) part.nodesOf[first[node]].push_back(node);
  return part;
}

void sumAtNodes(const BodyPart& part, Ranks& ranks, Vector& nodal) {
  Vector sums = Vector::Zero(2 * static_cast<Eigen::Index>(part.placesOfAll));
  for (size_t i = 0; i < part.shared.size(); ++i)
    sums.segment<2>(2 * part.places[i]) = nodal.segment<2>(2 * part.shared[i]);
  ranks.sum(sums.data(), sums.size());
  for (size_t i = 0; i < part.shared.size(); ++i)
    nodal.segment<2>(2 * part.shared[i]) = sums.segment<2>(2 * part.places[i]);
}

void completeAtNodes(const BodyPart& part, Ranks& ranks, Vector& nodal) {
  for (const int node : part.shared)
    if (part.owned[node] == 0) nodal.segment<2>(2 * node).setZero();
  sumAtNodes(part, ranks, nodal);
}

namespace {

/// So many values an item, in the order of the items of each rank, to those of the whole body.
std::vector<double> gathered(Ranks& ranks, const std::vector<double>& own, size_t each,
                             const std::vector<std::vector<int>>& itemsOf) {
  std::vector<size_t> sizes;
  size_t total = 0;
  for (const std::vector<int>& items : itemsOf) {
    sizes.push_back(each * items.size());
    total += sizes.back();
  }
  std::vector<double> all(total);
  ranks.gatherToFirst(own, sizes, all.data());
  std::vector<double> whole(total);
  auto next = all.begin();
  for (const std::vector<int>& items : itemsOf)
    for (const int item : items) {
      std::copy_n(next, each, whole.begin() + static_cast<std::ptrdiff_t>(each * item));
      next += static_cast<std::ptrdiff_t>(each);
    }
  return whole;
}

}  // namespace

Vector gatheredNodes(const BodyPart& part, Ranks& ranks, const Vector& nodal) {
  std::vector<double> own;
  for (size_t node = 0; node < part.owned.size(); ++node)
    if (part.owned[node] != 0) own.insert(own.end(), nodal.data() + 2 * node, nodal.data() + 2 * node + 2);
  const std::vector<double> whole = gathered(ranks, own, 2, part.nodesOf);
  return Eigen::Map<const Vector>(whole.data(), static_cast<Eigen::Index>(whole.size()));
}

Matrix gatheredPoints(const BodyPart& part, Ranks& ranks, const Matrix& columns) {
  const int triangles = static_cast<int>(part.cut.triangles.size());
  const Eigen::Index each = columns.rows() * part.pointsOfTriangle;
  const std::vector<double> whole =
      gathered(ranks, {columns.data(), columns.data() + each * triangles}, each, part.trianglesOf);
  return Eigen::Map<const Matrix>(
      whole.data(), columns.rows(),
      columns.rows() > 0 ? static_cast<Eigen::Index>(whole.size()) / columns.rows() : 0);
}

Vector nodesOfPart(const BodyPart& part, const Vector& nodal) {
  Vector own(2 * static_cast<Eigen::Index>(part.cut.nodes.size()));
  for (size_t i = 0; i < part.cut.nodes.size(); ++i)
    own.segment<2>(2 * static_cast<Eigen::Index>(i)) = nodal.segment<2>(2 * part.cut.nodes[i]);
  return own;
}

Matrix pointsOfPart(const BodyPart& part, const Matrix& columns) {
  const Eigen::Index each = part.pointsOfTriangle;
  Matrix own(columns.rows(), each * static_cast<Eigen::Index>(part.cut.triangles.size()));
  for (size_t i = 0; i < part.cut.triangles.size(); ++i)
    own.middleCols(each * static_cast<Eigen::Index>(i), each) =
        columns.middleCols(each * part.cut.triangles[i], each);
  return own;
}

}  // namespace mortier
