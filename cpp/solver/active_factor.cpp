#include "solver/active_factor.h"

#include <algorithm>
#include <utility>

#include "base/dense_templates.h"

namespace mortier {
namespace {

/// A pivot below this part of what it was before elimination is nothing but rounding.
constexpr double singular = 1e-12;

/// Sets smaller than this are factorised anew: updates would cost as much.
constexpr int smallSet = 48;

/// The border grows up to this part of the base.
constexpr int partOfBase = 8;

}  // namespace

ActiveFactor::ActiveFactor(const Matrix& W, bool symmetric, double& work)
    : W_(W),
      symmetric_(symmetric),
      unit_(W.size() > 0 ? W.diagonal().cwiseAbs().maxCoeff() : 0),
      placeOf_(W.rows(), -1),
      bordered_(W.rows(), 0),
      work_(work) {}

bool ActiveFactor::refactor(const std::vector<char>& active) {
  border_.clear();
  std::fill(bordered_.begin(), bordered_.end(), 0);
  base_.clear();
  for (size_t i = 0; i < active.size(); ++i) {
    placeOf_[i] = active[i] != 0 ? static_cast<int>(base_.size()) : -1;
    if (active[i] != 0) base_.push_back(static_cast<int>(i));
  }
  if (factoriseBase()) return true;
  base_.clear();
  std::fill(placeOf_.begin(), placeOf_.end(), -1);
  return false;
}

bool ActiveFactor::factoriseBase() {
  const auto n = static_cast<Eigen::Index>(base_.size());
  factor_.clear();
  if (n == 0) return true;
  Matrix block(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = symmetric_ ? j : 0; i < n; ++i) block(i, j) = W_(base_[i], base_[j]);
  const double cube = static_cast<double>(n) * static_cast<double>(n) * static_cast<double>(n);
  work_ += cube / (symmetric_ ? 3 : 1.5);
  return factor_.factorise(std::move(block), symmetric_) && factor_.leastPivot() > singular;
}

void ActiveFactor::solveBase(Matrix& x) {
  work_ += 2 * static_cast<double>(factor_.rows() * factor_.rows()) * static_cast<double>(x.cols());
  factor_.solve(x);
}

/// The condition's row of the bordered matrix over B.
Vector ActiveFactor::rowOfBorder(int condition) const {
  if (placeOf_[condition] < 0) {
    if (symmetric_) return W_.col(condition)(base_);
    return W_.row(condition)(base_).transpose();
  }
  Vector row = Vector::Zero(static_cast<Eigen::Index>(base_.size()));
  row[placeOf_[condition]] = unit_;
  return row;
}

/// All at once: one by one, each solve would read the factors anew.
void ActiveFactor::insert(const std::vector<int>& conditions) {
  const auto n = static_cast<Eigen::Index>(base_.size());
  const auto k = static_cast<Eigen::Index>(border_.size());
  const auto count = static_cast<Eigen::Index>(conditions.size());
  if (count == 0) return;
  if (rows_.rows() != n || rows_.cols() < k + count) {
    const Eigen::Index room = std::max(k + count, n / partOfBase + 1);
    rows_.conservativeResize(n, room);
    solved_.conservativeResize(n, room);
    schur_.conservativeResize(room, room);
  }
  Matrix columns(n, count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const int condition = conditions[c];
    rows_.col(k + c) = rowOfBorder(condition);
    columns.col(c) = placeOf_[condition] < 0 ? Vector(W_.col(condition)(base_)) : Vector(rows_.col(k + c));
    border_.push_back(condition);
    bordered_[condition] = 1;
  }
  solveBase(columns);
  solved_.middleCols(k, count) = columns;
  schur_.block(0, k, k + count, count).noalias() = -rows_.leftCols(k + count).transpose() * columns;
  schur_.block(k, 0, count, k).noalias() = -rows_.middleCols(k, count).transpose() * solved_.leftCols(k);
  work_ += 2 * static_cast<double>(n) * static_cast<double>(count) * static_cast<double>(2 * k + count);
  for (Eigen::Index j = k; j < k + count; ++j) {
    if (placeOf_[border_[j]] >= 0) continue;
    for (Eigen::Index i = 0; i <= j; ++i) {
      if (placeOf_[border_[i]] >= 0) continue;
      schur_(i, j) += W_(border_[i], border_[j]);
      if (i < j) schur_(j, i) += W_(border_[j], border_[i]);
    }
  }
}

void ActiveFactor::remove(int place) {
  const auto last = static_cast<Eigen::Index>(border_.size()) - 1;
  bordered_[border_[place]] = 0;
  border_[place] = border_[last];
  border_.pop_back();
  if (place == last) return;
  rows_.col(place) = rows_.col(last);
  solved_.col(place) = solved_.col(last);
  schur_.col(place).head(last + 1) = schur_.col(last).head(last + 1).eval();
  schur_.row(place).head(last + 1) = schur_.row(last).head(last + 1).eval();
}

bool ActiveFactor::take(const std::vector<char>& active) {
  std::vector<int> changed;
  int size = 0;
  for (size_t i = 0; i < active.size(); ++i) {
    size += active[i] != 0 ? 1 : 0;
    if ((active[i] != 0) != (placeOf_[i] >= 0)) changed.push_back(static_cast<int>(i));
  }
  if (changed.empty() && border_.empty()) return true;
  if (size < smallSet || partOfBase * changed.size() > base_.size()) return refactor(active);
  for (int place = static_cast<int>(border_.size()); place-- > 0;)
    if ((active[border_[place]] != 0) == (placeOf_[border_[place]] >= 0)) remove(place);
  std::erase_if(changed, [&](int condition) { return bordered_[condition] != 0; });
  insert(changed);
  const auto k = static_cast<Eigen::Index>(border_.size());
  if (k == 0) return true;
  const Matrix schur = schur_.topLeftCorner(k, k);
  schurFactor_.compute(schur);
  work_ += 2.0 / 3 * static_cast<double>(k) * static_cast<double>(k) * static_cast<double>(k);
  // Close to singular: factors of the set itself tell.
  constexpr double doubtful = 1e-9;
  if (!(schurFactor_.matrixLU().diagonal().cwiseAbs().minCoeff() > doubtful * unit_)) return refactor(active);
  return true;
}

void ActiveFactor::solve(Matrix& right) {
  if (base_.empty()) {
    right.setZero();
    return;
  }
  const auto k = static_cast<Eigen::Index>(border_.size());
  Matrix x = right(base_, Eigen::all);
  Matrix y(k, right.cols());
  for (Eigen::Index i = 0; i < k; ++i) {
    const int place = placeOf_[border_[i]];
    y.row(i).setZero();
    if (place >= 0)
      x.row(place).setZero();
    else
      y.row(i) = right.row(border_[i]);
  }
  solveBase(x);
  if (k > 0) {
    y -= rows_.leftCols(k).transpose() * x;
    y = schurFactor_.solve(y).eval();
    x -= solved_.leftCols(k) * y;
    work_ += 4 * static_cast<double>(x.size()) * static_cast<double>(k);
  }
  right.setZero();
  right(base_, Eigen::all) = x;
  for (Eigen::Index i = 0; i < k; ++i) {
    if (placeOf_[border_[i]] < 0)
      right.row(border_[i]) = y.row(i);
    else
      right.row(border_[i]).setZero();
  }
}

}  // namespace mortier
