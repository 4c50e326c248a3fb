// Tetrahedra that are refined until an accuracy is reached, where the exact error is known.
#include <gtest/gtest.h>

#include <iostream>

#include "theory/adapted.h"

namespace mortier::space_adapted_test {

using namespace scenes;

Adapted expectReached(const std::string& name, const KnownProblem& problem, double accuracy) {
  Adapted adapted = adapt(problem, accuracy);
  std::cout << name << ", degree " << problem.degree << ", " << accuracy << ":";
  for (const Adapted::Round& round : adapted.rounds)
    std::cout << " " << round.unknowns << " (" << round.error << ", " << round.estimated / round.error << ")";
  std::cout << "\n";
  EXPECT_EQ(adapted.verdict, Rounds::Verdict::reached) << name;
  EXPECT_LE(adapted.last().error, accuracy) << name;
  EXPECT_GE(adapted.effectivity(), 0.8) << name;
  EXPECT_LE(adapted.effectivity(), 1.4) << name;
  return adapted;
}

TEST(SpaceAdapted, contactWithAKnownEndHasTheOrderOfItsDegree) {
  struct Row {
    int degree;
    std::array<double, 2> accuracies;
    double leastOrder;  ///< of the unknowns; 1/3 and 2/3 where the stress is smooth
  };
  for (const Row& row : {Row{1, {0.2, 0.05}, 0.3}, Row{2, {0.03, 0.002}, 0.65}}) {
    std::array<Adapted::Round, 2> last;
    for (size_t i = 0; i < 2; ++i)
      last[i] = expectReached("known end", halfOpenInSpace(6, row.degree), row.accuracies[i]).last();
    const double ratio = double(last[1].unknowns) / last[0].unknowns;
    const double order = std::log(last[0].error / last[1].error) / std::log(ratio);
    std::cout << "order in unknowns " << order << "\n";
    EXPECT_GE(order, row.leastOrder);
  }
}

TEST(SpaceAdapted, anEdgeWithUnboundedStressIsReached) {
  for (const auto& [degree, accuracy] : {std::pair(1, 0.2), std::pair(2, 0.1)})
    expectReached("edge of an L", lShapeInSpace(2, degree), accuracy);
}

}  // namespace mortier::space_adapted_test
