#include "solver/friction.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "solver/contact_sets.h"
#include "solver/friction_sets.h"
#include "solver/uncarried_load.h"

namespace mortier {
namespace {

/// From the solution of Tresca's law under the bounds of the pressure without friction.
std::optional<FrictionSets> fromFixedBounds(const FrictionSystem& system) {
  constexpr int most = 50;  // where it takes more, the path is shorter
  const auto& [node, law, components] = system.problem().along;
  FrictionSets sets = system.allHeld();
  Vector limit = law.limit;
  for (int repetition = 0; repetition < 2; ++repetition) {
    const FrictionSystem bounded = system.underBounds(limit);
    const auto solution = system.components() > 1 ? bounded.newton(std::move(sets))
                                                  : bounded.changeSingly(std::move(sets), most);
    if (!solution) return std::nullopt;
    sets = solution->sets;
    limit = law.limit + law.coefficient.cwiseProduct(solution->force(node));
  }
  return sets;
}

/// Calls onPath(system) for the problem and for two nearby until it returns true. Where two things happen at
/// once, as they do in a symmetric problem, the path has a corner that it cannot turn.
template <class OnPath>
void followNearby(const FrictionSystem& system, OnPath onPath) {
  constexpr double turn = 0.754877666246693;
  for (const double nearby : {0.0, 1e-9, 1e-7}) {
    Vector q = system.q();
    const double largest = q.lpNorm<Eigen::Infinity>();
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double place = turn * static_cast<double>(i + 1);
      q[i] += nearby * largest * (place - std::floor(place) - 0.5);
    }
    if (onPath(FrictionSystem(system.problem(), q, system.springs(), system.work()))) return;
  }
}

/// Where conditions are independent.
FrictionSolution solveIndependent(const ContactProblem& problem, const Vector& q, const Springs& springs,
                                  const FrictionSets& first, bool endWhereSingular, FrictionWork& work) {
  const FrictionSystem system(problem, q, springs, work);
  work.singular = false;
  std::optional<FrictionSolution> found = system.newton(first);
  // A solution of index -1 is one that no path of loads leads to: Newton's method may meet it.
  const auto good = [&] { return found && found->index > 0; };
  const auto goesOn = [&] { return !good() && !(endWhereSingular && work.singular); };
  if (const FrictionSets held = system.allHeld(); goesOn() && !(first == held)) found = system.newton(held);
  if (goesOn()) {
    std::optional<FrictionSets> nearby = fromFixedBounds(system);
    if (nearby) found = system.newton(std::move(*nearby));
  }
  if (goesOn() && system.components() > 1) {
    // They are not tried again for the same load.
    if (!work.swept && (problem.G.cols() == 0 || !uncarriedLoad(problem, springs.load)))
      found = solveBySweeps(system);
    work.swept = work.swept || !good();
  } else if (goesOn()) {
    followNearby(system, [&](const FrictionSystem& moved) {
      const std::vector<FrictionSets> passages = followPath(moved, 0);
      found = passages.empty() ? std::nullopt : system.newton(passages.front());
      return good();
    });
  }
  if (!good()) return {};
  work.singular = false;
  return *found;
}

/// Conditions that depend on each other, as the four at a corner of which both sides touch a rigid body: W
/// is semidefinite. A compliance D of every condition is added, against x0, which follows x until D (x - x0)
/// is nothing: to springs W is W + D.
FrictionSolution solveDependent(const ContactProblem& problem, const Vector& q, const Springs& springs,
                                FrictionSets first, FrictionWork& work) {
  constexpr int repetitions = 8;
  constexpr double weight = 1e-8;
  constexpr double done = 1e-14;
  const Vector D = weight * problem.W.diagonal().cwiseMax(0);
  ContactProblem regular = problem;
  regular.W.diagonal() += D;
  FrictionSolution result;
  Vector x0 = Vector::Zero(q.size());
  const auto solve = [&] {
    result = solveIndependent(regular, q - D.cwiseProduct(x0), springs, first, false, work);
    if (!result.solved) return 0.0;
    first = result.sets;
    const double left = D.cwiseProduct(result.force - x0).lpNorm<Eigen::Infinity>();
    x0 = result.force;
    return ratio(left, q.lpNorm<Eigen::Infinity>() + (problem.W * x0).lpNorm<Eigen::Infinity>());
  };
  repeatProximal(repetitions, done, solve);
  work.singular = true;
  return result;
}

FrictionSolution solveOnSprings(const ContactProblem& problem, const Vector& q, const Springs& springs,
                                const FrictionSets& first, FrictionWork& work) {
  const bool ambiguous = work.ambiguous;
  FrictionSolution result = solveIndependent(problem, q, springs, first, true, work);
  if (result.solved || !work.singular) return result;
  work.ambiguous = ambiguous;  // the sign of a determinant that is rounding has no meaning
  result = solveDependent(problem, q, springs, first, work);
  if (result.solved) return result;
  work.ambiguous = ambiguous;
  if (problem.along.components > 1) {
    // Where sets differ by forces that balance each other Newton's method goes round, and sweeps do not.
    if (const auto swept = solveBySweeps(FrictionSystem(problem, q, springs, work))) {
      work.singular = true;
      return *swept;
    }
    work.ambiguous = ambiguous;
  }
  // A single set may be singular where conditions are independent.
  return solveIndependent(problem, q, springs, first, false, work);
}

}  // namespace

