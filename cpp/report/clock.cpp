#include "report/clock.h"

#include <sys/resource.h>

#include <chrono>

namespace mortier {

namespace {
const auto loaded = std::chrono::steady_clock::now();
}

double processSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - loaded).count();
}

double peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts KiB
}

}  // namespace mortier
