// A stage where contact follows the bodies. Its rows, distances and normals depend on where the bodies are at
// the end of the stage:
//
//   geometry at u_k  ->  contact problem with these rows, solved exactly  ->  u_(k+1)
//
// is repeated until the solution fulfils its conditions on the geometry at u_(k+1) too (docs/sliding.md). The
// first geometry is that of the guess.
#include <algorithm>
#include <limits>
#include <utility>

#include "base/dense_templates.h"
#include "base/formatted.h"
#include "fem/rigid_modes.h"
#include "time/measure.h"
#include "time/step_taker.h"

namespace mortier {
namespace {

/// How far a solution is off its conditions on other rows, as forces over the largest contact force [-]; gaps
/// that are rounding of places are none.
double misfit(const Model& model, const std::vector<Vector>& gap0, const Iterate& iterate,
              const Vector& compliance, double rounding) {
  if (compliance.size() == 0) return 0;  // at rest, without a linear solve
  const std::vector<Vector> gap = gaps(model, gap0, iterate);
  const std::vector<Vector> slip = slips(model, iterate);
  double force = 0;
  double off = 0;
  Eigen::Index row = 0;
  const auto add = [&](double by, Eigen::Index condition) {
    if (by <= rounding) return;
    off = std::max(off, by / (compliance[condition] > 0 ? compliance[condition] : compliance.maxCoeff()));
  };
  for (size_t k = 0; k < gap.size(); ++k) {
    if (gap[k].size() > 0) force = std::max(force, iterate.contactForce[k].maxCoeff());
    for (Eigen::Index i = 0; i < gap[k].size(); ++i, ++row)
      add(iterate.active[k][i] != 0 ? std::abs(gap[k][i]) : gap[k][i], row);
  }
  for (size_t k = 0; k < slip.size(); ++k)
    for (Eigen::Index i = 0; i < slip[k].size(); ++i, ++row) {
      const int sign = iterate.slipping[k][i];
      const bool bears = iterate.contactForce[k][i] > 0 || model.interfaces[k].friction().limit > 0;
      if (bears) add(sign == 0 ? std::abs(slip[k][i]) : -sign * slip[k][i], row);
    }
  if (off == 0) return 0;
  return force > 0 ? off / force : std::numeric_limits<double>::infinity();
}

/// What rounding makes of the places of bodies [m].
double roundingOfPlaces(const Model& model, const std::vector<Vector>& u) {
  constexpr double roundings = 16 * std::numeric_limits<double>::epsilon();
  double largest = 0;
  for (size_t b = 0; b < u.size(); ++b)
    for (Eigen::Index node = 0; node < model.bodies[b].nodes(); ++node)
      largest = std::max(largest, (model.bodies[b].elementNodes().places[node] + u[b].segment<2>(2 * node))
                                      .lpNorm<Eigen::Infinity>());
  return roundings * largest;
}

/// Of a body that contact alone holds, and that moves between two repetitions as a rigid one, that motion in
/// words: its load has passed what the conditions of contact can carry. Empty where there is none.
std::string whatTips(const Model& model, const std::vector<Vector>& from, const std::vector<Vector>& to) {
  constexpr double strained = 0.1;  // the part of a change that is none of a rigid body
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const Matrix modes = rigidModes(body);
    const Vector change = to[b] - from[b];
    if (modes.cols() == 0 || change.isZero(0)) continue;
    const Vector motion = modes * modes.colPivHouseholderQr().solve(change);
    if ((change - motion).norm() <= strained * change.norm())
      return "; contact does not hold body " + body.name() + " there: a repetition moves it by a " +
             describeRigidMotion(body, motion);
  }
  return {};
}

}  // namespace

/// Rows at the end of the increments. \returns the gaps of the state by these rows
std::vector<Vector> StepTaker::followTo(const Iterate& iterate, bool keepRows) {
  follow(model_, displacements(state_, iterate), keepRows);
  system_.takeRows();
  std::vector<Vector> gap0 = state_.gap;
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    if (!interface.follows()) continue;
    const auto& [nonmortar, mortar, coupling] = interface.pair();
    gap0[k] = -interface.distanceHere() - interface.jump(iterate.bodies[nonmortar.body].increment.value(),
                                                         iterate.bodies[mortar.body].increment.value());
  }
  return gap0;
}

StepOutcome StepTaker::repeatOnMovedBodies(StepData& data, Iterate& iterate, Effort effort) {
  constexpr int most = 40;
  constexpr int freely = 8;  // a set of rows that still changes then is kept
  constexpr double settled = 1e-10;
  constexpr double balanced = 1e-9;  // it was on the rows before; the next repetition would be as much better
  StepOutcome total;
  data.gap = followTo(iterate, false);
  double off = 0;
  std::vector<Vector> before;
  std::vector<Vector> now = displacements(state_, iterate);
  for (int repetition = 1; repetition <= most; ++repetition) {
    StepOutcome next = solveStep(system_, state_, data, iterate, effort);
    const Vector compliance = system_.compliances();
    total.follow(std::move(next));
    if (!total.converged()) break;
    data.gap = followTo(iterate, repetition >= freely);
    before = std::exchange(now, displacements(state_, iterate));
    off = misfit(model_, data.gap, iterate, compliance, roundingOfPlaces(model_, now));
    if (!(off <= settled)) continue;
    const Certificate here =
        system_.certify(system_.step(state_, data), iterate, total.certificate.materialResidual);
    if (!(here.forceBalance <= balanced)) continue;
    total.certificate = worse(total.certificate, here);
    return total;
  }
  if (!total.converged()) return total;
  total.fail(Reason::unconverged,
             formatted("contact does not settle where the bodies are in %d repetitions: the last one is off "
                       "by %g of the largest contact force",
                       most, off) +
                 (system_.contactHolds() ? whatTips(model_, before, now) : ""));
  return total;
}

}  // namespace mortier
