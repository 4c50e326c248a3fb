#include "fem/tangent_assembly.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <type_traits>

#include "fem/element.h"
#include "material/material.h"

namespace mortier {
namespace {

// With G = gradient / sqrt2, a nodal displacement (ux, uy) strains p, q, r by
//   B = [Gx Gy; Gx -Gy; Gy Gx],
// and of a body that turns about the axis the fourth component by the row [N/r 0], N the shape function.

/// B_a' D B_b for a column of B_b, D the moduli (3 x 3, column major): the column's two entries in the rows
/// of node a.
struct ColumnOfDB {
  double sum;         ///< of the rows p and q of D B
  double difference;  ///< of these
  double r;
  double hoop = 0;

  [[nodiscard]] Eigen::Vector2d times(double gx, double gy) const {
    return {sum * gx + r * gy, difference * gy + r * gx};
  }
  [[nodiscard]] Eigen::Vector2d times(double gx, double gy, double overRadius) const {
    return times(gx, gy) + Eigen::Vector2d(hoop * overRadius, 0);
  }
  /// With the strain around the axis, and its stress.
  void addHoop(const BeyondModuli& D, double p, double q, double shear, double strain) {
    sum += (D.column[0] + D.column[1]) * strain;
    difference += (D.column[0] - D.column[1]) * strain;
    r += D.column[2] * strain;
    hoop = D.row[0] * p + D.row[1] * q + D.row[2] * shear + D.corner * strain;
  }
  /// Where p is averaged only minus the circumference over sqrt2 is left of its row to a triangle.
  void averageRows() {
    hoop -= (sum + difference) / (2 * std::numbers::sqrt2);
    sum = (sum - difference) / 2;
    difference = -sum;
  }
};

ColumnOfDB columnOfDB(const std::array<double, 9>& D, double p, double q, double r) {
  const double dp = D[0] * p + D[3] * q + D[6] * r;
  const double dq = D[1] * p + D[4] * q + D[7] * r;
  return {dp + dq, dp - dq, D[2] * p + D[5] * q + D[8] * r};
}

void add(double* target, const Eigen::Vector2d& values) {
  Eigen::Map<Eigen::Vector2d>{target} += values;
}

}  // namespace

TangentAssembly::TangentAssembly(const TriangleData& triangles, const std::vector<int>& frameOf, int size,
                                 bool symmetric) {
  pattern_.symmetric = symmetric;
  pattern_.size = size;
  buildPattern(triangles);
  cutIntoParts(triangles.equations);
  placeBlocks(triangles, frameOf);
}

void TangentAssembly::buildPattern(const TriangleData& triangles) {
  // The neighbours of each node by counting sort of the triangles' couplings, then sorted and made unique one
  // node at a time. Equations ascend with nodes; those of nodes without a triangle here may be beyond.
  const auto nodes = static_cast<int>(triangles.equations.size() / 2);
  const size_t n = triangles.nodes.perTriangle();
  const auto forEachCouplingOf = [&](std::span<const int> of, auto visit) {
    for (const int j : of)
      for (const int i : of)
        if (i >= j || !pattern_.symmetric) visit(i, j);
  };
  const auto forEachCoupling = [&](auto visit) {
    for (int p = 0; triangles.patches != nullptr && p < triangles.patches->count(); ++p)
      forEachCouplingOf(triangles.patches->nodes(p), visit);
    for (size_t t = 0; triangles.patches == nullptr && t < triangles.count(); ++t)
      forEachCouplingOf({triangles.nodes.of(t), n}, visit);
  };
  std::vector<int> start(nodes + 1, 0);
  forEachCoupling([&](int, int of) { ++start[of + 1]; });
  for (int j = 0; j < nodes; ++j) start[j + 1] += start[j];
  std::vector<int> neighbours(start[nodes]);
  std::vector<int> next(start.begin(), start.end() - 1);
  forEachCoupling([&](int neighbour, int of) { neighbours[next[of]++] = neighbour; });

  pattern_.columnStart.assign(1, 0);
  pattern_.columnStart.reserve(pattern_.size + 1);
  for (int j = 0; j < nodes; ++j) {
    const auto begin = neighbours.begin() + start[j];
    std::sort(begin, neighbours.begin() + start[j + 1]);
    const auto end = std::unique(begin, neighbours.begin() + start[j + 1]);
    for (int c = 0; c < 2; ++c) {
      const int column = triangles.equations[2 * j + c];
      if (column < 0 || column >= pattern_.size) continue;
      for (auto node = begin; node != end; ++node)
        for (int r = 0; r < 2; ++r) {
          const int row = triangles.equations[2 * *node + r];
          if (row >= 0 && (row >= column || !pattern_.symmetric)) pattern_.rows.push_back(row);
        }
      pattern_.columnStart.push_back(static_cast<int>(pattern_.rows.size()));
    }
  }
}

int TangentAssembly::entry(int row, int column) const {
  const auto begin = pattern_.rows.begin() + pattern_.columnStart[column];
  const auto end = pattern_.rows.begin() + pattern_.columnStart[column + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - pattern_.rows.begin());
}

void TangentAssembly::addEntries(const TriangleData& triangles, std::span<const int> nodes, bool lower,
                                 std::vector<int>& entries) const {
  for (size_t j = 0; j < 2 * nodes.size(); ++j)
    for (size_t i = lower ? j : 0; i < 2 * nodes.size(); ++i) {
      const int column = triangles.equations[2 * nodes[j / 2] + j % 2];
      const int row = triangles.equations[2 * nodes[i / 2] + i % 2];
      const bool none = column < 0 || row < 0 || (row < column && pattern_.symmetric);
      // The rows of a node follow each other.
      const bool follows = !none && i % 2 == 1 && i > (lower ? j : 0) && entries.back() >= 0;
      entries.push_back(none ? -1 : follows ? entries.back() + 1 : entry(row, column));
    }
}

void TangentAssembly::cutIntoParts(const std::vector<int>& equations) {
  constexpr int columnsOfAPart = 8192;
  // Between nodes.
  for (size_t dof = 0; dof < equations.size(); dof += 2) {
    const int first = equations[dof] >= 0 ? equations[dof] : equations[dof + 1];
    if (first < static_cast<int>(parts_.size()) * columnsOfAPart || first >= pattern_.size) continue;
    if (!parts_.empty()) parts_.back().endColumn = first;
    parts_.push_back({first, pattern_.size, {}});
  }
}

void TangentAssembly::placeBlocks(const TriangleData& triangles, const std::vector<int>& frameOf) {
  const auto isPlain = [&](int node) {
    return triangles.equations[2 * node] >= 0 && triangles.equations[2 * node + 1] >= 0 &&
           (frameOf.empty() || frameOf[node] < 0);
  };
  const auto partOf = [&](int column) {
    const auto after = std::upper_bound(parts_.begin(), parts_.end(), column,
                                        [](int value, const Part& part) { return value < part.firstColumn; });
    return static_cast<int>(after - parts_.begin()) - 1;
  };
  for (int p = 0; triangles.patches != nullptr && p < triangles.patches->count(); ++p)
    addEntries(triangles, triangles.patches->nodes(p), pattern_.symmetric, entriesOfPatches_);
  const int n = triangles.nodes.perTriangle();
  blocks_.resize(triangles.count() * n * n);
  std::vector<int> home(n);
  for (size_t t = 0; t < triangles.count(); ++t) {
    const int* nodes = triangles.nodes.of(t);
    uint16_t* blocks = &blocks_[t * n * n];
    bool plain = std::all_of(nodes, nodes + n, isPlain);
    for (int b = 0; b < n && plain; ++b) {
      const int column = triangles.equations[2 * nodes[b]];
      home[b] = partOf(column);
      for (int a = 0; a < n; ++a) {
        const int row = triangles.equations[2 * nodes[a]];
        if (row < column && pattern_.symmetric) continue;
        const int place = entry(row, column) - pattern_.columnStart[column];
        plain = plain && place <= std::numeric_limits<uint16_t>::max();
        blocks[n * b + a] = static_cast<uint16_t>(place);
      }
    }
    if (!plain) {
      others_.push_back({static_cast<int>(t), {}});
      addEntries(triangles, {nodes, static_cast<size_t>(n)}, false, others_.back().entries);
      continue;
    }
    std::sort(home.begin(), home.end());
    for (int b = 0; b < n; ++b)
      if (b == 0 || home[b] != home[b - 1]) parts_[home[b]].triangles.push_back(static_cast<int>(t));
  }
  for (Part& part : parts_) part.triangles.shrink_to_fit();
}

// Both rows of a node follow each other in every column, and its second column is its first one (where
// symmetric: without its first row). Every entry is a sum over triangles in their order, whichever part it
// lies in.
template <class Element, bool aboutAxis, bool averaged>
void TangentAssembly::assemblePlain(const TriangleData& triangles, const TangentModuli& moduli,
                                    std::vector<double>& values, Threads& threads) const {
  constexpr int n = Element::nodes;
  constexpr int points = Element::points;
  values.resize(pattern_.entries());
  const bool symmetric = pattern_.symmetric;
  double* const first = values.data();
  const int* const start = pattern_.columnStart.data();
  const int* const equations = triangles.equations.data();
  threads.forEach(static_cast<int>(parts_.size()), [&](int p) {
    const Part& part = parts_[p];
    std::fill(values.begin() + start[part.firstColumn], values.begin() + start[part.endColumn], 0.0);
    for (const int t : part.triangles) {
      const int* nodes = &triangles.nodes.triangles[static_cast<size_t>(n) * t];
      const uint16_t* blocks = &blocks_[static_cast<size_t>(n) * n * t];
      int equation[n];
      for (int a = 0; a < n; ++a) equation[a] = equations[2 * nodes[a]];
      for (int i = points * t; i < points * (t + 1); ++i) {
        const std::array<double, 2 * n> G = triangles.gradientsOf<Element>(i);
        const std::array<double, 9> D = moduliAt(moduli.plane, i);
        [[maybe_unused]] BeyondModuli beyond;
        [[maybe_unused]] const double* overRadius = nullptr;
        if constexpr (aboutAxis) {
          beyond = beyondAt(*moduli.beyond, i);
          overRadius = &triangles.hoops[static_cast<size_t>(n) * i];
        }
        const double weight = triangles.weights[i];
        for (int b = 0; b < n; ++b) {
          if (equation[b] < part.firstColumn || equation[b] >= part.endColumn) continue;
          const double gx = weight * G[2 * b];
          const double gy = weight * G[2 * b + 1];
          double px = gx;
          double py = gy;
          if constexpr (averaged) px = py = 0;
          if constexpr (averaged && aboutAxis) px = -weight * overRadius[b] / std::numbers::sqrt2;
          ColumnOfDB x = columnOfDB(D, px, gx, gy);
          ColumnOfDB y = columnOfDB(D, py, -gy, gx);
          if constexpr (aboutAxis) {
            x.addHoop(beyond, px, gx, gy, weight * overRadius[b]);
            y.addHoop(beyond, py, -gy, gx, 0);
          }
          if constexpr (averaged) {
            x.averageRows();
            y.averageRows();
          }
          const auto rows = [&](const ColumnOfDB& column, int a) {
            if constexpr (aboutAxis) return column.times(G[2 * a], G[2 * a + 1], overRadius[a]);
            return column.times(G[2 * a], G[2 * a + 1]);
          };
          double* columnX = first + start[equation[b]];
          double* columnY = first + start[equation[b] + 1] - (symmetric ? 1 : 0);
          for (int a = 0; a < n; ++a) {
            if (symmetric && equation[a] < equation[b]) continue;
            const int place = blocks[n * b + a];
            const Eigen::Vector2d yy = rows(y, a);
            add(columnX + place, rows(x, a));
            if (symmetric && a == b)
              columnY[place + 1] += yy[1];
            else
              add(columnY + place, yy);
          }
        }
      }
    }
  });
}

void TangentAssembly::assemblePlain(const TriangleData& triangles, const TangentModuli& moduli,
                                    std::vector<double>& values, Threads& threads) const {
  withElement(triangles.nodes.degree, [&](auto element) {
    using Element = decltype(element);
    const auto assemble = [&](auto averaged) {
      if (moduli.beyond != nullptr)
        assemblePlain<Element, true, averaged.value>(triangles, moduli, values, threads);
      else
        assemblePlain<Element, false, averaged.value>(triangles, moduli, values, threads);
    };
    if (triangles.patches != nullptr)
      assemble(std::true_type());
    else
      assemble(std::false_type());
  });
}

}  // namespace mortier
