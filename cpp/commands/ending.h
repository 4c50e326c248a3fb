// What comes after the march: what is said of its accuracy, the result in its place, and how it ended.
#pragma once

#include <string>

#include "adapt/rounds.h"
#include "commands/attempt.h"
#include "commands/exit_code.h"
#include "report/output_folder.h"

namespace mortier {

/// Adds to a run what spoils its estimates, whether it has the accuracy that was asked for, and a bound of
/// its error where the scene wants one.
/// \param rounds  nullptr where none was
/// \param shortfall  why the accuracy is not reached; empty where it is
void addVerdict(Attempt& attempt, const Rounds* rounds, const std::string& shortfall);

/// Writes the summary, beside an accuracy the meshes, and puts the result in place. \returns where it is
/// \throws OutputError
std::string putInPlace(const Attempt& attempt, OutputFolder& folder);

struct Ending {
  ExitCode code = exitDone;
  std::string reason;  ///< one line where it is not done
};
/// \param folder  of the result; empty where it is in memory only
Ending endingOf(const Attempt& attempt, const std::string& shortfall, const std::string& folder);

}  // namespace mortier
