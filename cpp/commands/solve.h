// One march of a model with what goes with it: the files of the result, checkpoints, the log.
#pragma once

#include <functional>
#include <optional>

#include "commands/run.h"
#include "commands/stopped_run.h"
#include "report/accuracy.h"
#include "report/log.h"
#include "report/output_folder.h"
#include "report/result_files.h"
#include "report/run_facts.h"
#include "scene/scene.h"

namespace mortier {

/// Writes checkpoints at intervals of wall time, and never so often that a tenth of the time goes into them.
/// Without a folder it writes none.
class Checkpoints {
 public:
  Checkpoints(std::string folder, double interval, RunIdentity identity);
  [[nodiscard]] bool due() const;
  /// \param empty  the files before the first step
  void write(const FilesSoFar& empty, const FilesSoFar& files, const StepReport& last, const State& state,
             const MarchMemory& memory, const AccuracyMemory& accuracy);

 private:
  std::string folder_;
  double interval_;
  double last_;
  double cost_ = 0;
  RunIdentity identity_;
};

/// Why a run whose time is over has stopped.
constexpr const char* timeIsUp = "max_seconds are over";

struct Solving {
  const SceneDescription& scene;
  const Model& model;        ///< of whole bodies, on the first rank
  const Model& solvedModel;  ///< that of this rank: the same, or in parts
  CurrentSpaceError& error;  ///< kept up to date
  const RunFacts& facts;
  const std::string& folder;  ///< of the result files; empty: none are written
  Log& log;
  State state;  ///< in which it begins
  /// What a stopped run had done; it is gone on with.
  std::optional<Checkpoint> stopped = {};
  Checkpoints& checkpoints;
  std::string again;     ///< how a run that is interrupted goes on
  Observer alsoObserve;  ///< called with every state
  /// A run that is stopped begins anew: there is one checkpoint, of the initial state of the first round.
  bool checkpointInitialStateOnly = false;
};

struct Solved {
  State state;      ///< the last one that was reached
  StepReport last;  ///< of the step that led to it
  RunReport report;
  Accuracy accuracy;
  std::map<std::string, FileRecord> files;  ///< what was written
};

/// \throws OutputError, InterruptedError, UnheldBodyError
Solved solve(Solving solving);

}  // namespace mortier
