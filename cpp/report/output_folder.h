// Where a run writes: a temporary folder DIR.tmp-PID beside the result DIR, which takes its place when it is
// complete (report/result_place.h), so that a run that is killed or fails leaves what stood there. Files of
// others in the old result (pictures, ParaView states) move into the new one.
#pragma once

#include <string>

#include "report/folder_lock.h"
#include "report/manifest.h"
#include "report/result_place.h"

namespace mortier {

class OutputFolder {
 public:
  /// \throws OutputError when it cannot be made, InputError when `path` holds something that is no result of
  /// mortier or is in use.
  explicit OutputFolder(const std::string& path);
  /// Goes on in the temporary folder that a stopped run for `path` left. \throws InputError, OutputError
  OutputFolder(const std::string& path, std::string temporary, FolderLock lock);
  /// Removes the temporary folder unless it was committed, is complete or has a checkpoint.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  OutputFolder(OutputFolder&&) = delete;
  OutputFolder& operator=(OutputFolder&&) = delete;

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
