#include "linear/supervariables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "linear/elimination.h"
#include "unit/dense_reference.h"

namespace mortier::supervariables_test {

/// Nodes of one to three equations that couple as random nodes do.
struct NodeMatrix {
  std::vector<int> first;  ///< equation of each node, and the number of all
  Matrix K;

  NodeMatrix(std::mt19937& random, int nodes, bool symmetric) {
    std::uniform_int_distribution<int> size(1, 3);
    std::uniform_real_distribution<double> value(0.5, 1);
    for (int node = 0, next = 0; node <= nodes; next += size(random), ++node) first.push_back(next);
    const Matrix links = randomMatrix(random, nodes, 4, true);
    K = Matrix::Zero(first.back(), first.back());
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b < nodes; ++b)
        for (int i = first[a]; i < first[a + 1]; ++i)
          for (int j = first[b]; j < first[b + 1]; ++j)
            if (links(a, b) != 0) K(i, j) = symmetric && i > j ? K(j, i) : value(random);
    for (int j = 0; j < K.cols(); ++j) K(j, j) = 1 + K.col(j).sum() + K.row(j).sum();
    if (symmetric) K = K.selfadjointView<Eigen::Upper>().toDenseMatrix().eval();
  }
};

TEST(RunOrder, runsAreTheNodes) {
  std::mt19937 random(1);
  for (const bool symmetric : {true, false}) {
    const NodeMatrix matrix(random, 40, symmetric);
    const SparsePattern pattern = System(matrix.K, symmetric).pattern;
    const auto runs = [&](const std::vector<int>& kept) { return Supervariables(pattern, kept).first; };
    EXPECT_EQ(runs({}), matrix.first);
    // A node of which a part is kept is two runs, or three where its equations are kept in another order.
    const auto three =
        std::adjacent_find(matrix.first.begin(), matrix.first.end(), [](int a, int b) { return b == a + 3; });
    ASSERT_NE(three, matrix.first.end());
    const int at = *three;
    EXPECT_EQ(runs({at, at + 1, at + 2}), matrix.first);
    EXPECT_EQ(runs({at + 1, at + 2}).size(), matrix.first.size() + 1);
    EXPECT_EQ(runs({at + 2, at + 1, at}).size(), matrix.first.size() + 2);
  }
}

TEST(RunOrder, matricesOfNodesAgreeWithDenseElimination) {
  std::mt19937 random(2);
  for (const bool symmetric : {true, false})
    for (const int nodes : {2, 10, 60}) {
      const NodeMatrix matrix(random, nodes, symmetric);
      const auto size = static_cast<int>(matrix.K.rows());
      for (const int count : {0, 3, size / 2})
        compare(engines[0], System(matrix.K, symmetric), randomSubset(random, size, count), random);
      std::vector<int> kept;  // whole nodes
      for (int i = matrix.first[nodes / 2]; nodes > 2 && i < matrix.first[nodes / 2 + 2]; ++i)
        kept.push_back(i);
      compare(engines[0], System(matrix.K, symmetric), kept, random);
    }
}

/// Of quadratic triangles on a square, nodes in the order of a grid of their half size.
SparsePattern quadraticTriangles(int cells) {
  const int side = 2 * cells + 1;
  std::vector<std::set<int>> columns(side * side);
  for (int x = 0; x < 2 * cells; x += 2)
    for (int y = 0; y < 2 * cells; y += 2)
      for (const bool upper : {false, true}) {
        std::vector<int> nodes;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            if (upper ? i + j >= 2 : i + j <= 2) nodes.push_back((y + j) * side + x + i);
        for (const int a : nodes)
          for (const int b : nodes)
            if (a >= b) columns[b].insert(a);
      }
  SparsePattern pattern{side * side, true, {0}, {}};
  for (const std::set<int>& column : columns) {
    pattern.rows.insert(pattern.rows.end(), column.begin(), column.end());
    pattern.columnStart.push_back(pattern.entries());
  }
  return pattern;
}

// Placed with the last of its vertices, or anywhere, a middle fills the factor.
TEST(RunOrder, middlesGoWithTheirVertices) {
  constexpr int cells = 60;
  const Elimination plan = analyse(quadraticTriangles(cells), {});
  double numbers = 0;
  for (const Front& front : plan.fronts) numbers += static_cast<double>(front.panelSize());
  const double equations = (2 * cells + 1) * (2 * cells + 1);
  EXPECT_LT(numbers / (equations * std::log2(equations)), 4.0);  // 3.2; with the last vertex 10.9
}

}  // namespace mortier::supervariables_test
