// Which process a folder belongs to. Every folder in which a run writes holds the file run.lock, locked while
// its process lives; its one line, `mortier run in NAME`, says that the folder is the program's, and how it
// was called then.
#pragma once

#include <string>
#include <utility>

namespace mortier {

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

 private:
  OpenFile file_;
  State state_ = State::none;
  std::string name_;
};

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

}  // namespace mortier
