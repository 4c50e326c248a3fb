#include "report/clock.h"

#include <sys/resource.h>

#include <chrono>

namespace mortier {

namespace {
const auto loaded = std::chrono::steady_clock::now();
thread_local auto begun = loaded;
}  // namespace

double processSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

void beginClock() {
  begun = std::chrono::steady_clock::now();
}

double peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts KiB
}

}  // namespace mortier
