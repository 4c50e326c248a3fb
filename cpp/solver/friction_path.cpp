// The sets of a contact problem with friction by following a path (Lemke's idea, on sets). With
//   q(tau) = q + tau d,   d > 0 on gaps, on slips 0 or, where a limit c holds, -d/2 max(1, mu) of its gap,
// everything is open and slips for large tau. From there tau decreases to 0; where a force, a gap, a slip or
// the distance of a shear force from its bound becomes zero, the node changes its state and the path
// continues: tau decreases where det A(sets) > 0 and increases where it is negative. For W positive definite
// the only solution of q = d without limits is zero (x'd >= 0), so the path is bounded; no piece of it is
// visited twice, so it ends at tau = 0 (docs/theory.md). The solution found in this way has det A > 0.
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

/// All forces and rigid motions at once: the equations are rows of W where a condition acts, else those of a
/// force that is given,
///   closed: (W x - G z)_i = -q_i,   stuck: (W x - G z)_k = -q_k,   open: p_i = 0,
///   slipping: t_k -+ mu p = +-c.
/// The inverse is kept, and changed by rank one with every equation. What is solved with it is corrected by
/// residuals in twice the working precision: where W is that of thin or of stiff bodies, the next event is
/// found otherwise by rounding.
class Path {
 public:
  explicit Path(const FrictionSystem& system)
      : system_(system),
        W_(system.problem().W),
        G_(system.problem().G),
        law_(system.problem().along.law),
        node_(system.problem().along.node),
        n_(system.normals()),
        motions_(G_.cols()),
        sets_{std::vector<char>(n_, 0), std::vector<signed char>(node_.size(), 1)},
        d_(Vector::Zero(W_.rows())),
        unit_(W_.diagonal().cwiseInverse()) {
    if (motions_ > 0) scale_ = 1 / (unit_.minCoeff() * G_.cwiseAbs().maxCoeff());
    system.holdIdle(sets_);
    openBy();
  }

