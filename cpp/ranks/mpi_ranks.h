// The ranks of `mortier-mpi`: the processes that mpirun started. Before every exchange all report
// whether they were interrupted or have ended, so that none waits for one that does not come.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "base/ranks.h"
#include "linear/partition.h"
#include "linear/skeleton.h"

namespace mortier {

class MpiRanks final : public Ranks {
 public:
  MpiRanks(int& argc, char**& argv);
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;
  ~MpiRanks() override = default;

  [[nodiscard]] int count() const override { return count_; }
  [[nodiscard]] int rank() const override { return rank_; }

  void sum(double* values, size_t count) override;
  void largest(double* values, size_t count) override;
  void gather(const std::vector<double>& own, const std::vector<size_t>& sizes, double* all) override;
  void gatherToFirst(const std::vector<double>& own, const std::vector<size_t>& sizes, double* all) override;
  void reportFault() override;
  void releaseFreeMemory() override;

  /// Calls work(), in which a library lets the ranks of MPI_COMM_WORLD exchange what it likes; it throws
  /// nothing. It has a thread of its own, which is left to itself where another rank died: what it uses must
  /// live as long as it. Collective.
  void call(std::function<void()> work);

  [[nodiscard]] bool end(int code) override;
  void leave() override;
  bool interrupt() noexcept override {
    if (count_ > 1) interrupted_ = true;
    return count_ > 1;
  }
  bool answer() noexcept override {
    deaf_ = true;
    return !lost_ && !peerEnded_;
  }
  [[nodiscard]] double traffic() const override { return traffic_; }

 private:
  void silence();
  void reduce(double* values, size_t count, bool largest);
  std::vector<int> exchange(int own);
  void meet(int own = 0);
  void wait(const std::function<bool()>& done);

  int count_ = 1;
  int rank_ = 0;
  int errors_ = -1;
  std::atomic<bool> interrupted_ = false;
  bool deaf_ = false;  ///< to interruptions
  bool lost_ = false;  ///< whether a rank no longer answers
  bool peerEnded_ = false;
  double traffic_ = 0;
};

// Graphs cut by METIS (Karypis and Kumar 1998).

/// \throws std::runtime_error
std::vector<int> partitionByMetis(const Graph& graph, const std::vector<double>& shares);

// Skeletons whose factor MUMPS (Amestoy, Duff, Koster and L'Excellent 2001) distributes among the ranks.

/// \pre the ranks are those of MPI (ranks/mpi_ranks.h), and some equations are eliminated
/// \throws std::bad_alloc, std::runtime_error from all of them, here and in what it makes
std::unique_ptr<Skeleton> mumpsSkeleton(const SkeletonShape& shape, Ranks& ranks);

}  // namespace mortier
