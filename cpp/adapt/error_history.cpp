#include "adapt/error_history.h"

#include <algorithm>

namespace mortier {

void ErrorHistory::add(const State& state, const StepReport& report) {
  if (report.step == 0) {
    largest_.clear();
    for (const Body& body : model_.bodies)
      largest_.emplace_back(Vector::Zero(static_cast<Eigen::Index>(body.mesh().triangles.size())));
    error_ = energy_ = displacement_ = 0;
    return;  // it is given; what overlaps in it is pressed apart in the first step
  }
  double error = 0;
  double energy = 0;
  const std::vector<ErrorEstimate> estimates = estimator_(state);
  for (size_t b = 0; b < estimates.size(); ++b) {
    largest_[b] = largest_[b].cwiseMax(estimates[b].error);
    error += estimates[b].error.sum();
    energy += estimates[b].energy;
  }
  error_ = std::max(error_, error);
  energy_ = std::max(energy_, energy);
  displacement_ = std::max(displacement_, report.displacement);
}

std::vector<Vector> ErrorHistory::errors() const {
  constexpr double negligible = 1e-24;  // of the energy
  double rounding = negligible * energy_;
  double sum = 0;
  for (size_t b = 0; b < largest_.size(); ++b) {
    rounding += estimator_.roundingOf(b, displacement_);
    sum += largest_[b].sum();
  }
  std::vector<Vector> errors = largest_;
  for (Vector& error : errors) error *= error_ > rounding ? error_ / sum : 0;
  return errors;
}

}  // namespace mortier
