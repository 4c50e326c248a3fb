// Where a run writes: a temporary folder DIR.tmp-PID beside the result DIR, which takes its place when it is
// complete, so that a run that is killed or fails leaves what stood there. At any moment the old or the new
// result stands in its place, whole, and every file of others (pictures, ParaView states) stays:
//   1. DIR.tmp-PID gets its manifest: from here on the run is complete, and who finds it does steps 2 to 4.
//   2. Names are exchanged: DIR is the new result, DIR.tmp-PID the old one. The run.lock in DIR names the
//      latter, and has its number (inode): another folder of that name is not entered.
//   3. Files of others move from the old result into the new one; what the old one's manifest lists goes.
//   4. Stopped runs for DIR and an old DIR.failed go, run.lock last.
// Folders that are just being made or taken away are called DIR.mortier-PID.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/manifest.h"

namespace mortier {

// Which process a folder belongs to. Every folder in which a run writes holds the file run.lock, locked while
// its process lives; its line `mortier run in NAME` says that the folder is the program's, and how it was
// called then, the line `in place of NUMBER` which folder it replaces.

/// An open file, closed with the object; -1 for none.
class OpenFile {
 public:
  explicit OpenFile(int number = -1) : number_(number) {}
  ~OpenFile();
  OpenFile(OpenFile&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  OpenFile& operator=(OpenFile&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool isOpen() const { return number_ >= 0; }

 private:
  int number_;
};

constexpr const char* lockName = "run.lock";

/// The lock of a folder, given back with the object or the end of the process.
class FolderLock {
 public:
  enum class State {
    none,   ///< the folder is not one in which a run writes
    inUse,  ///< by a living process
    held
  };

  FolderLock() = default;
  /// Tries to take the lock of a folder. \throws OutputError  it cannot be read.
  explicit FolderLock(const std::string& folder);
  /// Marks a folder that has just been made, and takes its lock. \param name  how the folder will be called
  /// \throws OutputError
  FolderLock(const std::string& folder, const std::string& name);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool held() const { return state_ == State::held; }
  /// What the folder was called while the run wrote.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The number of the folder that this one was to replace, if any.
  [[nodiscard]] const std::optional<ino_t>& replaced() const { return replaced_; }

 private:
  OpenFile file_;
  State state_ = State::none;
  std::string name_;
  std::optional<ino_t> replaced_;
};

/// \throws OutputError
ino_t numberOf(const std::string& folder);

/// Writes into the lock of a folder whose place it is to take. \throws OutputError
void addReplaced(const std::string& folder, const std::string& replaced);

/// One process at a time looks for runs in a folder, makes new ones and puts results in place. Without effect
/// where folders cannot be locked, and where whoever has the lock keeps it for long.
class PlaceLock {
 public:
  explicit PlaceLock(const std::string& folder);

 private:
  OpenFile file_;
};

/// Whether another process lives whose number stands at the end of a name, `DIR.tmp-12` or `DIR.tmp-12.1`.
bool makerLives(const std::string& name);

/// The result DIR and the folders beside it.
class ResultPlace {
 public:
  using Path = std::filesystem::path;

  /// \throws InputError  a link to nothing, the current folder or one above it
  explicit ResultPlace(const std::string& path);

  /// DIR, or DIR.failed for a run that stopped early; links resolved.
  [[nodiscard]] Path of(bool failedRun) const;
  [[nodiscard]] Path parent() const { return result_.parent_path(); }
  /// A folder beside the result that does not exist: its name, `middle` and the number of this process.
  [[nodiscard]] Path unused(const std::string& middle) const;
  /// Whether `name` is that of such a folder, of any process: names in locks are data of others.
  [[nodiscard]] bool isCalled(const std::string& name, const std::string& middle) const;
  /// Folders beside the result that are called so.
  [[nodiscard]] std::vector<Path> all(const std::string& middle) const;
  /// A folder here as the user calls it, for messages.
  [[nodiscard]] std::string shown(const Path& folder) const;

  /// \throws InputError  it holds what is no result of mortier; OutputError  this user cannot replace it.
  void requireReplaceable() const;

  /// Step 2, for a folder with a manifest whose lock this process holds. \returns where the result is.
  [[nodiscard]] Path putInPlace(const Path& temporary) const;
  /// Steps 3 and 4. \param target  has just been put in place  \param name  of its folder before that
  void finish(const Path& target, const std::string& name) const;
  /// Clears up after killed runs: complete results are put in place, those that cannot be resumed are
  /// deleted. \throws InputError  a living process writes there.
  struct LeftBehind {
    std::vector<Path> stopped;  ///< temporary folders with a checkpoint, the latest first
    Path placed;                ///< where a complete result was put that had no place; empty: there was none
  };
  LeftBehind clearUp() const;
  /// Deletes the files of the program in a folder, and the folder. Files of others move into `heir`; where
  /// that is no result, they stay.
  void discard(const Path& folder, const Path& heir) const;

 private:
  void requireReplaceable(const Path& target) const;
  /// Gives a folder that is to go its last name. \returns it
  [[nodiscard]] Path renamed(const Path& folder) const;
  void requireFree(const FolderLock& lock, const Path& folder) const;
  void removeMarks(Path folder) const;
  void discardFailed() const;
  void clearTransient(const Path& folder) const;

  std::string given_;
  Path result_;
};

class OutputFolder {
 public:
  /// \throws OutputError when it cannot be made, InputError when `path` holds something that is no result of
  /// mortier or is in use.
  explicit OutputFolder(const std::string& path);
  /// Continues in the temporary folder that a stopped run for `path` left. \throws InputError, OutputError
  OutputFolder(const std::string& path, std::string temporary, FolderLock lock);
  /// Removes the temporary folder unless it was committed, is complete or has a checkpoint.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// The folder to write into.
  [[nodiscard]] const std::string& temporary() const { return temporary_; }
  /// Puts the result in place: in `path` (a `path`.failed of an earlier run goes), or in `path`.failed.
  /// \returns where it is \throws OutputError
  std::string commit(const Manifest& manifest);

 private:
  ResultPlace place_;
  std::string temporary_;
  FolderLock lock_;
};

}  // namespace mortier
