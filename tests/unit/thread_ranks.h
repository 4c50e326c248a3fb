// Ranks that are threads of one process.
#pragma once

#include <algorithm>
#include <barrier>
#include <functional>
#include <thread>
#include <vector>

#include "base/ranks.h"

namespace mortier {

class ThreadRanks {
 public:
  using Work = std::function<void(Ranks& ranks)>;

  /// Calls work on `count` ranks at once.
  static void run(int count, const Work& work) {
    Board board(count);
    std::vector<std::thread> threads;
    for (int rank = 0; rank < count; ++rank)
      threads.emplace_back([&, rank] {
        One one(board, count, rank);
        work(one);
      });
    for (std::thread& thread : threads) thread.join();
  }

 private:
  struct Board {
    explicit Board(int count) : parts(count), all(count) {}
    std::vector<std::vector<double>> parts;
    std::barrier<> all;
  };

  class One final : public Ranks {
   public:
    One(Board& board, int count, int rank) : board_(board), count_(count), rank_(rank) {}
    [[nodiscard]] int count() const override { return count_; }
    [[nodiscard]] int rank() const override { return rank_; }

    void sum(double* values, size_t count) override {
      show({values, values + count});
      std::fill_n(values, count, 0.0);
      for (const std::vector<double>& part : board_.parts)
        for (size_t i = 0; i < count; ++i) values[i] += part[i];
      board_.all.arrive_and_wait();
    }
    void largest(double* values, size_t count) override {
      show({values, values + count});
      for (const std::vector<double>& part : board_.parts)
        for (size_t i = 0; i < count; ++i) values[i] = std::max(values[i], part[i]);
      board_.all.arrive_and_wait();
    }
    void gather(const std::vector<double>& own, const std::vector<size_t>& /*sizes*/, double* all) override {
      show(own);
      for (const std::vector<double>& part : board_.parts) all = std::copy(part.begin(), part.end(), all);
      board_.all.arrive_and_wait();
    }
    void gatherToFirst(const std::vector<double>& own, const std::vector<size_t>& /*sizes*/,
                       double* all) override {
      show(own);
      if (first())
        for (const std::vector<double>& part : board_.parts) all = std::copy(part.begin(), part.end(), all);
      board_.all.arrive_and_wait();
    }

   private:
    void show(std::vector<double> part) {
      board_.parts[rank_] = std::move(part);
      board_.all.arrive_and_wait();
    }

    Board& board_;
    int count_;
    int rank_;
  };
};

}  // namespace mortier
