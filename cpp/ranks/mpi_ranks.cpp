#include "ranks/mpi_ranks.h"

#include <fcntl.h>
#include <malloc.h>
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <future>
#include <thread>
#include <utility>

#include "base/interrupt.h"

namespace mortier {
namespace {

enum Standing { going = 0, faulty = 1, interrupted = 2, ended = 3 };  // ended + its exit code

/// Where the parts of the ranks are, one after the other.
struct PartsOfAll {
  explicit PartsOfAll(const std::vector<size_t>& sizes)
      : counts(sizes.begin(), sizes.end()), places(sizes.size(), 0) {
    for (size_t r = 1; r < counts.size(); ++r) places[r] = places[r - 1] + counts[r - 1];
  }
  [[nodiscard]] size_t size() const { return static_cast<size_t>(places.back()) + counts.back(); }

  std::vector<int> counts;
  std::vector<int> places;
};

auto complete(MPI_Request& request) {
  return [&request] {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    return done != 0;
  };
}

}  // namespace

MpiRanks::MpiRanks(int& argc, char**& argv) {
  int level = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &level);  // two in call(), one after the other
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  if (!first()) silence();
}

void MpiRanks::sum(double* values, size_t count) {
  reduce(values, count, false);
}

void MpiRanks::largest(double* values, size_t count) {
  reduce(values, count, true);
}

void MpiRanks::gather(const std::vector<double>& own, const std::vector<size_t>& sizes, double* all) {
  meet();
  const PartsOfAll parts(sizes);
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Iallgatherv(own.data(), static_cast<int>(own.size()), MPI_DOUBLE, all, parts.counts.data(),
                  parts.places.data(), MPI_DOUBLE, MPI_COMM_WORLD, &request);
  wait(complete(request));
  traffic_ += sizeof(double) * static_cast<double>(parts.size() + own.size());
}

// Messages to the first alone; it takes as much memory as what it asked for.
void MpiRanks::gatherToFirst(const std::vector<double>& own, const std::vector<size_t>& sizes, double* all) {
  meet();
  const PartsOfAll parts(sizes);
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Igatherv(own.data(), static_cast<int>(own.size()), MPI_DOUBLE, all, parts.counts.data(),
               parts.places.data(), MPI_DOUBLE, 0, MPI_COMM_WORLD, &request);
  wait(complete(request));
  traffic_ += sizeof(double) * static_cast<double>(own.size());
  if (first()) traffic_ += sizeof(double) * static_cast<double>(parts.size());
}

void MpiRanks::reportFault() {
  meet(faulty);
}

void MpiRanks::releaseFreeMemory() {
  malloc_trim(0);
}

void MpiRanks::call(std::function<void()> work) {
  meet();
  std::packaged_task<void()> task(std::move(work));
  const std::future<void> done = task.get_future();
  std::thread thread(std::move(task));
  constexpr std::chrono::milliseconds moment(20);
  try {
    wait([&] { return done.wait_for(moment) == std::future_status::ready; });
  } catch (...) {
    thread.detach();
    throw;
  }
  thread.join();
}

// What ends all of them is reported by the first, what ends one alone by that one.
bool MpiRanks::end(int code) {
  bool reports = first();
  try {
    if (!lost_ && !peerEnded_) {
      const std::vector<int> standing = exchange(ended + code);
      const auto failed = [](int each) { return each > ended; };
      reports = std::find_if(standing.begin(), standing.end(), failed) - standing.begin() == rank_;
    }
  } catch (const Interrupted&) {  // some no longer answer
  }
  if (errors_ >= 0) dup2(errors_, STDERR_FILENO);
  return reports && !peerEnded_;
}

void MpiRanks::leave() {
  if (lost_) return;
  try {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    wait(complete(request));
    MPI_Finalize();
  } catch (const Interrupted&) {  // some no longer answer
  }
}

/// One rank writes the log and warnings.
void MpiRanks::silence() {
  std::fflush(stdout);
  errors_ = dup(STDERR_FILENO);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  close(nowhere);
}

void MpiRanks::reduce(double* values, size_t count, bool largest) {
  constexpr size_t most = size_t{1} << 28;
  meet();
  for (size_t begin = 0; begin < count; begin += most) {
    const auto size = static_cast<int>(std::min(most, count - begin));
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(MPI_IN_PLACE, values + begin, size, MPI_DOUBLE, largest ? MPI_MAX : MPI_SUM,
                   MPI_COMM_WORLD, &request);
    wait(complete(request));
  }
  traffic_ += 2.0 * sizeof(double) * static_cast<double>(count);
}

std::vector<int> MpiRanks::exchange(int own) {
  std::vector<int> standing(count_);
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Iallgather(&own, 1, MPI_INT, standing.data(), 1, MPI_INT, MPI_COMM_WORLD, &request);
  wait(complete(request));
  return standing;
}

void MpiRanks::meet(int own) {
  const std::vector<int> standing = exchange(interrupted_ && !deaf_ ? interrupted : own);
  const int worst = *std::max_element(standing.begin(), standing.end());
  if (worst >= ended) {
    peerEnded_ = true;
    throw PeerEnded(worst - ended);
  }
  if (worst == interrupted) throw Interrupted();
  if (worst == faulty && own != faulty) throw PeerFault();
}

/// Where a rank died, mpirun interrupts the others and kills them a second later.
void MpiRanks::wait(const std::function<bool()>& done) {
  const std::chrono::milliseconds patience(deaf_ ? 5000 : 200);
  constexpr std::chrono::milliseconds soon(5);  // who waits longer waits for the work of others, in meet()
  constexpr std::chrono::nanoseconds shortest(50000);
  constexpr std::chrono::nanoseconds longest(5000000);
  constexpr int part = 100;  // of the time that it has waited
  const auto begin = std::chrono::steady_clock::now();
  auto asked = std::chrono::steady_clock::time_point::max();
  while (!done()) {
    const auto now = std::chrono::steady_clock::now();
    if (interrupted_ && asked > now) asked = now;
    if (interrupted_ && now - asked > patience) {
      lost_ = true;
      throw Interrupted();
    }
    if (now - begin < soon)
      std::this_thread::yield();
    else
      std::this_thread::sleep_for(
          std::clamp<std::chrono::nanoseconds>((now - begin) / part, shortest, longest));
  }
}

void startRanks(int& argc, char**& argv) {
  static MpiRanks ranks(argc, argv);
  Ranks::use(ranks);
  partitionBy(partitionByMetis);
#ifdef MORTIER_MUMPS
  distributeSkeletonsBy(mumpsSkeleton);
#endif
}

}  // namespace mortier
