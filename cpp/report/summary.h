// summary.json: the result of a run in a few numbers.
#pragma once

#include <string>

#include "report/accuracy.h"
#include "report/manifest.h"
#include "report/run_facts.h"
#include "time/march.h"

namespace mortier {

/// The text of summary.json; `last` is the report of the step that led to `state`.
/// \param path  for messages
/// \throws OutputError when a number is not finite.
std::string summaryText(const std::string& path, const RunFacts& facts, const Model& model,
                        const State& state, const StepReport& last, const RunReport& report,
                        const Accuracy& accuracy);

/// Writes `folder`/summary.json. \returns what was written.
/// \throws OutputError when it cannot be written or a number is not finite.
FileRecord writeSummary(const std::string& folder, const RunFacts& facts, const Model& model,
                        const State& state, const StepReport& last, const RunReport& report,
                        const Accuracy& accuracy);

/// "converged", "failed", "unheld".
std::string word(Status status);

}  // namespace mortier
