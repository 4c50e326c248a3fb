#include "adapt/error_history.h"

#include <algorithm>

namespace mortier {

void ErrorHistory::add(const StepReport& report) {
  if (report.step == 0) {
    largest_.clear();
    for (const Body& body : model_.bodies)
      largest_.emplace_back(Vector::Zero(static_cast<Eigen::Index>(body.mesh().triangles.size())));
    largestSum_ = energy_ = displacement_ = 0;
    if (report.vonMises == 0) return;  // nothing acts yet
  }
  double error = 0;
  double energy = 0;
  const CurrentSpaceError::Estimates estimates = error_.estimates();
  for (size_t b = 0; b < estimates->size(); ++b) {
    const ErrorEstimate& estimate = (*estimates)[b];
    largest_[b] = largest_[b].cwiseMax(estimate.error);
    error += estimate.error.sum();
    energy += estimate.energy;
  }
  largestSum_ = std::max(largestSum_, error);
  energy_ = std::max(energy_, energy);
  displacement_ = std::max(displacement_, report.displacement);
}

std::vector<Vector> ErrorHistory::errors() const {
  constexpr double negligible = 1e-24;  // of the energy
  double rounding = negligible * energy_;
  double sum = 0;
  for (size_t b = 0; b < largest_.size(); ++b) {
    rounding += error_.roundingOf(b, displacement_);
    sum += largest_[b].sum();
  }
  std::vector<Vector> errors = largest_;
  for (Vector& error : errors) error *= largestSum_ > rounding ? largestSum_ / sum : 0;
  return errors;
}

}  // namespace mortier
