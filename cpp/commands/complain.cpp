#include "commands/complain.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <set>

#include "base/error.h"
#include "base/printable.h"

namespace mortier {

void complain(const std::string& text) {
  std::fflush(stdout);
  std::fprintf(stderr, "mortier: %s\n", printable(text).c_str());
}

void warn(const std::string& text) {
  static std::set<std::string> told;
  if (told.insert(text).second) complain("warning: " + text);
}

void finishStandardOutput() {
  errno = 0;
  std::cout.flush();
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout;
  if (failed && errno != EPIPE) {
    throw OutputError(std::string("standard output: cannot be written") +
                      (errno == 0 ? "" : std::string(": ") + std::strerror(errno)));
  }
}

}  // namespace mortier
