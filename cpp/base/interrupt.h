// Stopping a long computation: whoever wants it stopped says so, a signal handler too, and loops that may last ask.
#pragma once

#include <atomic>
#include <stdexcept>

namespace mortier {

/// Thrown where a loop was asked to stop.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

namespace interruption {
inline std::atomic<bool> requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");
}  // namespace interruption

inline void requestInterrupt() {
  interruption::requested = true;
}

/// To be called at least every tenth of a second. \throws Interrupted
inline void stopIfInterrupted() {
  if (interruption::requested.load(std::memory_order_relaxed)) throw Interrupted();
}

}  // namespace mortier
