// Kinks and jumps of data in time: steps chosen by their error end there, as no estimate sees what happens
// inside a step.
#pragma once

#include <functional>
#include <vector>

namespace mortier {

/// Times in (begin, end) [s] at which one of the data has a kink or a jump, ascending, each once; a jump
/// gives the two neighbouring numbers between which it lies. An interval is smooth where a cubic through four
/// of its points meets three others; what is not is halved, down to 1e-7 of the whole, and the number with
/// the fewest digits taken. A pulse shorter than a hundredth of the whole may be missed.
std::vector<double> findBreaks(const std::vector<std::function<double(double)>>& data, double begin,
                               double end);

}  // namespace mortier
