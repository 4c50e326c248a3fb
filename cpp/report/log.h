// The log on standard output: what is solved, a row per step, how it ended and how well the equations hold.
#pragma once

#include <string>

#include "report/accuracy.h"
#include "report/progress.h"
#include "report/run_facts.h"
#include "time/march.h"

namespace mortier {

/// What is solved: bodies, interfaces.
std::string logHeader(const RunFacts& facts, const Model& model);
/// The head of the table of steps, or of rounds.
std::string logStepsHeader(const Units& units);
std::string logRoundsHeader();
/// The last of the rounds.
std::string logRound(const std::vector<RoundFacts>& rounds);
/// One step.
std::string logRow(const StepReport& report);
/// That a run with steps chosen by their error is begun again.
std::string logTrial(double error, double tolerance);
/// How the run ended, and where its result is.
std::string logStatus(const RunReport& report, const std::string& folder);
/// How well the equations hold in the worst step.
std::string logVerification(const Certificate& worst);
/// How far the steps of a run in which they are chosen are from the exact ones,
/// and whether the tolerance is met.
std::string logTimeError(const RunFacts& facts, const RunReport& report);
/// How far stresses are from the exact ones, by their own estimate: those of the last step,
/// and the largest of the run.
std::string logAccuracy(const RunFacts& facts, const Model& model, const Accuracy& accuracy);
/// The largest values of the run where the last step does not have them,
/// and what no small strain is any more.
std::string logPeaks(const Peaks& peaks, const StepReport& last, const Units& units, bool contact);
/// The quantities of the scene at the end of the run, with the places of those that have one and the bounds
/// of their errors where there are such; nothing where there are none.
std::string logQuantities(const RunFacts& facts, const Model& model, const State& state,
                          const std::optional<EnergyBound>& bound);
/// Their smallest and largest values, and when.
std::string logRanges(const RunFacts& facts, const std::vector<QuantityRange>& ranges);
/// A line where contact conditions have no force of their own, otherwise nothing.
std::string logSpecial(const SpecialConditions& special);

/// Prints the above, and a progress bar where the run is long. A quiet log prints nothing.
class Log {
 public:
  Log(bool quiet, double endTime);
  void print(const std::string& text);
  /// Prints the row of a step.
  void step(const StepReport& report);
  /// Removes the progress bar.
  void finish() { progress_.clear(); }

 private:
  bool quiet_;
  bool sharesTerminal_;  ///< rows and bar are drawn on the same screen
  Progress progress_;
  double flushed_ = 0;
};

}  // namespace mortier
