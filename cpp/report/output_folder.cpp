#include "report/output_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "report/manifest.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

constexpr const char* transient = ".mortier-";  // folders that are just made or taken away
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
  for (int copy = 1; fs::exists(fs::symlink_status(to)); ++copy)
    to = folder / (name + ".kept" + (copy > 1 ? "-" + std::to_string(copy) : ""));
  fs::rename(file, to);
}

/// The entries of a folder that are the program's: by its manifest, or by name where a run is under way.
class ProgramFiles {
 public:
  explicit ProgramFiles(const fs::path& folder)
      : marked_(isMarked(folder)), manifest_(readManifest(folder.string())) {}

  [[nodiscard]] bool isMark(const fs::directory_entry& entry) const {
    const std::string name = entry.path().filename().string();
    return (name == lockName && marked_) || (name == manifestName && manifest_);
  }
  [[nodiscard]] bool has(const fs::directory_entry& entry) const {
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
  for (int number = 1; fs::exists(fs::symlink_status(folder)); ++number)
    folder = name + "." + std::to_string(number);
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
  for (const bool failedRun : {false, true})
    if (fs::exists(fs::symlink_status(of(failedRun)))) requireReplaceable(of(failedRun));
}

void ResultPlace::requireReplaceable(const fs::path& target) const {
  const std::string name = shown(target);
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

fs::path ResultPlace::renamed(const fs::path& folder) const {
  fs::path gone = unused(transient);
  fs::rename(folder, gone);
  return gone;
}

void ResultPlace::discard(const fs::path& folder, const fs::path& heir) const {
  const bool moves = isResult(heir);
  const ProgramFiles files(folder);
  bool stays = false;
  std::vector<fs::path> written;
  for (const fs::directory_entry& entry : entriesOf(folder)) {
    if (files.has(entry))
      written.push_back(entry.path());
    else if (moves && !files.isMark(entry))
      moveInto(entry.path(), heir);
    else
      stays = stays || !files.isMark(entry);
  }
  for (const fs::path& file : written) fs::remove(file);
  if (!stays) removeMarks(folder);
}

fs::path ResultPlace::putInPlace(const fs::path& temporary) const {
  // 1. What a result does not keep.
  const std::optional<Manifest> manifest = readManifest(temporary.string());
  if (!manifest) throw OutputError(shown(temporary) + ": its " + manifestName + " has vanished");
  for (const fs::directory_entry& entry : entriesOf(temporary)) {
    const std::string name = entry.path().filename().string();
    if (entry.symlink_status().type() == fs::file_type::regular && name != manifestName &&
        (isWorkName(name) || (isResultName(name) && manifest->files.count(name) == 0)))
      fs::remove(entry.path());
  }

  // 2. The exchange.
  requireReplaceable();
  fs::path target = of(manifest->failed);
  const bool replaces = fs::exists(target);
  if (replaces) addReplaced(temporary.string(), target.string());
  if (!replaces) {
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

void ResultPlace::finish(const fs::path& target, const std::string& name) const {
  const std::optional<ino_t> replaced = FolderLock(target.string()).replaced();
  for (const std::string& old : {name, name + asideName}) {
    const fs::path folder = parent() / old;
    if (!isCalled(name, ".tmp-") || !isFolder(folder) || numberOf(folder.string()) != replaced) continue;
    if (!fs::is_empty(folder) && (!isResult(folder) || isMarked(folder))) continue;
    const fs::path gone = renamed(folder);
    if (fs::is_empty(gone))
      fs::remove(gone);
    else
      discard(gone, target);
  }
  if (target == of(false)) {
    discardFailed();
    for (const fs::path& stopped : all(".tmp-"))  // a new run was begun instead of resuming them
      if (const FolderLock lock(stopped.string()); lock.held()) discard(stopped, target);
  }
  fs::remove(target / lockName);
}

/// Removes a folder in which nothing but the marks of this program is left. A kill at any moment leaves a
/// folder that is known: by its marks, or empty and with a name of our own.
void ResultPlace::removeMarks(fs::path folder) const {
  if (folder.string().rfind(of(false).string() + transient, 0) != 0) folder = renamed(folder);
  for (const char* name : {manifestName, lockName}) fs::remove(folder / name);
  fs::remove(folder);
}

/// That of an earlier run, if nobody has added or changed anything.
void ResultPlace::discardFailed() const {
  const fs::path failed = of(true);
  if (!isResult(failed)) return;
  const ProgramFiles files(failed);
  const auto entries = entriesOf(failed);
  if (!std::all_of(entries.begin(), entries.end(),
                   [&](const auto& e) { return files.has(e) || files.isMark(e); }))
    return;
  discard(renamed(failed), of(false));
}

/// A folder that a killed process was just making or taking away.
void ResultPlace::clearTransient(const fs::path& folder) const {
  const FolderLock lock(folder.string());
  if (lock.state() == FolderLock::State::inUse) return;
  const std::vector<fs::directory_entry> entries = entriesOf(folder);
  const auto isEmptyLock = [](const fs::directory_entry& entry) {
    return entry.path().filename() == lockName && entry.is_regular_file() && entry.file_size() == 0;
  };
  if (lock.held() || isResult(folder))
    discard(folder, of(false));
  else if (std::all_of(entries.begin(), entries.end(), isEmptyLock) && !makerLives(folder.string()))
    removeMarks(folder);
}

void ResultPlace::requireFree(const FolderLock& lock, const fs::path& folder) const {
  if (lock.state() == FolderLock::State::inUse)
    throw InputError(shown(of(false)) + ": in use, the run in " + shown(folder) + " still goes on");
}

ResultPlace::LeftBehind ResultPlace::clearUp() const {
  LeftBehind left;
  for (const bool failedRun : {false, true}) {
    const fs::path target = of(failedRun);
    const FolderLock lock(target.string());
    requireFree(lock, target);
    if (lock.held()) finish(target, lock.name());
  }
  std::vector<std::pair<fs::file_time_type, fs::path>> stopped;
  for (const fs::path& folder : all(".tmp-")) {
    const FolderLock lock(folder.string());
    requireFree(lock, folder);
    if (!lock.held()) continue;
    const std::optional<Manifest> manifest = readManifest(folder.string());
    if (manifest && isSound(folder.string(), *manifest)) {
      left.placed = putInPlace(folder);
      finish(left.placed, folder.filename().string());
    } else if (hasCheckpoint(folder.string())) {
      stopped.emplace_back(fs::last_write_time(folder), folder);
    } else {
      discard(folder, of(false));
    }
  }
  for (const fs::path& folder : all(transient)) {
    try {
      clearTransient(folder);
    } catch (const fs::filesystem_error& error) {  // its process may live after all, and be done with it
      if (error.code() != std::errc::no_such_file_or_directory) throw;
    }
  }
  std::sort(stopped.rbegin(), stopped.rend());
  for (const auto& [time, folder] : stopped)
    if (isFolder(folder)) left.stopped.push_back(folder);
  return left;
}

OutputFolder::OutputFolder(const std::string& path) : place_(path) {
  try {
    place_.requireReplaceable();
    fs::create_directories(place_.parent());
    const PlaceLock lockOfPlace(place_.parent().string());
    place_.clearUp();
    // Locked before it has the name by which others look for it.
    const fs::path fresh = place_.unused(transient);
    const fs::path temporary = place_.unused(".tmp-");
    fs::create_directory(fresh);
    try {
      lock_ = FolderLock(fresh.string(), temporary.filename().string());
      fs::rename(fresh, temporary);
      temporary_ = temporary.string();
    } catch (const std::exception&) {
      std::error_code none;
      fs::remove(fresh / lockName, none);
      fs::remove(fresh, none);
      throw;
    }
  } catch (const fs::filesystem_error& error) {
    throw OutputError(path + ": cannot be made: " + error.code().message());
  }
}

OutputFolder::OutputFolder(const std::string& path, std::string temporary, FolderLock lock)
    : place_(path), temporary_(std::move(temporary)), lock_(std::move(lock)) {
  place_.requireReplaceable();
}

OutputFolder::~OutputFolder() {
  try {
    if (fs::is_directory(temporary_) && !hasCheckpoint(temporary_) && !readManifest(temporary_))
      place_.discard(temporary_, place_.of(false));
  } catch (const std::exception&) {  // the next run tries again
  }
}

std::string OutputFolder::commit(const Manifest& manifest) {
  fs::path target;
  try {
    if (hasCheckpoint(temporary_))  // it goes when the result is on the disk
      for (const auto& [name, record] : manifest.files) OutputFile(temporary_ + "/" + name, record).sync();
    writeManifest(temporary_, manifest);
    {
      const PlaceLock lockOfPlace(place_.parent().string());
      target = place_.putInPlace(temporary_);
    }
    place_.finish(target, fs::path(temporary_).filename().string());
    return place_.shown(target);
  } catch (const std::exception& error) {
    const auto* file = dynamic_cast<const fs::filesystem_error*>(&error);
    const std::string reason = file != nullptr ? file->code().message() : error.what();
    const std::string name = place_.shown(place_.of(manifest.failed));
    if (!target.empty())
      throw OutputError(name +
                        ": the result is in place, but not all of the old one could be cleared: " + reason);
    if (readManifest(temporary_))
      throw OutputError(name + ": cannot be replaced: " + reason + "; the result is in " +
                        place_.shown(temporary_) + ", and the next run for " +
                        place_.shown(place_.of(false)) + " puts it in place");
    throw OutputError(name + ": cannot be written: " + reason);
  }
}

}  // namespace mortier
