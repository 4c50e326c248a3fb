// Foreign code in a process of its own: a crash of it is an error message, and it can neither start processes
// nor change files (Linux: a seccomp filter; elsewhere only the crash is caught).
#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace mortier {

/// A child process, killed at the end, and our end of the two that it shares with us.
class ForkedProcess {
 public:
  ForkedProcess(const ForkedProcess&) = delete;
  ForkedProcess& operator=(const ForkedProcess&) = delete;

 protected:
  /// \param child  gets its end  \throws OutputError where there is no process for it
  ForkedProcess(const std::function<void(int end)>& child, std::string subject);
  ~ForkedProcess();
  /// Waits for its end. \throws InputError where it crashed
  void join();
  /// Reads what has come, or waits a moment for it. \returns false where nothing more will come
  /// \throws InputError after `seconds` since `begin`; Interrupted
  bool receive(std::string& answer, std::chrono::steady_clock::time_point begin, double seconds) const;

  [[nodiscard]] const std::string& subject() const { return subject_; }
  [[nodiscard]] int socket() const { return socket_; }

 private:
  int end();

  std::string subject_;
  int socket_ = -1;
  int child_ = -1;
};

class ChildProcess : ForkedProcess {
 public:
  /// Begins `work` in a child process. Its standard output and errors are lost.
  /// \param subject  with which the message of a crash begins, e.g. `plate.msh: Gmsh`
  /// \throws OutputError where there is no process for it
  ChildProcess(const std::function<std::string()>& work, std::string subject);
  /// The same of a program, by its words. It writes its answer to standard output: a letter, which is r
  /// before the bytes that it gives, e before what is wrong with its input, m where memory does not suffice.
  ChildProcess(const std::vector<std::string>& program, std::string subject);
  /// Waits for the bytes that `work` gives. Once. \param seconds  for which it waits at most
  /// \throws InputError that work throws, or that names its crash or says that it does not end;
  /// std::bad_alloc, Interrupted
  std::string answer(double seconds = std::numeric_limits<double>::infinity());
};

/// Foreign code in a child process that answers requests, one after the other, as long as it is wanted.
class ChildServer : ForkedProcess {
 public:
  using Answers = std::function<std::string(const std::string& request)>;
  /// \param start  runs in the child: what it gives answers there  \throws OutputError
  ChildServer(const std::function<Answers()>& start, std::string subject);

  /// \param seconds  for which it waits at most  \throws InputError that is thrown there, or that names its
  /// crash or says that it does not end; std::bad_alloc, Interrupted
  std::string ask(const std::string& request, double seconds);
};

/// The bytes that `work` gives, run in a child process: as above, at once.
inline std::string inChildProcess(const std::function<std::string()>& work, const std::string& subject,
                                  double seconds = std::numeric_limits<double>::infinity()) {
  return ChildProcess(work, subject).answer(seconds);
}

}  // namespace mortier
