#include "report/result_place.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "report/checkpoint_files.h"
#include "report/folder_lock.h"
#include "report/manifest.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

constexpr const char* passing = ".mortier-";  // folders that are just made or taken away
constexpr const char* asideName = ".replaced";

bool isFolder(const fs::path& path) {
  return fs::symlink_status(path).type() == fs::file_type::directory;
}

bool isResult(const fs::path& folder) {
  return isFolder(folder) && readManifest(folder.string());
}

/// Whether this program has marked a folder as one in which it writes.
bool isMarked(const fs::path& folder) {
  return FolderLock(folder.string()).state() != FolderLock::State::none;
}

std::vector<fs::directory_entry> entriesOf(const fs::path& folder) {
  return {fs::directory_iterator(folder), fs::directory_iterator()};
}

/// Moves a file of others, under another name where its own is taken.
void moveInto(const fs::path& file, const fs::path& folder) {
  const std::string name = file.filename().string();
  fs::path to = folder / name;
  for (int again = 1; fs::exists(fs::symlink_status(to)); ++again)
    to = folder / (name + ".kept" + (again > 1 ? "-" + std::to_string(again) : ""));
  fs::rename(file, to);
}

/// Which entries of a folder are the program's: by its manifest, or by name where a run is under way.
class Ours {
 public:
  explicit Ours(const fs::path& folder)
      : marked_(isMarked(folder)), manifest_(readManifest(folder.string())) {}

  [[nodiscard]] bool isMark(const fs::directory_entry& entry) const {
    const std::string name = entry.path().filename().string();
    return (name == lockName && marked_) || (name == manifestName && manifest_);
  }
  [[nodiscard]] bool operator()(const fs::directory_entry& entry) const {
    const std::string name = entry.path().filename().string();
    if (entry.symlink_status().type() != fs::file_type::regular || isMark(entry)) return false;
    if (marked_ && isWorkName(name)) return true;
    if (!manifest_) return marked_ && isResultName(name);
    const auto record = manifest_->files.find(name);
    return record != manifest_->files.end() && matches(entry.path().string(), record->second);
  }

 private:
  bool marked_;
  std::optional<Manifest> manifest_;
};

/// Removes a folder in which nothing but the marks of this program is left. A kill at any moment leaves a
/// folder that is known: by its marks, or empty and with a name of our own.
void removeMarks(const ResultPlace& place, fs::path folder) {
  if (folder.string().rfind(place.of(false).string() + passing, 0) != 0) {
    const fs::path gone = place.unused(passing);
    fs::rename(folder, gone);
    folder = gone;
  }
  for (const char* name : {manifestName, lockName}) fs::remove(folder / name);
  fs::remove(folder);
}

/// That of an earlier run, if nobody has added or changed anything.
void discardFailed(const ResultPlace& place) {
  const fs::path failed = place.of(true);
  if (!isResult(failed)) return;
  const Ours ours(failed);
  const auto entries = entriesOf(failed);
  if (!std::all_of(entries.begin(), entries.end(), [&](const auto& e) { return ours(e) || ours.isMark(e); }))
    return;
  const fs::path gone = place.unused(passing);
  fs::rename(failed, gone);
  discard(place, gone, place.of(false));
}

/// A folder that a killed process was just making or taking away.
void clearPassing(const ResultPlace& place, const fs::path& folder) {
  const FolderLock lock(folder.string());
  if (lock.state() == FolderLock::State::inUse) return;
  const std::vector<fs::directory_entry> entries = entriesOf(folder);
  const auto isEmptyLock = [](const fs::directory_entry& entry) {
    return entry.path().filename() == lockName && entry.is_regular_file() && entry.file_size() == 0;
  };
  if (lock.held() || isResult(folder))
    discard(place, folder, place.of(false));
  else if (std::all_of(entries.begin(), entries.end(), isEmptyLock) && !makerLives(folder.string()))
    removeMarks(place, folder);
}

