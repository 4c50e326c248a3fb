// What threads would do: `Threads` (base/parallel.h) written anew to run all work on the caller's thread,
// take its processor time and keep which piece waits for which. A program that links it has no other threads.
#pragma once

#include <vector>

namespace mortier::bench {

/// A piece of work between two points where threads may part or meet.
struct Piece {
  double seconds = 0;
  std::vector<int> next;  ///< pieces that wait for it
  bool parallel = false;  ///< part of a call of forEach, upward or downward
};

/// Begins a record; what was recorded before is forgotten.
void beginRecord();
/// Ends it. Piece 0 is the first, and no piece waits for a later one.
std::vector<Piece> takeRecord();

/// Seconds on so many processors where whoever is idle takes the piece that became ready last.
double secondsOn(const std::vector<Piece>& pieces, int processors);
/// The longest chain of pieces that wait for each other.
std::vector<int> longestChain(const std::vector<Piece>& pieces);

}  // namespace mortier::bench
