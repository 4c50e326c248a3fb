// Where in a step nodes begin to slip. As loads grow in proportion to the part of the step, forces change in
// proportion to it while sets are the same:
//
//   1. The sets are those of the start; nodes that slip at the end and did not in this direction before
//      stick.
//   2. The forces at the end of the step are those that these sets would have.
//   3. On the way there, the first nodes have their bound, and slip from then on; or have no more pressure,
//      and open. From there on with 2, until none does any more.
//
// Nodes that close within the step are open until its end.
#include <algorithm>

#include "base/interrupt.h"
#include "solver/closed_contact.h"
#include "solver/step_system.h"

namespace mortier {
namespace {

/// The part of the way from one value to another at which it is no longer positive; 2 where it stays so.
double crossing(double before, double after) {
  return !(before > 0) ? 0 : after < 0 ? before / (before - after) : 2;
}

/// Takes out of a list what has happened until a part of the step, and tells it.
template <class At, class Tell>
void take(std::vector<size_t>& list, double until, const At& at, const Tell& tell) {
  std::vector<size_t> left;
  for (const size_t each : list) {
    if (at(each) > until)
      left.push_back(each);
    else
      tell(each);
  }
  list = std::move(left);
}

}  // namespace

std::vector<Vector> StepSystem::frictionAtSlip(const State& state0, const std::vector<Vector>& gap0,
                                               const Iterate& end) {
  constexpr double together = 0.01;  // of the step
  constexpr int most = 50;
  std::vector<Vector> atSlip = state0.frictionForce;
  const auto& [node, law, components] = contact_.along;
  if (node.empty()) return atSlip;
  const Eigen::Index n = rows();
  const Vector after = joined(end.contactForce, end.frictionForce);
  Vector now = joined(state0.contactForce, state0.frictionForce);
  const FrictionSets setsAfter = joinedSets(end);
  const auto lacks = [&, &law = law, &node = node, m = components](const Vector& forces, size_t k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double bound = law.coefficient[row] * forces[node[k]] + law.limit[row];
    const double along = m == 1 ? setsAfter.slip[k] * forces[n + row]
                                : setsAfter.directions[k].along.dot(forces.segment<2>(n + 2 * row));
    return std::max(bound, 0.0) - along;
  };

  FrictionSets sets{setsAfter.closed, {}, setsAfter.directions};
  for (const std::vector<signed char>& part : state0.slipping)
    sets.slip.insert(sets.slip.end(), part.begin(), part.end());
  const Vector gap = joined(gap0);
  std::vector<size_t> opening;
  for (size_t i = 0; i < sets.closed.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (now[row] > 0 && setsAfter.closed[i] == 0) opening.push_back(i);
    sets.closed[i] = now[row] > 0 || (gap[row] >= 0 && setsAfter.closed[i] != 0) ? 1 : 0;
  }
  // Tresca's bound is there without any pressure.
  const auto acts = [&, &law = law, &node = node](size_t k) {
    return sets.closed[node[k]] != 0 || law.limit[static_cast<Eigen::Index>(k)] > 0;
  };
  std::vector<size_t> sticking;
  for (size_t k = 0; k < node.size(); ++k) {
    if (sets.slip[k] == setsAfter.slip[k]) continue;
    sets.slip[k] = 0;
    if (setsAfter.slip[k] != 0 && acts(k) && lacks(now, k) > 0) sticking.push_back(k);
  }
  if (sticking.empty()) return atSlip;
  if (!ties_.taken()) static_cast<void>(currentFactors());

  std::vector<Vector> across = solvedGaps(model_, gap0, end);
  for (size_t k = 0; k < across.size(); ++k) {
    across[k] -= gap0[k];
    const ContactInterface& interface = model_.interfaces[k];
    if (interface.yields()) across[k] -= interface.yielded(end.contactForce[k] - state0.contactForce[k]);
  }
  const Vector moved = joined(across, slips(model_, end));
  // From the solution, whose forces of open conditions are taken away, and whose closed ones go back.
  const auto forcesOnSets = [&, &node = node, m = components] {
    Vector forces = after;
    Vector open = Vector::Zero(forces.size());
    for (Eigen::Index i = 0; i < n; ++i)
      if (sets.closed[i] == 0) std::swap(open[i], forces[i]);
    for (size_t k = 0; k < node.size(); ++k)
      if (const Eigen::Index row = n + m * static_cast<Eigen::Index>(k); !acts(k))
        open.segment(row, m).swap(forces.segment(row, m));
    const Vector slack = -moved - contact_.W * open;
    forces += ClosedContact(contact_, sets, false).solve(slack, contact_.G.transpose() * open).change;
    return forces;
  };
  Vector found = joined(state0.frictionForce);
  for (int event = 0; event < most && !sticking.empty(); ++event) {
    stopIfInterrupted();
    const Vector then = forcesOnSets();
    const auto slipsAt = [&](size_t k) { return crossing(lacks(now, k), lacks(then, k)); };
    const auto opensAt = [&](size_t i) {
      return crossing(now[static_cast<Eigen::Index>(i)], then[static_cast<Eigen::Index>(i)]);
    };
    double first = 2;
    for (const size_t k : sticking) first = std::min(first, slipsAt(k));
    for (const size_t i : opening) first = std::min(first, opensAt(i));
    if (first > 1) break;
    const double until = std::min(1.0, first + together);
    take(sticking, until, slipsAt, [&](size_t k) {
      const int m = contact_.along.components;
      const Eigen::Index row = m * static_cast<Eigen::Index>(k);
      sets.slip[k] = setsAfter.slip[k];
      found.segment(row, m) = now.segment(n + row, m) + slipsAt(k) * (then - now).segment(n + row, m);
    });
    take(opening, until, opensAt, [&](size_t i) { sets.closed[i] = 0; });
    now += first * (then - now);
  }
  Eigen::Index first = 0;
  for (Vector& each : atSlip) {
    each = found.segment(first, each.size());
    first += each.size();
  }
  return atSlip;
}

}  // namespace mortier
