// Where a run writes: a temporary folder beside the result, renamed when it is complete, so that a run that
// is killed or fails leaves what stood there. Files of others in the old result (pictures, ParaView states)
// move into the new one.
#pragma once

#include <string>

namespace mortier {

class OutputFolder {
 public:
  /// \throws OutputError when it cannot be made, InputError when `path` holds something that is no result of
  /// mortier.
  explicit OutputFolder(std::string path);
  /// Removes the temporary folder unless it was committed.
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
};

}  // namespace mortier
