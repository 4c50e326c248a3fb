// history.csv: a row per step with everything that is reported of it, units in the header.
#pragma once

#include "report/output_file.h"
#include "time/march.h"

namespace mortier {

class History {
 public:
  explicit History(const std::string& folder);
  /// Goes on after what `keep` records.
  History(const std::string& folder, const FileRecord& keep) : file_(folder + "/history.csv", keep) {}
  void add(const StepReport& report);
  /// Brings everything to the disk. \returns what is written so far.
  FileRecord sync() { return file_.sync(); }
  FileRecord close() { return file_.close(); }

 private:
  OutputFile file_;
};

}  // namespace mortier
