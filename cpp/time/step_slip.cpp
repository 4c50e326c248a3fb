// What slips in a step, and what friction dissipates.
#include <numeric>

#include "time/error_norms.h"
#include "time/step_taker.h"

namespace mortier {

SlipAndWork StepTaker::slip() const {
  const std::vector<double> work = frictionWork(model_, state_, solutions_.back());
  std::vector<Matrix> flow = ratesOf(solutions_.back(), 1);
  if (!shift_.empty()) addTo(flow, 1, shift_);
  return {slips(model_, solutions_.back()), std::accumulate(work.begin(), work.end(), 0.0), std::move(flow)};
}

double StepTaker::workAlong(const std::vector<Vector>& slip) const {
  const std::vector<Vector> force = slidingForces(state_, solutions_.back());
  double work = 0;
  for (size_t k = 0; k < slip.size(); ++k) work += force[k].dot(slip[k]);
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
