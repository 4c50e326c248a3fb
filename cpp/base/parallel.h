// Independent pieces of work side by side. Results do not depend on how many threads there are.
#pragma once

#include <atomic>
#include <cstddef>
#include <future>
#include <vector>

namespace mortier {

/// Calls work(i) for i in [0, n), on at most `threads` threads. An exception of any of them is thrown on.
template <class Work>
void inParallel(int threads, size_t n, const Work& work) {
  std::atomic<size_t> next = 0;
  const auto takeTurns = [&] {
    for (size_t i = next++; i < n; i = next++) work(i);
  };
  std::vector<std::future<void>> others;
  for (size_t thread = 1; thread < n && thread < static_cast<size_t>(threads); ++thread)
    others.push_back(std::async(std::launch::async, takeTurns));
  takeTurns();
  for (auto& other : others) other.get();
}

}  // namespace mortier
