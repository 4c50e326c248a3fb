// Processes that share one run. All of them execute the same program in the same order and take the same
// decisions, which depend only on data that are bitwise identical on all ranks. The functions here are
// collective: every rank calls them, in the same order. A run of one process has one rank, for which they do
// nothing.
#pragma once

#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.h"

namespace mortier {

/// Thrown where another rank has reported a fault of its data (Ranks::reportFault).
class PeerFault : public std::exception {};

/// Thrown where another rank has ended: it has reported why.
class PeerEnded : public std::runtime_error {
 public:
  explicit PeerEnded(int code) : std::runtime_error("another rank ended"), code_(code) {}
  [[nodiscard]] int code() const { return code_; }  ///< exit code of that rank

 private:
  int code_;
};

class Ranks {
 public:
  virtual ~Ranks() = default;

  /// Those of this process: one, unless others are used from now on.
  static Ranks& all() { return *all_; }
  static void use(Ranks& ranks) { all_ = &ranks; }

  [[nodiscard]] virtual int count() const { return 1; }
  [[nodiscard]] virtual int rank() const { return 0; }
  [[nodiscard]] bool shared() const { return count() > 1; }
  /// Whether it is the one that writes files and the log.
  [[nodiscard]] bool first() const { return rank() == 0; }

  // Collective. An interruption of any rank is thrown by all of them. \throws Interrupted, PeerEnded

  /// values[i] becomes the sum over all ranks, the same bits everywhere.
  virtual void sum(double* /*values*/, size_t /*count*/) {}
  /// values[i] becomes the largest of all ranks. \pre no NaN
  virtual void largest(double* /*values*/, size_t /*count*/) {}
  /// `all` becomes the parts of all ranks one after the other, part r of sizes[r] values.
  virtual void gather(const std::vector<double>& own, const std::vector<size_t>& sizes, double* all);

  /// The same, but `all` is filled on the first rank alone; `sizes` need be known there only.
  virtual void gatherToFirst(const std::vector<double>& own, const std::vector<size_t>& sizes, double* all);
  /// Where the data of this rank have a fault: the others throw PeerFault in the function that they have come
  /// to.
  virtual void reportFault() {}

  /// To be called once, with the exit code, when the work is over. \returns whether this rank reports why.
  [[nodiscard]] virtual bool end(int /*code*/) { return true; }
  /// Lets all ranks throw Interrupted when they next meet; for signal handlers. \returns false where there is
  /// one rank, which stops by itself (base/interrupt.h).
  virtual bool interrupt() noexcept { return false; }
  /// After Interrupted was thrown: whether all ranks still answer. They no longer hear of interruptions then.
  virtual bool answer() noexcept { return true; }
  /// To be called where what was whole for a moment (meshes before they are cut, states that were gathered)
  /// is gone: several processes on one machine need the memory.
  virtual void releaseFreeMemory() {}
  /// Values that were sent and received so far [bytes].
  [[nodiscard]] virtual double traffic() const { return 0; }
  /// After end(), when all is reported: mpirun ends the others when one that failed is gone.
  virtual void leave() {}

 private:
  static Ranks* all_;
};

/// The first rank works alone while it lives; the others wait for the end.
class FirstRankOnly {
 public:
  FirstRankOnly() : others_(Ranks::all()) { Ranks::use(one_); }
  FirstRankOnly(const FirstRankOnly&) = delete;
  FirstRankOnly& operator=(const FirstRankOnly&) = delete;
  ~FirstRankOnly() { Ranks::use(others_); }

 private:
  Ranks& others_;
  Ranks one_;
};

/// Makes the processes that the program was started in (main.cpp) the ranks of it: one, or those of MPI.
void startRanks(int& argc, char**& argv);

/// Whether any rank says so. Collective.
bool anyOf(Ranks& ranks, bool own);
/// The text of the first rank that has one. Collective.
std::string textOfAny(Ranks& ranks, const std::string& text);
/// The text of the first rank.
std::string textOfFirst(Ranks& ranks, const std::string& text);
/// The number of the first rank.
double numberOfFirst(Ranks& ranks, double number);

// Data that are wrong where one rank alone detects it.

/// Calls work(). A DatumError of any rank is thrown by all. Collective.
template <class Work>
void withSharedFaults(Ranks& ranks, const Work& work) {
  std::string fault;
  try {
    work();
    return;
  } catch (const DatumError& error) {
    fault = error.what();
    ranks.reportFault();
  } catch (const PeerFault&) {
  }
  throw DatumError(textOfAny(ranks, fault));
}

}  // namespace mortier
