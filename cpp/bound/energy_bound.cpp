#include "bound/energy_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bound/checks.h"
#include "bound/pressures.h"

namespace mortier {

double EnergyBound::relative() const {
  if (!obstacle.empty() || !(bound < norm)) return std::numeric_limits<double>::infinity();
  return bound / (norm - bound);
}

EnergyBound energyBound(const Model& model, const State& state, const std::vector<Functional>& functionals) {
  EnergyBound result;
  const auto none = [&](const std::string& why) {
    result.obstacle = why;
    return result;
  };
  for (const Body& body : model.bodies) {
    if (body.degree() != 1) return none("displacements are quadratic");
    if (!body.material().linear()) return none(body.name() + " is viscoplastic");
    for (const PrescribedDisplacement& held : body.conditions().displacements)
      if (held.point) return none(body.name() + " is held at a point");
  }
  const MatchedMeshes meshes = matchedMeshes(model);
  if (!meshes.obstacle.empty()) return none(meshes.obstacle);

  std::vector<LoadedBody> bodies;
  bodies.reserve(model.bodies.size());
  for (size_t b = 0; b < model.bodies.size(); ++b)
    bodies.emplace_back(model, state, meshes.bodies[b], static_cast<int>(b));

  for (size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].hasCurvedSupport()) return none(model.bodies[b].name() + " is held along a curve");
  std::vector<Vector> spread = spreadPressures(model, state, meshes);
  if (!balancePressures(model, meshes, bodies, spread))
    return none(
        "bodies that contact alone holds are not in equilibrium with a pressure that is nowhere negative");
  std::vector<std::array<double, 2>> pressures;
  for (const MatchedPiece& piece : meshes.pieces) {
    pressures.push_back(pressureOn(piece, spread));
    result.leastPressure = std::min({result.leastPressure, pressures.back()[0], pressures.back()[1]});
    const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
    const auto moments = momentsOfLinear(pressures.back(), piece.length);
    bodies[nonmortar.body].press(piece.vertices[0], piece.normal, moments);
    bodies[mortar.body].press(piece.vertices[1], -piece.normal, moments);
  }

  DataOscillation oscillation;
  double largest = 0;
  double stress = 0;
  double norm = 0;
  std::vector<LiftedBody> lifted;
  for (LoadedBody& body : bodies) {
    if (!body.balance()) return none("a tangent is singular");
    stress += body.energies().sum();
    norm += body.norm();
    const auto [worst, size] = body.imbalance();
    result.imbalance = std::max(result.imbalance, worst);
    largest = std::max(largest, size);
    oscillation.add(body.oscillation());
    lifted.push_back(body.lifted());
  }
  for (const MatchedPiece& piece : meshes.pieces) {
    const auto& [nonmortar, mortar, coupling] = model.interfaces[piece.interface].pair();
    result.mismatch =
        std::max(result.mismatch, mismatchOf(piece, pressures[&piece - meshes.pieces.data()],
                                             bodies[nonmortar.body].momentsBetween(piece.vertices[0]),
                                             bodies[mortar.body].momentsBetween(piece.vertices[1])));
  }
  if (largest > 0) {
    result.imbalance /= largest;
    result.mismatch /= largest;
  }
  Strictness strictness{result.imbalance, result.mismatch, result.leastPressure, 0};
  if (!strictness.broken().empty()) return none(strictness.broken());
  const Lift lifting = lift(lifted, model, meshes.pieces, pressures);
  if (!lifting.obstacle.empty()) return none(lifting.obstacle);
  strictness.leastGap = leastGapOf(model, meshes.pieces, lifting.displacements);
  if (!strictness.broken().empty()) return none(strictness.broken());
  double lifts = 0;
  for (const Vector& energies : lifting.energies) lifts += energies.sum();
  result.stress = std::sqrt(stress);
  result.lift = std::sqrt(lifts);
  result.gap = lifting.gap;
  result.leastGap = lifting.leastGap;
  result.norm = std::sqrt(norm);
  result.oscillation = oscillation.relative();
  result.bound = std::sqrt(stress + lifts + 2 * lifting.gap);
  result.quantities = enclose({model, meshes, bodies, spread, lifting}, functionals);
  return result;
}

}  // namespace mortier
