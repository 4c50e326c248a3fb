// Foreign code in a process of its own: a crash of it is an error message, and it can neither start programs
// nor change files (Linux: a seccomp filter; elsewhere only the crash is caught).
#pragma once

#include <functional>
#include <string>

namespace mortier {

/// The bytes that `work` gives, run in a child process. Its standard output and errors are lost.
/// \param subject  with which the message of a crash begins, e.g. `plate.msh: Gmsh`
/// \throws InputError that work throws, or that names its crash; std::bad_alloc
std::string inChildProcess(const std::function<std::string()>& work, const std::string& subject);

}  // namespace mortier
