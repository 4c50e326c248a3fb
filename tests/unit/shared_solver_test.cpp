// The interior shared by ranks, against one that is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "linear/condensing_solver.h"
#include "linear/partition.h"
#include "unit/thread_ranks.h"

namespace mortier::shared_solver_test {

constexpr double rounding = 1e-11;

/// A grid of cells, each with a full matrix over its four corners and an owner.
struct Cells {
  int side;
  SparsePattern pattern;
  std::vector<std::vector<int>> corners;
  std::vector<Matrix> matrices;
  std::vector<int> owner;

  Cells(std::mt19937& random, int n, bool symmetric, int ranks) : side(n) {
    std::uniform_real_distribution<double> value(-1, 1);
    for (int y = 0; y + 1 < side; ++y)
      for (int x = 0; x + 1 < side; ++x) {
        const int first = side * y + x;
        corners.push_back({first, first + 1, first + side, first + side + 1});
        Matrix B(4, 4);
        for (double& entry : B.reshaped()) entry = value(random);
        matrices.push_back(B * B.transpose() + Matrix::Identity(4, 4));
        if (!symmetric) matrices.back()(0, 1) += 0.5;
        owner.push_back(ranks * x / side);
      }
    std::vector<std::set<int>> columns(side * side);
    for (const std::vector<int>& cell : corners)
      for (const int j : cell)
        for (const int i : cell)
          if (i >= j || !symmetric) columns[j].insert(i);
    pattern.size = side * side;
    pattern.symmetric = symmetric;
    pattern.columnStart.push_back(0);
    for (const std::set<int>& rows : columns) {
      pattern.rows.insert(pattern.rows.end(), rows.begin(), rows.end());
      pattern.columnStart.push_back(pattern.entries());
    }
  }

  /// The sum over the cells of a rank, or of all.
  [[nodiscard]] std::vector<double> values(int rank = -1) const {
    std::vector<double> sum(pattern.entries(), 0.0);
    for (size_t c = 0; c < corners.size(); ++c)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
          const int row = corners[c][i];
          const int column = corners[c][j];
          if ((rank >= 0 && owner[c] != rank) || (row < column && pattern.symmetric)) continue;
          const auto begin = pattern.rows.begin() + pattern.columnStart[column];
          const auto at =
              std::lower_bound(begin, pattern.rows.begin() + pattern.columnStart[column + 1], row);
          sum[at - pattern.rows.begin()] += matrices[c](i, j);
        }
    return sum;
  }

  [[nodiscard]] std::vector<int> equationsOf(int rank) const {
    std::set<int> equations;
    for (size_t c = 0; c < corners.size(); ++c)
      if (owner[c] == rank) equations.insert(corners[c].begin(), corners[c].end());
    return {equations.begin(), equations.end()};
  }

  /// What a rank has, in numbers of its own; kept equations of others come last.
  struct Part {
    std::vector<int> equations;  ///< of all
    SparsePattern pattern;
    std::vector<double> values;
    std::vector<int> kept;
    SharedEquations shared;
  };
  [[nodiscard]] Part partOf(int rank, const std::vector<int>& kept) const {
    Part part;
    part.equations = equationsOf(rank);
    part.shared.count = pattern.size;
    std::vector<int> number(pattern.size, -1);
    for (size_t i = 0; i < part.equations.size(); ++i) {
      number[part.equations[i]] = static_cast<int>(i);
      part.shared.equations.push_back(static_cast<int>(i));
      part.shared.numbers.push_back(part.equations[i]);
    }
    part.pattern.size = static_cast<int>(part.equations.size());
    part.pattern.symmetric = pattern.symmetric;
    part.pattern.columnStart.push_back(0);
    const std::vector<double> own = values(rank);
    for (int column = 0; column < part.pattern.size; ++column) {
      const int j = part.equations[column];
      for (int k = pattern.columnStart[j]; k < pattern.columnStart[j + 1]; ++k) {
        if (number[pattern.rows[k]] < 0) continue;
        part.pattern.rows.push_back(number[pattern.rows[k]]);
        part.values.push_back(own[k]);
      }
      part.pattern.columnStart.push_back(part.pattern.entries());
    }
    for (const int each : kept) {
      if (number[each] < 0) {
        number[each] = static_cast<int>(part.equations.size());
        part.equations.push_back(each);
      }
      part.kept.push_back(number[each]);
    }
    return part;
  }
};

