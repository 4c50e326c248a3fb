// A stage where contact follows the bodies. Its rows, distances and normals depend on where the bodies are at
// the end of the stage:
//
//   geometry at u_k  ->  contact problem with these rows, solved exactly  ->  u_(k+1)
//
// is repeated until the solution fulfils its conditions on the geometry at u_(k+1) too (docs/sliding.md). The
// first geometry is that of the guess.
#include <algorithm>
#include <limits>
#include <utility>

#include "base/dense_templates.h"
#include "base/formatted.h"
#include "fem/rigid_modes.h"
#include "time/measure.h"
#include "time/step_taker.h"

namespace mortier {
namespace {

/// How far a solution is off its conditions on other rows, as forces over the largest contact force [-]; gaps
/// that are rounding of places are none.
double misfit(const Model& model, const std::vector<Vector>& gap0, const Iterate& iterate,
              const Vector& compliance, double rounding) {
  if (compliance.size() == 0) return 0;  // at rest, without a linear solve
  const std::vector<Vector> gap = gaps(model, gap0, iterate);
  const std::vector<Vector> slip = slips(model, iterate);
  double force = 0;
  double off = 0;
  Eigen::Index row = 0;
  const auto add = [&](double by, Eigen::Index condition) {
    if (by <= rounding) return;
    off = std::max(off, by / (compliance[condition] > 0 ? compliance[condition] : compliance.maxCoeff()));
  };
  for (size_t k = 0; k < gap.size(); ++k) {
    if (gap[k].size() > 0) force = std::max(force, iterate.contactForce[k].maxCoeff());
    for (Eigen::Index i = 0; i < gap[k].size(); ++i, ++row)
      add(iterate.active[k][i] != 0 ? std::abs(gap[k][i]) : gap[k][i], row);
  }
  for (size_t k = 0; k < slip.size(); ++k) {
    const int m = model.interfaces[k].slipComponents();
    const Vector bound = model.interfaces[k].frictionBound(iterate.contactForce[k]);
    for (Eigen::Index i = 0; m * i < slip[k].size(); ++i, row += m) {
      if (!(bound[i] > 0)) continue;
      const auto slipped = slip[k].segment(m * i, m);
      if (iterate.slipping[k][i] == 0) {
        add(slipped.norm(), row);
        continue;
      }
      const Vector direction = iterate.frictionForce[k].segment(m * i, m) / bound[i];
      const double forwards = direction.dot(slipped);
      add(-forwards, row);
      // Across it a force turns with the slip.
      const double aside = (slipped - forwards * direction).norm();
      if (aside > rounding) off = std::max(off, aside / (compliance[row] + slipped.norm() / bound[i]));
    }
  }
  if (off == 0) return 0;
  return force > 0 ? off / force : std::numeric_limits<double>::infinity();
}

/// What rounding makes of the places of bodies [m].
double roundingOfPlaces(const Model& model, const std::vector<Vector>& u) {
  constexpr double roundings = 16 * std::numeric_limits<double>::epsilon();
  double largest = 0;
  for (size_t b = 0; b < u.size(); ++b)
    model.bodies[b].withMesh([&](const auto&, const auto& nodes) {
      const Eigen::Index n = nodes.places.front().size();
      for (Eigen::Index node = 0; node < nodes.count(); ++node)
        largest = std::max(
            largest, (nodes.places[node] + u[b].segment(n * node, n)).template lpNorm<Eigen::Infinity>());
    });
  return roundings * largest;
}

std::vector<Vector> incrementsOf(const Iterate& iterate) {
  std::vector<Vector> result;
  for (const auto& body : iterate.bodies) result.push_back(body.increment.value());
  return result;
}

Vector inOne(const std::vector<Vector>& parts) {
  Eigen::Index size = 0;
  for (const Vector& part : parts) size += part.size();
  Vector result(size);
  size = 0;
  for (const Vector& part : parts) {
    result.segment(size, part.size()) = part;
    size += part.size();
  }
  return result;
}

/// How far bodies move from where their rows are, repetition by repetition: towards a state, or away.
class Repetitions {
 public:
  /// \param rows  increments of the bodies where the rows are [m]
  explicit Repetitions(std::vector<Vector> rows) : rows_(std::move(rows)), at_(inOne(rows_)) {}

  /// Takes the increments that were found with the rows.
  void add(const std::vector<Vector>& found) {
    const Vector before = std::exchange(change_, inOne(found) - at_);
    const double square = change_.squaredNorm();
    along_ = before.size() > 0 ? change_.dot(before) : 0;
    approaches_ = square < square_;
    grown_ = along_ > 0 && !approaches_ ? grown_ + 1 : 0;
    square_ = square;
    if (before.size() == 0) return;
    last_.push_back({step_, change_ - before});
    if (last_.size() > depth) last_.erase(last_.begin());
  }

