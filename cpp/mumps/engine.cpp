// Bodies factorised by MUMPS (Amestoy, Duff, Koster and L'Excellent 2001), with their contact equations as
// the Schur complement, in the processes that mpirun has started.
#include <dmumps_c.h>
#include <unistd.h>
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <new>
#include <numeric>
#include <stdexcept>

#include "base/interrupt.h"
#include "linear/distributed_engine.h"

namespace mortier {
namespace {

/// The words of the manual of MUMPS, and what ends the processes.
enum Job { leave = -3, end = -2, begin = -1, analysis = 1, factorisation = 2, solution = 3 };
enum Failure { singularStructure = -6, singularMatrix = -10, noMemory = -13, notPositive = -40 };
constexpr int commWorld = -987654;

/// Whether work space that the analysis foresaw is too small: pivots are delayed.
bool wantsMoreSpace(int code) {
  return code == -8 || code == -9 || (code <= -14 && code >= -20 && code != -16);
}

/// What the first process lets all of them do.
struct Order {
  int job = leave;
  int number = 0;  ///< of the matrix
  int symmetric = 0;
  std::array<char, sizeof(DMUMPS_STRUC_C::ooc_tmpdir)> folder{};  ///< of factors; empty: in memory
};

/// The matrices of one process, which all of them number alike.
class Matrices {
 public:
  void obey(const Order& order) {
    DMUMPS_STRUC_C& of = matrices_[order.number];
    of.job = order.job;
    if (order.job == begin) {
      of.par = 1;
      of.sym = order.symmetric;
      of.comm_fortran = commWorld;
    }
    dmumps_c(&of);
    if (order.job == begin) std::copy(order.folder.begin(), order.folder.end(), of.ooc_tmpdir);
    if (order.job == end) matrices_.erase(order.number);
  }
  DMUMPS_STRUC_C& operator[](int number) { return matrices_[number]; }

 private:
  std::map<int, DMUMPS_STRUC_C> matrices_;
};

void broadcast(Order& order) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibcast(&order, sizeof(order), MPI_BYTE, 0, MPI_COMM_WORLD, &request);
  // A process that waits leaves its core to the first one, which does much alone.
  constexpr useconds_t pause = 100;
  for (int done = 0;; usleep(pause)) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return;
  }
}

class Mumps;

class MumpsEngine final : public DistributedEngine {
 public:
  explicit MumpsEngine(int processes) : processes_(processes) {}

  [[nodiscard]] std::unique_ptr<CondensingSolver> solver(const SparsePattern& pattern,
                                                         const std::vector<int>& kept) override;
  void keepFactorsIn(const std::string& folder) override { folder_ = folder; }
  [[nodiscard]] int processes() const override { return processes_; }
  [[nodiscard]] std::string version() const override { return MUMPS_VERSION; }

  /// Lets all processes do a job of a matrix; bodies are factorised by several threads.
  void order(int job, int number, bool symmetric = false) {
    const std::lock_guard alone(lock_);
    Order order{job, number, symmetric ? 1 : 0};
    folder_.copy(order.folder.data(), order.folder.size() - 1);
    broadcast(order);
    if (job != leave) matrices_.obey(order);
  }
  /// A matrix that none has yet.
  int newNumber() {
    const std::lock_guard alone(lock_);
    return next_++;
  }
  DMUMPS_STRUC_C& matrix(int number) {
    const std::lock_guard alone(lock_);
    return matrices_[number];
  }
  [[nodiscard]] bool onDisk() const { return !folder_.empty(); }

 private:
  int processes_;
  int next_ = 0;
  std::string folder_;
  std::mutex lock_;
  Matrices matrices_;
};

class Mumps final : public CondensingSolver {
 public:
  Mumps(const SparsePattern& pattern, const std::vector<int>& kept, MumpsEngine& engine)
      : engine_(engine),
        number_(engine.newNumber()),
        size_(pattern.size),
        symmetric_(pattern.symmetric),
        kept_(kept) {
    engine_.order(begin, number_, symmetric_);  // positive definite, or unsymmetric
    matrix_ = &engine_.matrix(number_);
    for (const int output : {1, 2, 3}) icntl(output) = -1;
    icntl(4) = 0;                          // prints nothing
    icntl(6) = 0;                          // no permutation to a large diagonal
    icntl(22) = engine_.onDisk() ? 1 : 0;  // out of core
    places_ = kept;
    for (int& place : places_) ++place;
    if (!kept.empty()) {
      icntl(19) = 1;  // S by rows on the first process
      matrix_->size_schur = static_cast<MUMPS_INT>(kept.size());
      matrix_->listvar_schur = places_.data();
    }
    rows_.reserve(pattern.rows.size());
    columns_.reserve(pattern.rows.size());
    for (int column = 0; column < size_; ++column)
      for (int i = pattern.columnStart[column]; i < pattern.columnStart[column + 1]; ++i) {
        rows_.push_back(pattern.rows[i] + 1);
        columns_.push_back(column + 1);
      }
    matrix_->n = size_;
    matrix_->nnz = static_cast<MUMPS_INT8>(rows_.size());
    matrix_->irn = rows_.data();
    matrix_->jcn = columns_.data();
    engine_.order(analysis, number_);
    analysed_ = matrix_->infog[0] != singularStructure;
    if (analysed_) expectSuccess();
  }
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;
  ~Mumps() override { engine_.order(end, number_); }

