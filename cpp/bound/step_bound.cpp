#include "bound/step_bound.h"

#include <algorithm>
#include <cmath>

#include "bound/admissible.h"
#include "bound/flow_misfit.h"

namespace mortier {

StepBound stepBound(const Model& model, const State& state, double weight) {
  StepBound result;
  result.obstacle = FlowPotential::obstacleOf(model);
  if (!result.obstacle.empty()) return result;
  const Admissible pair(model, state, weight);
  result.obstacle = pair.obstacle;
  if (!result.obstacle.empty()) return result;
  FlowMisfit all;
  for (size_t b = 0; b < pair.bodies.size(); ++b) {
    const LoadedBody& body = pair.bodies[b];
    if (model.bodies[b].material().linear()) {
      all.stress += body.energies().sum();
      all.lift += pair.lifting.energies[b].sum();
      all.norm += body.norm();
      continue;
    }
    const Vector lowered = body.lifted().displacement - pair.lifting.displacements[b];
    const FlowMisfit one = flowMisfit(model.bodies[b], state.bodies[b], body, lowered, weight);
    all.stress += one.stress;
    all.lift += one.lift;
    all.flow += one.flow;
    all.shift += one.shift;
    all.norm += one.norm;
    all.strain += one.strain;
    all.fluidity = std::max(all.fluidity, one.fluidity);
  }
  result.stress = std::sqrt(all.stress);
  result.flow = std::sqrt(all.flow);
  result.lift = std::sqrt(all.lift);
  result.gap = pair.lifting.gap;
  result.norm = std::sqrt(all.norm);
  result.bound = std::sqrt(all.stress + all.flow + all.lift + 2 * pair.lifting.gap);
  result.strain = std::sqrt(weight * all.fluidity) * result.bound + std::sqrt(all.shift);
  result.strainNorm = std::sqrt(all.strain);
  return result;
}

}  // namespace mortier
