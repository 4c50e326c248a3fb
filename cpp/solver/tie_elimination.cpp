#include "solver/tie_elimination.h"

#include <cmath>
#include <utility>

#include "base/dense_templates.h"
#include "solver/contact_sets.h"

namespace mortier {
namespace {

/// A pivot below this fraction of its value before elimination is rounding.
constexpr double singular = 1e-12;

}  // namespace

void TieElimination::setMotions(Matrix G, Eigen::Index ties) {
  G_ = std::move(G);
  ties_ = ties;
  taken_ = false;
  if (ties == 0) return;
  const Matrix ofTies = G_.bottomRows(ties);
  RigidMotions motions = rigidMotionsOn(std::vector<char>(ties, 1), ofTies);
  held_ = std::move(motions.held);
  free_ = std::move(motions.free);
  heldTies_ = ofTies * held_;
}

Matrix TieElimination::contactMotions() const {
  return ties_ == 0 ? G_ : Matrix(G_.topRows(G_.rows() - ties_) * free_);
}

Matrix TieElimination::take(Matrix W, bool symmetric) {
  taken_ = true;
  if (ties_ == 0) return W;
  const Eigen::Index n = W.rows() - ties_;
  const Eigen::Index motions = held_.cols();
  const Matrix Wtt = W.bottomRightCorner(ties_, ties_);
  dependent_.reset();
  stiffness_.clear();
  bool regular = compliance_.factorise(Matrix(Wtt), symmetric) && compliance_.leastPivot() > singular;
  if (regular && motions > 0) {
    carried_ = heldTies_;
    compliance_.solve(carried_);
    regular = stiffness_.factorise(Matrix(heldTies_.transpose() * carried_), symmetric);
  }
  if (!regular) {
    // Ties that say the same twice: the least of their forces are taken.
    unit_ = Wtt.diagonal().cwiseAbs().maxCoeff();
    Matrix A = Matrix::Zero(ties_ + motions, ties_ + motions);
    A.topLeftCorner(ties_, ties_) = Wtt / unit_;
    A.topRightCorner(ties_, motions) = -heldTies_;
    A.bottomLeftCorner(motions, ties_) = -heldTies_.transpose();
    dependent_.emplace();
    dependent_->setThreshold(singular);
    dependent_->compute(A);
  }
  across_.resize(n, ties_ + motions);
  across_ << W.topRightCorner(n, ties_), -G_.topRows(n) * held_;
  Matrix B(ties_ + motions, n);
  B << W.bottomLeftCorner(ties_, n), -(G_.topRows(n) * held_).transpose();
  solved_ = solve(B);
  Matrix reduced = W.topLeftCorner(n, n) - across_ * solved_;
  if (symmetric) reduced = ((reduced + reduced.transpose()) / 2).eval();
  return reduced;
}

Matrix TieElimination::solve(const Matrix& right) const {
  const Eigen::Index motions = held_.cols();
  Matrix x = right;
  if (dependent_) {
    x.topRows(ties_) /= unit_;
    x = dependent_->solve(x).eval();
    x.bottomRows(motions) *= unit_;
    return x;
  }
  // l = W_tt^-1 (f + G_t H h),   (G_t H)' l = -g.
  Matrix l = right.topRows(ties_);
  compliance_.solve(l);
  if (motions > 0) {
    Matrix h = -right.bottomRows(motions) - heldTies_.transpose() * l;
    stiffness_.solve(h);
    l += carried_ * h;
    x.bottomRows(motions) = h;
  }
  x.topRows(ties_) = l;
  return x;
}

/// (t0, H' r)
Matrix TieElimination::lower(const Whole& whole) const {
  Matrix right(ties_ + held_.cols(), 1);
  right << whole.slack.tail(ties_), held_.transpose() * whole.balance;
  return right;
}

TieElimination::Whole TieElimination::reduced(const Whole& whole) const {
  if (ties_ == 0) return whole;
  const auto& [slack, balance] = whole;
  return {slack.head(slack.size() - ties_) - across_ * solve(lower(whole)), free_.transpose() * balance};
}

ContactSolution TieElimination::completed(ContactSolution solution, const Whole& whole) const {
  if (ties_ == 0) return solution;
  const Vector dp = solution.change;
  const Vector x = -solve(lower(whole)) - solved_ * dp;
  solution.change.resize(dp.size() + ties_);
  solution.change << dp, x.head(ties_);
  solution.rigid = free_ * solution.rigid + held_ * x.tail(held_.cols());
  return solution;
}

}  // namespace mortier