  bool factorise(const std::vector<double>& values) override {
    stopIfInterrupted();
    if (!analysed_) return false;
    values_ = values;
    matrix_->a = values_.data();
    const auto m = static_cast<Eigen::Index>(kept_.size());
    Matrix byRows(m, m);
    matrix_->schur = byRows.data();
    engine_.order(factorisation, number_);
    for (int more = 0; more < 8 && wantsMoreSpace(matrix_->infog[0]); ++more) {
      icntl(14) = 2 * icntl(14) + 20;  // percent
      engine_.order(factorisation, number_);
    }
    const int code = matrix_->infog[0];
    if (code == singularMatrix || code == notPositive) return false;
    expectSuccess();
    if (symmetric_ && matrix_->infog[11] > 0) return false;  // negative pivots
    if (matrix_->infog[24] > 0) return false;                // tiny ones, that were replaced
    schur_ = byRows.transpose();
    if (symmetric_) schur_.triangularView<Eigen::StrictlyUpper>() = schur_.transpose();
    return true;
  }

  [[nodiscard]] const Matrix& schurComplement() const override { return schur_; }
  [[nodiscard]] Matrix takeSchurComplement() override { return std::move(schur_); }

  // MUMPS keeps what it has eliminated from f until it is expanded.
  void condense(Vector& f) const override {
    if (kept_.empty()) return;  // expand() does it all
    reduced_.resize(static_cast<Eigen::Index>(kept_.size()));
    matrix_->redrhs = reduced_.data();
    matrix_->lredrhs = static_cast<MUMPS_INT>(kept_.size());
    icntl(26) = 1;
    Vector right = f;
    solve(right);
    f(kept_) = reduced_;
  }

  void expand(Vector& f) const override {
    Vector x = f;
    if (!kept_.empty()) {
      reduced_ = f(kept_);
      matrix_->redrhs = reduced_.data();
      icntl(26) = 2;
    }
    solve(x);
    if (!kept_.empty()) x(kept_) = f(kept_);
    f = std::move(x);
  }

 private:
  [[nodiscard]] MUMPS_INT& icntl(int number) const { return matrix_->icntl[number - 1]; }

  void solve(Vector& right) const {
    matrix_->rhs = right.data();
    matrix_->nrhs = 1;
    matrix_->lrhs = size_;
    engine_.order(solution, number_);
    expectSuccess();
  }

  void expectSuccess() const {
    const int code = matrix_->infog[0];
    if (code >= 0) return;
    if (code == noMemory) throw std::bad_alloc();
    throw std::runtime_error("MUMPS: INFOG(1) = " + std::to_string(code) +
                             ", INFOG(2) = " + std::to_string(matrix_->infog[1]));
  }

  MumpsEngine& engine_;
  int number_;
  int size_;
  bool symmetric_;
  std::vector<int> kept_;
  DMUMPS_STRUC_C* matrix_ = nullptr;
  std::vector<MUMPS_INT> places_, rows_, columns_;  ///< from 1: of the kept equations, of the entries
  std::vector<double> values_;
  mutable Vector reduced_;  ///< right-hand side on the kept equations, then their solution
  bool analysed_ = false;   ///< whether the pattern can be regular
  Matrix schur_;
};

std::unique_ptr<CondensingSolver> MumpsEngine::solver(const SparsePattern& pattern,
                                                      const std::vector<int>& kept) {
  if (static_cast<int>(kept.size()) == pattern.size) return multifrontalSolver(pattern, kept);
  return std::make_unique<Mumps>(pattern, kept, *this);
}

/// Until the first process ends. The first one alone acts on signals.
[[noreturn]] void serve() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  Matrices matrices;
  for (Order order; broadcast(order), order.job != leave;) matrices.obey(order);
  MPI_Finalize();
  std::_Exit(0);
}

}  // namespace

void startProcesses(int& argc, char**& argv) {
  int level = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &level);
  int processes = 1;
  int number = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &processes);
  MPI_Comm_rank(MPI_COMM_WORLD, &number);
  if (number > 0) serve();
  static MumpsEngine engine(processes);
  DistributedEngine::use(&engine);
}

void endProcesses() {
  if (auto* engine = dynamic_cast<MumpsEngine*>(DistributedEngine::ofProgram())) engine->order(leave, 0);
  DistributedEngine::use(nullptr);
  MPI_Finalize();
}

}  // namespace mortier
