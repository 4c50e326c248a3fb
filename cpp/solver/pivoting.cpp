// How the active set of a contact problem is found: complementarity.h.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/interrupt.h"
#include "solver/contact_sets.h"

namespace mortier {
namespace {

using Violations = ContactSets::Violations;

/// The penetration of a set, as the energy of closing each condition by itself.
double depthOf(const Violations& violations, const Vector& diagonal) {
  double sum = 0;
  for (const int i : violations.penetration) sum += violations.slack[i] * violations.slack[i] / diagonal[i];
  return sum;
}

/// Whether a set without tension is nearer to the solution. W symmetric: by the energy 1/2 p'W p + s0'p,
/// whose change is half of s_old'p_new - s_new'p_old; else by the number of conditions that penetrate.
bool isBetter(const Violations& next, const Violations& best, bool symmetric) {
  if (next.penetration.empty()) return true;
  if (!symmetric) return next.penetration.size() < best.penetration.size();
  return best.slack.dot(next.force) < next.slack.dot(best.force);
}

/// The deepest condition of each run of neighbours that penetrate: most of a run that closes as a whole would
/// be under tension. At most `count`, the deepest ones.
std::vector<int> deepest(const Violations& violations, const Vector& diagonal, size_t count) {
  const Vector depth = violations.slack.cwiseQuotient(diagonal);
  std::vector<int> result;
  for (size_t k = 0; k < violations.penetration.size(); ++k) {
    const int i = violations.penetration[k];
    if (k == 0 || i != violations.penetration[k - 1] + 1)
      result.push_back(i);
    else if (depth[i] < depth[result.back()])
      result.back() = i;
  }
  if (result.size() <= count) return result;
  std::nth_element(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(count), result.end(),
                   [&](int a, int b) { return std::pair(depth[a], a) < std::pair(depth[b], b); });
  result.resize(count);
  return result;
}

/// Removes conditions under tension. Contact that peels off from the ends of closed runs would lose one node
/// in each solve: after a few solves neighbours are removed too, twice as many each time, until some of them
/// penetrate, which are closed again.
class TensionRemoval {
 public:
  void drop(const Violations& violations, std::vector<char>& active) {
    constexpr int patience = 3;
    if (++rounds_ > patience) width_ = std::max(1, std::min(2 * width_, widest_));
    for (const int i : violations.tension) active[i] = 0;
    const auto n = static_cast<int>(active.size());
    for (const int i : violations.tension)
      for (const int side : {-1, 1})
        for (int j = i + side; j >= 0 && j < n && std::abs(j - i) < width_ && active[j] != 0; j += side) {
          active[j] = 0;
          beside_.push_back(j);
        }
  }
  /// \returns whether too many were dropped.
  bool takeBack(const Violations& violations, std::vector<char>& active) {
    constexpr int narrower = 4;
    bool any = false;
    for (const int i : beside_) {
      if (!std::binary_search(violations.penetration.begin(), violations.penetration.end(), i)) continue;
      active[i] = 1;
      any = true;
    }
    beside_.clear();
    if (!any) return false;
    widest_ = width_ / narrower;
    width_ = 1;
    rounds_ = 0;
    return true;
  }

