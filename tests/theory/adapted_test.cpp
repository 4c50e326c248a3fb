// Meshes that are refined until an accuracy is reached, where the exact error is known: below what was asked, and near the estimate.
#include <gtest/gtest.h>

#include <iostream>

#include "theory/adapted.h"

namespace mortier {
namespace {

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

}  // namespace
}  // namespace mortier
