// A scene solved in this process: what `mortier run` does, its result in memory and, where a folder is given,
// in files as well.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "commands/run.h"
#include "report/fields.h"
#include "report/result_files.h"
#include "scene.h"

namespace mortier::python {

/// A state of a run, and what is computed of it when it is first asked for.
struct Step {
  std::shared_ptr<const Attempt> of;
  StepReport report;
  std::vector<HistoryValue> row;  ///< of the history
  State state;

  std::vector<Vector> moved = {};                          ///< nodes, by bodies and dofs
  std::vector<std::optional<CellFields>> cells = {};       ///< by bodies
  std::vector<std::optional<ContactFields>> contact = {};  ///< by interfaces
  std::vector<Vector> errors = {};                         ///< by bodies and triangles
};

using HistoryColumn = std::variant<std::vector<int>, std::vector<double>, std::vector<std::string_view>>;

struct Solution {
  std::vector<std::pair<std::string, HistoryColumn>> history;  ///< `time[s]` and so on; a row a step
  std::vector<std::shared_ptr<Step>> steps;                    ///< that were kept, the last one at least
  std::string summary;                                         ///< summary.json
  std::string folder;                                          ///< of the files, empty without
  Ending ending;
};

/// \param keepAll  all steps, in place of those of output.every
/// \param onStep  called with every step as it is done; not for scenes whose steps may be done again.
/// \throws InputError, UnheldBodyError, OutputError, InterruptedError, Interrupted
Solution solveScene(const Scene& scene, const RunOptions& options, bool keepAll,
                    const std::function<void(std::shared_ptr<Step>)>& onStep = {});

}  // namespace mortier::python
