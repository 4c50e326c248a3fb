// The sets of a contact problem with friction by path following (Lemke's method, on sets). With
//   q(tau) = q + tau d,   d > 0 on gaps, on slips 0 or, where a limit c holds, -d/2 max(1, mu) of its gap,
// 1. for large tau all conditions are open and slip: the path begins there, and tau decreases;
// 2. at the first tau where a force, a gap, a slip or the distance of a shear force from its bound vanishes,
//    the node changes its state;
// 3. tau decreases where det A(sets) > 0 and increases where it is negative, until it is 0.
// For W positive definite the only solution of q = d without limits is zero (x'd >= 0): the path is bounded,
// and no piece of it is visited twice, so it ends at tau = 0 (docs/theory.md), with det A > 0.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "base/two_part_vector.h"
#include "solver/friction_sets.h"

namespace mortier {
namespace {

class Path {
 public:
  explicit Path(const FrictionSystem& system)
      : system_(system),
        law_(system.problem().along.law),
        node_(system.problem().along.node),
        n_(system.normals()),
        sets_{std::vector<char>(n_, 0), std::vector<signed char>(node_.size(), 1)},
        d_(Vector::Zero(system.q().size())),
        unit_(system.compliance().cwiseInverse()) {
    system.holdIdle(sets_);
    openBy();
  }

  std::vector<FrictionSets> follow(double beyond) {
    const Eigen::Index most = 200 + 40 * d_.size();
    std::vector<FrictionSets> passages;
    if (!locate(0)) return passages;
    double tau = 0;
    double largest = 0;
    for (Eigen::Index i = 0; i < d_.size(); ++i) {
      if (d_[i] == 0) continue;
      tau = std::max(tau, -here_->motion[i] / d_[i]);
      largest = std::max(largest, std::abs(here_->motion[i] / d_[i]));
    }
    for (Eigen::Index event = 0; event < most; ++event) {
      stopIfInterrupted();
      if (!locate(tau)) return passages;
      const double direction = here_->index > 0 ? -1 : 1;
      const Event next = nextEvent(direction);
      if (direction * tau <= 0 && next.step >= -direction * tau) passages.push_back(sets_);
      const bool ends = direction < 0 ? next.step >= tau + beyond * largest : !std::isfinite(next.step);
      if (ends || (beyond == 0 && !passages.empty())) return passages;
      tau += direction * next.step;
      ++system_.work().events;
      change(next, direction * next.step);
    }
    return passages;
  }

 private:
  struct Event {
    double step = std::numeric_limits<double>::infinity();
    Eigen::Index condition = -1;
    int slip = 0;  ///< of a node that sticks, how it begins to slip
  };

  [[nodiscard]] bool sticks(Eigen::Index k) const { return system_.sticks(sets_, k); }

  /// d: gaps as uniform forces open them, that forces of the path are of their size; a little different for
  /// all, so that events come one by one. What shear limits hold slips.
  void openBy() {
    constexpr double turn = 0.618033988749895;
    constexpr double least = 0.1;
    Vector forces = Vector::Zero(n_);
    for (Eigen::Index i = 0; i < n_; ++i) {
      const double place = turn * static_cast<double>(i);
      if (!system_.idle(i)) forces[i] = 1 + 0.3 * (place - std::floor(place));
    }
    d_.head(n_) = system_.problem().W.topLeftCorner(n_, n_) * forces;
    double short_ = 0;
    for (Eigen::Index i = 0; i < n_; ++i)
      if (!system_.idle(i)) short_ = std::max(short_, least - d_[i] * unit_[i]);
    for (Eigen::Index i = 0; i < d_.size(); ++i) {
      if (system_.idle(i)) {
        d_[i] = 0;
      } else if (i < n_) {
        d_[i] += short_ * forces[i] / unit_[i];
      } else if (law_.limit[i - n_] > 0) {
        const int node = node_[i - n_];
        d_[i] =
            -0.5 * (system_.idle(node) ? 1 / unit_[i] : d_[node]) / std::max(1.0, law_.coefficient[i - n_]);
      }
    }
  }

  /// The solution at tau, and how it changes with tau. \returns false where the equations are singular.
  bool locate(double tau) {
    const HeldSystem equations(system_.problem(), system_.heldOn(sets_), 0, system_.springs().stiffness);
    if (!(equations.leastPivot() > 0)) return false;
    TwoPartSums shifted(system_.q());
    shifted.add(d_, {Vector::Constant(1, tau), Vector::Zero(1)});
    here_ = system_.solve(equations, sets_, 1, shifted);
    slope_ = system_.solve(equations, sets_, 0, TwoPartSums(d_));
    return here_ && slope_;
  }

  /// Where the first value that must not be negative ends on the way of tau.
  [[nodiscard]] Event nextEvent(double direction) const {
    Event next;
    const auto consider = [&](double at, double along, Eigen::Index condition, int slip) {
      const double slope = direction * along;
      if (!(slope < 0)) return;
      const double step = std::max(at, 0.0) / -slope;
      if (step < next.step) next = {step, condition, slip};
    };
    // Bounds first: a node that sticks reaches one before its pressure ends.
    for (Eigen::Index k = 0; k < d_.size() - n_; ++k) {
      const Eigen::Index row = n_ + k;
      const int i = node_[k];
      if (sticks(k)) {
        const double mu = law_.coefficient[k];
        for (const int slip : {-1, 1})
          consider(mu * here_->force[i] + law_.limit[k] - slip * here_->force[row],
                   mu * slope_->force[i] - slip * slope_->force[row], row, slip);
      } else if (!system_.idle(row) && (sets_.closed[i] != 0 || law_.limit[k] > 0)) {
        consider(-sets_.slip[k] * here_->motion[row] * unit_[row],
                 -sets_.slip[k] * slope_->motion[row] * unit_[row], row, 0);
      }
    }
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (sets_.closed[i] != 0)
        consider(here_->force[i], slope_->force[i], i, 0);
      else if (!system_.idle(i))
        consider(here_->motion[i] * unit_[i], slope_->motion[i] * unit_[i], i, 0);
    }
    return next;
  }

  void change(const Event& event, double moved) {
    if (event.condition >= n_) {
      sets_.slip[event.condition - n_] = static_cast<signed char>(event.slip);
      return;
    }
    sets_.closed[event.condition] = sets_.closed[event.condition] != 0 ? 0 : 1;
    if (sets_.closed[event.condition] == 0) return;
    // What closes slips the way its node moves.
    for (size_t k = 0; k < node_.size(); ++k) {
      const auto row = n_ + static_cast<Eigen::Index>(k);
      if (node_[k] == event.condition && !(law_.limit[row - n_] > 0) && !system_.idle(row))
        sets_.slip[k] = here_->motion[row] + moved * slope_->motion[row] > 0 ? -1 : 1;
    }
  }

  const FrictionSystem& system_;
  const FrictionLaw& law_;
  const std::vector<int>& node_;
  Eigen::Index n_;
  FrictionSets sets_;
  Vector d_;
  Vector unit_;  ///< by which motions become forces
  std::optional<FrictionSolution> here_;
  std::optional<FrictionSolution> slope_;
};

}  // namespace

std::vector<FrictionSets> followPath(const FrictionSystem& system, double beyond) {
  return Path(system).follow(beyond);
}

}  // namespace mortier
