// A run of a scene, in rounds where an accuracy is asked for: what the command line and Python drive.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "adapt/rounds.h"
#include "commands/attempt.h"
#include "commands/command_line.h"
#include "report/checkpoint.h"
#include "report/log.h"
#include "report/output_folder.h"

namespace mortier {

/// The user stopped the run.
class InterruptedError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Why a run whose time is over has stopped.
constexpr const char* timeIsUp = "max_seconds are over";

struct RunOptions {
  std::string out;         ///< folder of the result; empty: memory only
  double checkpoint = 30;  ///< wall time between checkpoints [s]; 0: one a step
  int threads = 1;
  std::string factors = {};  ///< folder of the factors of `mortier-mpi`; empty: in memory
  bool quiet = true;         ///< no log
};

/// A stopped run to resume.
struct StoppedRun {
  std::string folder;  ///< its temporary folder
  FolderLock lock;
  Checkpoint checkpoint;
};

/// The latest stopped run whose result was to be `path`; none when the run was complete: its result has been
/// put in place. \throws InputError when there is none that can be resumed.
std::optional<StoppedRun> findStoppedRun(const std::string& path);

struct Ending {
  ExitCode code = exitDone;
  std::string reason = {};  ///< one line where it is not done
};

class Run {
 public:
  /// Called with every state of every round.
  using Observe = std::function<void(const std::shared_ptr<Attempt>&, const State&, const StepReport&)>;

  /// Builds the model, of the first round. \throws InputError, UnheldBodyError
  Run(ResolvedScene scene, RunOptions options, std::optional<StoppedRun> stopped = {});

  /// Whether it continues at a checkpoint; rounds begin again.
  [[nodiscard]] bool resumes() const { return stopped_ && !rounds_; }
  /// Lets the data of t = 0 act. \returns what a user may not have meant of it (scene/build.h)
  [[nodiscard]] std::string settle() const;
  /// Makes the folder of the result and prints the head of the log. \throws InputError, OutputError
  void open();
  /// \throws OutputError, InterruptedError, UnheldBodyError
  void solve(Observe observe = {});
  /// Puts the result in place and prints the end of the log. \throws OutputError
  Ending finish();

  /// What the log of a run that has ended warns of.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// The round that is solved, in the end that of the result.
  [[nodiscard]] const std::shared_ptr<Attempt>& attempt() const { return attempt_; }
  /// Once it is finished: summary.json, and the folder of the result, empty where it is in memory only.
  [[nodiscard]] const std::string& summary() const { return summary_; }
  [[nodiscard]] const std::string& folder() const { return placed_; }

 private:
  // run_march.cpp
  void march(const std::shared_ptr<Attempt>& attempt, const Observer& alsoObserve = {});
  [[nodiscard]] bool checkpointIsDue() const;
  void writeCheckpoint(const Checkpoint& checkpoint);
  // run_rounds.cpp
  Rounds::Verdict solveRound(const std::shared_ptr<Attempt>& attempt, std::vector<RoundFacts>& done);
  void solveRounds();
  // run.cpp
  void addVerdict();
  void putInPlace();
  [[nodiscard]] Ending ending() const;

  RunOptions options_;
  std::optional<StoppedRun> stopped_;
  std::optional<Rounds> rounds_;
  std::shared_ptr<Attempt> attempt_;
  RunIdentity identity_;
  std::optional<OutputFolder> folder_;
  std::string temporary_;   ///< folder of the result files; empty: none are written
  std::string resumeHint_;  ///< how a run that is interrupted continues
  double lastCheckpoint_ = 0;
  double checkpointCost_ = 0;  ///< wall time of the last one [s]
  Log log_;
  Log rows_;  ///< of steps; quiet in rounds
  Observe observe_;
  std::string shortfall_;  ///< why an accuracy is not reached; empty where it is
  std::string summary_;
  std::string placed_;
};

}  // namespace mortier
