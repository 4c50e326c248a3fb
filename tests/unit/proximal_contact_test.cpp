// A set that was solved on is closed to rounding, however large the forces are that cancel in it: signs of
// one exact problem do not go round. Compliances of 1/k^5 have condition numbers of 1e13; without corrections
// single forces are wrong by 1e-9.
#include "solver/proximal_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/load_patterns.h"

namespace mortier::proximal_contact_test {

TEST(ProximalContact, closesASetToRounding) {
  constexpr int n = 300;
  const std::vector<char> idle(n, 0);
  const Vector p0 = Vector::Zero(n);
  std::mt19937 random(1);
  for (const int motions : {0, 1, 2}) {
    const Matrix Q = patterns::waves(n);
    ContactProblem problem{Q * patterns::compliances(n, 5).asDiagonal() * Q.transpose(), true,
                           Matrix::Ones(n, motions)};
    if (motions == 2) problem.G.col(1).setLinSpaced(-1, 1);
    for (int trial = 0; trial < 30; ++trial) {
      const patterns::Pattern pattern = patterns::pattern(random, problem);
      // Runs of neighbours, and a few open nodes within.
      ContactSolution solution;
      solution.active.assign(n, 0);
      const int begin = static_cast<int>(random() % (n / 2));
      const int end = begin + n / 3 + static_cast<int>(random() % (n / 6));
      for (int i = begin; i < end; ++i) solution.active[i] = random() % 10 != 0 ? 1 : 0;
      Work work(problem);
      ProximalContact contact(problem, idle, pattern.slack, p0, pattern.balance, work);
      contact.setProximalPoint(Vector::Zero(motions));
      ASSERT_TRUE(contact.solveOn(solution));
      const Vector& p = solution.change;
      Vector exact = pattern.slack + problem.W * p - problem.G * solution.rigid;
      const double size =
          std::max(p.lpNorm<Eigen::Infinity>(),
                   pattern.slack.cwiseQuotient(problem.W.diagonal()).lpNorm<Eigen::Infinity>());
      for (int i = 0; i < n; ++i) {
        if (solution.active[i] == 0)
          EXPECT_EQ(p[i], 0);
        else
          EXPECT_LE(std::abs(exact[i]) / problem.W(i, i), 2 * ProximalContact::rounding * size)
              << motions << " " << trial;
      }
    }
  }
}

}  // namespace mortier::proximal_contact_test
