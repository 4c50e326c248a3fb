#include "solver/friction_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/interrupt.h"

namespace mortier {
namespace {

/// All forces at once: the equations are rows of W where a condition acts, else those of a force that is
/// given,
///   closed: (W x)_i = -q_i,   open: p_i = 0,   stuck: (W x)_k = -q_k,   slipping: t_k -+ mu p = +-c.
/// The inverse is kept, and changed by rank one with every equation.
class Path {
 public:
  Path(const FrictionSystem& system, FrictionSets sets)
      : system_(system),
        W_(system.problem().W),
        law_(system.problem().rows.law),
        node_(system.problem().rows.node),
        n_(system.normals()),
        sets_(std::move(sets)),
        d_(Vector::Zero(W_.rows())),
        unit_(W_.diagonal().cwiseInverse()) {
    constexpr double turn = 0.618033988749895;  // different for all, so that events come one by one
    for (Eigen::Index i = 0; i < W_.rows(); ++i) {
      if (system.idle(i)) unit_[i] = 1;
      const double place = turn * static_cast<double>(i);
      if (i < n_) d_[i] = system.idle(i) ? 0 : (1 + 0.3 * (place - std::floor(place))) / unit_[i];
    }
  }

  /// \param beyond  how far below 0 tau goes, over the largest |q|/d
  /// \returns the sets on the passages through tau = 0: the first one, or all where it goes beyond
  std::vector<FrictionSets> follow(double beyond, int& events) {
    const Eigen::Index most = 200 + 40 * W_.rows();
    constexpr int fresh = 50;
    std::vector<FrictionSets> passages;
    if (!invert()) return passages;
    locate();
    double tau = 0;
    double largest = 0;
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (!(d_[i] > 0)) continue;
      tau = std::max(tau, -motion0_[i] / d_[i]);
      largest = std::max(largest, std::abs(motion0_[i] / d_[i]));
    }
    for (Eigen::Index event = 0; event < most; ++event) {
      stopIfInterrupted();
      if (event > 0 && event % fresh == 0) {
        if (!invert()) return passages;
        locate();
      }
      const double direction = sign_ > 0 ? -1 : 1;
      const Event next = nextEvent(tau, direction);
      if (direction * tau <= 0 && next.step >= -direction * tau) passages.push_back(sets_);
      const bool ends = direction < 0 ? next.step >= tau + beyond * largest : !std::isfinite(next.step);
      if (ends || (beyond == 0 && !passages.empty())) return passages;
      tau += direction * next.step;
      ++events;
      if (!change(next, tau)) return passages;
      locate();
    }
    return passages;
  }

 private:
  struct Event {
    double step = std::numeric_limits<double>::infinity();
    Eigen::Index condition = -1;
    int slip = 0;  ///< of a node that sticks, how it begins to slip
  };

  [[nodiscard]] bool sticks(Eigen::Index k) const {
    return system_.sticks(law_, sets_, static_cast<size_t>(k));
  }

  /// The equation of a condition on the sets.
  [[nodiscard]] Vector equation(Eigen::Index condition) const {
    const Eigen::Index k = condition - n_;
    if (k < 0 ? sets_.closed[condition] != 0 : sticks(k))
      return unit_[condition] * W_.row(condition).transpose();
    Vector row = Vector::Unit(W_.rows(), condition);
    if (k >= 0 && !system_.idle(condition)) row[node_[k]] = -sets_.slip[k] * law_.coefficient[k];
    return row;
  }

  /// The inverse of all equations, and the sign of their determinant.
  bool invert() {
    const Eigen::Index size = W_.rows();
    Matrix A(size, size);
    for (Eigen::Index i = 0; i < size; ++i) A.row(i) = equation(i).transpose();
    DenseFactor factor;
    if (!factor.factorise(std::move(A), false)) return false;
    inverse_ = Matrix::Identity(size, size);
    factor.solve(inverse_);
    sign_ = factor.sign();
    return true;
  }

  /// Puts the present equation of a condition in place of the one before.
  bool replace(Eigen::Index condition) {
    constexpr double negligible = 1e-13;
    Eigen::RowVectorXd along = equation(condition).transpose() * inverse_;
    const double pivot = along[condition];
    if (!(std::abs(pivot) > negligible * along.cwiseAbs().maxCoeff())) return false;
    along[condition] -= 1;
    const Vector column = inverse_.col(condition) / pivot;
    inverse_.noalias() -= column * along;
    if (pivot < 0) sign_ = -sign_;
    return true;
  }