void expectSameSolution(const CondensingSolverFactory& engine, bool symmetric, int ranks, int kept) {
  std::mt19937 random(ranks + kept);
  const Cells cells(random, 12, symmetric, ranks);
  std::vector<int> last;
  for (int i = 0; i < kept; ++i) last.push_back(cells.side * cells.side - 1 - i);  // all ranks have some
  const Vector load = Vector::Random(cells.pattern.size);

  const auto alone = engine(cells.pattern, last);
  ASSERT_TRUE(alone->factorise(cells.values()));
  Vector expected = load;
  alone->condense(expected);
  const Vector condensed = expected(last);
  alone->expand(expected);

  ThreadRanks::run(ranks, [&](Ranks& all) {
    const Cells::Part part = cells.partOf(all.rank(), last);
    const auto solver = sharedSolver(part.pattern, part.kept, part.shared, engine, all);
    ASSERT_TRUE(solver->join(solver->factorise(part.values)));
    const Matrix error = solver->schurComplement() - alone->schurComplement();
    EXPECT_LE(error.size() > 0 ? error.cwiseAbs().maxCoeff() : 0, rounding);
    // A load at an equation of several is given by one of them.
    Vector f = Vector::Zero(static_cast<Eigen::Index>(part.equations.size()));
    for (int k = 0; k < part.pattern.size; ++k) {
      const int i = part.equations[k];
      bool before = false;
      for (int other = 0; other < all.rank(); ++other) {
        const std::vector<int> theirs = cells.equationsOf(other);
        before = before || std::binary_search(theirs.begin(), theirs.end(), i);
      }
      if (!before) f[k] = load[i];
    }
    solver->condense(f);
    solver->joinCondensed(f);
    for (int i = 0; i < kept; ++i) EXPECT_NEAR(f[part.kept[i]], condensed[i], rounding) << i;
    solver->expandJoined(f);
    solver->expand(f);
    EXPECT_LE((f - expected(part.equations)).cwiseAbs().maxCoeff(), rounding) << "rank " << all.rank();
  });
}

TEST(SharedSolver, agreesWithOneRank) {
  for (const bool symmetric : {true, false})
    for (const int ranks : {1, 2, 3, 4})
      for (const int kept : {0, 1, 15, 144}) expectSameSolution(multifrontalSolver, symmetric, ranks, kept);
}

TEST(SharedSolver, partsMayBeEliminatedByTheLibraries) {
  for (const bool symmetric : {true, false}) expectSameSolution(suiteSparseSolver, symmetric, 3, 15);
}

// What one rank cannot factorise no rank takes for factorised.
TEST(SharedSolver, allRanksHearOfASingularPart) {
  std::mt19937 random(1);
  Cells cells(random, 8, true, 3);
  for (size_t c = 0; c < cells.owner.size(); ++c)
    if (cells.owner[c] == 1) cells.matrices[c] *= -1;
  ThreadRanks::run(3, [&](Ranks& all) {
    const Cells::Part part = cells.partOf(all.rank(), {0, 1});
    const auto solver = sharedSolver(part.pattern, part.kept, part.shared, multifrontalSolver, all);
    EXPECT_FALSE(solver->join(solver->factorise(part.values)));
  });
}

TEST(Ranks, textAndNumberAreThoseOfTheFirst) {
  ThreadRanks::run(3, [](Ranks& all) {
    EXPECT_EQ(textOfFirst(all, all.first() ? "caf\xc3\xa9" : "other"), "caf\xc3\xa9");
    EXPECT_EQ(textOfFirst(all, all.first() ? "" : "other"), "");
    EXPECT_EQ(numberOfFirst(all, 10 + all.rank()), 10);
  });
}

TEST(Partition, partsHaveTheSizesThatTheyAreToHave) {
  Graph line;
  constexpr int size = 1000;
  for (int i = 0; i < size; ++i) {
    if (i > 0) line.neighbours.push_back(i - 1);
    if (i + 1 < size) line.neighbours.push_back(i + 1);
    line.start.push_back(static_cast<int>(line.neighbours.size()));
  }
  for (const std::vector<double>& shares : {std::vector{1.0}, {0.5, 0.5}, {0.2, 0.5, 0.3}}) {
    const std::vector<int> part = partition(line, shares);
    ASSERT_EQ(part.size(), size);
    for (size_t p = 0; p < shares.size(); ++p)
      EXPECT_NEAR(static_cast<double>(std::count(part.begin(), part.end(), p)), shares[p] * size,
                  0.05 * size);
    int cuts = 0;
    for (int i = 0; i + 1 < size; ++i) cuts += part[i] != part[i + 1] ? 1 : 0;
    EXPECT_LE(cuts, 3 * (shares.size() - 1));
  }
}

}  // namespace mortier::shared_solver_test
