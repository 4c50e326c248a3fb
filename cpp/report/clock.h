// Time and memory of the whole process.
#pragma once

namespace mortier {

/// Wall time since the program was loaded [s]; in a thread that has begun a clock of its own, since then.
double processSeconds();
/// For a run that is one of many in a process.
void beginClock();

/// The most memory the process has held [MiB].
double peakMemory();

}  // namespace mortier
