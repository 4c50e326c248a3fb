// Work in a thread of its own, which takes turns with the caller: while it works the interpreter lock is free
// and Python's signal handlers are heard, and the work may hand over what it has between two steps.
#pragma once

#include <sys/types.h>

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace mortier::python {

class Worker {
 public:
  /// `work` begins with the first go(); it must not touch Python.
  explicit Worker(std::function<void(Worker&)> work);
  /// Work that is parked is given up.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Lets the work go on until it parks or ends; the caller holds the interpreter lock, which is free
  /// meanwhile. \returns whether it has parked. \throws what the work throws; what a signal handler raises
  /// (KeyboardInterrupt), after the work has stopped
  bool go();
  /// In the work: hands over to the caller until it calls go() again.
  void park();

 private:
  enum class Turn { callers, works, over };
  struct GivenUp {};
  void work(const std::function<void(Worker&)>& work);

  std::mutex mutex_;
  std::condition_variable changed_;
  Turn turn_ = Turn::callers;
  bool givenUp_ = false;
  std::exception_ptr error_;
  pid_t process_;
  std::thread thread_;
};

/// Does it in a thread of its own, and returns when it is done. \throws as Worker::go
void interruptibly(const std::function<void()>& work);

}  // namespace mortier::python