void requireFree(const ResultPlace& place, const FolderLock& lock, const fs::path& folder) {
  if (lock.state() == FolderLock::State::inUse)
    throw InputError(place.shown(place.of(false)) + ": in use, the run in " + place.shown(folder) +
                     " still goes on");
}

}  // namespace

ResultPlace::ResultPlace(const std::string& path) : given_(path) {
  while (given_.size() > 1 && given_.back() == '/') given_.pop_back();
  std::error_code error;
  if (fs::is_symlink(given_, error) && !fs::exists(given_, error))
    throw InputError(given_ + ": a link to nothing, expected a folder or a name that is free");
  const fs::path whole = fs::weakly_canonical(fs::absolute(given_)).lexically_normal();
  result_ = whole.has_filename() ? whole : whole.parent_path();
  const fs::path here = fs::current_path();
  if (std::mismatch(result_.begin(), result_.end(), here.begin(), here.end()).first == result_.end())
    throw InputError(given_ +
                     ": the current folder or one above it, expected another one, that can be replaced");
}

fs::path ResultPlace::of(bool failedRun) const {
  return failedRun ? fs::path(result_.string() + ".failed") : result_;
}

fs::path ResultPlace::unused(const std::string& middle) const {
  const std::string name = result_.string() + middle + std::to_string(getpid());
  fs::path folder = name;
  for (int again = 1; fs::exists(fs::symlink_status(folder)); ++again)
    folder = name + "." + std::to_string(again);
  return folder;
}

bool ResultPlace::isCalled(const std::string& name, const std::string& middle) const {
  const std::string begin = result_.filename().string() + middle;
  return name.size() > begin.size() && name.compare(0, begin.size(), begin) == 0 &&
         name.find_first_not_of("0123456789.", begin.size()) == std::string::npos;
}

std::vector<fs::path> ResultPlace::all(const std::string& middle) const {
  std::vector<fs::path> found;
  if (!fs::is_directory(parent())) return found;
  for (const fs::directory_entry& entry : entriesOf(parent()))
    if (isCalled(entry.path().filename().string(), middle) && isFolder(entry.path()))
      found.push_back(entry.path());
  return found;
}

std::string ResultPlace::shown(const fs::path& folder) const {
  return (fs::path(given_).parent_path() / folder.filename()).string();
}

void ResultPlace::requireReplaceable() const {
  for (const bool failedRun : {false, true}) requireReplaceable(of(failedRun));
}

void ResultPlace::requireReplaceable(const fs::path& target) const {
  const std::string name = shown(target);
  if (!fs::exists(fs::symlink_status(target))) return;
  if (!isFolder(target) || (!fs::is_empty(target) && !isResult(target)))
    throw InputError(name + ": exists and is no result of mortier (no " + manifestName +
                     " of its own in it), expected a new or empty folder, or a result to replace");
  struct stat facts {};
  struct stat above {};
  if (stat(target.c_str(), &facts) != 0 || stat(parent().c_str(), &above) != 0 ||
      faccessat(AT_FDCWD, target.c_str(), R_OK | W_OK | X_OK, AT_EACCESS) != 0)
    throw OutputError(name + ": cannot be replaced: " + std::strerror(errno));
  const uid_t user = geteuid();
  if ((above.st_mode & S_ISVTX) != 0 && user != 0 && facts.st_uid != user && above.st_uid != user)
    throw OutputError(name + ": cannot be replaced: it belongs to another user");
  if (facts.st_dev != above.st_dev)
    throw OutputError(name + ": cannot be replaced: it is a file system of its own, expected a folder in it");
}

