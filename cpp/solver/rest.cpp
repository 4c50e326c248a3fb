#include <algorithm>

#include "solver/methods.h"

namespace mortier {
namespace {

/// Whether all loads and supports are the same, to the last bit, at the start and the end of a step.
bool sameData(StepSystem& system, const Step& step) {
  const double before = step.state0.time;
  const double after = step.data.time;
  const Model& model = system.model();
  if (before != after && model.any(system.loadsAt(before) != step.loads)) return false;
  for (const ContactInterface& interface : model.interfaces)
    if (interface.distanceMoves() && interface.distance(before) != interface.distance(after)) return false;
  return !model.any(!std::all_of(model.bodies.begin(), model.bodies.end(), [&](const Body& body) {
    Vector u = Vector::Zero(body.dofs());
    Vector v = u;
    body.prescribe(before, u);
    body.prescribe(after, v);
    return u == v;
  }));
}

}  // namespace

StepOutcome rest(StepSystem& system, const Step& step, Iterate& iterate) {
  constexpr double touching = 1e-14;
  StepOutcome outcome;
  outcome.rung = Rung::rest;
  const Model& model = system.model();
  const auto none = [](const Matrix& shift) { return shift.isZero(0); };
  if (!sameData(system, step) || flows(model, step.state0) ||
      model.any(!std::all_of(step.data.shift.begin(), step.data.shift.end(), none)))
    return outcome;
  iterate = startingIterate(step.state0);
  const double residual = system.linearise(step, iterate, step.data.weight, false).residual();
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const Vector& gap = step.gap0()[k];
    const double size = model.bodies[model.interfaces[k].pair().nonmortar.body].extent();
    for (Eigen::Index i = 0; i < gap.size(); ++i)
      if (gap[i] < -touching * size) iterate.active[k][i] = 0;
  }
  const Certificate certificate = system.certify(step, iterate, residual);
  if (residual <= system.options().tolerance && certificate.forceBalance <= balanceTolerance)
    outcome.converge(certificate);
  return outcome;
}

}  // namespace mortier
