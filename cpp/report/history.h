// history.csv: a row per step with everything that is reported of it; with friction whether several solutions
// are possible and the work of each interface that has it; the quantities of the scene. Units in the header.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "report/output_file.h"
#include "time/march.h"
#include "time/quantity.h"

namespace mortier {

/// The columns with their units, `time[s]`, and what stands in them.
std::vector<std::string> historyColumns(const Model& model, const std::vector<Quantity>& quantities,
                                        const Units& units);
using HistoryValue = std::variant<int, double, std::string_view>;
std::vector<HistoryValue> historyRow(const StepReport& report);
/// The initial state has one where something acts in it.
inline bool hasRow(const StepReport& report) {
  return report.step > 0 || report.motion > 0 || report.vonMises > 0;
}

class History {
 public:
  History(const std::string& folder, const Model& model, const std::vector<Quantity>& quantities,
          const Units& units);
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
