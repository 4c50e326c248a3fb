// Tetrahedra that are refined until an accuracy is reached, where the exact error is known.
#include <gtest/gtest.h>

#include <iostream>

#include "theory/adapted.h"

namespace mortier::space_adapted_test {

using namespace scenes;

TEST(SpaceAdapted, contactWithAKnownEndHasItsOrder) {
  struct Row {
    int degree;
    std::array<double, 2> accuracies;
    double leastOrder;  ///< of the unknowns
  };
  for (const Row& row : {Row{1, {0.2, 0.1}, 0.33}, Row{2, {0.03, 0.012}, 0.6}}) {
    std::array<Adapted::Round, 2> last;
    for (size_t i = 0; i < 2; ++i) {
      const Adapted adapted = adapt(extruded(6, row.degree), row.accuracies[i]);
      EXPECT_EQ(adapted.verdict, Rounds::Verdict::reached);
      last[i] = adapted.last();
      std::cout << "degree " << row.degree << ", " << row.accuracies[i] << ":";
      for (const Adapted::Round& round : adapted.rounds)
        std::cout << " " << round.unknowns << " (" << round.error << ", " << round.estimated / round.error << ")";
      std::cout << "\n";
      EXPECT_LE(last[i].error, row.accuracies[i]);
      EXPECT_GE(adapted.effectivity(), 0.8);
      EXPECT_LE(adapted.effectivity(), 1.4);
    }
    const double order = std::log(last[0].error / last[1].error) / std::log(double(last[1].unknowns) / last[0].unknowns);
    std::cout << "order in unknowns " << order << "\n";
    EXPECT_GE(order, row.leastOrder);
  }
}

}  // namespace mortier::space_adapted_test
