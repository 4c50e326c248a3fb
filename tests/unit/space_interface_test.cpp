#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>

#include "base/error.h"
#include "contact/interface.h"
#include "mesh/shape.h"

namespace mortier::space_interface_test {

/// The least processor time of a few couplings of two plates with so many layers of cells [s].
double timeOf(int layers) {
  constexpr int cells = 80;
  const auto plate = [&](double lower, int along) {
    return cuboidMesh({{0, 0, lower}, {1, 1, lower + 0.1}, {along, along, layers}});
  };
  const TetrahedronMesh upper = plate(0, cells);
  const TetrahedronMesh lower = plate(-0.1, cells + 1);
  const SpaceNodes upperNodes = spaceNodes(upper, 2);
  const SpaceNodes lowerNodes = spaceNodes(lower, 2);
  double least = 1e9;
  for (int i = 0; i < 2; ++i) {
    const std::clock_t start = std::clock();
    const ContactInterface interface({{0, 1}, {1, 3}, CouplingKind::weighted},
                                     SpaceContactMesh{upper, upperNodes},
                                     SpaceContactMesh{lower, lowerNodes});
    EXPECT_EQ((cells + 1) * (cells + 1), interface.rows());
    least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

TEST(SpaceInterface, doesNotCostWhatIsBelowTheSurface) {
  // Where each dof costs as much as there are rows it is more than four times.
  EXPECT_LE(timeOf(8), 2.5 * timeOf(1));
}

std::string fault(const Cuboid& lower) {
  const TetrahedronMesh a = cuboidMesh({{0, 0, 0}, {1, 1, 1}, {1, 1, 1}});
  const TetrahedronMesh b = cuboidMesh(lower);
  const SpaceNodes aNodes = spaceNodes(a, 1);
  const SpaceNodes bNodes = spaceNodes(b, 1);
  try {
    const ContactInterface met({{0, 1}, {1, 3}, CouplingKind::weighted}, SpaceContactMesh{a, aNodes},
                               SpaceContactMesh{b, bNodes});
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(SpaceInterface, saysWhyTwoSidesHaveNoRows) {
  EXPECT_EQ("none", fault({{0, 0, -1}, {1, 1, 0}, {2, 2, 2}}));
  EXPECT_EQ("box label 1 \"bottom\" and box label 3 \"top\" do not face each other",
            fault({{2, 0, -1}, {3, 1, 0}, {2, 2, 2}}));
  EXPECT_EQ(
      "box label 1 \"bottom\" and box label 3 \"top\" overlap at no nonmortar node, expected one across "
      "the mortar side: a finer nonmortar side, or the sides exchanged",
      fault({{0.2, 0.2, -1}, {0.8, 0.8, 0}, {2, 2, 2}}));
}

}  // namespace mortier::space_interface_test
