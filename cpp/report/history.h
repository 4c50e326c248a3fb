// history.csv: a row per step with everything that is reported of it and the quantities of the scene, units
// in the header.
#pragma once

#include "report/output_file.h"
#include "time/march.h"
#include "time/quantity.h"

namespace mortier {

class History {
 public:
  History(const std::string& folder, const std::vector<Quantity>& quantities);
  /// Goes on after what `keep` records.
  History(const std::string& folder, const FileRecord& keep) : file_(folder + "/history.csv", keep) {}
  /// `values` of the quantities.
  void add(const StepReport& report, const std::vector<double>& values);
  /// Brings everything to the disk. \returns what is written so far.
  FileRecord sync() { return file_.sync(); }
  FileRecord close() { return file_.close(); }

 private:
  OutputFile file_;
};

}  // namespace mortier
