// Foreign code in a process of its own: a crash of it is an error message, and it can neither start processes
// nor change files (Linux: a seccomp filter; elsewhere only the crash is caught).
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace mortier {

class ChildProcess {
 public:
  /// Begins `work` in a child process. Its standard output and errors are lost.
  /// \param subject  with which the message of a crash begins, e.g. `plate.msh: Gmsh`
  /// \throws OutputError where there is no process for it
  ChildProcess(const std::function<std::string()>& work, std::string subject);
  /// The same of a program, by its words. It writes its answer to standard output: a letter, which is r
  /// before the bytes that it gives, e before what is wrong with its input, m where memory does not suffice.
  ChildProcess(const std::vector<std::string>& program, std::string subject);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  /// Kills it where its answer was not waited for.
  ~ChildProcess();

  /// Waits for the bytes that `work` gives. Once. \param seconds  for which it waits at most
  /// \throws InputError that work throws, or that names its crash or says that it does not end;
  /// std::bad_alloc, Interrupted
  std::string answer(double seconds = std::numeric_limits<double>::infinity());

 private:
  void begin(const std::function<void(int pipe)>& child);
  int end();

  std::string subject_;
  int pipe_ = -1;
  int child_ = -1;
};

/// The bytes that `work` gives, run in a child process: as above, at once.
inline std::string inChildProcess(const std::function<std::string()>& work, const std::string& subject,
                                  double seconds = std::numeric_limits<double>::infinity()) {
  return ChildProcess(work, subject).answer(seconds);
}

}  // namespace mortier
