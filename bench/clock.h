// Time as benchmarks take it.
#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

namespace mortier::bench {

/// Wall time, or the time of the processor over all threads: all that is left on a machine that others use,
/// and blind to what threads gain.
enum class TimeOf { wall, processor };

inline TimeOf timeOf = TimeOf::wall;

inline double now() {
  timespec time{};
  clock_gettime(timeOf == TimeOf::wall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class Work>
double secondsOf(const Work& work) {
  const double begin = now();
  work();
  return now() - begin;
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

}  // namespace mortier::bench
