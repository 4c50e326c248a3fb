// Pressures between two blocks in space whose meshes and stiffnesses differ, far and near.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "material/stress.h"
#include "mesh/shape.h"
#include "time/march.h"

namespace mortier::space_pressures_test {

enum : int { bottom = 1, right, top, left, front, back };

Body block(const std::string& name, double z, const std::array<int, 3>& cells, double young, int degree,
           bool loaded) {
  Conditions conditions;
  const Datum zero = [](const SpacePoint&, double) { return 0.0; };
  for (const int side : {left, right}) conditions.displacements.push_back({side, alongX, zero});
  for (const int side : {front, back}) conditions.displacements.push_back({side, alongY, zero});
  if (loaded)
    conditions.tractions.push_back(
        {top, alongZ, [](const SpacePoint& x, double t) { return -t * (1 + 0.5 * std::cos(M_PI * x.x())); }});
  else
    conditions.displacements.push_back({bottom, alongZ, zero});
  return {name, cuboidMesh({{0, 0, z}, {1, 1, z + 1}, cells}), elasticMaterial({young, 0.3}, Plane::none),
          std::move(conditions), degree};
}

/// Nodal pressures over 1 by the places of their nodes, of a nonmortar block on a softer or as soft one.
std::vector<std::pair<double, double>> pressures(int fine, int coarse, double ratio, int degree,
                                                 bool stabilised) {
  constexpr double young = 1000;
  Model model;
  model.bodies.push_back(block("upper", 0, {fine, fine, 2}, ratio * young, degree, true));
  model.bodies.push_back(block("lower", -1, {coarse, coarse, 2}, young, degree, false));
  InterfaceOptions options;
  options.stabilised = stabilised;
  options.mortarCompliance = 0.91 / young;
  addInterface(model, {{0, bottom}, {1, top}, CouplingKind::weighted}, options);
  State state = initialState(model);
  const RunReport report =
      march(model, state, {.end = 1, .steps = 1}, {}, [](const State&, const StepReport&) {});
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  const ContactInterface& interface = model.interfaces[0];
  const Vector pressure = interface.contactPressure(state.contactForce[0]);
  std::vector<std::pair<double, double>> result;
  for (int row = 0; row < interface.rows(); ++row)
    result.emplace_back(model.bodies[0].placeOfNode(interface.nonmortarNodes()[row]).x(), pressure[row]);
  return result;
}

// A stiff block makes the pressure uniform, whatever the load on it.
TEST(SpacePressures, ofAStiffFineBlockAreUniform) {
  double most = 0;
  for (const double ratio : {1e4, 1e6})
    for (const auto& [fine, coarse] : {std::pair(16, 2), std::pair(12, 5)})
      for (const auto& [x, p] : pressures(fine, coarse, ratio, 1, true))
        most = std::max(most, std::abs(p - 1));
  std::cout << "stiff and fine: pressures off by at most " << most << "\n";
  EXPECT_LE(most, 0.01);
  double without = 0;
  for (const auto& [x, p] : pressures(16, 2, 1e4, 1, false)) without = std::max(without, std::abs(p - 1));
  EXPECT_GE(without, 1);
}

// Those of meshes that match are the reference: 1 + c cos(pi x).
TEST(SpacePressures, ofEqualBlocksDoNotDependOnTheMeshes) {
  double amplitude = 0;
  for (const auto& [x, p] : pressures(8, 8, 1, 2, true))
    if (x == 0) amplitude = std::max(amplitude, p - 1);
  for (const int degree : {1, 2})
    for (const auto& [fine, coarse] : {std::pair(12, 2), std::pair(9, 4)}) {
      double most = 0;
      for (const auto& [x, p] : pressures(fine, coarse, 1, degree, true))
        most = std::max(most, std::abs(p - 1 - amplitude * std::cos(M_PI * x)));
      std::cout << "degree " << degree << ", " << fine << " on " << coarse << " cells: pressures off by "
                << most << "\n";
      EXPECT_LE(most, degree == 1 ? 0.05 : 0.03);
    }
}

}  // namespace mortier::space_pressures_test
