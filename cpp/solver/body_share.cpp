#include "solver/body_share.h"

#include <algorithm>

#include "linear/partition.h"

namespace mortier {
namespace {

/// Triangles that have a side in common.
Graph neighbourhoods(const Body& body) {
  const ElementNodes& nodes = body.elementNodes();
  const size_t triangles = body.mesh().triangles.size();
  struct Side {
    int first, second, triangle;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles);
  for (size_t t = 0; t < triangles; ++t)
    for (int i = 0; i < 3; ++i) {
      const auto [first, second] = std::minmax(nodes.of(t)[i], nodes.of(t)[(i + 1) % 3]);
      sides.push_back({first, second, static_cast<int>(t)});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::pair(a.first, a.second) < std::pair(b.first, b.second);
  });
  const auto forEachPair = [&](auto visit) {
    for (size_t i = 0; i + 1 < sides.size(); ++i)
      if (sides[i].first == sides[i + 1].first && sides[i].second == sides[i + 1].second)
        visit(sides[i].triangle, sides[i + 1].triangle);
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

Cut cutOf(const Model& model, int body, int ranks) {
  constexpr double least = 0.1;  // of a rank's share: what is smaller goes to its neighbour
  double before = 0;
  double all = 0;
  const auto sizeOf = [&](size_t b) { return static_cast<double>(model.bodies[b].points()); };
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    if (b < static_cast<size_t>(body)) before += sizeOf(b);
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

BodyShare::BodyShare(const Model& model, int body, Ranks& ranks) : ranks_(&ranks), runs_(ranks.count()) {
  const Body& whole = model.bodies[body];
  const Cut cut = cutOf(model, body, ranks.count());
  const auto triangles = static_cast<int>(whole.mesh().triangles.size());
  std::vector<double> owner(triangles, 0.0);
  if (ranks.first() && cut.shares.size() > 1) {
    const std::vector<int> part = partition(neighbourhoods(whole), cut.shares);
    std::copy(part.begin(), part.end(), owner.begin());
  }
  if (cut.shares.size() > 1) ranks.sum(owner.data(), owner.size());

  const int points = whole.points() / triangles;
  std::vector<char> own(whole.nodes(), 0);
  responsible_.assign(whole.nodes(), 0);
  std::vector<char> taken(whole.nodes(), 0);
  for (int t = 0; t < triangles; ++t) {
    const int rank = cut.firstRank + static_cast<int>(owner[t]);
    std::vector<Run>& runs = runs_[rank];
    if (runs.empty() || runs.back().second != points * t) runs.emplace_back(points * t, points * t);
    runs.back().second = points * (t + 1);
    for (int i = 0; i < whole.elementNodes().perTriangle(); ++i) {
      const int node = whole.elementNodes().of(t)[i];
      if (taken[node] == 0 && rank == ranks.rank()) responsible_[node] = 1;
      taken[node] = 1;
      if (rank == ranks.rank()) own[node] = 1;
    }
  }
  for (int dof = 0; dof < whole.dofs(); ++dof)
    if (own[dof / 2] != 0 && whole.equations()[dof] >= 0) equations_.push_back(whole.equations()[dof]);
}

void BodyShare::gather(Matrix& columns) const {
  const Eigen::Index rows = columns.rows();
  std::vector<size_t> sizes;
  size_t total = 0;
  for (const std::vector<Run>& runs : runs_) {
    size_t count = 0;
    for (const auto& [begin, end] : runs) count += end - begin;
    sizes.push_back(count * rows);
    total += sizes.back();
  }
  std::vector<double> own;
  own.reserve(sizes[ranks_->rank()]);
  for (const auto& [begin, end] : runs())
    own.insert(own.end(), columns.data() + rows * begin, columns.data() + rows * end);
  std::vector<double> all(total);
  ranks_->gather(own, sizes, all.data());
  const double* next = all.data();
  for (const std::vector<Run>& runs : runs_)
    for (const auto& [begin, end] : runs) {
      std::copy_n(next, rows * (end - begin), columns.data() + rows * begin);
      next += rows * (end - begin);
    }
}

void BodyShare::clearOthers(Matrix& columns) const {
  for (int rank = 0; rank < ranks_->count(); ++rank)
    for (const auto& [begin, end] : runs_[rank])
      if (rank != ranks_->rank()) columns.middleCols(begin, end - begin).setZero();
}

double BodyShare::largest(const Matrix& columns) const {
  double largest = 0;
  for (const auto& [begin, end] : runs())
    largest = std::max(largest, columns.middleCols(begin, end - begin).cwiseAbs().maxCoeff());
  return largest;
}

}  // namespace mortier
