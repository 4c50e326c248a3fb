#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <random>
#include <stdexcept>
#include <thread>

namespace mortier::parallel_test {

std::vector<int> randomForest(std::mt19937& random, int n) {
  std::vector<int> parent(n, -1);
  for (int i = 0; i + 1 < n; ++i)
    if (random() % 8 != 0)
      parent[i] = std::uniform_int_distribution<int>(i + 1, std::min(n - 1, i + 6))(random);
  return parent;
}

TEST(Threads, everyItemIsDoneOnce) {
  for (const int count : {1, 2, 5}) {
    Threads threads(count);
    for (const int n : {0, 1, 2, 100}) {
      std::vector<std::atomic<int>> done(n);
      threads.forEach(n, [&](int i) { ++done[i]; });
      for (const auto& each : done) EXPECT_EQ(each, 1);
    }
  }
}

TEST(Threads, itemsWaitForTheirChildrenOrParents) {
  std::mt19937 random(1);
  for (const int count : {1, 2, 5}) {
    Threads threads(count);
    for (int repetition = 0; repetition < 50; ++repetition) {
      const std::vector<int> parent = randomForest(random, 60);
      std::vector<std::atomic<int>> childrenDone(60);
      std::vector<int> children(60, 0);
      for (const int p : parent)
        if (p >= 0) ++children[p];
      std::atomic<int> early = 0;
      threads.upward(parent, [&](int i) {
        if (childrenDone[i] != children[i]) ++early;
        if (parent[i] >= 0) ++childrenDone[parent[i]];
      });
      std::vector<std::atomic<bool>> done(60);
      threads.downward(parent, [&](int i) {
        if (parent[i] >= 0 && !done[parent[i]]) ++early;
        done[i] = true;
      });
      EXPECT_EQ(early, 0);
      for (const auto& each : done) EXPECT_TRUE(each);
    }
  }
}

TEST(Threads, itemsMayHaveItemsOfTheirOwn) {
  for (const int count : {1, 2, 3}) {
    Threads threads(count);
    std::atomic<int> done = 0;
    threads.forEach(5,
                    [&](int) { threads.forEach(7, [&](int) { threads.forEach(3, [&](int) { ++done; }); }); });
    EXPECT_EQ(done, 5 * 7 * 3);
  }
}

// One of two items ends at once; the other has two items that can only end together.
TEST(Threads, callersHelpWithTheItemsOfTheirItems) {
  constexpr std::chrono::seconds enough(20);
  Threads threads(2);
  for (const int longOne : {0, 1}) {
    std::atomic<int> together = 0;
    std::atomic<bool> met = true;
    threads.forEach(2, [&](int item) {
      if (item != longOne) return;
      threads.forEach(2, [&](int) {
        ++together;
        const auto begin = std::chrono::steady_clock::now();
        while (together < 2 && met)
          if (std::chrono::steady_clock::now() - begin > enough) met = false;
      });
    });
    EXPECT_TRUE(met);
  }
}

TEST(Threads, theFirstOfSeveralExceptionsComesOut) {
  for (const int count : {1, 2, 4}) {
    Threads threads(count);
    for (int repetition = 0; repetition < 20; ++repetition) {
      int first = -1;
      std::atomic<bool> laterOneBegun = count == 1;
      try {
        threads.forEach(20, [&](int i) {
          if (i < 3) return;
          const bool isFirst = i == 3;
          if (isFirst)
            while (!laterOneBegun) std::this_thread::yield();
          else
            laterOneBegun = true;
          if (isFirst == (repetition % 2 == 0)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
          throw i;
        });
      } catch (const int item) {
        first = item;
      }
      EXPECT_EQ(first, 3);
    }
  }
}

TEST(Threads, exceptionsComeOutAndTheThreadsStay) {
  for (const int count : {1, 3}) {
    Threads threads(count);
    const auto fail = [](int i) {
      if (i == 11) throw std::runtime_error("eleven");
    };
    EXPECT_THROW(threads.forEach(20, fail), std::runtime_error);
    EXPECT_THROW(threads.upward(std::vector<int>(20, -1), fail), std::runtime_error);
    std::atomic<int> done = 0;
    threads.forEach(20, [&](int) { ++done; });
    EXPECT_EQ(done, 20);
  }
}

}  // namespace mortier::parallel_test
