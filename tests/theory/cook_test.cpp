// Cook's membrane: the deflection of the middle of the free end, linear triangles. Values of two independent
// programs on cells cut along the rising diagonal.
#include <gtest/gtest.h>

#include <iostream>

#include "material/deviatoric.h"
#include "theory/scenes.h"

namespace mortier::cook_test {

using namespace scenes;

double deflection(int n, Cut cut,
                  const std::shared_ptr<const Material>& material = elasticMaterial({1, 1.0 / 3})) {
  Model model;
  model.bodies.emplace_back(
      "membrane", quadrilateralMesh({{Point(0, 0), {48, 44}, {48, 60}, {0, 44}}, n, n}, cut), material,
      Conditions{
          {{4, alongX, constant(0)}, {4, alongY, constant(0)}}, {{2, alongY, constant(1.0 / 16)}}, {}});
  const Result result = run(model, 1, 1);
  EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
  const auto middle = [](const Point& x) { return x.x() == 48 && std::abs(x.y() - 52) < 1e-9; };
  const Range range = displacementRange(model.bodies[0], result.state.bodies[0], 1, middle);
  EXPECT_EQ(range.count, 1);
  return range.max;
}

TEST(Cook, deflectionsAreThoseOfOtherPrograms) {
  constexpr double digits = 5e-4;  // all that are known
  const std::pair<int, double> known[] = {
      {8, 17.331}, {16, 21.592}, {32, 23.275}, {64, 23.774}, {128, 23.913}};
  for (const auto& [n, value] : known) EXPECT_NEAR(deflection(n, Cut::rising), value, digits) << n;
}

TEST(Cook, otherDiagonalsTendToTheSame) {
  constexpr double secondOrder = 23.9618;  // of elements of second order on 64 cells
  for (const Cut cut : {Cut::falling, Cut::both}) {
    std::cout << (cut == Cut::falling ? "falling diagonal, 8 to 128 cells:"
                                      : "both diagonals, 8 to 128 cells:");
    std::vector<double> found;
    for (const int n : {8, 16, 32, 64, 128}) {
      found.push_back(deflection(n, cut));
      std::cout << " " << found.back();
      EXPECT_LT(found.back(), secondOrder);
    }
    std::cout << "\n";
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    EXPECT_NEAR(found.back(), secondOrder, 0.02);
  }
}

// Nearly incompressible, plane strain: one diagonal a cell locks, by the known figures. Both diagonals do
// not: elements of second order have 18.45 on 64 cells.
TEST(Cook, nearlyIncompressiblePlaneStrainLocksByTheKnownFigures) {
  constexpr double digits = 5e-3;
  const auto material = elasticMaterial({1, 0.4999}, Plane::strain);
  const std::pair<int, double> known[] = {{8, 5.25}, {16, 5.36}, {32, 5.74}, {64, 6.83}, {128, 9.33}};
  for (const auto& [n, value] : known) EXPECT_NEAR(deflection(n, Cut::rising, material), value, digits) << n;
  const double crossed = deflection(64, Cut::both, material);
  std::cout << "both diagonals, 64 cells: " << crossed << "\n";
  EXPECT_NEAR(crossed, 18.45, 0.02 * 18.45);
}

}  // namespace mortier::cook_test