FrictionSolution solveFriction(const ContactProblem& given, Vector q, FrictionSets first, const Vector& load,
                               std::vector<FrictionSolution>* all) {
  constexpr int repetitions = 15;
  constexpr double softest = 1e-4;  // springs, over those to begin with
  constexpr double stiffer = 1e3;
  constexpr double stiffest = 0.1;  // over the stiffness of contact
  constexpr double mostImbalance = 1e-9;
  constexpr double roundingOfGaps = 1e-5;  // an imbalance of 1e-9 of that is rounding

  const std::optional<ContactProblem> regular =
      given.along.components > 1 ? std::optional(withoutIdleSlips(given)) : std::nullopt;
  const ContactProblem& problem = regular ? *regular : given;
  const Matrix& G = problem.G;
  const double compliance = problem.W.diagonal().maxCoeff();
  // What rigid motions take away is taken first, as in solveContact.
  std::vector<char> closed = first.closed;
  for (size_t k = 0; k < first.slip.size(); ++k) {
    const bool sticks = first.slip[k] == 0 && first.closed[problem.along.node[k]] != 0;
    closed.insert(closed.end(), problem.along.components, sticks ? 1 : 0);
  }
  const Vector moved = moveRigidBodiesIntoContact(G, closed, q);
  const double force = load.lpNorm<Eigen::Infinity>();
  Springs springs{load, Vector::Zero(G.cols())};
  springs.stiffness = proximalStiffness(problem.proximal * (G.squaredNorm() / compliance), force,
                                        q.head(problem.normals()).maxCoeff());
  const double least = softest * springs.stiffness;
  FrictionSolution result;
  FrictionWork work;
  double imbalance = 0;
  double beside = 0;
  Vector change;
  bool stiffened = false;
  const auto solve = [&] {
    result = solveOnSprings(problem, q, springs, first, work);
    // On weak springs bodies that nothing presses move far in a solve, and Newton's method goes round.
    for (double most = stiffest * G.squaredNorm() / compliance;
         !result.solved && springs.stiffness < most && !uncarriedLoad(problem, load);) {
      springs.stiffness *= stiffer;
      stiffened = true;
      work.swept = false;
      result = solveOnSprings(problem, q, springs, first, work);
    }
    if (!result.solved) return 0.0;
    first = result.sets;
    change = result.rigid - springs.z0;
    springs.z0 = result.rigid;
    imbalance = (load - G.transpose() * result.force).lpNorm<Eigen::Infinity>();
    const Matrix size = G.cwiseAbs().transpose();
    beside = force + (size * result.force.cwiseAbs()).lpNorm<Eigen::Infinity>();
    return ratio(imbalance, beside);
  };
  repeatProximal(repetitions, balanceRounding, solve,
                 [&] { springs.stiffness = std::max(softer * springs.stiffness, least); });
  if (result.solved) {
    const double usual = problem.forceScale + roundingOfGaps * q.lpNorm<Eigen::Infinity>() / compliance;
    const double scale = beside + usual * G.cwiseAbs().colwise().sum().lpNorm<Eigen::Infinity>();
    result.balanced = G.cols() == 0 || imbalance <= mostImbalance * scale;
    result.solved = result.balanced || !stiffened;  // else these springs hold what would not be held
    if (all != nullptr && result.balanced) *all = solutionsOnPath(problem, q, springs, result);
    result.rigid = result.balanced ? Vector(result.rigid + moved) : change;
  }
  static_cast<FrictionWork&>(result) = work;
  return result;
}

std::vector<FrictionSolution> solutionsOnPath(const ContactProblem& problem, const Vector& q,
                                              const Springs& springs, const FrictionSolution& taken) {
  constexpr double same = 1e-9;
  constexpr double beyond = 3;
  std::vector<FrictionSolution> all{taken};
  const auto isKnown = [&](const FrictionSolution& one) {
    return std::any_of(all.begin(), all.end(), [&](const FrictionSolution& other) {
      const double size =
          std::max(one.force.lpNorm<Eigen::Infinity>(), other.force.lpNorm<Eigen::Infinity>());
      return one.sets == other.sets || (one.force - other.force).lpNorm<Eigen::Infinity>() <= same * size;
    });
  };
  FrictionWork work;
  const FrictionSystem system(problem, q, springs, work);
  followNearby(system, [&](const FrictionSystem& moved) {
    const std::vector<FrictionSets> passages = followPath(moved, beyond);
    for (const FrictionSets& sets : passages)
      if (const auto one = system.newton(sets); one && !isKnown(*one)) all.push_back(*one);
    return !passages.empty();
  });
  return all;
}

}  // namespace mortier
