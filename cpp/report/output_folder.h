// Where a run writes: a temporary folder DIR.tmp-PID beside the result DIR, renamed when it is complete, so
// that a run that is killed or fails leaves what stood there. Files of others in the old result (pictures,
// ParaView states) move into the new one. A lock tells the folder of a run that goes on from what a killed
// one left; of that the next run takes away whatever has no checkpoint.
#pragma once

#include <string>
#include <vector>

namespace mortier {

/// A lock on a folder, given back with the object or the end of the process.
class FolderLock {
 public:
  FolderLock() = default;
  /// Takes the lock of `folder` if no living process holds it, or of one that this process has just made.
  explicit FolderLock(const std::string& folder, bool own = false);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  [[nodiscard]] bool held() const { return file_ >= 0; }

 private:
  int file_ = -1;
};

class OutputFolder {
 public:
  /// \throws OutputError when it cannot be made, InputError when `path` holds something that is no result of
  /// mortier.
  explicit OutputFolder(const std::string& path);
  /// Goes on in the temporary folder that a stopped run for `path` left. \throws InputError, OutputError
  OutputFolder(const std::string& path, std::string temporary, FolderLock lock);
  /// Removes the temporary folder unless it was committed or has a checkpoint.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  OutputFolder(OutputFolder&&) = delete;
  OutputFolder& operator=(OutputFolder&&) = delete;

  /// The folder to write into.
  [[nodiscard]] const std::string& temporary() const { return temporary_; }
  /// Puts the result in place (and removes `path`.failed of an earlier run). \throws OutputError
  void commit();
  /// Puts the result of a run that stopped early beside it. \returns `path`.failed \throws OutputError
  std::string commitAsFailed();

 private:
  std::string path_;
  std::string temporary_;
  FolderLock lock_;
};

/// The temporary folders of runs for `path` that have a checkpoint, of living and dead processes, the latest
/// first.
std::vector<std::string> stoppedRuns(const std::string& path);

}  // namespace mortier
