#include "solver/solve_step.h"

#include <algorithm>
#include <utility>

#include "solver/methods.h"

namespace mortier {

const char* nameOf(SolutionMethod method) {
  constexpr const char* names[] = {"rest", "newton",          "continuation", "interior-point",
                                   "path", "penalty-duality", "cut"};
  return names[static_cast<int>(method)];
}

namespace {

/// Whether a central path leads to the law, on which few iterations depend on its stiffness.
bool hasPath(const Material& material) {
  const std::vector<LawDescription> laws = material.laws();
  return std::ranges::any_of(laws, [](const LawDescription& law) { return law.projects; });
}

/// Whether a law that flows is linearised where the strain leads in every method.
bool alwaysMaps(const Body& body) {
  const Material& material = body.material();
  return !material.linear() && material.usesReturnMapping() && !hasPath(material);
}

/// Whether a body flows by a law without a yield stress, or by one that is linearised where the strain leads:
/// Newton's method may have a long way to come down from elasticity, and the walks, which begin anew, have
/// none that is shorter. Elsewhere it has corners at which it could turn in circles.
bool comesDownFromFar(const Body& body) {
  return (!body.material().linear() && body.material().stressScale() == 0) || alwaysMaps(body);
}

}  // namespace

// What takes many linear solves comes last, and is for projections that are not associated: with a symmetric
// tangent the interior point method leads to the one solution.
StepOutcome solveStep(StepSystem& system, const State& state0, const StepData& data, Iterate& guess,
                      Effort effort) {
  constexpr int firstContinuation = 60;
  constexpr int usualIterations = 300;
  constexpr int secondContinuation = 100;
  constexpr int longestPath = 1500;
  constexpr int descent = 60;
  const SolverOptions& options = system.options();
  const Step step = system.step(state0, data);
  const std::vector<Body>& bodies = system.model().bodies;
  const auto linear = [](const Body& body) { return body.material().linear(); };
  const bool allLinear = std::ranges::all_of(bodies, linear);
  const bool unique = system.uniqueSolutions();
  // A line search leads down to the one solution. In the plane, where factors cost little, it comes last, and
  // not where there is a path.
  const auto maps = [](const Body& body) { return body.material().usesReturnMapping(); };
  const bool searches = !allLinear && system.completes() && std::ranges::all_of(bodies, maps);
  const bool far = std::ranges::any_of(bodies, comesDownFromFar);
  const int plainIterations = searches ? descent : far ? 25 : 7;
  if (options.reduce && data.startSolved)
    if (StepOutcome outcome = rest(system, step, guess); outcome.converged()) return outcome;
  if (options.method == Method::penaltyDuality) return penaltyDuality(system, step, guess);

  NewtonLimits plain{std::min(plainIterations, options.maxIterations), options.tolerance};
  plain.giveUpOnReversal = !searches;
  plain.lineSearch = plain.anticipate = searches;
  // Before the first solve the strain is that of supports which move alone: a law that is linearised there
  // would flow beside them.
  plain.elasticFirst =
      (searches || std::ranges::any_of(bodies, alwaysMaps)) && !flows(system.model(), state0);
  StepOutcome total = newton(system, step, data.weight, plain, guess);
  const auto tryMethod = [&](SolutionMethod method, StepOutcome next) {
    total.follow(std::move(next));
    total.method = method;
  };
  const auto iterationsLeft = [&](int most) {
    return std::min(most, options.maxIterations) - total.iterations;
  };
  const auto unsolved = [&](int most) {
    return !total.converged() && !total.unheld() && iterationsLeft(most) > 0;
  };
  // What flowed may unload.
  if (unsolved(usualIterations) && flows(system.model(), state0)) {
    plain.iterations = std::min(plainIterations, iterationsLeft(options.maxIterations));
    plain.giveUpOnReversal = false;
    plain.elasticFirst = true;
    Iterate unloaded = startingIterate(state0);
    tryMethod(SolutionMethod::newton, newton(system, step, data.weight, plain, unloaded));
    if (total.converged()) guess = std::move(unloaded);
  }
  // The other methods change the law, which is linear already.
  if (effort == Effort::little || allLinear) return total;
  const bool descends = unique && std::ranges::all_of(bodies, [&](const Body& body) {
                          return linear(body) || alwaysMaps(body);
                        });
  if (unsolved(usualIterations) && descends) {
    NewtonLimits searching{iterationsLeft(usualIterations), options.tolerance};
    searching.lineSearch = true;
    Iterate searched = startingIterate(state0);
    tryMethod(SolutionMethod::newton, newton(system, step, data.weight, searching, searched));
    if (total.converged()) guess = std::move(searched);
  }
  ViscosityContinuation continuation(system.model(), step);
  if (unsolved(usualIterations) && !unique)
    tryMethod(SolutionMethod::continuation,
              lowerViscosity(system, step, continuation,
                             std::min(firstContinuation, iterationsLeft(usualIterations)), guess));
  if (unsolved(usualIterations))
    tryMethod(SolutionMethod::interiorPoint,
              interiorPoint(system, step, iterationsLeft(usualIterations), guess));
  if (unsolved(usualIterations) && !descends) {
    const int most = std::min(unique ? usualIterations : secondContinuation, iterationsLeft(usualIterations));
    tryMethod(SolutionMethod::continuation, lowerViscosity(system, step, continuation, most, guess));
  }
  const int longest = effort == Effort::all ? options.maxIterations : usualIterations;
  if (unsolved(longest) && !unique)
    tryMethod(SolutionMethod::path,
              followCurve(system, step, continuation, std::min(longestPath, iterationsLeft(longest)), guess));
  return total;
}

namespace {

/// Whether all loads and supports are the same, to the last bit, at the start and the end of a step.
bool sameData(StepSystem& system, const Step& step) {
  const double before = step.state0.time;
  const double after = step.data.time;
  const Model& model = system.model();
  if (before != after && system.loadsAt(before) != step.loads) return false;
  for (const ContactInterface& interface : model.interfaces)
    if (interface.distanceMoves() && interface.distance(before) != interface.distance(after)) return false;
  return std::ranges::all_of(model.bodies, [&](const Body& body) {
    Vector u = Vector::Zero(body.dofs());
    Vector v = u;
    body.prescribe(before, u);
    body.prescribe(after, v);
    return u == v;
  });
}

}  // namespace

StepOutcome rest(StepSystem& system, const Step& step, Iterate& iterate) {
  constexpr double touching = 1e-14;
  StepOutcome outcome;
  outcome.method = SolutionMethod::rest;
  const Model& model = system.model();
  const auto none = [](const Matrix& explicitStrain) { return explicitStrain.isZero(0); };
  if (!sameData(system, step) || flows(model, step.state0) ||
      !std::ranges::all_of(step.data.explicitStrain, none))
    return outcome;
  iterate = startingIterate(step.state0);
  const double residual = system.linearise(step, iterate, step.data.weight, false).residual();
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    Vector gap = step.gap0()[k];
    if (interface.yields()) gap -= interface.yielded(iterate.contactForce[k]);
    const double size = model.bodies[interface.pair().nonmortar.body].extent();
    for (Eigen::Index i = 0; i < gap.size(); ++i)
      if (gap[i] < -touching * size) iterate.active[k][i] = 0;
  }
  const Certificate certificate = system.certify(step, iterate, residual);
  if (residual <= system.options().tolerance && certificate.forceBalance <= balanceTolerance)
    outcome.converge(certificate);
  return outcome;
}

}  // namespace mortier
