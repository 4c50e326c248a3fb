// Disjoint sets of numbers, joined two at a time; the smallest number of a set represents it (Galler and
// Fischer 1964).
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace mortier {

class DisjointSets {
 public:
  /// Each of 0 .. size - 1 alone.
  explicit DisjointSets(size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  /// The number that stands for the set of `i`.
  int of(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) {
    const auto [low, high] = std::minmax({of(a), of(b)});
    parent_[high] = low;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace mortier
