// The error of a stress that relaxes within a step.
#include <algorithm>

#include "time/error_norms.h"
#include "time/step_taker.h"

namespace mortier {

/// Where stresses relax within the step, the flow of a stage is the mean over a part of the step and not that
/// of its end: the stages are of order one. The strains that flowed are right to order two there, and so is
/// the rate at the end of the quadratic through them, p. With the part F of a stress that relaxes in the last
/// stage the error of the stress is F^2 k a_ss (p' - G_s) / (E^-1 + k a_ss J), where
/// F = k a_ss J/(E^-1 + k a_ss J): nothing of a short step.
void StepTaker::addLag(const Fields& rates, std::vector<Response>& error) {
  const Stage& last = tableau_.stages[1];
  const double k = t1_ - state_.time;
  std::vector<Matrix> strain;
  for (size_t b = 0; b < error.size(); ++b)
    strain.push_back(k * last.diagonal * (rates[1][b] - rateOf(rates, b, 1)));
  addTo(error, lag(std::move(strain)));
}

/// The rate at 0 or 1 of the polynomial through what flowed up to the stages.
Matrix StepTaker::rateOf(const Fields& rates, size_t body, double fraction) const {
  const Stage& first = tableau_.stages[0];
  const Matrix& g = rates[0][body];
  const Matrix mean = first.diagonal / first.time * g;
  if (rates.size() == 1) return mean;
  const Stage& last = tableau_.stages[1];
  const Matrix all = last.before[0] * g + last.diagonal * rates[1][body];
  return mean + (2 * fraction - first.time) * ((all - first.diagonal * g) / (1 - first.time) - mean);
}

/// What relaxes of a stress twice, where it would by a strain k a_ss G that the flow misses.
std::vector<Response> StepTaker::lag(std::vector<Matrix> strain) {
  constexpr int filters = 2;
  std::vector<Response> lag = response(strain);
  for (int i = 0; i < filters; ++i) {
    std::vector<Matrix> flow = flowOf(strain, lag);
    for (size_t b = 0; b < flow.size(); ++b) flow[b] = strain[b] - flow[b];
    onlyWhereItFlows(tableau_.stages.size() - 1, flow);
    strain = std::move(flow);
    lag = response(strain);
  }
  return lag;
}

bool StepTaker::closes() const {
  constexpr double rounding = 1e-9;  // over the displacements, of a contact that touches
  double largest = 0;
  for (const BodyState& body : state_.bodies)
    if (body.displacement.size() > 0)
      largest = std::max(largest, body.displacement.lpNorm<Eigen::Infinity>());
  bool any = false;
  for (size_t k = 0; k < state_.contactForce.size(); ++k) {
    const auto open = state_.contactForce[k].array() <= 0 && state_.gap[k].array() < -rounding * largest;
    any = any || (open && solutions_.back().contactForce[k].array() > 0).any();
  }
  return any;
}

std::vector<Response> StepTaker::lagAtStart() {
  const double k = t1_ - state_.time;
  const std::vector<Matrix> start = startingRates();
  const Fields rates = stageRates();
  const double part = tableau_.stages.size() == 1 ? 0.5 : 1;  // of one stage the rate is that of the middle
  std::vector<Matrix> strain;
  for (size_t b = 0; b < start.size(); ++b)
    strain.push_back(part * k * tableau_.stages.back().diagonal * (start[b] - rateOf(rates, b, 0)));
  return lag(std::move(strain));
}

}  // namespace mortier
