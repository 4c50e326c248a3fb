// Ends a test program that takes more processor time than MORTIER_TEST_SECONDS says. Other work on the
// machine does not count.
#include <sys/resource.h>

#include <cstdlib>

namespace {

[[maybe_unused]] const bool limited = [] {
  const char* seconds = std::getenv("MORTIER_TEST_SECONDS");
  if (seconds == nullptr) return false;
  const auto most = static_cast<rlim_t>(std::atol(seconds));
  const rlimit limit{most, most + 1};
  return setrlimit(RLIMIT_CPU, &limit) == 0;
}();

}  // namespace
