// Stopping a long computation: whoever wants it stopped says so, a signal handler too, and loops that may
// last ask.
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
inline std::atomic<int> deafCalls = 0;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "signal handlers use them");
}  // namespace interruption

inline void requestInterrupt() {
  interruption::requested = true;
}

/// Lives around a long call of a library that asks nothing, where no file is being written and no step of a
/// run is done: a signal that finds it may end the process.
struct DeafCall {
  DeafCall() { ++interruption::deafCalls; }
  ~DeafCall() { --interruption::deafCalls; }
  DeafCall(const DeafCall&) = delete;
  DeafCall& operator=(const DeafCall&) = delete;
};

inline bool inDeafCall() {
  return interruption::deafCalls > 0;
}

/// To be called at least every tenth of a second. \throws Interrupted
inline void stopIfInterrupted() {
  if (interruption::requested.load(std::memory_order_relaxed)) throw Interrupted();
}

}  // namespace mortier
