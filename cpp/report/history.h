// history.csv: a row per step with everything that is reported of it, units in the header.
#pragma once

#include "report/output_file.h"
#include "time/march.h"

namespace mortier {

class History {
 public:
  explicit History(const std::string& folder);
  /// Goes on after the first `keep` bytes.
  History(const std::string& folder, uint64_t keep) : file_(folder + "/history.csv", keep) {}
  void add(const StepReport& report);
  /// Brings everything to the disk. \returns the bytes so far.
  uint64_t sync() { return file_.sync(); }
  void close() { file_.close(); }

 private:
  OutputFile file_;
};

}  // namespace mortier