void discard(const ResultPlace& place, const fs::path& folder, const fs::path& heir) {
  const bool moves = isResult(heir);
  const Ours ours(folder);
  bool stays = false;
  std::vector<fs::path> own;
  for (const fs::directory_entry& entry : entriesOf(folder)) {
    if (ours(entry))
      own.push_back(entry.path());
    else if (moves && !ours.isMark(entry))
      moveInto(entry.path(), heir);
    else
      stays = stays || !ours.isMark(entry);
  }
  for (const fs::path& file : own) fs::remove(file);
  if (!stays) removeMarks(place, folder);
}

fs::path putInPlace(const ResultPlace& place, const fs::path& temporary) {
  // 1. What a result does not keep.
  const std::optional<Manifest> manifest = readManifest(temporary.string());
  if (!manifest) throw OutputError(place.shown(temporary) + ": its " + manifestName + " has vanished");
  for (const fs::directory_entry& entry : entriesOf(temporary)) {
    const std::string name = entry.path().filename().string();
    if (entry.symlink_status().type() == fs::file_type::regular && name != manifestName &&
        (isWorkName(name) || (isResultName(name) && manifest->files.count(name) == 0)))
      fs::remove(entry.path());
  }

  // 2. The exchange.
  place.requireReplaceable();
  fs::path target = place.of(manifest->failed);
  if (!fs::exists(target)) {
    fs::rename(temporary, target);
  } else if (renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) != 0) {
    if (errno != EINVAL && errno != ENOSYS && errno != ENOTSUP)
      throw fs::filesystem_error("", std::error_code(errno, std::generic_category()));
    const fs::path aside = temporary.string() + asideName;  // no such call here: in two steps
    fs::rename(target, aside);
    fs::rename(temporary, target);
  }
  return target;
}

void finish(const ResultPlace& place, const fs::path& target, const std::string& name) {
  for (const std::string& old : {name, name + asideName}) {
    const fs::path folder = place.parent() / old;
    if (!place.isCalled(name, ".tmp-") || !isFolder(folder)) continue;
    if (!fs::is_empty(folder) && (!isResult(folder) || isMarked(folder))) continue;
    const fs::path gone = place.unused(passing);
    fs::rename(folder, gone);
    if (fs::is_empty(gone))
      fs::remove(gone);
    else
      discard(place, gone, target);
  }
  if (target == place.of(false)) {
    discardFailed(place);
    for (const fs::path& stopped : place.all(".tmp-"))  // begun anew instead of being gone on with
      if (const FolderLock lock(stopped.string()); lock.held()) discard(place, stopped, target);
  }
  fs::remove(target / lockName);
}

LeftBehind clearUp(const ResultPlace& place) {
  LeftBehind left;
  for (const bool failedRun : {false, true}) {
    const fs::path target = place.of(failedRun);
    const FolderLock lock(target.string());
    requireFree(place, lock, target);
    if (lock.held()) finish(place, target, lock.name());
  }
  std::vector<std::pair<fs::file_time_type, fs::path>> stopped;
  for (const fs::path& folder : place.all(".tmp-")) {
    const FolderLock lock(folder.string());
    requireFree(place, lock, folder);
    if (!lock.held()) continue;
    const std::optional<Manifest> manifest = readManifest(folder.string());
    if (manifest && isSound(folder.string(), *manifest)) {
      left.placed = putInPlace(place, folder);
      finish(place, left.placed, folder.filename().string());
    } else if (hasCheckpoint(folder.string())) {
      stopped.emplace_back(fs::last_write_time(folder), folder);
    } else {
      discard(place, folder, place.of(false));
    }
  }
  for (const fs::path& folder : place.all(passing)) {
    try {
      clearPassing(place, folder);
    } catch (const fs::filesystem_error& error) {  // its process may live after all, and be done with it
      if (error.code() != std::errc::no_such_file_or_directory) throw;
    }
  }
  std::sort(stopped.rbegin(), stopped.rend());
  for (const auto& [time, folder] : stopped)
    if (isFolder(folder)) left.stopped.push_back(folder);
  return left;
}

}  // namespace mortier
