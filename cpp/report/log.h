// The log on standard output: what is solved, a row per step, how it ended and how well the equations hold.
#pragma once

#include <string>
#include <vector>

#include "base/formatted.h"
#include "base/types.h"
#include "report/accuracy.h"

namespace mortier {

/// What is solved: bodies, interfaces.
std::string logHeader(const RunFacts& facts, const Model& model);
/// The head of the table of steps, or of rounds.
std::string logStepsHeader(const Units& units);
std::string logRoundsHeader(const Model& model);
/// The last of the rounds.
std::string logRound(const std::vector<RoundFacts>& rounds);
/// One step.
std::string logRow(const StepReport& report);
/// Strains and rotations that are not small, and that were small before.
std::vector<std::string> deformationWarnings(const Peaks& peaks, const Units& units,
                                             const Peaks& before = {});
/// Of a run that has ended: those, and what contact and motions have done that the model does not have.
std::vector<std::string> warningsOf(const RunReport& report, const Model& model, const Units& units);
/// As lines of the log.
std::string asLines(const std::vector<std::string>& warnings);
/// That a run with steps chosen by their error is begun again.
std::string logTrial(double error, double tolerance);
/// How the run ended, where its result is, how well it holds (equations, estimates, bounds), the largest
/// values where the last step does not have them, and the quantities of the scene.
/// \param place  of the result
std::string logEnd(const RunFacts& facts, const Model& model, const Solved& solved, const std::string& place);

/// Prints the above and, where standard error is a terminal, a progress bar there of a run that takes longer
/// than two seconds. A quiet log prints nothing.
class Log {
 public:
  Log(bool quiet, double endTime);
  ~Log() { finish(); }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  void print(const std::string& text);
  /// Prints the row of a step.
  void step(const StepReport& report);
  /// Removes the progress bar.
  void finish();

 private:
  /// Draws the bar for a run that has reached `time` [s of the model].
  void drawBar(double time);

  bool quiet_;
  bool sharesTerminal_;  ///< rows and bar are drawn on the same screen
  bool hasBar_;
  bool drawn_ = false;
  double endTime_;
  double start_;
  double lastDrawn_ = 0;
  double flushed_ = 0;
};

// summary.json: the result of a run in a few numbers.

/// \param path  for messages
/// \throws OutputError when a number is not finite.
std::string summaryText(const std::string& path, const RunFacts& facts, const Model& model,
                        const Solved& solved);

// Guaranteed bounds in it. \tparam Json  nlohmann's, which only sources include
template <class Json>
Json jsonOfBound(const EnergyBound& bound);
/// Of the error of a quantity.
template <class Json>
Json jsonOfBound(const EnergyBound& bound, size_t quantity, double value);

/// "converged", "failed", "unheld".
std::string word(Status status);

}  // namespace mortier