  std::vector<FrictionSets> follow(double beyond) {
    const Eigen::Index most = 200 + 40 * W_.rows();
    constexpr int fresh = 50;
    std::vector<FrictionSets> passages;
    if (!invert() || !locate(0)) return passages;
    double tau = 0;
    double largest = 0;
    for (Eigen::Index i = 0; i < W_.rows(); ++i) {
      if (d_[i] == 0) continue;
      tau = std::max(tau, -here_.motion[i] / d_[i]);
      largest = std::max(largest, std::abs(here_.motion[i] / d_[i]));
    }
    for (Eigen::Index event = 0; event < most; ++event) {
      stopIfInterrupted();
      if ((event > 0 && event % fresh == 0 && !invert()) || !locate(tau)) return passages;
      const double direction = sign_ > 0 ? -1 : 1;
      const Event next = nextEvent(direction);
      if (direction * tau <= 0 && next.step >= -direction * tau) passages.push_back(sets_);
      const bool ends = direction < 0 ? next.step >= tau + beyond * largest : !std::isfinite(next.step);
      if (ends || (beyond == 0 && !passages.empty())) return passages;
      tau += direction * next.step;
      ++system_.work().events;
      if (!change(next, direction * next.step) && !invert()) return passages;
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
    d_.head(n_) = W_.topLeftCorner(n_, n_) * forces;
    double short_ = 0;
    for (Eigen::Index i = 0; i < n_; ++i)
      if (!system_.idle(i)) short_ = std::max(short_, least - d_[i] * unit_[i]);
    for (Eigen::Index i = 0; i < W_.rows(); ++i) {
      if (system_.idle(i)) {
        unit_[i] = 1;
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

  /// Whether its row of W is an equation of a condition on the sets.
  [[nodiscard]] bool acts(Eigen::Index condition) const {
    return condition < n_ ? sets_.closed[condition] != 0 : sticks(condition - n_);
  }

  /// The equation of a condition on the sets.
  [[nodiscard]] Vector equation(Eigen::Index condition) const {
    Vector row = Vector::Zero(W_.rows() + motions_);
    if (acts(condition)) {
      row.head(W_.rows()) = unit_[condition] * W_.row(condition).transpose();
      if (motions_ > 0) row.tail(motions_) = -unit_[condition] * scale_ * G_.row(condition).transpose();
      return row;
    }
    row[condition] = 1;
    if (condition >= n_ && !system_.idle(condition))
      row[node_[condition - n_]] = -sets_.slip[condition - n_] * law_.coefficient[condition - n_];
    return row;
  }

  /// The inverse of all equations, and the sign of their determinant.
  bool invert() {
    const Eigen::Index size = W_.rows();
    Matrix A(size + motions_, size + motions_);
    for (Eigen::Index i = 0; i < size; ++i) A.row(i) = equation(i).transpose();
    if (motions_ > 0) {
      A.bottomLeftCorner(motions_, size) = balanceUnit() * G_.transpose();
      A.bottomRightCorner(motions_, motions_) =
          balanceUnit() * scale_ * system_.springs().stiffness * Matrix::Identity(motions_, motions_);
    }
    DenseFactor factor;
    if (!factor.factorise(std::move(A), false)) return false;
    inverse_ = Matrix::Identity(size + motions_, size + motions_);
    factor.solve(inverse_);
    sign_ = factor.sign();
    return true;
  }
  [[nodiscard]] double balanceUnit() const { return 1 / G_.cwiseAbs().maxCoeff(); }

  /// Puts the present equation of a condition in place of the one before.
  bool replace(Eigen::Index condition) {
    constexpr double negligible = 1e-8;  // less is left to an inverse that is made anew
    Eigen::RowVectorXd along = equation(condition).transpose() * inverse_;
    const double pivot = along[condition];
    if (!(std::abs(pivot) > negligible * along.cwiseAbs().maxCoeff())) return false;
    along[condition] -= 1;
    const Vector column = inverse_.col(condition) / pivot;
    inverse_.noalias() -= column * along;
    if (pivot < 0) sign_ = -sign_;
    return true;
  }

  /// Forces and motions, or how they change with tau.
  struct Place {
    Vector force;
    Vector motion;
  };

  /// Solves the equations with q * part + d * tau.
  bool solve(double part, double tau, Place& place) const {
    const Eigen::Index size = W_.rows();
    TwoPartVector x = TwoPartVector::zero(size);
    TwoPartVector z = TwoPartVector::zero(motions_);
    std::optional<Corrections> corrections;
    Vector rest(size + motions_);
    TwoPartSums start(part * system_.q());
    start.add(d_, {Vector::Constant(1, tau), Vector::Zero(1)});
    while (true) {
      place.motion = system_.motionOf(start, x, z);
      for (Eigen::Index i = 0; i < size; ++i) {
        if (acts(i)) {
          rest[i] = -unit_[i] * place.motion[i];
        } else {
          const Eigen::Index k = i - n_;
          const bool slips = k >= 0 && !system_.idle(i);
          rest[i] = slips ? part * sets_.slip[k] * law_.limit[k] : 0;
          if (slips) rest[i] += sets_.slip[k] * law_.coefficient[k] * x.high[node_[k]];
          rest[i] -= x.high[i];
          if (slips) rest[i] += sets_.slip[k] * law_.coefficient[k] * x.low[node_[k]];
          rest[i] -= x.low[i];
        }
      }
      if (motions_ > 0) rest.tail(motions_) = balanceUnit() * system_.unbalanced(part, x, z);
      const Vector change = inverse_ * rest;
      if (!corrections) {
        const Vector cancels = inverse_.cwiseAbs() * rest.cwiseAbs();
        corrections.emplace(std::max(cancels.head(size).maxCoeff(), rest.lpNorm<Eigen::Infinity>()));
      }
      x += change.head(size);
      z += scale_ * change.tail(motions_);
      place.force = x.value();
      if (!corrections->goOn(change.head(size).lpNorm<Eigen::Infinity>(),
                             place.force.lpNorm<Eigen::Infinity>()))
        break;
    }
    place.motion = system_.motionOf(start, x, z);
    return !corrections->failed();
  }

  bool locate(double tau) {
    if (solve(1, tau, here_) && solve(0, 1, slope_)) return true;
    return invert() && solve(1, tau, here_) && solve(0, 1, slope_);
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
    for (Eigen::Index k = 0; k < W_.rows() - n_; ++k) {
      const Eigen::Index row = n_ + k;
      const int i = node_[k];
      if (sticks(k)) {
        const double mu = law_.coefficient[k];
        for (const int slip : {-1, 1})
          consider(mu * here_.force[i] + law_.limit[k] - slip * here_.force[row],
                   mu * slope_.force[i] - slip * slope_.force[row], row, slip);
      } else if (!system_.idle(row) && (sets_.closed[i] != 0 || law_.limit[k] > 0)) {
        consider(-sets_.slip[k] * here_.motion[row] * unit_[row],
                 -sets_.slip[k] * slope_.motion[row] * unit_[row], row, 0);
      }
    }
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (sets_.closed[i] != 0)
        consider(here_.force[i], slope_.force[i], i, 0);
      else if (!system_.idle(i))
        consider(here_.motion[i] * unit_[i], slope_.motion[i] * unit_[i], i, 0);
    }
    return next;
  }

  bool change(const Event& event, double moved) {
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
        sets_.slip[k] = here_.motion[row] + moved * slope_.motion[row] > 0 ? -1 : 1;
      if (!replace(row)) return false;
    }
    return replace(event.condition);
  }

  const FrictionSystem& system_;
  const Matrix& W_;
  const Matrix& G_;
  const FrictionLaw& law_;
  const std::vector<int>& node_;
  Eigen::Index n_;
  Eigen::Index motions_;
  FrictionSets sets_;
  Vector d_;
  Vector unit_;       ///< by which equations in lengths become forces
  double scale_ = 1;  ///< of rigid motions
  Matrix inverse_;
  int sign_ = 1;
  Place here_;
  Place slope_;
};

}  // namespace

std::vector<FrictionSets> followPath(const FrictionSystem& system, double beyond) {
  return Path(system).follow(beyond);
}

}  // namespace mortier
