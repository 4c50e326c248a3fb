// The kernels of a front against Eigen, in the sizes done by loops, by BLAS and by tiles.
#include "linear/dense_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <limits>
#include <random>

#include "base/types.h"

namespace mortier::dense_kernels_test {

struct Size {
  int n, pivots;
};
constexpr Size sizes[] = {{1, 1},     {7, 3},     {13, 13},   {30, 5},   {150, 90},
                          {140, 140}, {460, 260}, {400, 400}, {390, 389}};
constexpr double rounding = 1e-11;

Matrix random(int n, bool symmetric) {
  std::mt19937 generator(n);
  std::normal_distribution<double> normal;
  Matrix A = Matrix::NullaryExpr(n, n, [&] { return normal(generator); });
  if (symmetric) return A * A.transpose() + Matrix::Identity(n, n);
  return A;
}

TEST(DenseKernels, partialCholeskyLeavesTheSchurComplement) {
  for (const auto& [n, pivots] : sizes) {
    const Matrix A = random(n, true);
    const int rest = n - pivots;
    Matrix panel = A.leftCols(pivots);
    Matrix update(rest, rest);
    ASSERT_TRUE(dense::partialCholesky(panel.data(), n, pivots, update.data(), Threads::none()));
    Matrix L = panel;
    L.topRows(pivots) = Matrix(panel.topRows(pivots).triangularView<Eigen::Lower>());
    EXPECT_LE((L * L.topRows(pivots).transpose() - A.leftCols(pivots)).cwiseAbs().maxCoeff(),
              rounding * A.norm());
    const Matrix expected = -L.bottomRows(rest) * L.bottomRows(rest).transpose();
    for (int j = 0; j < rest; ++j)
      for (int i = j; i < rest; ++i) EXPECT_NEAR(update(i, j), expected(i, j), rounding * A.norm());
  }
}

TEST(DenseKernels, partialLULeavesTheSchurComplement) {
  for (const auto& [n, pivots] : sizes) {
    const Matrix A = random(n, false);
    const int rest = n - pivots;
    Matrix panel = A.leftCols(pivots);
    Matrix upper = A.topRightCorner(pivots, rest).transpose();
    Matrix update(rest, rest);
    std::vector<int> interchange(pivots);
    ASSERT_TRUE(dense::partialLU(panel.data(), n, pivots, upper.data(), update.data(), interchange.data(),
                                 Threads::none()));
    const Matrix L = Matrix(panel.topRows(pivots).triangularView<Eigen::UnitLower>());
    const Matrix U = Matrix(panel.topRows(pivots).triangularView<Eigen::Upper>());
    Matrix swapped = A.topRows(pivots);
    for (Eigen::Index j = 0; j < n; ++j) dense::swapRows(swapped.col(j).data(), interchange.data(), pivots);
    EXPECT_LE((L * U - swapped.leftCols(pivots)).cwiseAbs().maxCoeff(), rounding * A.norm());
    EXPECT_LE((L * upper.transpose() - swapped.rightCols(rest)).norm(), rounding * A.norm());
    EXPECT_LE((panel.bottomRows(rest) * U - A.bottomLeftCorner(rest, pivots)).norm(), rounding * A.norm());
    EXPECT_LE((update + panel.bottomRows(rest) * upper.transpose()).norm(), rounding * update.norm());
  }
}

TEST(DenseKernels, noBitDependsOnThreads) {
  constexpr int n = 700;
  constexpr int pivots = 420;
  ASSERT_TRUE(dense::isLarge(n, pivots));
  const Matrix A = random(n, false);
  const Matrix symmetric = random(n, true);
  const auto factored = [&](Threads& threads) {
    std::vector<Matrix> all{symmetric.leftCols(pivots), Matrix::Zero(n - pivots, n - pivots),
                            A.leftCols(pivots), A.topRightCorner(pivots, n - pivots).transpose(),
                            Matrix::Zero(n - pivots, n - pivots)};
    std::vector<int> interchange(pivots);
    EXPECT_TRUE(dense::partialCholesky(all[0].data(), n, pivots, all[1].data(), threads));
    EXPECT_TRUE(dense::partialLU(all[2].data(), n, pivots, all[3].data(), all[4].data(), interchange.data(),
                                 threads));
    return all;
  };
  Threads three(3);
  EXPECT_EQ(factored(Threads::none()), factored(three));
}

TEST(DenseKernels, pivotsThatAreNoneAreRefused) {
  for (const auto& [n, pivots] : sizes)
    for (const double wrong :
         {-1e3, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      Matrix panel = random(n, true).leftCols(pivots);
      panel(pivots - 1, pivots - 1) = wrong;
      Matrix update(n - pivots, n - pivots);
      EXPECT_FALSE(dense::partialCholesky(panel.data(), n, pivots, update.data(), Threads::none()))
          << n << ", " << wrong;
      panel = random(n, false).leftCols(pivots);
      panel.col(pivots - 1).head(pivots).setConstant(wrong < 0 ? 0 : wrong);
      Matrix upper(n - pivots, pivots);
      std::vector<int> interchange(pivots);
      EXPECT_FALSE(dense::partialLU(panel.data(), n, pivots, upper.setZero().data(), update.data(),
                                    interchange.data(), Threads::none()))
          << n << ", " << wrong;
    }
}

TEST(DenseKernels, solvesAndProducts) {
  constexpr int n = 9;
  constexpr int ld = 12;
  const Matrix A = random(ld, false).leftCols(n) + 5 * Matrix::Identity(ld, n);
  const Matrix square = A.topRows(n);
  const Vector b = Vector::LinSpaced(n, 1, 2);
  const auto solved = [&](auto solve) {
    Vector x = b;
    solve(x.data());
    return x;
  };
  const Vector lower = solved([&](double* x) { dense::solveLower(A.data(), ld, n, false, x); });
  EXPECT_LE((square.triangularView<Eigen::Lower>() * lower - b).norm(), rounding);
  const Vector unit = solved([&](double* x) { dense::solveLower(A.data(), ld, n, true, x); });
  EXPECT_LE((square.triangularView<Eigen::UnitLower>() * unit - b).norm(), rounding * unit.norm());
  const Vector transposed = solved([&](double* x) { dense::solveLowerTransposed(A.data(), ld, n, x); });
  EXPECT_LE((square.transpose().triangularView<Eigen::Upper>() * transposed - b).norm(), rounding);
  const Vector upper = solved([&](double* x) { dense::solveUpper(A.data(), ld, n, x); });
  EXPECT_LE((square.triangularView<Eigen::Upper>() * upper - b).norm(), rounding);
  for (const int columns : {1, 4, 7}) {
    Vector y(ld);
    dense::multiply(A.data(), ld, ld, columns, b.data(), y.data());
    EXPECT_LE((y - A.leftCols(columns) * b.head(columns)).norm(), rounding);
    Vector z = b;
    const Vector x = Vector::LinSpaced(ld, -1, 3);
    dense::subtractTransposed(A.data(), ld, ld, columns, x.data(), z.data());
    EXPECT_LE((z.head(columns) - (b.head(columns) - A.leftCols(columns).transpose() * x)).norm(), rounding);
    EXPECT_EQ(z.tail(n - columns), b.tail(n - columns));
  }
}

}  // namespace mortier::dense_kernels_test
