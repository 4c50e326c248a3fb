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
  const double moved = body.place().displacement.lpNorm<Eigen::Infinity>();
  const double strain = roundingOfSums * moved * body.body().largestGradient();
  double sum = 0;
  for (size_t t = 0; t < body.parents().size(); ++t)
    sum += body.body().weights()[t] * strain * strain * body.place().moduli[t].norm();
  return sum;
}

std::string obstacleOf(const Model& model) {
  for (const Body& body : model.bodies)
    if (body.degree() == 1 && !body.material().linear()) return body.name() + " is viscoplastic";
  return "";
}

EnergyBound boundOf(const Model& model, const State& state, const std::vector<Quantity>& quantities) {
  EnergyBound result;
  result.obstacle = obstacleOf(model);
  if (!result.obstacle.empty()) return result;
  const Admissible pair(model, state);
  result.obstacle = pair.obstacle;
  result.imbalance = pair.strictness.imbalance;
  result.mismatch = pair.strictness.mismatch;
  if (!result.obstacle.empty()) return result;
  double stress = 0;
  double lift = 0;
  double norm = 0;
  double data = 0;
  double rounding = 0;
  // With what the data leave in a triangle: by Minkowski's inequality.
  const auto squares = [](const Vector& energies, const Vector& rest) {
    return (energies.cwiseMax(0).cwiseSqrt() + rest).squaredNorm();
  };
  for (size_t b = 0; b < pair.bodies.size(); ++b) {
    const LoadedBody& body = pair.bodies[b];
    const BodyData& rest = body.data();
    stress += squares(body.energies(), rest.carried);
    lift += squares(pair.lifting.energies[b], rest.strained);
    norm += body.norm();
    data += rest.carried.squaredNorm() + rest.strained.squaredNorm();
    rounding += roundingOf(body);
  }
  result.stress = std::sqrt(stress) + pair.defect;
  result.lift = std::sqrt(lift);
  result.gap = pair.lifting.gap;
  result.norm = std::sqrt(norm);
  result.oscillation = norm > 0 ? std::sqrt(data / norm) : 0;
  result.bound = std::sqrt(result.stress * result.stress + lift + 2 * pair.lifting.gap);
  if (result.bound * result.bound <= rounding) result.bound = result.stress = result.lift = result.gap = 0;
  result.quantities = enclose(pair, quantities);
  return result;
}

}  // namespace

EnergyBound energyBound(const Model& model, const State& state, const std::vector<Quantity>& quantities) {
  EnergyBound result = boundOf(model, state, quantities);
  if (!result.obstacle.empty()) result.quantities.assign(quantities.size(), {result.obstacle});
  return result;
}

std::string foreseenObstacle(const Model& model, const State& state) {
  const std::string obstacle = obstacleOf(model);
  return obstacle.empty() ? Admissible::foreseen(model, state) : obstacle;
}

}  // namespace mortier
