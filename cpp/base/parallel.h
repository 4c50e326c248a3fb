// Work on threads that are kept. What a piece of work computes must not depend on which thread does it, nor
// on the order of pieces that do not wait for each other: then results are the same, bit for bit, for any
// number of threads.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

namespace mortier {

class Threads {
 public:
  using Work = std::function<void(int item)>;

  /// \param count  of threads that work, the caller's included.
  explicit Threads(int count);
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  ~Threads();

  /// The caller's thread alone.
  static Threads& none();

  [[nodiscard]] int count() const;

  // `work` may call these functions too; idle threads then help. An exception that it throws is thrown here.

  /// Calls work(i) for i in [0, n), in any order.
  void forEach(int n, const Work& work);
  /// Calls work(i) for the nodes of a forest, children before parents. parent[i] > i, or -1.
  void upward(const std::vector<int>& parent, const Work& work);
  /// The same, parents before children.
  void downward(const std::vector<int>& parent, const Work& work);

 private:
  class Pool;
  std::unique_ptr<Pool> pool_;  ///< none for one thread
};

// Arrays taken a block at a time, blocks by whoever is idle.

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
