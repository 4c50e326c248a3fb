// history.csv: a row per step with everything that is reported of it, units in the header.
#pragma once

#include "report/output_file.h"
#include "time/march.h"

namespace mortier {

class History {
 public:
  explicit History(const std::string& folder);
  void add(const StepReport& report);
  void close() { file_.close(); }

 private:
  OutputFile file_;
};

}  // namespace mortier
