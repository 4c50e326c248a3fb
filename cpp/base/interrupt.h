// Stopping a long computation: any code, a signal handler included, may set a flag, and loops that take long
// check it.
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

/// Marks a long call into a library that does not check the flag. No file is being written meanwhile and no
/// step of a run is finished, so that a signal may end the process.
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
