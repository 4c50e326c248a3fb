// Stopping a long computation: any code, a signal handler included, may set a flag, or a time at which it is
// to stop, and loops that take long check both.
#pragma once

#include <atomic>
#include <chrono>
#include <stdexcept>

namespace mortier {

/// Thrown where a loop was asked to stop.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Thrown where the time that a TimeLimit gives is over.
class TimeIsUp : public Interrupted {};

namespace interruption {
using Clock = std::chrono::steady_clock;
constexpr Clock::rep never = Clock::time_point::max().time_since_epoch().count();
inline std::atomic<bool> requested = false;
inline std::atomic<Clock::rep> deadline = never;
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers use it");
}  // namespace interruption

inline void requestInterrupt() {
  interruption::requested = true;
}

/// While it lives, loops stop when `seconds` from now are over; infinite: never. One at a time.
class TimeLimit {
 public:
  explicit TimeLimit(double seconds) {
    constexpr double century = 3e9;
    if (seconds < century)
      interruption::deadline =
          (interruption::Clock::now() +
           std::chrono::duration_cast<interruption::Clock::duration>(std::chrono::duration<double>(seconds)))
              .time_since_epoch()
              .count();
  }
  ~TimeLimit() { interruption::deadline = interruption::never; }
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
};

/// To be called at least every tenth of a second. \throws Interrupted, TimeIsUp
inline void stopIfInterrupted() {
  if (interruption::requested.load(std::memory_order_relaxed)) throw Interrupted();
  const auto deadline = interruption::deadline.load(std::memory_order_relaxed);
  if (deadline != interruption::never && interruption::Clock::now().time_since_epoch().count() > deadline)
    throw TimeIsUp();
}

}  // namespace mortier
