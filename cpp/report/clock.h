// Time and memory of the whole process.
#pragma once

namespace mortier {

/// Wall time since the program was loaded [s].
double processSeconds();

/// The most memory the process has held [MiB].
double peakMemory();

}  // namespace mortier
