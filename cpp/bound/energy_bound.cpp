#include "bound/energy_bound.h"

#include <cmath>
#include <limits>

#include "bound/admissible.h"

namespace mortier {

double EnergyBound::relative() const {
  if (!obstacle.empty() || !(bound < norm)) return std::numeric_limits<double>::infinity();
  return bound / (norm - bound);
}

namespace {

EnergyBound boundOf(const Model& model, const State& state, const std::vector<Functional>& functionals) {
  EnergyBound result;
  for (const Body& body : model.bodies)
    if (body.degree() == 1 && !body.material().linear()) {
      result.obstacle = body.name() + " is viscoplastic";
      return result;
    }
  const Admissible pair(model, state);
  result.obstacle = pair.obstacle;
  result.imbalance = pair.strictness.imbalance;
  result.mismatch = pair.strictness.mismatch;
  result.leastPressure = pair.strictness.leastPressure;
  if (!result.obstacle.empty()) return result;
  double stress = 0;
  double norm = 0;
  for (const LoadedBody& body : pair.bodies) {
    stress += body.energies().sum();
    norm += body.norm();
  }
  double lifts = 0;
  for (const Vector& energies : pair.lifting.energies) lifts += energies.sum();
  result.stress = std::sqrt(stress);
  result.lift = std::sqrt(lifts);
  result.gap = pair.lifting.gap;
  result.leastGap = pair.lifting.leastGap;
  result.norm = std::sqrt(norm);
  result.oscillation = pair.oscillation.relative();
  result.bound = std::sqrt(stress + lifts + 2 * pair.lifting.gap);
  result.quantities = enclose({model, pair.meshes, pair.bodies, pair.spread, pair.lifting}, functionals);
  return result;
}

}  // namespace

EnergyBound energyBound(const Model& model, const State& state, const std::vector<Functional>& functionals) {
  EnergyBound result = boundOf(model, state, functionals);
  if (!result.obstacle.empty()) result.quantities.assign(functionals.size(), {result.obstacle});
  return result;
}

}  // namespace mortier
