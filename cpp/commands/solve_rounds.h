// The rounds of a run that is to have an accuracy (adapt/rounds.h), and the best of them: a round that comes
// out worse, cannot be solved, or is not done when the time is over, leaves the best one's result as it was.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "adapt/rounds.h"
#include "commands/attempt.h"

namespace mortier {

using SolveAttempt = std::function<void(Attempt& attempt, Observer alsoObserve)>;

/// The rounds of a scene that asks for an accuracy; the scene becomes that of the first.
std::optional<Rounds> beginRounds(ResolvedScene& resolved);

/// \param attempt  in: the first round; out: that of the least error, whose files are in `folder`. Where the
/// first one cannot be solved, it.
/// \param options  of every round
/// \returns why the accuracy is not reached; empty where it is, and where the first round cannot be solved.
/// \throws OutputError, InterruptedError, and what the first round throws
std::string solveRounds(Rounds& rounds, std::unique_ptr<Attempt>& attempt, const AttemptOptions& options,
                        const std::string& folder, Log& log, const SolveAttempt& solve);

}  // namespace mortier
