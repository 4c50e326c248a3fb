// Traces with elements of random lengths.
#pragma once

#include <cmath>
#include <random>

#include "contact/smooth_part.h"

namespace mortier {

/// A trace from `begin` to `end` whose neighbouring elements differ in length by up to `grading`.
inline Trace randomTrace(std::mt19937& random, int elements, double begin, double end, double grading) {
  std::uniform_real_distribution<double> exponent(0, std::log(grading));
  Trace trace{0};
  for (int i = 0; i < elements; ++i) trace.push_back(trace.back() + std::exp(exponent(random)));
  const double length = trace.back();
  for (double& s : trace) s = begin + (end - begin) * (s / length);
  trace.back() = end;
  return trace;
}

}  // namespace mortier
