#include "base/two_part_vector.h"

#include <gtest/gtest.h>

#include <random>

namespace mortier::two_part_vector_test {

// Powers of two, so that every sum is known exactly: 1e5 changes below the rounding of the entry, and back
// again.
TEST(TwoPartVector, keepsChangesBelowTheRoundingOfItsEntries) {
  constexpr double tiny = 0x1p-74;
  constexpr int changes = 100000;
  TwoPartVector u = TwoPartVector::zero(2);
  u += Vector::Constant(2, 0.75);
  for (int i = 0; i < changes; ++i) u += Vector{{tiny, -tiny}};
  EXPECT_EQ(u.value(), Vector::Constant(2, 0.75));
  u += Vector::Constant(2, -0.75);
  EXPECT_EQ(u.value(), (Vector{{changes * tiny, -changes * tiny}}));
}

TEST(TwoPartVector, differencesAreThoseOfTheSums) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&](double size) {
    return Vector(Vector::NullaryExpr(50, [&] { return size * uniform(random); }));
  };
  TwoPartVector a{vector(1), vector(1e-17)};
  const TwoPartVector b = a;
  const Vector change = vector(1e-18);
  a += change;
  EXPECT_LE((a.minus(b) - change).cwiseAbs().maxCoeff(), 1e-32);
  EXPECT_EQ((0.5 * a).value(), 0.5 * a.value());
}

TEST(TwoPartVector, componentsAreSetInBothParts) {
  TwoPartVector u{Vector{{1, 2, 3}}, Vector{{1e-20, 2e-20, 3e-20}}};
  u.set(2, -4);
  EXPECT_EQ(u.high[2], -4);
  EXPECT_EQ(u.low[2], 0);
}

}  // namespace mortier::two_part_vector_test
