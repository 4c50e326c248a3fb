// The libraries as engine: K_bb factorised by CHOLMOD or UMFPACK, S column by column. Check and fallback of
// the multifrontal engine, and the reference that its speed is measured against.
#include <umfpack.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "base/interrupt.h"
#include "linear/cholmod_common.h"
#include "linear/condensing_solver.h"

namespace mortier {
namespace {

/// A block of K by columns, with the entry of the pattern that each of its values comes from.
struct Block {
  std::vector<int> start{0};
  std::vector<int> rows;
  std::vector<int> entry;
  std::vector<double> values;

  void take(const std::vector<double>& all) {
    values.resize(entry.size());
    for (size_t k = 0; k < entry.size(); ++k) values[k] = all[entry[k]];
  }

  void subtractProduct(const double* x, double* y) const {
    for (size_t j = 0; j + 1 < start.size(); ++j)
      for (int k = start[j]; k < start[j + 1]; ++k) y[rows[k]] -= values[k] * x[j];
  }
};

/// All of K (also where the pattern holds its lower triangle), rows and columns renumbered in parts.
Block cut(const SparsePattern& pattern, const std::vector<int>& rowNumber,
          const std::vector<int>& columnNumber, int columns, bool lowerOnly) {
  std::vector<std::vector<std::pair<int, int>>> lists(columns);
  const auto add = [&](int row, int column, int entry) {
    if (rowNumber[row] < 0 || columnNumber[column] < 0) return;
    if (lowerOnly && rowNumber[row] < columnNumber[column]) return;
    lists[columnNumber[column]].emplace_back(rowNumber[row], entry);
  };
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.columnStart[j]; k < pattern.columnStart[j + 1]; ++k) {
      add(pattern.rows[k], j, k);
      if (pattern.symmetric && pattern.rows[k] != j) add(j, pattern.rows[k], k);
    }
  Block result;
  for (auto& list : lists) {
    std::sort(list.begin(), list.end());
    for (const auto& [row, entry] : list) {
      result.rows.push_back(row);
      result.entry.push_back(entry);
    }
    result.start.push_back(static_cast<int>(result.rows.size()));
  }
  return result;
}

/// A factorised sparse matrix.
class Factorisation {
 public:
  virtual ~Factorisation() = default;
  virtual bool factorise(Block& K) = 0;
  virtual void solve(const Block& K, Vector& x) const = 0;
};

class Cholmod final : public Factorisation {
 public:
  explicit Cholmod(Block& pattern) {
    common_->supernodal = CHOLMOD_SUPERNODAL;
    common_->nmethods = 1;
    common_->method[0].ordering = CHOLMOD_METIS;
    common_->quick_return_if_not_posdef = 1;
    pattern.values.assign(pattern.rows.size(), 0.0);
    cholmod_sparse A = lowerTriangle(pattern.start, pattern.rows, pattern.values.data());
    const std::lock_guard alone(metisInUse);
    factor_ = cholmod_analyze(&A, &common_);
    if (factor_ == nullptr) throw std::runtime_error("symbolic analysis failed in CHOLMOD");
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
  ~Cholmod() override { cholmod_free_factor(&factor_, &common_); }

  bool factorise(Block& K) override {
    cholmod_sparse A = lowerTriangle(K.start, K.rows, K.values.data());
    return cholmod_factorize(&A, factor_, &common_) != 0 && common_->status == CHOLMOD_OK;
  }

  void solve(const Block& /*K*/, Vector& x) const override {
    cholmod_dense b{};
    b.nrow = b.nzmax = b.d = x.size();
    b.ncol = 1;
    b.x = x.data();
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor_, &b, &common_);
    if (solution == nullptr) throw std::runtime_error("solve failed in CHOLMOD");
    std::copy_n(static_cast<const double*>(solution->x), x.size(), x.data());
    cholmod_free_dense(&solution, &common_);
  }

