// The libraries as engine: K_bb factorised by CHOLMOD or UMFPACK, S column by column. Check and fallback of
// the multifrontal engine, and the reference that its speed is measured against.
#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
#include <Eigen/UmfPackSupport>
#include <stdexcept>
#include <utility>

#include "base/interrupt.h"
#include "linear/cholmod_common.h"
#include "linear/condensing_solver.h"

namespace mortier {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Cholmod = Eigen::CholmodSupernodalLLT<Sparse>;
using Umfpack = Eigen::UmfPackLU<Sparse>;

void orderByMetis(Cholmod& engine) {
  cholmod_common& common = engine.cholmod();
  common.print = 0;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_METIS;
  common.quick_return_if_not_posdef = 1;
}
void orderByMetis(Umfpack& engine) {
  engine.umfpackControl()[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
}

/// \tparam Engine  that factorises K_bb: Cholmod or Umfpack
template <class Engine>
class SuiteSparse final : public CondensingSolver {
 public:
  SuiteSparse(const SparsePattern& pattern, const std::vector<int>& kept)
      : pattern_(pattern),
        kept_(static_cast<Eigen::Index>(kept.size())),
        interior_(pattern.size - kept_),
        order_(pattern.size) {
    order_.indices().setConstant(-1);
    for (Eigen::Index k = 0; k < kept_; ++k) order_.indices()[kept[k]] = static_cast<int>(interior_ + k);
    int next = 0;
    for (int& place : order_.indices())
      if (place < 0) place = next++;
    if (interior_ == 0) return;
    split(std::vector<double>(pattern.rows.size(), 1.0));
    orderByMetis(engine_);
    const std::lock_guard alone(metisInUse);
    engine_.analyzePattern(Kbb_);
    if (engine_.info() != Eigen::Success) throw std::runtime_error("symbolic analysis failed in SuiteSparse");
  }

  bool factorise(const std::vector<double>& values) override {
    stopIfInterrupted();
    split(values);
    if (interior_ > 0) engine_.factorize(Kbb_);
    if (interior_ > 0 && engine_.info() != Eigen::Success) return false;
    schur_ = Kkk_;
    for (Eigen::Index j = 0; j < kept_; ++j) {
      stopIfInterrupted();
      schur_.col(j) -= Kkb_ * solved(Kbk_.col(j));
    }
    return true;
  }

  [[nodiscard]] const Matrix& schurComplement() const override { return schur_; }
  [[nodiscard]] Matrix takeSchurComplement() override { return std::move(schur_); }

  // f_b becomes K_bb^-1 f_b.
  void condense(Vector& f) const override {
    Vector x = order_ * f;
    x.head(interior_) = solved(x.head(interior_));
    x.tail(kept_) -= Kkb_ * x.head(interior_);
    f = order_.transpose() * x;
  }

  // x_b = K_bb^-1 f_b - K_bb^-1 K_bk x_k.
  void expand(Vector& f) const override {
    Vector x = order_ * f;
    x.head(interior_) -= solved(Kbk_ * x.tail(kept_));
    f = order_.transpose() * x;
  }

 private:
  /// The blocks of K, with entries by rows as the libraries take them.
  void split(const std::vector<double>& values) {
    const Eigen::Map<const Sparse> held(pattern_.size, pattern_.size, pattern_.entries(),
                                        pattern_.columnStart.data(), pattern_.rows.data(), values.data());
    Sparse K = held;
    if (pattern_.symmetric) K = held.selfadjointView<Eigen::Lower>();
    Sparse ordered;
    ordered = K.twistedBy(order_);
    const Sparse transposed = ordered.transpose();
    K = transposed.transpose();
    Kbb_ = K.topLeftCorner(interior_, interior_);
    Kbk_ = K.topRightCorner(interior_, kept_);
    Kkb_ = K.bottomLeftCorner(kept_, interior_);
    Kkk_ = K.bottomRightCorner(kept_, kept_);
  }

  [[nodiscard]] Vector solved(const Vector& b) const {
    if (interior_ == 0) return b;
    const Vector x = engine_.solve(b);
    if (engine_.info() != Eigen::Success) throw std::runtime_error("solve failed in SuiteSparse");
    return x;
  }

  SparsePattern pattern_;
  Eigen::Index kept_, interior_;
  Eigen::PermutationMatrix<Eigen::Dynamic> order_;  ///< of equations: the interior, then the kept ones
  Sparse Kbb_, Kbk_, Kkb_, Kkk_;
  Engine engine_;
  Matrix schur_;
};

}  // namespace

std::unique_ptr<CondensingSolver> suiteSparseSolver(const SparsePattern& pattern,
                                                    const std::vector<int>& kept) {
  if (pattern.symmetric) return std::make_unique<SuiteSparse<Cholmod>>(pattern, kept);
  return std::make_unique<SuiteSparse<Umfpack>>(pattern, kept);
}

}  // namespace mortier
