// What slips in a step, and what friction dissipates.
#include <algorithm>
#include <numeric>

#include "time/error_norms.h"
#include "time/step_taker.h"

namespace mortier {

std::vector<double> StepTaker::dissipatedByFriction() const {
  const std::vector<Vector> slip = slips(model_, solutions_.back());
  std::vector<Vector> slip0 = slip;
  for (size_t k = 0; k < rowsBefore_.size(); ++k) {
    if (slip[k].size() == 0) continue;
    const ContactPair& pair = model_.interfaces[k].pair();
    const std::vector<BodyIterate>& bodies = solutions_.back().bodies;
    slip0[k] = rowsBefore_[k][0] * bodies[pair.nonmortar.body].increment.value() +
               rowsBefore_[k][1] * bodies[pair.mortar.body].increment.value();
  }
  std::vector<double> result;
  // The sum keeps the energy, single nodes may be negative; so may all where contact opens in a long step.
  for (const Vector& work : frictionWork(frictionAtSlip_, solutions_.back(), slip0, slip))
    result.push_back(std::max(work.sum(), 0.0));
  return result;
}

SlipAndWork StepTaker::slip() const {
  const std::vector<double> work = dissipatedByFriction();
  std::vector<Matrix> flow = ratesOf(solutions_.back(), 1);
  if (!shift_.empty()) addTo(flow, 1, shift_);
  return {slips(model_, solutions_.back()), std::accumulate(work.begin(), work.end(), 0.0), std::move(flow)};
}

/// The first stage, where it is before, shows how gaps close and nodes slip; else the step before does.
std::vector<Vector> StepTaker::slipBeforeClosing() const {
  const Iterate& end = solutions_.back();
  std::vector<Vector> result;
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    result.emplace_back(Vector::Zero(interface.slipRows()));
    if (!interface.hasFriction() || interface.follows()) continue;
    const auto [nonmortar, mortar, coupling] = interface.pair();
    struct Motion {
      double time = 0;
      Vector closing = {}, slip = {};
    };
    const auto motion = [&](double from, double to, const TwoPartVector& u1, const TwoPartVector& u2) {
      Motion made{to - from, interface.jump(u1.value(), u2.value()), interface.slip(u1.value(), u2.value())};
      if (interface.distanceMoves()) made.closing -= interface.distance(to) - interface.distance(from);
      return made;
    };
    Motion before;
    if (!memory_.increments.empty()) {
      const std::vector<BodyIncrement>& last = memory_.increments.back();
      before = motion(state_.time - memory_.timeStep, state_.time, last[nonmortar.body].displacement,
                      last[mortar.body].displacement);
    }
    Motion within;
    if (solutions_.size() > 1) {
      const std::vector<BodyIterate>& bodies = solutions_.front().bodies;
      within = motion(state_.time, state_.time + tableau_.stages.front().time * (t1_ - state_.time),
                      bodies[nonmortar.body].increment, bodies[mortar.body].increment);
    }
    const int m = interface.slipComponents();
    for (Eigen::Index i = 0; i < interface.rows(); ++i) {
      const double open = -state_.gap[k][i];
      const bool closes = state_.contactForce[k][i] <= 0 && open > 0 && end.contactForce[k][i] > 0;
      if (!closes || end.slipping[k][i] != 0) continue;
      const bool later = solutions_.size() > 1 && solutions_.front().contactForce[k][i] <= 0;
      const Motion& shown = later ? within : before;
      if (!(shown.time > 0) || !(shown.closing[i] > 0)) continue;
      result[k].segment(m * i, m) =
          std::min(open / shown.closing[i], (t1_ - state_.time) / shown.time) * shown.slip.segment(m * i, m);
    }
  }
  return result;
}

double StepTaker::workAlong(const std::vector<Vector>& slip) const {
  double work = 0;
  for (const Vector& each : frictionWork(frictionAtSlip_, solutions_.back(), slip, slip)) work += each.sum();
  return work;
}

bool StepTaker::contactChanges() const {
  const Iterate& end = solutions_.back();
  for (size_t k = 0; k < state_.contactForce.size(); ++k)
    if (((state_.contactForce[k].array() > 0) != (end.contactForce[k].array() > 0)).any() ||
        state_.slipping[k] != end.slipping[k])
      return true;
  return false;
}

std::vector<Vector> StepTaker::slipOf(const std::vector<Response>& response) const {
  std::vector<Vector> result;
  for (const ContactInterface& interface : model_.interfaces) {
    const ContactPair& pair = interface.pair();
    result.emplace_back();
    if (interface.hasFriction())
      result.back() =
          interface.slip(response[pair.nonmortar.body].displacement, response[pair.mortar.body].displacement);
  }
  return result;
}

}  // namespace mortier
