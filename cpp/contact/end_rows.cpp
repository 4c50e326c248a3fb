#include "contact/end_rows.h"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

namespace mortier {
namespace {

constexpr double atTheEnd = 1e-9;  // of the distance of two rows

/// A stretch of vertices that all have rows, and where contact ends beside it; NaN where it goes on.
struct Stretch {
  int first = 0;  ///< row
  int last = 0;
  double begin = NAN;
  double end = NAN;
};

std::vector<Stretch> stretches(const CommonRefinement& refinement, const std::vector<int>& nodes,
                               const std::vector<char>& goesOn) {
  const SmoothPart& part = refinement.part();
  const std::vector<Segment>& segments = refinement.segments();
  const auto isCorner = [&](int vertex) {
    const auto& corners = refinement.corners();
    return std::any_of(corners.begin(), corners.end(), [&](const auto& c) { return c.vertex == vertex; });
  };
  // Where contact ends in an element beside a vertex with a row, on the side of the other vertex.
  const auto endIn = [&](int vertex, int element, int other) {
    if (goesOn[vertex] != 0 || isCorner(vertex)) return double(NAN);
    if (element < 0 || element >= part.elements()) return part.closed ? double(NAN) : part.s[vertex];
    if (goesOn[other] != 0) return double(NAN);
    const auto [from, to] = refinement.piecesOf(element);
    if (from == to) return part.s[vertex];
    return other > vertex ? segments[to - 1].end : segments[from].begin;
  };
  std::vector<Stretch> result;
  for (int row = 0; row < static_cast<int>(nodes.size()); ++row) {
    const int vertex = nodes[row];
    if (row == 0 || nodes[row - 1] + 1 != vertex)
      result.push_back({row, row, endIn(vertex, vertex - 1, vertex - 1), NAN});
    Stretch& stretch = result.back();
    stretch.last = row;
    stretch.end = endIn(vertex, vertex, vertex + 1);
  }
  return result;
}

}  // namespace

Eigen::SparseMatrix<double> endRows(const CommonRefinement& refinement, const std::vector<int>& nodes,
                                    const Vector& places, const std::vector<char>& goesOn) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  const bool quadratic = std::any_of(nodes.begin(), nodes.end(), [&](int node) {
    return node > refinement.part().elements();  // those act at their nodes, up to the end
  });
  Triplets entries;
  for (int row = 0; row < n; ++row) entries.emplace_back(row, row, 1);
  const auto move = [&](int row, int beside, double to) {
    const double apart = places[row] - places[beside];
    const double beyond = to - places[row];
    if (!(beyond * apart > atTheEnd * apart * apart)) return;
    entries.emplace_back(row, row, beyond / apart);
    entries.emplace_back(row, beside, -beyond / apart);
  };
  if (quadratic) return assembled(n, n, entries);
  for (const Stretch& stretch : stretches(refinement, nodes, goesOn)) {
    if (stretch.first == stretch.last) continue;
    move(stretch.first, stretch.first + 1, stretch.begin);
    move(stretch.last, stretch.last - 1, stretch.end);
  }
  return assembled(n, n, entries);
}

Vector forcesAtEnds(const Eigen::SparseMatrix<double>& T, const Vector& f) {
  return Eigen::SparseLU<Eigen::SparseMatrix<double>>(T.transpose()).solve(f);
}

}  // namespace mortier
