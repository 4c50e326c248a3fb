// Meshes that are refined where the error of a quantity comes from, against refinement in the energy norm and
// equal meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "adapt/adapted_meshes.h"
#include "bound/energy_bound.h"
#include "theory/scenes.h"
#include "time/mesh_error.h"

namespace mortier::goal_test {

using namespace scenes;

/// The upper block is pressed at its left and lifted at its right.
Model tiltedBlock(const AdaptedMeshes& meshes) {
  const auto material = elasticMaterial({1, 0.3});
  const Function rise = [](double x, double, double t) { return t * (-0.3 + 0.4 * x); };
  Body upper("upper", meshes.mesh(0), material, {{{top, 0, constant(0)}, {top, 1, rise}}, {}, {}});
  Body lower("lower", meshes.mesh(1), material,
             {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  return contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody);
}

struct Found {
  int unknowns = 0;
  double force = 0;
  double error = 0;  ///< guaranteed
};

enum class Way { quantity, energy, equal };

std::vector<Found> refined(Way way, int rounds) {
  AdaptedMeshes meshes({square(0, 4), square(-1, 7)}, 1);
  std::vector<Found> found;
  while (true) {
    const Model model = tiltedBlock(meshes);
    const auto [state, report] = run(model, 1, 1);
    EXPECT_EQ(report.status, Status::converged);
    const EnergyBound bound = energyBound(
        model, state, {{"", Quantity::Kind::contactForce, upperBody, bottom, Quantity::Component::y}});
    const Enclosure& enclosure = bound.quantities[0];
    EXPECT_EQ(enclosure.obstacle, "");
    const double force = state.contactForce[0].sum();
    found.push_back({model.bodies[0].freeDofs() + model.bodies[1].freeDofs(), force, enclosure.error(force)});
    if (static_cast<int>(found.size()) == rounds) return found;
    if (way == Way::equal) {
      for (int i = 0; i < 2; ++i) meshes.refineAll();
      continue;
    }
    std::vector<Vector> errors = enclosure.parts;
    if (way == Way::energy) {
      errors.clear();
      for (const ErrorEstimate& each : MeshErrorEstimator(model)(state)) errors.push_back(each.error);
    }
    double sum = 0;
    for (const Vector& each : errors) sum += each.sum();
    if (way == Way::quantity) {
      EXPECT_NEAR(sum / ((enclosure.upper - enclosure.lower) / 2), 1, 0.5);
    }
    meshes.refine(errors, 0.5 * std::sqrt(sum));
  }
}

/// Unknowns for an error, on the line through the logarithms of the last two.
double unknownsFor(double error, const std::vector<Found>& found) {
  const Found& a = found[found.size() - 2];
  const Found& b = found.back();
  const double slope = std::log(double(b.unknowns) / a.unknowns) / std::log(b.error / a.error);
  return b.unknowns * std::pow(error / b.error, slope);
}

TEST(Goal, takesNoMoreUnknownsThanTheEnergyNormAndHalfOfEqualMeshes) {
  const std::vector<Found> quantity = refined(Way::quantity, 4);
  const std::vector<Found> energy = refined(Way::energy, 4);
  const std::vector<Found> equal = refined(Way::equal, 3);
  const double exact = quantity.back().force;
  const auto report = [&](const std::string& name, const std::vector<Found>& found) {
    for (const Found& each : found)
      std::cout << name << ": " << each.unknowns << " unknowns, force " << each.force << ", off "
                << 100 * std::abs(each.force - exact) / exact << " %, guaranteed " << 100 * each.error / exact
                << " %\n";
  };
  report("quantity", quantity);
  report("energy", energy);
  report("equal", equal);
  const double error = quantity.back().error;
  const double needed = quantity.back().unknowns;
  std::cout << "for the last one " << needed << ", " << unknownsFor(error, energy) << ", "
            << unknownsFor(error, equal) << " unknowns\n";
  EXPECT_LT(2 * needed, unknownsFor(error, equal));
  EXPECT_LE(needed, unknownsFor(error, energy));
  for (const auto* each : {&quantity, &energy, &equal})
    EXPECT_LE(std::abs(each->back().force - exact), each->back().error + error);
}

}  // namespace mortier::goal_test
