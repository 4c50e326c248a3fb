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
