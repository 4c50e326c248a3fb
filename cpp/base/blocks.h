// Arrays taken a block at a time, blocks by whoever is idle.
#pragma once

#include <algorithm>

#include "base/parallel.h"

namespace mortier {

/// Items that stay in the cache from one loop over them to the next, a multiple of the lanes.
constexpr int itemsOfBlock = 2048;

inline int blocksOf(int n) {
  return (n + itemsOfBlock - 1) / itemsOfBlock;
}

/// Calls work(begin, end) for the blocks of [0, n).
template <class Work>
void forEachBlock(int n, Threads& threads, const Work& work) {
  threads.forEach(blocksOf(n), [&](int i) { work(itemsOfBlock * i, std::min(itemsOfBlock * (i + 1), n)); });
}

}  // namespace mortier
