// The interface of all sparse linear algebra. A sparse system with some equations kept,
//   K = [K_bb K_bk; K_kb K_kk],
// is factorised in its interior b only; what contact needs of it is the Schur complement on the kept
// equations,
//   S = K_kk - K_kb K_bb^-1 K_bk,
// a right-hand side condensed to them, and the solution spread from them.
#pragma once

#include <memory>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"

namespace mortier {

// Which entries of a square sparse matrix exist, by columns.

struct SparsePattern {
  int size = 0;
  bool symmetric = true;  ///< only the lower triangle (row >= column) is held; otherwise all of a pattern
                          ///< that is structurally symmetric
  std::vector<int> columnStart;  ///< size + 1
  std::vector<int> rows;         ///< ascending in each column

  [[nodiscard]] int entries() const { return static_cast<int>(rows.size()); }
};

class CondensingSolver {
 public:
  virtual ~CondensingSolver() = default;

  /// Numeric factorisation of the interior. \returns false when it is singular (or, where the pattern is
  /// symmetric, not positive definite); the solver is then unusable until the next factorise().
  virtual bool factorise(const std::vector<double>& values) = 0;
  /// S (kept x kept, in the order in which the kept equations were given), all of it also where symmetric.
  [[nodiscard]] virtual const Matrix& schurComplement() const = 0;
  /// The same, moved out: the solver has it no longer until the next factorise().
  [[nodiscard]] virtual Matrix takeSchurComplement() = 0;
  /// f (equations) in place: its kept part becomes f_k - K_kb K_bb^-1 f_b, its interior whatever expand()
  /// needs.
  virtual void condense(Vector& f) const = 0;
  /// f from condense() with the solution x_k in its kept part: becomes the solution x.
  virtual void expand(Vector& f) const = 0;

  /// Works on these threads from now on; they must outlive the solver.
  void use(Threads& threads) { threads_ = &threads; }

 protected:
  [[nodiscard]] Threads& threads() const { return *threads_; }

 private:
  Threads* threads_ = &Threads::none();
};

// Solvers that analyse the pattern once. `kept` are equations, each once.

/// Multifrontal Cholesky (symmetric patterns) or LU, the kept equations a last front that is never
/// factorised.
std::unique_ptr<CondensingSolver> multifrontalSolver(const SparsePattern& pattern,
                                                     const std::vector<int>& kept);

/// The same by Cholesky in single precision: half of the memory and nearly of the time. What it solves is off
/// by the rounding of single precision times the condition of K; repeated solves for the residual take that
/// away.
std::unique_ptr<CondensingSolver> singleSolver(const SparsePattern& pattern, const std::vector<int>& kept);

/// CHOLMOD (symmetric patterns) or UMFPACK on the interior, one right-hand side per kept equation.
std::unique_ptr<CondensingSolver> suiteSparseSolver(const SparsePattern& pattern,
                                                    const std::vector<int>& kept);

}  // namespace mortier
