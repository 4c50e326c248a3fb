#include "report/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <set>
#include <utility>

#include "base/error.h"
#include "report/checkpoint_files.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

constexpr const char* lockName = "run.lock";

bool isResult(const fs::path& folder) {
  return fs::exists(folder / "summary.json");
}

/// Anything but an old result could be something that the user wants to keep.
void requireReplaceable(const fs::path& folder) {
  if (fs::exists(folder) && (!fs::is_directory(folder) || (!fs::is_empty(folder) && !isResult(folder)))) {
    throw InputError(folder.string() +
                     ": exists and is no result of mortier (no summary.json in it), "
                     "expected a new or empty folder, or a result to replace");
  }
}

bool isOurs(const fs::path& file) {
  static const std::set<std::string> names{"fields.pvd", "contact.csv", "history.csv", "summary.json",
                                           lockName};
  const std::string name = file.filename().string();
  return names.count(name) != 0 || file.extension() == ".vtu" || isCheckpointFile(name);
}

/// Moves what is not ours, where the target has nothing of that name.
void moveFilesOfOthers(const fs::path& from, const fs::path& target) {
  for (const fs::directory_entry& entry : fs::directory_iterator(from)) {
    const fs::path to = target / entry.path().filename();
    if (!isOurs(entry.path()) && !fs::exists(to)) fs::rename(entry.path(), to);
  }
}

/// Removes what is ours, and the folder where it held nothing else.
void removeOurs(const fs::path& folder) {
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (isOurs(entry.path())) fs::remove(entry.path(), none);
  fs::remove(folder, none);
}

void replace(const fs::path& from, const fs::path& target) {
  try {
    if (!fs::exists(target)) {
      fs::rename(from, target);
    } else if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) {
      moveFilesOfOthers(from, target);
      fs::remove_all(from);
    } else {  // a file system that cannot exchange two folders in one step
      moveFilesOfOthers(target, from);
      fs::remove_all(target);
      fs::rename(from, target);
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(target))
      if (const std::string name = entry.path().filename().string();
          name == lockName || isCheckpointFile(name))
        fs::remove(entry.path());
  } catch (const fs::filesystem_error& error) {
    throw OutputError(target.string() + ": cannot be replaced: " + error.code().message());
  }
}

std::string withoutSlash(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

/// The folder itself where `path` is a link.
fs::path resolved(const std::string& path) {
  return withoutSlash(fs::weakly_canonical(fs::absolute(path)).string());
}

/// Temporary folders of runs for `path`.
std::vector<fs::path> temporariesOf(const std::string& path) {
  const fs::path target = resolved(path);
  const std::string begin = target.filename().string() + ".tmp-";
  std::vector<fs::path> found;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(target.parent_path(), none)) {
    const std::string name = entry.path().filename().string();
    const bool numbered = name.size() > begin.size() && name.compare(0, begin.size(), begin) == 0 &&
                          name.find_first_not_of("0123456789.", begin.size()) == std::string::npos;
    if (numbered && entry.is_directory(none)) found.push_back(entry.path());
  }
  return found;
}

/// The process by which a temporary folder is named.
bool makerLives(const std::string& folder) {
  const size_t begin = folder.rfind(".tmp-") + 5;
  pid_t pid = 0;
  std::from_chars(folder.data() + begin, folder.data() + folder.size(), pid);
  return pid > 0 && (kill(pid, 0) == 0 || errno == EPERM);
}

/// What killed runs left goes, but for checkpoints and files of others.
void cleanUp(const std::string& path) {
  for (const fs::path& folder : temporariesOf(path)) {
    const FolderLock lock(folder.string());
    if (!lock.held() || hasCheckpoint(folder.string())) continue;
    if (isResult(path)) moveFilesOfOthers(folder, path);
    removeOurs(folder);
  }
}

}  // namespace

FolderLock::FolderLock(const std::string& folder, bool own) {
  const std::string path = folder + "/" + lockName;
  std::error_code none;
  if (!own && !fs::exists(path, none) && makerLives(folder)) return;  // it is just taking the folder away
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0 || flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const bool unknown = errno != EWOULDBLOCK;  // a file system without locks
  if (unknown && (own || !makerLives(folder))) return;
  close(file_);
  file_ = -1;
}

FolderLock::~FolderLock() {
  if (file_ >= 0) close(file_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(file_, other.file_);
  return *this;
}

OutputFolder::OutputFolder(const std::string& path) : path_(withoutSlash(path)) {
  try {
    requireReplaceable(path_);
    requireReplaceable(path_ + ".failed");
    const fs::path target = resolved(path_);
    fs::create_directories(target.parent_path());
    cleanUp(path_);
    // Locked before it has the name by which others look for it.
    const std::string fresh = target.string() + ".new-" + std::to_string(getpid());
    fs::create_directory(fresh);
    lock_ = FolderLock(fresh, true);
    const std::string name = target.string() + ".tmp-" + std::to_string(getpid());
    temporary_ = name;
    for (int again = 1; fs::exists(temporary_); ++again) temporary_ = name + "." + std::to_string(again);
    fs::rename(fresh, temporary_);
    if (!lock_.held()) throw OutputError(path_ + ": cannot be written");
  } catch (const fs::filesystem_error& error) {
    throw OutputError(path_ + ": cannot be made: " + error.code().message());
  }
}

OutputFolder::OutputFolder(const std::string& path, std::string temporary, FolderLock lock)
    : path_(withoutSlash(path)), temporary_(std::move(temporary)), lock_(std::move(lock)) {
  requireReplaceable(path_);
  requireReplaceable(path_ + ".failed");
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!hasCheckpoint(temporary_)) fs::remove_all(temporary_, ignored);
}

void OutputFolder::commit() {
  replace(temporary_, resolved(path_));
  std::error_code ignored;
  if (const fs::path failed = path_ + ".failed"; isResult(failed)) {
    fs::remove_all(failed, ignored);
  }
  // Stopped runs that were begun anew instead of being gone on with.
  for (const std::string& stopped : stoppedRuns(path_)) {
    if (const FolderLock lock(stopped); lock.held()) removeOurs(stopped);
  }
}

std::string OutputFolder::commitAsFailed() {
  std::string failed = path_ + ".failed";
  replace(temporary_, resolved(failed));
  return failed;
}

std::vector<std::string> stoppedRuns(const std::string& path) {
  std::error_code none;
  std::vector<std::pair<fs::file_time_type, std::string>> found;
  for (const fs::path& folder : temporariesOf(path))
    if (hasCheckpoint(folder.string()))
      found.emplace_back(fs::last_write_time(folder, none), folder.string());
  std::sort(found.rbegin(), found.rend());
  std::vector<std::string> names;
  names.reserve(found.size());
  for (auto& [time, name] : found) names.push_back(std::move(name));
  return names;
}

}  // namespace mortier
