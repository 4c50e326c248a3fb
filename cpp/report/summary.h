// summary.json: the result of a run in a few numbers.
#pragma once

#include <string>

#include "report/accuracy.h"

namespace mortier {

/// \param path  for messages
/// \throws OutputError when a number is not finite.
std::string summaryText(const std::string& path, const RunFacts& facts, const Model& model,
                        const Solved& solved);

/// "converged", "failed", "unheld".
std::string word(Status status);

}  // namespace mortier
