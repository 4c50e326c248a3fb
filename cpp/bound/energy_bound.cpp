#include "bound/energy_bound.h"

#include <cmath>
#include <limits>

#include "bound/admissible.h"
#include "bound/quantity_bound.h"

namespace mortier {

double EnergyBound::relative() const {
  if (obstacle.empty() && bound == 0) return 0;
  if (!obstacle.empty() || !(bound < norm)) return std::numeric_limits<double>::infinity();
  return bound / (norm - bound);
}

namespace {

/// |s|^2 of the stresses that roundings of the displacements make [J/m].
double roundingOf(const LoadedBody& body) {
  constexpr double roundings = 16 * std::numeric_limits<double>::epsilon();
  const double moved = body.lifted().displacement.lpNorm<Eigen::Infinity>();
  const double strain = roundings * moved * body.body().largestGradient();
  double sum = 0;
  for (size_t t = 0; t < body.parents().size(); ++t)
    sum += body.body().weights()[t] * strain * strain * body.lifted().moduli[t].norm();
  return sum;
}

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
  double lifts = 0;
  double data = 0;
  // With what the data leave in a triangle: by Minkowski's inequality.
  const auto squares = [](const Vector& energies, const Vector& rest) {
    return (energies.cwiseMax(0).cwiseSqrt() + rest).squaredNorm();
  };
  for (size_t b = 0; b < pair.bodies.size(); ++b) {
    const LoadedBody& body = pair.bodies[b];
    const BodyData& rest = body.data();
    stress += squares(body.energies(), rest.carried);
    lifts += squares(pair.lifting.energies[b], rest.strained);
    data += rest.carried.squaredNorm() + rest.strained.squaredNorm();
    norm += body.norm();
  }
  result.stress = std::sqrt(stress) + pair.defect;
  result.lift = std::sqrt(lifts);
  result.gap = pair.lifting.gap;
  result.leastGap = pair.lifting.leastGap;
  result.norm = std::sqrt(norm);
  result.oscillation = norm > 0 ? std::sqrt(data / norm) : 0;
  result.bound = std::sqrt(result.stress * result.stress + lifts + 2 * pair.lifting.gap);
  double rounding = 0;
  for (const LoadedBody& body : pair.bodies) rounding += roundingOf(body);
  if (result.bound * result.bound <= rounding) result.bound = result.stress = result.lift = result.gap = 0;
  result.quantities =
      enclose({model, pair.meshes, pair.bodies, pair.spread, pair.lifting, pair.opens}, functionals);
  return result;
}

}  // namespace

EnergyBound energyBound(const Model& model, const State& state, const std::vector<Functional>& functionals) {
  EnergyBound result = boundOf(model, state, functionals);
  if (!result.obstacle.empty()) result.quantities.assign(functionals.size(), {result.obstacle});
  return result;
}

}  // namespace mortier
