// Factors that follow a changing set solve as factors of the set itself do.
#include "solver/proximal_contact.h"

#include <gtest/gtest.h>

#include "unit/enumerated_contact.h"

namespace mortier::active_factor_test {

Vector solutionOn(const Matrix& W, const std::vector<char>& active, const Vector& f) {
  std::vector<int> set;
  for (size_t i = 0; i < active.size(); ++i)
    if (active[i] != 0) set.push_back(static_cast<int>(i));
  Vector x = Vector::Zero(f.size());
  if (!set.empty()) x(set) = W(set, set).partialPivLu().solve(f(set)).eval();
  return x;
}

TEST(ActiveFactor, followsASetThatChanges) {
  constexpr int n = 200;
  constexpr double tolerance = 1e-9;  // the condition numbers are about 1e4
  Randoms random(1);
  for (const bool symmetric : {true, false}) {
    const Matrix W = symmetric ? symmetricPositive(random, n) : unsymmetricP(random, n, false);
    double work = 0;
    ActiveFactor factor(W, symmetric, work);
    std::vector<char> active = random.set(n);
    int updated = 0;
    for (int change = 0; change < 200; ++change) {
      // One or a few conditions to and fro; now and then many.
      const int flips = change % 50 == 49 ? n / 2 : 1 + random.below(3);
      for (int k = 0; k < flips; ++k) active[random.below(change % 3 == 0 ? n : 10)] ^= 1;
      ASSERT_TRUE(factor.take(active));
      updated += factor.fresh() ? 0 : 1;
      const Vector f = random.vector(n);
      Matrix x = f;
      factor.solve(x);
      const Vector exact = solutionOn(W, active, f);
      ASSERT_LE((x - exact).cwiseAbs().maxCoeff(), tolerance * exact.cwiseAbs().maxCoeff()) << change;
    }
    EXPECT_GT(updated, 150);
    EXPECT_LT(work, 20.0 * n * n * n);
  }
}

TEST(ActiveFactor, seesThatASetIsSingular) {
  constexpr int n = 120;
  Randoms random(2);
  for (const bool symmetric : {true, false}) {
    Matrix W = symmetric ? symmetricPositive(random, n) : unsymmetricP(random, n, false);
    W.row(n - 1) = W.row(0);
    W.col(n - 1) = W.col(0);
    double work = 0;
    ActiveFactor factor(W, symmetric, work);
    std::vector<char> active(n, 1);
    active[n - 1] = 0;
    EXPECT_TRUE(factor.take(active));
    active[n - 1] = 1;
    EXPECT_FALSE(factor.take(active));
    active[0] = 0;
    EXPECT_TRUE(factor.take(active));
  }
}

}  // namespace mortier::active_factor_test
