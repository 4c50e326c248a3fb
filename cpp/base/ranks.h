// Processes that work on one run. All of them go through the same program in the same order and hold the same
// data, bit for bit, but for what they have shared out. The functions here are collective: every rank calls
// them, in the same order. A run of one process has one rank, for which they do nothing.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace mortier {

/// Thrown where another rank has ended: it has told why.
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

  /// To be called once, with the exit code, when the work is over. \returns whether this rank is to tell why.
  [[nodiscard]] virtual bool end(int /*code*/) { return true; }
  /// Lets all ranks throw Interrupted when they next meet; for signal handlers. \returns false where there is
  /// one rank, which stops by itself (base/interrupt.h).
  virtual bool interrupt() noexcept { return false; }
  /// Values that were sent and received so far [bytes].
  [[nodiscard]] virtual double traffic() const { return 0; }

 private:
  static Ranks* all_;
};

/// Makes the processes that the program was started in (main.cpp) the ranks of it: one, or those of MPI.
void startRanks(int& argc, char**& argv);

/// The text of the first rank.
std::string textOfFirst(Ranks& ranks, const std::string& text);
/// The number of the first rank.
double numberOfFirst(Ranks& ranks, double number);

}  // namespace mortier