  /// Where the next rows are to be: where the bodies are, or once changes swing about a state, where they
  /// would vanish if they were linear in the last ones (Anderson's acceleration).
  const std::vector<Vector>& goOn(bool mayRelax) {
    relaxes_ = relaxes_ || (mayRelax && along_ < 0);
    step_ = change_;
    if (relaxes_) {
      Matrix changes(change_.size(), static_cast<Eigen::Index>(last_.size()));
      for (size_t k = 0; k < last_.size(); ++k) changes.col(static_cast<Eigen::Index>(k)) = last_[k].ofChange;
      const Vector shares = changes.colPivHouseholderQr().solve(change_);
      for (size_t k = 0; k < last_.size(); ++k)
        step_ -= shares[static_cast<Eigen::Index>(k)] * (last_[k].ofRows + last_[k].ofChange);
    }
    at_ += step_;
    Eigen::Index begin = 0;
    for (Vector& body : rows_) {
      body = at_.segment(begin, body.size());
      begin += body.size();
    }
    return rows_;
  }
  [[nodiscard]] bool relaxes() const { return relaxes_; }
  [[nodiscard]] bool approaches() const { return approaches_; }  ///< the last change is less than that before
  /// Of a body that contact alone holds, the rigid motion in words by which the last repetition moves it: it
  /// finds no place where contact carries its load. A tool moves as a rigid body whatever the reason is, and
  /// is named only where the last repetitions move it on and on. Empty where there is none.
  [[nodiscard]] std::string whatFalls(const Model& model) const;

 private:
  struct Difference {
    Vector ofRows, ofChange;
  };
  static constexpr size_t depth = 5;
  std::vector<Vector> rows_;
  Vector at_;  ///< the same in one
  Vector change_, step_;
  std::vector<Difference> last_;
  double square_ = infinity;
  double along_ = 0;
  bool relaxes_ = false;
  bool approaches_ = true;
  int grown_ = 0;  ///< repetitions, the last of them
};

std::string Repetitions::whatFalls(const Model& model) const {
  constexpr double strained = 0.3;  // part of a change that is none of the body as drawn, which has turned
  constexpr int enough = 4;         // changes of a cycle go back before
  Eigen::Index begin = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const Vector change = change_.segment(begin, rows_[b].size());
    begin += change.size();
    if (body.rigid() && grown_ < enough) continue;
    const Matrix modes = rigidModes(body);
    if (modes.cols() == 0 || change.isZero(0)) continue;
    const Vector motion = modes * modes.colPivHouseholderQr().solve(change);
    if ((change - motion).norm() <= strained * change.norm())
      return "body " + body.name() + ": " + describeRigidMotion(body, motion);
  }
  return {};
}

}  // namespace

/// Rows where increments bring the bodies. \returns the gaps of the state by these rows
std::vector<Vector> StepTaker::followTo(const std::vector<Vector>& increments, bool keepRows) {
  std::vector<Vector> u;
  for (size_t b = 0; b < increments.size(); ++b) u.push_back(state_.bodies[b].displacement + increments[b]);
  follow(model_, u, keepRows);
  system_.updateConstraints();
  std::vector<Vector> gap0 = state_.gap;
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    if (!interface.follows()) continue;
    const auto& [nonmortar, mortar, coupling] = interface.pair();
    gap0[k] = -interface.distanceHere() - interface.jump(increments[nonmortar.body], increments[mortar.body]);
  }
  return gap0;
}

std::vector<Vector> StepTaker::followTo(const Iterate& iterate) {
  return followTo(incrementsOf(iterate), false);
}

StepOutcome StepTaker::repeatOnMovedBodies(StepData& data, Iterate& iterate, Effort effort) {
  constexpr int usual = 40;
  constexpr int most = 400;  // where each is nearer, as short of the load at which a body tips
  constexpr int freely = 8;  // a set of rows that still changes then is kept
  constexpr double settled = 1e-10;
  constexpr double balanced = 1e-9;  // it was on the rows before; the next repetition would be as much better
  StepOutcome total;
  std::vector<Vector> found = incrementsOf(iterate);
  Repetitions repetitions(found);
  data.gap = followTo(found, false);
  double off = 0;
  bool searchedAgain = false;
  int repetition = 1;
  for (; repetition <= usual || (repetition <= most && repetitions.approaches()); ++repetition) {
    StepOutcome here = solveStep(system_, state_, data, iterate, effort);
    const Vector compliance = system_.compliances();
    total.follow(std::move(here));
    if (!total.converged()) return total;
    found = incrementsOf(iterate);
    data.gap = followTo(found, repetition >= freely);
    off = misfit(model_, data.gap, iterate, compliance,
                 roundingOfPlaces(model_, displacements(state_, iterate)));
    if (off <= settled) {
      const Certificate moved =
          system_.certify(system_.step(state_, data), iterate, total.certificate.materialResidual);
      if (moved.forceBalance <= balanced) {
        if (searchedAgain || !overlapOf(iterate, data.time).refused()) {
          total.certificate = worse(total.certificate, moved);
          return total;
        }
        searchedAgain = true;  // its rows may have been kept from before
        data.gap = followTo(found, false);
        continue;
      }
    }
    repetitions.add(found);
    const std::vector<Vector>& next = repetitions.goOn(repetition >= freely);
    if (repetitions.relaxes()) data.gap = followTo(next, true);
  }
  if (const std::string motion = system_.contactHolds() ? repetitions.whatFalls(model_) : ""; !motion.empty())
    total.fail(Reason::unheld, "contact where the bodies are cannot hold " + motion);
  else
    total.fail(Reason::unconverged,
               formatted("contact geometry did not converge in %d updates: the last one is off "
                         "by %g of the largest contact force",
                         repetition - 1, off));
  return total;
}

}  // namespace mortier