  /// Forces and motions as functions of tau: force0 + tau force1.
  void locate() {
    Vector right0 = Vector::Zero(W_.rows());
    Vector right1 = right0;
    for (Eigen::Index i = 0; i < W_.rows(); ++i) {
      const Eigen::Index k = i - n_;
      if (k < 0 ? sets_.closed[i] != 0 : sticks(k)) {
        right0[i] = -unit_[i] * system_.q()[i];
        right1[i] = -unit_[i] * d_[i];
      } else if (k >= 0 && !system_.idle(i)) {
        right0[i] = sets_.slip[k] * law_.limit[k];
      }
    }
    force0_ = inverse_ * right0;
    force1_ = inverse_ * right1;
    motion0_ = system_.q() + W_ * force0_;
    motion1_ = d_ + W_ * force1_;
  }

  /// Where the first value that must not be negative ends on the way of tau.
  [[nodiscard]] Event nextEvent(double tau, double direction) const {
    Event next;
    const auto consider = [&](double at0, double at1, Eigen::Index condition, int slip) {
      const double slope = direction * at1;
      if (!(slope < 0)) return;
      const double step = std::max(at0 + tau * at1, 0.0) / -slope;
      if (step < next.step) next = {step, condition, slip};
    };
    // Bounds first: a node that sticks reaches one before its pressure ends.
    for (Eigen::Index k = 0; k < W_.rows() - n_; ++k) {
      const Eigen::Index row = n_ + k;
      const int i = node_[k];
      if (sticks(k)) {
        const double mu = law_.coefficient[k];
        for (const int slip : {-1, 1})
          consider(mu * force0_[i] + law_.limit[k] - slip * force0_[row],
                   mu * force1_[i] - slip * force1_[row], row, slip);
      } else if (!system_.idle(row) && (sets_.closed[i] != 0 || law_.limit[k] > 0)) {
        consider(-sets_.slip[k] * motion0_[row] * unit_[row], -sets_.slip[k] * motion1_[row] * unit_[row],
                 row, 0);
      }
    }
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (sets_.closed[i] != 0)
        consider(force0_[i], force1_[i], i, 0);
      else if (!system_.idle(i))
        consider(motion0_[i] * unit_[i], motion1_[i] * unit_[i], i, 0);
    }
    return next;
  }

  bool change(const Event& event, double tau) {
    if (event.condition >= n_) {
      sets_.slip[event.condition - n_] = static_cast<signed char>(event.slip);
      return replace(event.condition);
    }
    sets_.closed[event.condition] = sets_.closed[event.condition] != 0 ? 0 : 1;
    // What closes slips the way its node moves; without a limit, what opens has no t.
    for (size_t k = 0; k < node_.size(); ++k) {
      const auto row = n_ + static_cast<Eigen::Index>(k);
      if (node_[k] != event.condition || law_.limit[row - n_] > 0 || system_.idle(row)) continue;
      if (sets_.closed[event.condition] != 0)
        sets_.slip[k] = motion0_[row] + tau * motion1_[row] > 0 ? -1 : 1;
      if (!replace(row)) return false;
    }
    return replace(event.condition);
  }

  const FrictionSystem& system_;
  const Matrix& W_;
  const FrictionLaw& law_;
  const std::vector<int>& node_;
  Eigen::Index n_;
  FrictionSets sets_;
  Vector d_;
  Vector unit_;  ///< by which equations in lengths become forces
  Matrix inverse_;
  int sign_ = 1;
  Vector force0_, force1_;
  Vector motion0_, motion1_;
};

}  // namespace

std::optional<FrictionSets> followPath(const FrictionSystem& system, FrictionSets first, int& events) {
  std::vector<FrictionSets> passages = Path(system, std::move(first)).follow(0, events);
  if (passages.empty()) return std::nullopt;
  return std::move(passages.front());
}

std::vector<FrictionSets> followPathBeyond(const FrictionSystem& system, FrictionSets first, int& events) {
  constexpr double beyond = 3;
  return Path(system, std::move(first)).follow(beyond, events);
}

}  // namespace mortier