 private:
  mutable CholmodCommon common_;
  cholmod_factor* factor_ = nullptr;
};

class Umfpack final : public Factorisation {
 public:
  explicit Umfpack(const Block& pattern) : size_(static_cast<int>(pattern.start.size()) - 1) {
    umfpack_di_defaults(control_);
    control_[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
    if (umfpack_di_symbolic(size_, size_, pattern.start.data(), pattern.rows.data(), nullptr, &symbolic_,
                            control_, nullptr) != UMFPACK_OK)
      throw std::runtime_error("symbolic analysis failed in UMFPACK");
  }
  Umfpack(const Umfpack&) = delete;
  Umfpack& operator=(const Umfpack&) = delete;
  ~Umfpack() override {
    umfpack_di_free_numeric(&numeric_);
    umfpack_di_free_symbolic(&symbolic_);
  }

  bool factorise(Block& K) override {
    umfpack_di_free_numeric(&numeric_);
    return umfpack_di_numeric(K.start.data(), K.rows.data(), K.values.data(), symbolic_, &numeric_, control_,
                              nullptr) == UMFPACK_OK;
  }

  void solve(const Block& K, Vector& x) const override {
    const Vector b = x;
    umfpack_di_solve(UMFPACK_A, K.start.data(), K.rows.data(), K.values.data(), x.data(), b.data(), numeric_,
                     control_, nullptr);
  }

 private:
  int size_;
  double control_[UMFPACK_CONTROL]{};
  void* symbolic_ = nullptr;
  void* numeric_ = nullptr;
};

class SuiteSparse final : public CondensingSolver {
 public:
  SuiteSparse(const SparsePattern& pattern, const std::vector<int>& kept) : keptEquations_(kept) {
    std::vector<int> keptNumber(pattern.size, -1);
    for (size_t k = 0; k < kept.size(); ++k) keptNumber[kept[k]] = static_cast<int>(k);
    std::vector<int> interiorNumber(pattern.size, -1);
    for (int i = 0; i < pattern.size; ++i)
      if (keptNumber[i] < 0) {
        interiorNumber[i] = static_cast<int>(interiorEquations_.size());
        interiorEquations_.push_back(i);
      }
    const auto interior = static_cast<int>(interiorEquations_.size());
    const auto keptCount = static_cast<int>(kept.size());
    Kbb_ = cut(pattern, interiorNumber, interiorNumber, interior, pattern.symmetric);
    Kbk_ = cut(pattern, interiorNumber, keptNumber, keptCount, false);
    Kkb_ = cut(pattern, keptNumber, interiorNumber, interior, false);
    Kkk_ = cut(pattern, keptNumber, keptNumber, keptCount, false);
    if (interior == 0) return;
    if (pattern.symmetric)
      factorisation_ = std::make_unique<Cholmod>(Kbb_);
    else
      factorisation_ = std::make_unique<Umfpack>(Kbb_);
  }

  bool factorise(const std::vector<double>& values) override {
    stopIfInterrupted();
    for (Block* block : {&Kbb_, &Kbk_, &Kkb_, &Kkk_}) block->take(values);
    if (factorisation_ && !factorisation_->factorise(Kbb_)) return false;
    const auto kept = static_cast<Eigen::Index>(keptEquations_.size());
    schur_.setZero(kept, kept);
    Vector column(static_cast<Eigen::Index>(interiorEquations_.size()));
    for (Eigen::Index j = 0; j < kept; ++j) {
      stopIfInterrupted();
      for (int k = Kkk_.start[j]; k < Kkk_.start[j + 1]; ++k) schur_(Kkk_.rows[k], j) = Kkk_.values[k];
      column.setZero();
      for (int k = Kbk_.start[j]; k < Kbk_.start[j + 1]; ++k) column[Kbk_.rows[k]] = Kbk_.values[k];
      if (factorisation_) factorisation_->solve(Kbb_, column);
      Kkb_.subtractProduct(column.data(), schur_.col(j).data());
    }
    return true;
  }

  [[nodiscard]] const Matrix& schurComplement() const override { return schur_; }
  [[nodiscard]] Matrix takeSchurComplement() override { return std::move(schur_); }
  // f_b becomes K_bb^-1 f_b.
  void condense(Vector& f) const override {
    Vector interior = gather(f, interiorEquations_);
    if (factorisation_) factorisation_->solve(Kbb_, interior);
    Vector kept = gather(f, keptEquations_);
    Kkb_.subtractProduct(interior.data(), kept.data());
    scatter(interior, interiorEquations_, f);
    scatter(kept, keptEquations_, f);
  }

  // x_b = K_bb^-1 f_b - K_bb^-1 K_bk x_k.
  void expand(Vector& f) const override {
    const Vector kept = gather(f, keptEquations_);
    Vector change = Vector::Zero(static_cast<Eigen::Index>(interiorEquations_.size()));
    Kbk_.subtractProduct(kept.data(), change.data());
    if (factorisation_) factorisation_->solve(Kbb_, change);
    scatter(gather(f, interiorEquations_) + change, interiorEquations_, f);
  }

 private:
  static Vector gather(const Vector& f, const std::vector<int>& equations) {
    Vector result(static_cast<Eigen::Index>(equations.size()));
    for (size_t i = 0; i < equations.size(); ++i) result[i] = f[equations[i]];
    return result;
  }

  static void scatter(const Vector& part, const std::vector<int>& equations, Vector& f) {
    for (size_t i = 0; i < equations.size(); ++i) f[equations[i]] = part[i];
  }

  std::vector<int> keptEquations_;
  std::vector<int> interiorEquations_;
  Block Kbb_;
  Block Kbk_;
  Block Kkb_;
  Block Kkk_;
  std::unique_ptr<Factorisation> factorisation_;
  Matrix schur_;
};

}  // namespace

std::unique_ptr<CondensingSolver> suiteSparseSolver(const SparsePattern& pattern,
                                                    const std::vector<int>& kept) {
  return std::make_unique<SuiteSparse>(pattern, kept);
}

}  // namespace mortier
