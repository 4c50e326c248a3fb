#include "report/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <string_view>
#include <thread>

#include "base/error.h"

namespace mortier {

namespace {

constexpr std::string_view mark = "mortier run in ";
constexpr std::string_view inPlaceOf = "\nin place of ";

[[noreturn]] void fail(const std::string& path, const char* what, int reason) {
  throw OutputError(path + ": cannot be " + what + ": " + std::strerror(reason));
}

/// Whether `path` still names the open file.
bool isStill(int file, const std::string& path) {
  struct stat one {};
  struct stat other {};
  if (fstat(file, &one) != 0) fail(path, "read", errno);
  if (lstat(path.c_str(), &other) != 0) {
    if (errno != ENOENT) fail(path, "read", errno);
    return false;
  }
  return one.st_ino == other.st_ino && one.st_dev == other.st_dev;
}

struct LockText {
  std::string name;  ///< empty where the lock is not one of ours
  std::optional<ino_t> replaced;
};

LockText textIn(int file, const std::string& path) {
  std::array<char, 4096> bytes{};
  const ssize_t size = pread(file, bytes.data(), bytes.size(), 0);
  if (size < 0) fail(path, "read", errno);
  const std::string_view text(bytes.data(), size > 0 ? static_cast<size_t>(size) : 0);
  if (text.substr(0, mark.size()) != mark || text.find('\n') == std::string_view::npos) return {};
  LockText result;
  const size_t end = std::min(text.find(inPlaceOf), text.back() == '\n' ? text.size() - 1 : text.size());
  result.name = text.substr(mark.size(), end - mark.size());
  if (const size_t at = text.rfind(inPlaceOf); at != std::string_view::npos) {
    ino_t number = 0;
    const char* last = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + at + inPlaceOf.size(), last, number);
    if (error == std::errc() && rest + 1 == last && *rest == '\n') result.replaced = number;
  }
  return result;
}

}  // namespace

OpenFile::~OpenFile() {
  if (isOpen()) close(number_);
}

bool makerLives(const std::string& name) {
  const size_t dash = name.rfind('-');
  pid_t pid = 0;
  if (dash != std::string::npos) std::from_chars(name.data() + dash + 1, name.data() + name.size(), pid);
  return pid > 0 && pid != getpid() && (kill(pid, 0) == 0 || errno == EPERM);
}

ino_t numberOf(const std::string& folder) {
  struct stat facts {};
  if (lstat(folder.c_str(), &facts) != 0) fail(folder, "read", errno);
  return facts.st_ino;
}

FolderLock::FolderLock(const std::string& folder) {
  const std::string path = folder + "/" + lockName;
  struct stat facts {};
  if (lstat(path.c_str(), &facts) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return;
    fail(path, "read", errno);
  }
  if (!S_ISREG(facts.st_mode)) return;
  file_ = OpenFile(open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!file_.isOpen() && (errno == ENOENT || (errno == EACCES && facts.st_uid != geteuid())))
    return;  // gone in between, or of another user
  if (!file_.isOpen()) fail(path, "read", errno);
  const LockText text = textIn(file_.number(), path);
  name_ = text.name;
  replaced_ = text.replaced;
  if (name_.empty()) return;
  const bool locked = flock(file_.number(), LOCK_EX | LOCK_NB) == 0;
  // On a file system without locks the number of the process must do.
  const bool living = !locked && (errno == EWOULDBLOCK || makerLives(name_));
  state_ = living ? State::inUse : isStill(file_.number(), path) ? State::held : State::none;
}

FolderLock::FolderLock(const std::string& folder, const std::string& name) : name_(name) {
  const std::string path = folder + "/" + lockName;
  file_ = OpenFile(open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  const std::string line = std::string(mark) + name + "\n";
  ssize_t written = file_.isOpen() ? 0 : -1;
  for (size_t all = 0; written >= 0 && all < line.size(); all += static_cast<size_t>(written))
    written = write(file_.number(), line.data() + all, line.size() - all);
  if (written < 0) fail(path, "written", errno);
  flock(file_.number(), LOCK_EX | LOCK_NB);  // nothing else has opened it
  state_ = State::held;
}

void addReplaced(const std::string& folder, const std::string& replaced) {
  const std::string path = folder + "/" + lockName;
  const OpenFile file(open(path.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC));
  const std::string line = std::string(inPlaceOf.substr(1)) + std::to_string(numberOf(replaced)) + "\n";
  if (!file.isOpen() || write(file.number(), line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    fail(path, "written", errno);
}

PlaceLock::PlaceLock(const std::string& folder)
    : file_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  constexpr auto patience = std::chrono::seconds(10);
  constexpr auto pause = std::chrono::milliseconds(2);
  const auto end = std::chrono::steady_clock::now() + patience;
  while (file_.isOpen() && flock(file_.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK &&
         std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(pause);
}

}  // namespace mortier
