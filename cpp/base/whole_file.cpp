#include "base/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/error.h"
#include "base/interrupt.h"

namespace mortier {

namespace {

constexpr std::array endings{SIGINT, SIGTERM, SIGHUP};

/// While it lives, signals that end the process wait.
class SignalsWait {
 public:
  SignalsWait() {
    sigset_t waiting;
    sigemptyset(&waiting);
    for (const int signal : endings) sigaddset(&waiting, signal);
    pthread_sigmask(SIG_BLOCK, &waiting, &before_);
  }
  ~SignalsWait() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

  [[nodiscard]] static bool any() {
    sigset_t pending;
    sigpending(&pending);
    return std::any_of(endings.begin(), endings.end(),
                       [&](int signal) { return sigismember(&pending, signal) == 1; });
  }

 private:
  sigset_t before_{};
};

}  // namespace

void writeWhole(const std::string& path, std::string_view text, bool durable) {
  namespace fs = std::filesystem;
  constexpr size_t block = size_t{1} << 20;
  std::error_code error;
  const bool direct = fs::exists(path, error) && !fs::is_regular_file(path, error);
  const std::string beside = direct ? path : path + ".tmp-" + std::to_string(getpid());
  std::optional<SignalsWait> signals;  // whoever reads a pipe may be slow
  if (!direct) signals.emplace();
  bool interrupted = false;
  std::FILE* file = std::fopen(beside.c_str(), "wb");
  bool sound = file != nullptr;
  while (sound && !text.empty() && !(interrupted = signals && !durable && SignalsWait::any())) {
    const size_t next = std::min(text.size(), block);
    sound = std::fwrite(text.data(), 1, next, file) == next;
    text.remove_prefix(next);
  }
  sound = sound && !interrupted && std::fflush(file) == 0 && (!durable || fsync(fileno(file)) == 0);
  int reason = errno;
  if (file != nullptr && std::fclose(file) != 0 && sound) {
    reason = errno;
    sound = false;
  }
  if (sound && !direct && std::rename(beside.c_str(), path.c_str()) != 0) {
    reason = errno;
    sound = false;
  }
  if (sound) return;
  if (!direct) fs::remove(beside, error);
  if (interrupted) throw Interrupted();
  throw OutputError(path + ": cannot be written: " + std::strerror(reason));
}

std::string readWhole(const std::string& path, const std::string& expected, uint64_t most, bool pipes) {
  constexpr size_t block = size_t{1} << 20;
  const auto reject = [&](const std::string& what) {
    throw InputError(path + ": " + what + ", expected " + expected);
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const int opened = open(path.c_str(), O_RDONLY | O_CLOEXEC | (pipes ? 0 : O_NONBLOCK));
  const std::unique_ptr<std::FILE, Close> file(opened < 0 ? nullptr : fdopen(opened, "rb"));
  struct stat facts {};
  if (!file || fstat(opened, &facts) != 0)
    reject(errno == ENOENT && !pipes ? "not a file" : "cannot be read");
  if (!S_ISREG(facts.st_mode) && !pipes) reject("not a file");
  std::string text;
  const auto fits = [&] {
    if (std::max<uint64_t>(text.size(), facts.st_size) > most)
      reject("larger than " + std::to_string(most >> 20) + " MiB");
  };
  fits();
  text.reserve(static_cast<size_t>(facts.st_size) + block);
  for (size_t got = 1; got > 0; fits()) {
    const size_t begin = text.size();
    text.resize(begin + block);
    got = std::fread(text.data() + begin, 1, block, file.get());
    text.resize(begin + got);
  }
  if (std::ferror(file.get()) != 0) reject("cannot be read");
  return text;
}

}  // namespace mortier
