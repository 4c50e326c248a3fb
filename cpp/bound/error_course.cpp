#include "bound/flowing_body.h"

#include <cmath>
#include <limits>

namespace mortier {

StepWeights::StepWeights(double rho0, double rho1) : rho0_(rho0), rho1_(rho1) {
  constexpr double small = 1e-2;  // of the growth: a series is more accurate than differences
  constexpr int terms = 9;
  if (fromRest()) {
    moments_ = {std::numeric_limits<double>::infinity(), 1 / rho1, 1 / (2 * rho1)};
    return;
  }
  const double z = (rho1 - rho0) / rho0;
  if (z < small) {
    double power = 1 / rho0;
    for (int i = 0; i < terms; ++i, power *= -z)
      for (int j = 0; j < 3; ++j) moments_[j] += power / (i + j + 1);
    return;
  }
  moments_[0] = std::log1p(z) / (rho0 * z);
  moments_[1] = (1 / rho0 - moments_[0]) / z;
  moments_[2] = (1 / (2 * rho0) - moments_[1]) / z;
}

double StepWeights::root() const {
  return 2 / (std::sqrt(rho0_) + std::sqrt(rho1_));
}

StepWeights ErrorCourse::weights(double factor) const {
  return {growth, growth > 0 ? growth * factor : 1};
}

void ErrorCourse::add(const StepWeights& weights, double factor, double timeStep, double delta,
                      double change) {
  growth = growth > 0 ? growth * factor : 1;
  misfit += delta;
  drift += change * weights.root();
  const double length = lengths.back() + timeStep * weights.length();
  const double sum = misfit + drift * (std::sqrt(2 * misfit) + drift);
  // Corners that are on or above the line from the one before to the new one go.
  const auto above = [&] {
    const size_t n = lengths.size();
    return n > 1 && (sums[n - 1] - sums[n - 2]) * (length - lengths[n - 2]) >=
                        (sum - sums[n - 2]) * (lengths[n - 1] - lengths[n - 2]);
  };
  while (above()) {
    lengths.pop_back();
    sums.pop_back();
  }
  lengths.push_back(length);
  sums.push_back(sum);
}

double ErrorCourse::energyNorm() const {
  return std::sqrt(growth) * (std::sqrt(2 * misfit) + drift);
}

double ErrorCourse::rateIntegral(double lambda) const {
  double all = 0;
  for (size_t i = 1; i < lengths.size(); ++i)
    all += std::sqrt((lengths[i] - lengths[i - 1]) * (sums[i] - sums[i - 1]) / lambda);
  return all;
}

}  // namespace mortier
