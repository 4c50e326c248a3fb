// Meshes that are refined until an accuracy is reached, where the exact error is known: below what was asked,
// and near the estimate.
#include <gtest/gtest.h>

#include <iostream>

#include "theory/adapted.h"

namespace mortier::adapted_test {

using namespace scenes;

void expectReached(const std::string& name, const Adapted& adapted, double accuracy) {
  constexpr double leastEffectivity = 0.9;
  constexpr double mostEffectivity = 1.3;
  constexpr double mostOverhead = 3;
  std::cout << name << ", " << accuracy << ": " << adapted.rounds.size() << " rounds, "
            << adapted.last().unknowns << " unknowns, error " << adapted.last().error << ", effectivity "
            << adapted.effectivity() << ", overhead " << adapted.overhead() << "\n";
  EXPECT_EQ(adapted.verdict, Rounds::Verdict::reached) << name;
  EXPECT_LE(adapted.last().error, accuracy) << name;
  EXPECT_GE(adapted.effectivity(), leastEffectivity) << name;
  EXPECT_LE(adapted.effectivity(), mostEffectivity) << name;
  EXPECT_LE(adapted.overhead(), mostOverhead) << name;
}

TEST(Adapted, contactWithAKnownEnd) {
  for (const double contrast : {1e-6, 1e-3, 1.0, 1e3, 1e6})
    for (const int nonmortar : {upperBody, lowerBody})
      for (const auto& cells : {std::pair(4, 5), std::pair(4, 13), std::pair(13, 4)})
        expectReached("E 1:" + std::to_string(contrast) + (nonmortar == upperBody ? ", upper" : ", lower") +
                          " nonmortar, cells " + std::to_string(cells.first) + ":" +
                          std::to_string(cells.second),
                      adapt(halfOpen(cells, contrast, nonmortar), 0.05), 0.05);
}

TEST(Adapted, cornerOfAnLAtEitherDegree) {
  for (const auto& [degree, accuracy] : {std::pair(1, 0.1), std::pair(1, 0.05), std::pair(2, 0.01)})
    expectReached("L, degree " + std::to_string(degree), adapt(lShape(1, degree), accuracy), accuracy);
}

/// Exponent of the unknowns in the errors of ever smaller accuracies.
double orderInUnknowns(const KnownProblem& problem, const std::vector<double>& accuracies) {
  std::vector<double> unknowns;
  std::vector<double> errors;
  for (const double accuracy : accuracies) {
    const Adapted adapted = adapt(problem, accuracy);
    unknowns.push_back(adapted.last().unknowns);
    errors.push_back(adapted.last().error);
  }
  return fittedOrder(unknowns, errors);
}

// On meshes that are not refined towards the corner both degrees have the order a/2 = 0.27.
TEST(Adapted, ordersAreThoseOfTheDegreeWhereStressesAreUnbounded) {
  const double linear = orderInUnknowns(lShape(1, 1), {0.2, 0.1, 0.05});
  const double quadratic = orderInUnknowns(lShape(1, 2), {0.05, 0.02, 0.01, 0.005});
  std::cout << "order in unknowns: degree 1 " << linear << ", degree 2 " << quadratic << "\n";
  EXPECT_NEAR(linear, -0.5, 0.1);
  EXPECT_NEAR(quadratic, -1, 0.15);
}

}  // namespace mortier::adapted_test
