// Factors of dense matrices solve, whatever the number of panels and of right-hand sides, and hear an
// interruption.
#include "solver/dense_factor.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "base/interrupt.h"
#include "unit/enumerated_contact.h"

namespace mortier::dense_factor_test {

TEST(DenseFactor, solves) {
  constexpr double tolerance = 1e-11;  // condition numbers up to 1e4
  Randoms random(1);
  for (const int n : {1, 5, 8, 9, 127, 128, 129, 300})
    for (const bool symmetric : {true, false}) {
      const Matrix A = symmetric ? symmetricPositive(random, n) : random.matrix(n, n);
      DenseFactor factor;
      ASSERT_TRUE(factor.factorise(Matrix(A), symmetric));
      for (const int columns : {1, 3, 20}) {
        const Matrix b = random.matrix(n, columns);
        Matrix x = b;
        factor.solve(x);
        EXPECT_LE((A * x - b).norm(), tolerance * A.norm() * x.norm())
            << n << " " << symmetric << " " << columns;
      }
    }
}

TEST(DenseFactor, refusesWhatIsSingular) {
  constexpr int n = 200;
  Randoms random(2);
  Matrix A = symmetricPositive(random, n);
  A(150, 150) = -1;
  DenseFactor factor;
  EXPECT_FALSE(factor.factorise(Matrix(A), true));
  A.col(150).setZero();
  EXPECT_FALSE(factor.factorise(Matrix(A), false));
}

TEST(DenseFactor, pivotsTellHowCloseToSingular) {
  Randoms random(3);
  for (const bool symmetric : {true, false}) {
    Matrix A = symmetricPositive(random, 180);
    A.row(170) = A.row(3);
    A.col(170) = A.col(3);
    A(170, 170) *= 1 + 1e-13;
    DenseFactor factor;
    static_cast<void>(factor.factorise(std::move(A), symmetric));
    EXPECT_LT(factor.leastPivot(), 1e-12);
  }
}

TEST(DenseFactor, isInterruptedBetweenItsBlocks) {
  Randoms random(4);
  for (const bool symmetric : {true, false}) {
    DenseFactor factor;
    requestInterrupt();
    EXPECT_THROW(factor.factorise(symmetricPositive(random, 300), symmetric), Interrupted);
    interruption::requested = false;
  }
}

}  // namespace mortier::dense_factor_test
