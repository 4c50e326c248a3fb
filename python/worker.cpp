#include "worker.h"

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <stdexcept>

#include "base/interrupt.h"
#include "commands/run.h"

namespace py = pybind11;

namespace mortier::python {

Worker::Worker(std::function<void(Worker&)> work)
    : process_(getpid()), thread_([this, todo = std::move(work)] { this->work(todo); }) {}

Worker::~Worker() {
  if (getpid() != process_) {  // a fork has no thread
    thread_.detach();
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    givenUp_ = true;
    if (turn_ == Turn::callers) turn_ = Turn::works;
  }
  changed_.notify_all();
  thread_.join();
}

void Worker::work(const std::function<void(Worker&)>& work) {
  try {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return turn_ == Turn::works; });
    }
    if (!givenUp_) work(*this);
  } catch (const GivenUp&) {
  } catch (...) {
    error_ = std::current_exception();
  }
  {
    const std::lock_guard lock(mutex_);
    turn_ = Turn::over;
  }
  changed_.notify_all();
}

void Worker::park() {
  std::unique_lock lock(mutex_);
  turn_ = Turn::callers;
  changed_.notify_all();
  changed_.wait(lock, [&] { return turn_ == Turn::works; });
  if (givenUp_) throw GivenUp();
}

bool Worker::go() {
  constexpr std::chrono::milliseconds signalsAreHeardEvery(50);
  std::optional<py::error_already_set> raised;
  {
    const py::gil_scoped_release others;
    std::unique_lock lock(mutex_);
    if (turn_ == Turn::works) throw std::runtime_error("another thread waits for the same steps");
    if (turn_ == Turn::over) return false;
    turn_ = Turn::works;
    changed_.notify_all();
    while (!changed_.wait_for(lock, signalsAreHeardEvery, [&] { return turn_ != Turn::works; })) {
      lock.unlock();
      if (raised) {
        requestInterrupt();  // another run that ends has taken it back
      } else {
        const py::gil_scoped_acquire held;
        if (PyErr_CheckSignals() != 0) {
          raised.emplace();
          requestInterrupt();
        }
      }
      lock.lock();
    }
  }
  if (raised || turn_ == Turn::over) interruption::requested = false;  // the process goes on
  if (raised) {
    try {
      if (error_) std::rethrow_exception(error_);
    } catch (const InterruptedError& error) {  // how the run goes on
      if (py::hasattr(raised->value(), "add_note")) raised->value().attr("add_note")(error.what());
    } catch (...) {  // what the signal raises comes first
    }
    throw py::error_already_set(*raised);
  }
  if (error_) std::rethrow_exception(error_);
  return turn_ == Turn::callers;
}

void interruptibly(const std::function<void()>& work) {
  Worker([&work](Worker&) { work(); }).go();
}

}  // namespace mortier::python