 private:
  int rounds_ = 0;
  int width_ = 1;
  int widest_ = std::numeric_limits<int>::max() / 2;
  std::vector<int> beside_;
};

/// Solves until no condition is under tension; where none penetrates either, with factors of the set itself.
/// \returns false where the work ends or the set is redundant.
/// \param exchange  whether conditions that penetrate join at once to begin with (semismooth Newton), as long
/// as most times fewer conditions are violated
bool removeTension(ContactSets& contact, ContactSolution& solution, Violations& violations,
                   bool exchange = false) {
  constexpr int patience = 2;
  TensionRemoval removal;
  size_t wrong = solution.active.size() + 1;
  int inVain = 0;
  while (!contact.redundant() && !contact.capped()) {
    stopIfInterrupted();
    if (!contact.solveOn(solution)) return false;
    violations = contact.violationsOf(solution);
    const size_t now = violations.tension.size() + violations.penetration.size();
    inVain += now < wrong ? 0 : 1;
    wrong = std::min(wrong, now);
    exchange = exchange && inVain < patience;
    if (exchange && now > 0) {
      for (const int i : violations.tension) solution.active[i] = 0;
      for (const int i : violations.penetration) solution.active[i] = 1;
      continue;
    }
    if (removal.takeBack(violations, solution.active)) continue;
    removal.drop(violations, solution.active);
    if (!violations.tension.empty()) continue;
    if (!violations.penetration.empty() || contact.fresh()) return true;
    if (!contact.refactor(solution.active)) return false;
  }
  return false;
}

/// Closes a condition that penetrates, from the forces p >= 0 of a set. Of those that come under tension the
/// first one leaves, and so on: the energy falls (Lawson and Hanson 1974).
void descend(ContactSets& contact, int chosen, Vector p, ContactSolution& solution) {
  solution.active[chosen] = 1;
  while (!contact.capped()) {
    stopIfInterrupted();
    if (!contact.solveOn(solution)) return;
    const Vector towards = contact.p0() + solution.change - p;
    double length = 1;
    int first = -1;
    for (int i = 0; i < p.size(); ++i) {
      if (solution.active[i] == 0 || !(p[i] + length * towards[i] < 0)) continue;
      length = -p[i] / towards[i];
      first = i;
    }
    if (first < 0) return;
    p = (p + length * towards).cwiseMax(0);
    p[first] = 0;
    solution.active[first] = 0;
  }
}

/// Closes a condition that penetrates, on a set without tension; no condition becomes violated (Cottle and
/// Dantzig 1968).
void closeOne(ContactSets& contact, int chosen, ContactSolution& solution) {
  if (!contact.solveOn(solution)) return;
  Vector p = contact.p0() + solution.change;
  Vector s = contact.slack();
  const Vector& diagonal = contact.diagonal();
  ContactSets::Growth rate;
  while (!contact.capped()) {
    stopIfInterrupted();
    if (!contact.grow(chosen, solution, rate)) return;
    const double least =
        ContactSets::rounding *
        std::max(rate.force.cwiseAbs().maxCoeff(), rate.slack.cwiseQuotient(diagonal).cwiseAbs().maxCoeff());
    double length = rate.slack[chosen] > 0 ? -s[chosen] / rate.slack[chosen] : INFINITY;
    int next = chosen;
    for (int i = 0; i < p.size(); ++i) {
      if (i == chosen || contact.idle(i)) continue;
      const bool active = solution.active[i] != 0;
      const double fall = active ? -rate.force[i] : -rate.slack[i] / diagonal[i];
      const double value = active ? p[i] : s[i] / diagonal[i];
      if (!(fall > least) || (!active && value < 0) || !(std::max(value, 0.0) < length * fall)) continue;
      length = std::max(value, 0.0) / fall;
      next = i;
    }
    if (!std::isfinite(length)) return;
    p += length * rate.force;
    s += length * rate.slack;
    solution.active[next] = solution.active[next] != 0 ? 0 : 1;
    if (next == chosen) return;
    (solution.active[next] != 0 ? s : p)[next] = 0;
  }
}

/// From the set in `solution` to one that violates nothing. \returns false after all work that is allowed, or
/// where a matrix is redundant.
bool pivot(ContactSets& contact, ContactSolution& solution) {
  constexpr size_t faster = 2;
  constexpr size_t slower = 4;
  constexpr double shallower = 0.9;
  const ContactProblem& problem = contact.problem();
  Violations best;
  if (!removeTension(contact, solution, best, true)) return false;
  size_t atOnce = solution.active.size();
  double least = depthOf(best, contact.diagonal());
  bool pressed = 2 * best.penetration.size() > solution.active.size();  // most of what closes may stay closed
  while (!best.penetration.empty()) {
    const std::vector<char> before = solution.active;
    const std::vector<int> chosen = pressed ? best.penetration : deepest(best, contact.diagonal(), atOnce);
    for (const int i : chosen) solution.active[i] = 1;
    Violations next;
    if (!removeTension(contact, solution, next)) return false;
    // A set that penetrates less than any before is accepted whatever its energy: that happens rarely.
    const double depth = depthOf(next, contact.diagonal());
    if (depth < shallower * least || isBetter(next, best, problem.symmetric)) {
      least = std::min(least, depth);
      best = std::move(next);
      atOnce = faster * chosen.size();
      pressed = false;
      continue;
    }
    solution.active = before;
    if (!pressed) atOnce = std::max<size_t>(1, chosen.size() / slower);
    if (std::exchange(pressed, false) || chosen.size() > 1) continue;
    if (problem.symmetric)
      descend(contact, chosen.front(), best.force, solution);
    else
      closeOne(contact, chosen.front(), solution);
    if (!removeTension(contact, solution, best)) return false;
  }
  return true;
}

}  // namespace

ContactSolution solveBalanced(ContactSets& contact, const std::vector<char>& active) {
  constexpr int repetitions = 12;
  constexpr double mostImbalance = 1e-6;
  const Eigen::Index motions = contact.problem().G.cols();
  ContactSolution solution;
  solution.active = active;
  solution.rigid = Vector::Zero(motions);
  bool found = false;
  const auto solve = [&] {
    contact.setProximalPoint(solution.rigid);
    found = pivot(contact, solution);
    return !found || motions == 0 ? 0 : contact.imbalance(solution, Vector::Zero(solution.change.size()));
  };
  repeatProximal(repetitions, balanceRounding, solve, [&] { contact.soften(); });
  if (!found)
    solution.outcome = contact.capped() ? ContactSolution::Outcome::capped : ContactSolution::Outcome::cycled;
  else if (motions > 0 && contact.imbalance(solution, contact.forceScales(solution)) > mostImbalance)
    solution.outcome = contact.isUnbounded(solution) ? ContactSolution::Outcome::unbalanced
                                                     : ContactSolution::Outcome::cycled;
  else
    solution.outcome = ContactSolution::Outcome::solved;
  return solution;
}

}  // namespace mortier
