// Time and memory of the whole process.
#pragma once

#include <sys/resource.h>

#include <chrono>

namespace mortier {

namespace clock_start {
inline const auto loaded = std::chrono::steady_clock::now();
inline thread_local auto begun = loaded;
}  // namespace clock_start

/// Wall time since the program was loaded [s]; in a thread that has begun a clock of its own, since then.
inline double processSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - clock_start::begun).count();
}

/// For a run that is one of many in a process.
inline void beginClock() {
  clock_start::begun = std::chrono::steady_clock::now();
}

/// The most memory the process has held [MiB].
inline double peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts KiB
}

}  // namespace mortier
