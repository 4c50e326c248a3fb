#include <algorithm>
#include <cmath>
#include <limits>

#include "material/interior_path.h"
#include "solver/step.h"

namespace mortier {

// The law is followed along its central path (material/interior_path.h) while the complementarity of contact
// stays exact in every linear solve. Near the end of the path it is told which triangles flow, and Newton's
// method finishes.
StepOutcome StepSolver::interiorPoint(const State& state0, const StepData& step, int maxIterations,
                                      Iterate& solution) {
  constexpr double toBoundary = 0.99;
  constexpr double blocked = 1e-6;
  constexpr double leastCentering = 1e-6;
  constexpr int finishing = 20;
  constexpr int allIterations = 120;
  constexpr double ends[] = {1e-4, 1e-6, 1e-8};  // of mu over the yield strain

  StepOutcome total;
  const auto add = [&](const StepOutcome& part) {
    total.iterations += part.iterations;
    total.factorisations += part.factorisations;
    total.unheld = part.unheld;
    total.reason = part.reason;
  };
  const std::vector<Vector>& loads = loadsAt(step.time);

  Iterate iterate = start(state0);
  prescribe(state0, step.time, iterate);
  std::vector<std::unique_ptr<InteriorPath>> paths;
  int points = 0;
  double flow = 0;
  double yieldStrain = std::numeric_limits<double>::infinity();
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Material& material = model_.bodies[b].material();
    paths.push_back(material.interiorPath(step.weight, state0.bodies[b].stress));
    if (!paths[b]) continue;
    points += paths[b]->points();
    flow = std::max(flow, paths[b]->flowAtTwiceYield());
    yieldStrain = std::min(yieldStrain, paths[b]->flowAtTwiceYield() / (1 + material.stiffness(step.weight)));
  }
  // Stresses that are there may be far beyond yield already.
  double overstress = 1;
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    if (paths[b])
      overstress = std::max(overstress, state0.bodies[b].stress.cwiseAbs().maxCoeff() /
                                            model_.bodies[b].material().stressScale());
  for (const auto& path : paths)
    if (path) path->begin(options_.firstOverstress * overstress * flow);
  const auto complementarity = [&] {
    double sum = 0;
    for (const auto& path : paths) sum += path ? path->complementarity() : 0;
    return sum / points;
  };
  // Where the iterate would go in the direction that aims at `target`. \returns the largest step.
  const auto direct = [&](double target, bool correct, Iterate& next) {
    forEachBody([&](int b) {
      BodyIterate& body = iterate.bodies[b];
      if (paths[b])
        systems_[b].linearise(*paths[b], body.strain, target, correct);
      else
        systems_[b].linearise({step.weight, state0.bodies[b].stress, body.strain, false},
                              step.shift.empty() ? nullptr : &step.shift[b], body);
    });
    if (!correct && !factorise(total)) return 0.0;
    next = iterate;
    solveLinearised(state0, loads, next, total);
    if (!total.reason.empty()) return 0.0;
    double largest = 1 / toBoundary;
    for (size_t b = 0; b < paths.size(); ++b) {
      strain(step, static_cast<int>(b), next.bodies[b]);
      if (paths[b])
        largest = std::min(largest, paths[b]->direct(next.bodies[b].strain - iterate.bodies[b].strain));
    }
    return largest;
  };

  for (const double end : ends) {
    for (double mu = complementarity(); mu > end * yieldStrain; mu = complementarity()) {
      if (total.iterations >= std::min(maxIterations, allIterations)) {
        total.reason = "the interior point method did not converge in " + std::to_string(total.iterations) +
                       " iterations";
        return total;
      }
      ++total.iterations;
      for (size_t b = 0; b < paths.size(); ++b) strain(step, static_cast<int>(b), iterate.bodies[b]);
      Iterate next;
      const double open = std::min(1.0, direct(0, false, next));
      if (!total.reason.empty()) return total;
      const double centering = std::max(leastCentering, std::pow(1 - open, 3));
      const double length = std::min(1.0, toBoundary * direct(centering * mu, true, next));
      if (!total.reason.empty()) return total;
      if (length < blocked) {
        total.reason = "the interior point method found its way barred";
        return total;
      }
      for (size_t b = 0; b < paths.size(); ++b) {
        BodyIterate& body = iterate.bodies[b];
        body.increment += length * next.bodies[b].increment.minus(body.increment);
        if (paths[b])
          paths[b]->advance(length, body.stress);
        else
          body.stress += length * (next.bodies[b].stress - body.stress);
      }
      for (size_t k = 0; k < iterate.contactForce.size(); ++k)
        iterate.contactForce[k] += length * (next.contactForce[k] - iterate.contactForce[k]);
      iterate.active = next.active;
    }
    solution = iterate;
    const int left = maxIterations - total.iterations;
    const StepOutcome last =
        newton(state0, step, {std::min(finishing, left), options_.tolerance, true}, solution);
    add(last);
    if (last.converged) {
      total.converged = true;
      total.certificate = last.certificate;
      return total;
    }
  }
  return total;
}

}  // namespace mortier
