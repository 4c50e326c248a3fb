#pragma once

#include <string>
#include <vector>

namespace mortier {

/// The ends of the steps of a run, ascending, from the history.csv in its folder [s, or the run's unit].
/// \throws InputError where there is none, or it is not of a run to `end` from time 0
std::vector<double> stepsOfRun(const std::string& folder, double end);

}  // namespace mortier
