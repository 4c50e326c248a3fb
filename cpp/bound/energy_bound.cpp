#include "bound/energy_bound.h"

#include <cmath>
#include <limits>

#include "bound/admissible.h"
#include "bound/flow_potential.h"
#include "bound/flowing_body.h"
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
  const double moved = body.place().displacement.lpNorm<Eigen::Infinity>();
  const double strain = roundingOfSums * moved * body.body().largestGradient();
  double sum = 0;
  for (size_t t = 0; t < body.parents().size(); ++t)
    sum += body.body().weights()[t] * strain * strain * body.place().moduli[t].norm();
  return sum;
}

std::string obstacleOf(const Model& model, double weight) {
  if (weight > 0) return FlowPotential::obstacleOf(model);
  for (const Body& body : model.bodies)
    if (body.degree() == 1 && !body.material().linear()) return body.name() + " is viscoplastic";
  return "";
}

EnergyBound boundOf(const Model& model, const State& state, const std::vector<Functional>& functionals,
                    double weight) {
  EnergyBound result;
  result.obstacle = obstacleOf(model, weight);
  if (!result.obstacle.empty()) return result;
  const Admissible pair(model, state, weight);
  result.obstacle = pair.obstacle;
  result.imbalance = pair.strictness.imbalance;
  result.mismatch = pair.strictness.mismatch;
  if (!result.obstacle.empty()) return result;
  FlowMisfit all;
  double data = 0;
  double rounding = 0;
  // With what the data leave in a triangle: by Minkowski's inequality.
  const auto squares = [](const Vector& energies, const Vector& rest) {
    return (energies.cwiseMax(0).cwiseSqrt() + rest).squaredNorm();
  };
  for (size_t b = 0; b < pair.bodies.size(); ++b) {
    const LoadedBody& body = pair.bodies[b];
    if (model.bodies[b].material().linear()) {
      const BodyData& rest = body.data();
      all.stress += squares(body.energies(), rest.carried);
      all.lift += squares(pair.lifting.energies[b], rest.strained);
      all.norm += body.norm();
      data += rest.carried.squaredNorm() + rest.strained.squaredNorm();
    } else {
      FlowingBody(model.bodies[b]).addStep(state.bodies[b], body, pair.lifting.displacements[b], weight, all);
    }
    if (weight == 0) rounding += roundingOf(body);
  }
  result.stress = std::sqrt(all.stress) + pair.defect;
  result.flow = std::sqrt(all.flow);
  result.lift = std::sqrt(all.lift);
  result.gap = pair.lifting.gap;
  result.norm = std::sqrt(all.norm);
  result.oscillation = all.norm > 0 ? std::sqrt(data / all.norm) : 0;
  result.bound = std::sqrt(result.stress * result.stress + all.lift + all.flow + 2 * pair.lifting.gap);
  if (result.bound * result.bound <= rounding) result.bound = result.stress = result.lift = result.gap = 0;
  result.strain = std::sqrt(weight * all.fluidity) * result.bound + std::sqrt(all.shift);
  result.strainNorm = std::sqrt(all.strain);
  result.quantities = enclose(pair, functionals);
  return result;
}

}  // namespace

EnergyBound energyBound(const Model& model, const State& state, const std::vector<Functional>& functionals,
                        double weight) {
  EnergyBound result = boundOf(model, state, functionals, weight);
  if (!result.obstacle.empty()) result.quantities.assign(functionals.size(), {result.obstacle});
  return result;
}

std::string foreseenObstacle(const Model& model, const State& state, double weight) {
  std::string obstacle = obstacleOf(model, weight);
  return obstacle.empty() ? Admissible::foreseen(model, state, weight) : obstacle;
}

}  // namespace mortier
